"""A day or a season on paper: gathered once, written as PDF or HTML."""
