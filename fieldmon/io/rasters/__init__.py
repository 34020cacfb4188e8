"""Rasters: pictures of the ground, and values that plants stand on."""
