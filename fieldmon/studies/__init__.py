"""Published experiments made again, and samplers and beliefs held against each other."""
