"""Samplers and beliefs side by side: the same insects, the same luck, the same hours."""
