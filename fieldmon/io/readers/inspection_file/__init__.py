"""A file of inspections: its columns, results, plants, times, and all of it row by row."""
