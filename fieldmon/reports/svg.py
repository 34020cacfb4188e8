"""Drawings as SVG, for a page of HTML."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING

import numpy as np
from markupsafe import Markup

from fieldmon.reports.drawing import Areas, Bitmap, Discs, Part, Segments, Strokes
from fieldmon.reports.pdf_painter import PT_MM

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.reports.drawing import Colour, Drawing


_NONE = Markup()
_HIDDEN = Markup('aria-hidden="true"')
_ROUND, _DASHED = Markup(' stroke-linecap="round"'), Markup(' stroke-dasharray="1.2"')
_EVEN_ODD, _BOLD = Markup(' fill-rule="evenodd"'), Markup(' font-weight="bold"')


def svg(drawing: Drawing, label: str) -> Markup:
    """Return a drawing as an SVG element; `label` says what it shows."""
    said = Markup('role="img" aria-label="{}"').format(label) if label else _HIDDEN
    return Markup(
        '<svg xmlns="http://www.w3.org/2000/svg" {} viewBox="0 0 {:.1f} {:.1f}" '
        'font-family="system-ui, sans-serif" stroke-linejoin="round">{}</svg>'
    ).format(said, drawing.width, drawing.height, Markup().join(map(_part, drawing.parts)))


def _part(part: Part) -> Markup:
    if isinstance(part, Strokes):
        return _path(
            "".join(_line(line) for line in part.lines), None, part.colour, part.width,
            _ROUND + (_DASHED if part.dashed else Markup()),
        )  # fmt: skip
    if isinstance(part, Segments):
        ends = np.round(part.ends, 2).tolist()
        data = "".join(f"M{a:g} {b:g}L{c:g} {d:g}" for a, b, c, d in ends)
        return _path(data, None, part.colour, part.width)
    if isinstance(part, Areas):
        data = "".join(f"{_line(ring)}Z" for ring in part.rings)
        through = Markup(' fill-opacity="{:g}"').format(part.opacity)
        return _path(data, part.fill, part.edge, part.width, _EVEN_ODD + through)
    if isinstance(part, Discs):
        return Markup().join(_disc(part, x, y) for x, y in np.round(part.places, 2).tolist())
    if isinstance(part, Bitmap):
        return Markup(
            '<image x="{:g}" y="{:g}" width="{:g}" height="{:g}" preserveAspectRatio="none" '
            'href="data:image/png;base64,{}"/>'
        ).format(part.x, part.y, part.width, part.height, base64.b64encode(part.png).decode())
    return Markup(
        '<text x="{:.2f}" y="{:.2f}" font-size="{:.2f}" fill="{}" text-anchor="{}" '
        'dominant-baseline="central"{}>{}</text>'
    ).format(
        part.x, part.y, part.size_pt * PT_MM, _colour(part.colour), part.anchor,
        _BOLD if part.bold else Markup(), part.text,
    )  # fmt: skip


def _disc(part: Discs, x: float, y: float) -> Markup:
    return Markup(
        '<circle cx="{:g}" cy="{:g}" r="{:g}" fill="{}" stroke="{}" stroke-width="{:g}"/>'
    ).format(x, y, part.radius, _colour(part.fill), _colour(part.edge), part.width)


def _path(
    data: str, fill: Colour | None, edge: Colour | None, width: float, more: Markup = _NONE
) -> Markup:
    return Markup('<path d="{}" fill="{}" stroke="{}" stroke-width="{:.2f}"{}/>').format(
        data, _colour(fill), _colour(edge), width, more
    )


def _line(places: NDArray[np.float64]) -> str:
    return "M" + "L".join(f"{x:g} {y:g}" for x, y in np.round(places, 2).tolist())


def _colour(colour: Colour | None) -> str:
    return "none" if colour is None else "#{:02x}{:02x}{:02x}".format(*colour)
