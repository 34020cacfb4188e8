"""The doors: files of others in, files for others out."""
