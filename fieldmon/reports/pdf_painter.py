"""Drawings put down on a page of PDF."""

from __future__ import annotations

import io
from contextlib import contextmanager
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from fieldmon.reports.drawing import (
    Areas,
    Bitmap,
    Discs,
    Drawing,
    Lettering,
    Part,
    Segments,
    Strokes,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fpdf import FPDF
    from numpy.typing import NDArray

    from fieldmon.reports.drawing import Colour
    from fieldmon.reports.fonts import FontSet

#: a point of type in millimetres
PT_MM = 25.4 / 72
# a disc with an edge has so many corners: smaller than a plant, a hundredth of a curve's bytes
_CORNERS = 16
#: how wide texts are in each file that is written, by font and size
_WIDE_MM: WeakKeyDictionary[FPDF, dict[tuple[str, str, float, str], float]] = WeakKeyDictionary()


def paint(pdf: FPDF, fonts: FontSet, drawing: Drawing, corner: tuple[float, float]) -> None:
    """Put a drawing down, its upper left corner there."""
    for part in drawing.parts:
        _part(pdf, fonts, part, np.array(corner))


def _part(pdf: FPDF, fonts: FontSet, part: Part, at: NDArray[np.float64]) -> None:
    if isinstance(part, Strokes):
        _strokes(pdf, part, at)
    elif isinstance(part, Segments):
        _segments(pdf, part, at)
    elif isinstance(part, Areas):
        _areas(pdf, part, at)
    elif isinstance(part, Discs):
        _discs(pdf, part, at)
    elif isinstance(part, Lettering):
        letter(pdf, fonts, part, (float(at[0]), float(at[1])))
    elif isinstance(part, Bitmap):
        x, y = at + np.array([part.x, part.y])
        pdf.image(io.BytesIO(part.png), float(x), float(y), part.width, part.height)


def _pen(pdf: FPDF, colour: Colour, width: float) -> None:
    pdf.set_draw_color(*colour)
    pdf.set_line_width(width)


def _strokes(pdf: FPDF, part: Strokes, at: NDArray[np.float64]) -> None:
    with pdf.local_context(stroke_join_style="round", stroke_cap_style="round"):
        _pen(pdf, part.colour, part.width)
        if part.dashed:
            pdf.set_dash_pattern(dash=1.2, gap=1.2)
        for line in part.lines:
            _path(pdf, line + at, "S")


def _segments(pdf: FPDF, part: Segments, at: NDArray[np.float64]) -> None:
    with pdf.local_context(stroke_cap_style="butt"):
        _pen(pdf, part.colour, part.width)
        for x1, y1, x2, y2 in (part.ends + np.tile(at, 2)).tolist():
            pdf.line(x1, y1, x2, y2)


def _areas(pdf: FPDF, part: Areas, at: NDArray[np.float64]) -> None:
    """Fill rings and draw their edges; what lies in a hole is left out by cutting it."""
    with _filling(pdf, part) as paint_by:
        for ring in part.rings:
            _path(pdf, ring + at, paint_by, closed=True)


@contextmanager
def _filling(pdf: FPDF, part: Areas | Discs) -> Iterator[str]:
    """Choose colours; give how areas are painted with them."""
    paints = {(True, True): "B", (True, False): "f", (False, True): "S", (False, False): "S"}
    opacity = part.opacity if isinstance(part, Areas) else 1.0
    with pdf.local_context(fill_opacity=opacity, stroke_join_style="round"):
        if part.fill:
            pdf.set_fill_color(*part.fill)
        if part.edge:
            _pen(pdf, part.edge, part.width)
        yield paints[bool(part.fill), bool(part.edge)]


def _path(pdf: FPDF, corners: NDArray[np.float64], paint_by: str, *, closed: bool = False) -> None:
    """Draw a line as `FPDF.polyline` does, which takes ten times as long: a map has thousands."""
    _paths(pdf, corners[None], f" h\n {paint_by}" if closed else f" {paint_by}")


def _paths(pdf: FPDF, corners: NDArray[np.float64], ends: str) -> None:
    """Draw lines of equally many corners ``(k, c, 2)``, each with what ends it."""
    points = (corners * [1, -1] + [0, pdf.h]) * pdf.k
    k, c, _ = points.shape
    each = "\n".join(["%.2f %.2f m", *(c - 1) * ["%.2f %.2f l"], ends])
    drawn = "\n".join(k * [each]) % tuple(points.ravel().tolist())
    pdf._out(drawn)  # noqa: SLF001 - it has no other way


def _discs(pdf: FPDF, part: Discs, at: NDArray[np.float64]) -> None:
    places = np.reshape(part.places, (-1, 1, 2)) + at
    if not len(places):
        return
    if part.fill and not part.edge:
        # what a round pen leaves that does not move
        with pdf.local_context(stroke_cap_style="round"):
            _pen(pdf, part.fill, 2.0 * part.radius)
            _paths(pdf, np.repeat(places, 2, axis=1), " S")
        return
    turn = np.linspace(0, 2 * np.pi, _CORNERS, endpoint=False)
    about = part.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    with _filling(pdf, part) as paint_by:
        _paths(pdf, places + about, f" h\n {paint_by}")


def wide_mm(pdf: FPDF, text: str) -> float:
    """Return how wide a text is in the font that is set; of each it is asked once, which is slow.

    The same numbers and names stand in hundreds of rows of a table.
    """
    known = _WIDE_MM.setdefault(pdf, {})
    asked = pdf.font_family, pdf.font_style, pdf.font_size_pt, text
    if asked not in known:
        known[asked] = float(pdf.get_string_width(text))
    return known[asked]


def letter(pdf: FPDF, fonts: FontSet, part: Lettering, at: tuple[float, float]) -> None:
    """Write words, their middle at the height named."""
    text = fonts.printable(part.text)
    pdf.set_font("open", "B" if part.bold else "", part.size_pt)
    pdf.set_text_color(*part.colour)
    wide = wide_mm(pdf, text)
    x = at[0] + part.x - wide * {"start": 0.0, "middle": 0.5, "end": 1.0}[part.anchor]
    high = part.size_pt * PT_MM * 1.2
    pdf.set_xy(x - pdf.c_margin, at[1] + part.y - high / 2)
    pdf.cell(wide + 2 * pdf.c_margin, high, text, align="L")
