"""Foreign files are opened in a process of their own, within limits; only values come out."""
