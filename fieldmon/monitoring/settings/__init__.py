"""What is chosen for a season, from which day on, and in which words it is said."""
