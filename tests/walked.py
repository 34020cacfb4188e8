"""Outlines as somebody walks round them with a phone."""

import numpy as np

from fieldmon.plot.projection import Frame

FRAME = Frame(35.151, 30.3602)


def walked(corners, step_m=3.0, noise_m=1.0, *, drift_m=0.0, stand=0, seed=0):
    """Return the fixes ``(n, 2)`` of a walk round corners in metres, the first one last again.

    Each fix is off by the noise, and by a drift that stays much the same for 30 m; at each corner
    so many fixes are taken standing.
    """
    rng = np.random.default_rng(seed)
    on_way = []
    for here, there in zip(np.array(corners, float), np.roll(corners, -1, axis=0), strict=True):
        n = max(1, int(np.hypot(*(there - here)) / step_m))
        on_way += [here] * stand + [here + (there - here) * k / n for k in range(n)]
    drift, off = rng.normal(0, drift_m, 2), []
    keeps = np.exp(-step_m / 30.0)
    for _ in on_way:
        off.append(drift)
        drift = keeps * drift + np.sqrt(1 - keeps**2) * rng.normal(0, drift_m, 2)
    fixes = np.array(on_way) + np.array(off) + rng.normal(0, noise_m, (len(on_way), 2))
    return np.concatenate([fixes, fixes[:1]])


def write_corners(path, xy_m):
    """Write a table of corners in metres east and north of a place, as degrees."""
    lines = [f"{lon:.7f},{lat:.7f}" for lon, lat in FRAME.lonlat(np.array(xy_m, float))]
    path.write_text("\n".join(["lon,lat", *lines]) + "\n")
    return path
