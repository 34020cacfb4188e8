"""Chances of plants and of pairs of neighbours, by day and by night."""
