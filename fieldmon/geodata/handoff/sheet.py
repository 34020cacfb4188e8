"""A field sheet for a scout without a phone: a map, the plants in order, boxes to tick.

One HTML file that asks for nothing from outside, to be printed on A4.
"""

from __future__ import annotations

from html import escape
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.geodata.routes import summary

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.geodata.handoff.plan import HandoffPlan, Stop

    Float = NDArray[np.float64]

_WIDE_MM, _HIGH_MM = 186.0, 95.0
_MOST_NUMBERS = 60  # stops whose numbers the map shows; of more, every fifth, tenth...
_STYLE = """
@page { size: A4; margin: 12mm; }
* { box-sizing: border-box; }
body { font: 9pt/1.2 sans-serif; color: #000; background: #fff; margin: 0 auto; max-width: 186mm; }
section { break-after: page; } section:last-of-type { break-after: auto; }
h1 { font-size: 14pt; margin: 0 0 1mm; } p { margin: 0 0 2mm; }
.blank { display: inline-block; width: 45mm; border-bottom: 0.3mm solid #000; }
svg { display: block; width: 100%; height: auto; border: 0.2mm solid #999; break-inside: avoid; }
.legend { margin: 2mm 0; }
.rows { columns: 3; column-gap: 5mm; }
table { border-collapse: collapse; width: 100%; margin: 0 0 2mm; }
caption { text-align: start; font-weight: bold; break-after: avoid; }
tr { break-inside: avoid; break-after: auto; }
td { border-bottom: 0.1mm solid #bbb; padding: 0.45mm 0.6mm; text-align: end; }
td.n { color: #555; width: 7mm; } td.p { font-weight: bold; width: 8mm; }
td.w { width: 11mm; } td.c { border-bottom: 0.3mm solid #000; width: 9mm; }
i { display: inline-block; width: 3.4mm; height: 3.4mm; border: 0.3mm solid #000; margin: 0 0.6mm; }
i.found { border-radius: 50%; } i.not { border-style: dashed; }
"""


class _Map(NamedTuple):
    """From metres of the plot to millimetres of paper, rows along the longer side."""

    turned: bool
    low: Float
    scale: float

    def __call__(self, xy_m: Float) -> Float:
        xy = np.atleast_2d(xy_m)
        flat = np.stack([xy[:, 0], -xy[:, 1]], axis=1)
        if self.turned:
            flat = np.stack([-flat[:, 1], flat[:, 0]], axis=1)
        placed: Float = (flat - self.low) * self.scale + 4.0
        return placed


def route_sheet(plan: HandoffPlan) -> bytes:
    """Return a day as an HTML page for printing.

    A route has its own page; one of more stops than fit goes on on the next, no plant's line cut in
    two. Plants are grouped by the row as they come, with arrows for the way the numbers run.
    """
    figures = summary(plan.route, plan.notes)
    start = "" if plan.notes.start is None else f"from {plan.clock(0.0)[11:16]} "
    told = (
        f"{figures['stops']} plants, {figures['drive_m'] / 1000:.2f} km, "
        f"{start}{figures['seconds'] / 3600:.1f} h"
    )
    tables = "".join(
        _row_table(row, list(stops)) for row, stops in groupby(plan.stops, key=lambda s: s.row)
    )
    title = escape(plan.title)
    page = f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>{_STYLE}</style>
