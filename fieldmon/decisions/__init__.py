"""From finds to a decision: thresholds, sequential plans, where to treat."""
