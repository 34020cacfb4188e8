"""The samplers: who decides which plants come next."""
