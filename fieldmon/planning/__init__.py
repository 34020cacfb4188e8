"""One day: which plants, in which order, along which line, and why."""
