"""What is shown of a plot, a day and a season; nothing is written or started in here."""
