"""What is believed of the plants and what happens to them: records, chances, nights, hot spots."""
