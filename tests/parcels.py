"""Many plots from a few: each shifted to a place of its own and turned."""

import json

import numpy as np
import shapely

from fieldmon.plot.projection import Frame


def many(fields, n, seed=1):
    """Return n boundaries in degrees, made from those of `fields` by shifting and turning."""
    rng = np.random.default_rng(seed)
    made = []
    for k in range(n):
        boundary = fields[k % len(fields)].boundary
        west, south, east, north = boundary.bounds
        shape = Frame((west + east) / 2, (south + north) / 2).geometry_m(boundary)
        there = Frame(-3.0 + 0.03 * (k % 40), 40.0 + 0.03 * (k // 40), rng.uniform(0.0, 360.0))
        made.append(there.geometry_lonlat(shape))
    return made


def write_geojson(path, shapes, **columns):
    """Write areas in degrees with a column of names, and any others given."""
    features = [
        {
            "type": "Feature",
            "geometry": json.loads(shapely.to_geojson(shape)),
            "properties": {
                "name": f"Plot {k + 1}",
                **{name: values[k] for name, values in columns.items()},
            },
        }
        for k, shape in enumerate(shapes)
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
