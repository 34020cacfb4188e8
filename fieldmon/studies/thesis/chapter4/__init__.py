"""The published experiments: listings, scenarios, tables."""
