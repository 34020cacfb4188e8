"""Files by their format: each becomes a layer of geometries and columns."""
