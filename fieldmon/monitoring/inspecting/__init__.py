"""What is found: inspections as they are recorded, told again, contradicted and listed."""
