"""Routes along rows: published models and heuristics beside the exact ladder."""
