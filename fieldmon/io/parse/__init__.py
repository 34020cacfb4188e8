"""What cells, columns and coordinates mean, by their own evidence."""