</head>
<body>
<section>
<h1><bdi>{title}</bdi></h1>
<p>{told}. Inspected by <span class="blank"></span> on <span class="blank"></span></p>
{_svg(plan)}
<p class="legend">Tick one: <i></i> clean <i class="found"></i> found (write how many)
<i class="not"></i> could not be inspected. Without a tick it counts as not inspected.</p>
<div class="rows">{tables}</div>
</section>
</body>
</html>
"""
    return page.encode()


def _row_table(row: int, stops: list[Stop]) -> str:
    """Return the plants of one row in a line each, with boxes; an arrow where numbers rise."""
    arrow = "" if len(stops) < 2 else (" ↑" if stops[-1].number > stops[0].number else " ↓")
    lines = "".join(
        f'<tr data-plant="{stop.plant}"><td class="n">{stop.order}</td>'
        f'<td class="p">{stop.number}{"ab"[stop.face - 1] if stop.face else ""}</td>'
        f'<td class="w">{stop.arrive[11:16]}</td>'
        '<td><i></i><i class="found"></i><i class="not"></i></td><td class="c"></td></tr>'
        for stop in stops
    )
    return f"<table><caption>Row {row}{arrow}</caption>{lines}</table>"


def _svg(plan: HandoffPlan) -> str:
    grid = plan.grid
    placed, size = _map_of(plan)
    first, last = grid.row_start[:-1], grid.row_start[1:] - 1
    rows = "".join(
        f"M{_xy(placed(grid.xy_m[a]))}L{_xy(placed(grid.xy_m[b]))}"
        for a, b in zip(first.tolist(), last.tolist(), strict=True)
    )
    line = _path(placed(plan.route.line_m)) if len(plan.route.line_m) > 1 else ""
    return (
        f'<svg viewBox="0 0 {size[0]:.1f} {size[1]:.1f}" role="img" aria-label="map">'
        f'<path d="{_area(plan, placed)}" fill="#f4f4ee" stroke="#888" stroke-width="0.3" '
        'fill-rule="evenodd"/>'
        f'<path d="{rows}" stroke="#9c9" stroke-width="0.4" stroke-linecap="round"/>'
        f'<path d="{line}" fill="none" stroke="#c50" stroke-width="0.35" stroke-linejoin="round"/>'
        f"{_marks(plan, placed)}{_north(plan, placed, size)}{_scale_bar(placed.scale, size)}</svg>"
    )


def _map_of(plan: HandoffPlan) -> tuple[_Map, Float]:
    """Return how metres come on paper, and the size of the drawing in millimetres."""
    everything = [shapely.get_coordinates(plan.grid.drivable_m), plan.grid.xy_m, plan.route.line_m]
    xy = np.concatenate(everything)
    spread = np.ptp(xy, axis=0)
    turned = bool(spread[1] > spread[0])
    flat = _Map(turned, np.zeros(2), 1.0)(xy) - 4.0
    low, span = flat.min(axis=0), np.maximum(np.ptp(flat, axis=0), 1.0)
    scale = float(min((_WIDE_MM - 8.0) / span[0], (_HIGH_MM - 8.0) / span[1]))
    return _Map(turned, low, scale), np.array([_WIDE_MM, span[1] * scale + 8.0])


def _area(plan: HandoffPlan, placed: _Map) -> str:
    rings = shapely.get_rings(shapely.get_parts(plan.grid.drivable_m))
    return "".join(_path(placed(shapely.get_coordinates(ring))) + "Z" for ring in rings)


def _marks(plan: HandoffPlan, placed: _Map) -> str:
    """Return a dot for each stop, with its number as far as there is room."""
    if not plan.stops:
        return ""
    every = next(k for k in (1, 5, 10, 20, 50, 100, 10**9) if len(plan.stops) / k <= _MOST_NUMBERS)
    places = placed(plan.grid.xy_m[plan.route.plant])
    marks = []
    for stop, (x, y) in zip(plan.stops, places.tolist(), strict=True):
        marks.append(f'<circle cx="{x:.2f}" cy="{y:.2f}" r="0.7"/>')
        if stop.order == 1 or stop.order % every == 0:
            marks.append(f'<text x="{x + 0.9:.2f}" y="{y - 0.6:.2f}">{stop.order}</text>')
    x, y = placed(plan.route.line_m[0])[0].tolist()
    marks.append(f'<rect x="{x - 1:.2f}" y="{y - 1:.2f}" width="2" height="2" fill="#c50"/>')
    return f'<g font-size="2.6" font-family="sans-serif">{"".join(marks)}</g>'


def _north(plan: HandoffPlan, placed: _Map, size: Float) -> str:
    """Return an arrow to true north in the upper right corner."""
    frame = plan.grid.frame
    ahead = frame.xy_m(np.array([[frame.lon, frame.lat + 1e-4]]))
    step = placed(ahead)[0] - placed(np.zeros(2))[0]
    step = step / np.hypot(*step) * 4.0
    x, y = size[0] - 8.0, 8.0
    angle = np.degrees(np.arctan2(step[0], -step[1]))
    return (
        f'<g transform="translate({x:.1f} {y:.1f}) rotate({angle:.1f})" class="north">'
        '<path d="M0 5V-5M-1.6 -2.4L0 -5L1.6 -2.4" fill="none" stroke="#000" stroke-width="0.4"/>'
        '<text y="-5.6" font-size="3" text-anchor="middle">N</text></g>'
    )


def _scale_bar(scale: float, size: Float) -> str:
    """Return a bar of a round number of metres, about a fifth of the drawing."""
    wish = size[0] / 5 / scale
    decade = 10 ** np.floor(np.log10(wish))
    metres = decade * max(k for k in (1, 2, 5) if k * decade <= wish)
    x, y = 4.0, size[1] - 2.0
    return (
        f'<path d="M{x} {y:.2f}h{metres * scale:.2f}" stroke="#000" stroke-width="0.6"/>'
        f'<text x="{x}" y="{y - 1:.2f}" font-size="2.6" class="scale">{metres:g} m</text>'
    )


def _path(xy: Float) -> str:
    return "M" + "L".join(_xy(place) for place in xy)


def _xy(place: Float) -> str:
    x, y = np.ravel(place)
    return f"{x:.2f} {y:.2f}"
