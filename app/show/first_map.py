"""A plot's outline where the map will be, before the browser has loaded what draws maps."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING
from urllib.parse import quote

import numpy as np
import shapely

from ..words import texts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.field import Field

_SIZE = 1000.0
# seen on a light ground and on a dark one
_LINE = "#7c857f"


def outline(field: Field) -> str:
    """Return the outline as a drawing that fills the free part of the window."""
    rings = [
        shapely.get_coordinates(ring)
        for ring in shapely.get_rings(shapely.get_parts(field.boundary))
    ]
    corners = np.concatenate(rings)
    low, high = corners.min(axis=0), corners.max(axis=0)
    flat = np.array([np.cos(np.deg2rad((low[1] + high[1]) / 2)), 1.0])
    wide, tall = (high - low) * flat
    scale = _SIZE / max(wide, tall, 1e-9)

    def placed(ring: NDArray[np.float64]) -> str:
        x, y = ((ring - low) * flat * scale).T
        return "M" + "L".join(f"{a:.1f} {tall * scale - b:.1f}" for a, b in zip(x, y, strict=True))

    path = "".join(placed(ring) + "Z" for ring in rings)
    box = f"0 0 {max(wide * scale, 1):.0f} {max(tall * scale, 1):.0f}"
    drawing = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}"><path d="{path}" fill="none" '
        f'stroke="{_LINE}" stroke-width="2" vector-effect="non-scaling-stroke"/></svg>'
    )
    said = escape(texts.OUTLINE_ALT.format(name=field.name))
    # as a picture: of what stands in a page, Streamlit takes drawings out
    return f'<img class="first-map" alt="{said}" src="data:image/svg+xml,{quote(drawing)}">'
