"""Samplers and beliefs side by side: the same insects, the same draws, the same hours."""
