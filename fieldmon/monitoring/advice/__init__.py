"""To treat, to inspect more, or to wait: what a season's inspections prove."""
