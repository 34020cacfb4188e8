"""From layers to what fieldmon knows: plots, plants, records, inspections."""
