"""The directions in which plants stand in rows, over one another: each its own line and colour."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pydeck import Layer

from fieldmon.plot.row_detection import row_ends

from . import legends

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.row_detection import RowDirection

    from .colours import Colour
    from .labels import Label
    from .legends import LegendPart

    Float = NDArray[np.float64]

# Okabe & Ito's, for the colour-blind
_COLOURS: tuple[Colour, ...] = ((0, 114, 178), (213, 94, 0), (204, 121, 167), (0, 158, 115))
# of the longest row: how many strokes, and which share of each is drawn; the first is not broken
_STROKES = ((1, 1.0), (20, 0.6), (36, 0.5), (12, 0.8))
# more strokes than these make a map slow
_MOST = 6_000


def layers(lonlat: Float, found: tuple[RowDirection, ...], notes: tuple[str, ...]) -> list[Layer]:
    """Return the rows of plants ``(n, 2)`` in each direction, with what each says when tapped."""
    made = []
    for k, (one, note) in enumerate(zip(found, notes, strict=True)):
        ends = row_ends(lonlat, one.bearing_deg, one.row_spacing_m)
        lines = [{"path": path, "t": note} for path in _strokes(ends, *_STROKES[k % len(_STROKES)])]
        made.append(
            Layer("PathLayer", lines, id=f"direction-{k + 1}", get_path="path",
                  get_color=list(colour(k)), get_width=0.3, width_min_pixels=2.5)
        )  # fmt: skip
    return made


def legend(notes: tuple[str, ...]) -> LegendPart:
    """Return what the lines of each direction mean."""
    return legends.part("", [("line", colour(k), note) for k, note in enumerate(notes)])


def numbers(lonlat: Float, found: tuple[RowDirection, ...]) -> list[Label]:
    """Return the number of each direction, at the beginning of its middle row."""
    made: list[Label] = []
    for k, one in enumerate(found):
        ends = row_ends(lonlat, one.bearing_deg, one.row_spacing_m)
        made.append({"p": ends[len(ends) // 2, 0].round(7).tolist(), "t": f"{k + 1}", "k": "leg"})
    return made


def colour(k: int) -> Colour:
    """Return the colour of a direction, by its number from 0."""
    return _COLOURS[k % len(_COLOURS)]


def _strokes(ends: Float, most: int, share: float) -> list[list[list[float]]]:
    """Return rows ``(r, 2, 2)`` as strokes of about one length, `most` of them on the longest."""
    step = ends[:, 1] - ends[:, 0]
    length = np.hypot(*step.T)
    most = min(most, max(_MOST // len(ends), 3)) if most > 1 else 1
    n = np.maximum(np.round(most * length / max(length.max(), 1e-12)), 1).astype(int)
    row = np.repeat(np.arange(len(ends)), n)
    place = np.concatenate([np.arange(k) for k in n])
    at = np.stack([place, place + share], axis=1) / n[row, None]
    paths = ends[row, None, 0] + at[..., None] * step[row, None]
    strokes: list[list[list[float]]] = np.round(paths, 7).tolist()
    return strokes
