"""One day of a season, or of all plots: its routes, who walks them, what is left of it."""
