"""What stands where: field, plants in rows, headlands, and the way from plant to plant."""
