"""What insects do: how they spread, hide and fare in the weather."""
