"""The season itself, part by part: what is planned, found, treated, corrected, copied and known."""
