"""Decide which plants to inspect for pests today, and learn from what is found."""
