"""Foreign files are opened in a process of their own, within limits, and nothing gets out of it but values."""
