"""How many looks a verdict takes, and how often it is right."""
