"""The doors: files in, files out. Only here (and in project.py) files are opened."""
