"""Decide in the browser's page, driven without a browser."""
