"""From finds to a decision: action thresholds, sequential plans, where to treat."""
