"""Each change of a season: its transaction, its line in the log, what other programs changed."""
