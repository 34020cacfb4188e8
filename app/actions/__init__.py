"""What a person can do: each action writes, starts or changes something."""
