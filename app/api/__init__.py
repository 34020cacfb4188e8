"""The HTTP interface of a season: fetch the day, tell findings, ask for the rest."""
