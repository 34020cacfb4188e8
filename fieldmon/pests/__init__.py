"""A pest as published figures, the weather that it meets, and how far it has come in it."""
