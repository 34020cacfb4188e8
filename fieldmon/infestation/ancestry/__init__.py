"""Who infested whom: drawn for the finds, and what follows for all plants."""
