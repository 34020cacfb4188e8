"""A field sheet for a scout without a phone: a map, the plants in order, boxes to tick.

One HTML file that asks for nothing from outside, to be printed on A4.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from markupsafe import Markup

from fieldmon.compute.wording import Worded, counted, worded
from fieldmon.io.html import page
from fieldmon.io.writers.day_file import plain_text
from fieldmon.io.writers.geojson import summary
from fieldmon.plot.grid import before_rows
from fieldmon.plot.row_course import row_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.writers.day_file import HandoffPlan

    Float = NDArray[np.float64]

#: what is printed beside the plants; those of results are read where the sheet is typed in
WORDS = {
    "map": worded("map"),
    "by": worded("Inspected by:"),
    "on": worded("on:"),
    "tick": worded("Tick one:"),
    "clean": worded("clean"),
    "found": worded("found"),
    "skipped": worded("could not inspect"),
    "count": worded("Of finds write how many."),
    "gone": worded("Write gone if dead or missing."),
    "none": worded("No tick: not inspected."),
    "row": worded("row"),
    "plant": worded("plant"),
    "time": worded("time"),
    "how_many": worded("how many"),
}

_WIDE_MM, _HIGH_MM = 186.0, 88.0
_MARGIN_MM = 5.0
_MOST_NUMBERS = 60  # stops whose numbers the map shows; of more, every fifth, tenth...


class _Map(NamedTuple):
    """From metres of the plot to millimetres of paper, its longer side across the page.

    ``corner`` is where the drawing's upper left corner lies on paper.
    """

    turned: bool
    low: Float
    scale: float
    corner: Float

    def __call__(self, xy_m: Float) -> Float:
        xy = np.atleast_2d(xy_m)
        flat = np.stack([xy[:, 0], -xy[:, 1]], axis=1)
        if self.turned:
            flat = np.stack([-flat[:, 1], flat[:, 0]], axis=1)
        placed: Float = (flat - self.low) * self.scale + self.corner
        return placed


def route_sheet(plan: HandoffPlan) -> bytes:
    """Return a day as an HTML page for printing.

    A route has a page of its own, which holds about a hundred plants; a longer one goes on on the
    next, no plant's line cut in two. A thick line parts the rows.
    """
    start, language = plan.notes.start, plan.notes.language
    told = [_figures(plan), plan.bound]
    return page(
        "fieldmon/io/writers/field_sheet.html.j2",
        plan=plan,
        plot=plain_text(plan.notes.plot),
        date="" if start is None else f"{start:%Y-%m-%d}",
        told=" ".join(language.say(one) for one in told if one),
        words={name: language.say(said) for name, said in WORDS.items()},
        map=_svg(plan),
    ).encode()


def _figures(plan: HandoffPlan) -> Worded:
    figures = summary(plan.route, plan.notes)
    said = {
        "plants": counted(figures["stops"], "plant"),
        "drive": figures["drive_m"] / 1000,
        "hours": figures["seconds"] / 3600,
    }
    if plan.notes.start is None:
        return worded("{plants}, {drive:.2f} km, {hours:.1f} h.", **said)
    times = {"start": plan.clock(0.0)[11:16], "end": plan.clock(plan.route.end_s)[11:16]}
    return worded("{plants}, {drive:.2f} km, {hours:.1f} h ({start} to {end}).", **said, **times)


def _svg(plan: HandoffPlan) -> Markup:
    grid = plan.grid
    placed, size = _map_of(plan)
    rows = "".join(_path(placed(line)) for line in row_corners(grid))
    line = _path(placed(plan.route.line_m)) if len(plan.route.line_m) > 1 else ""
    return Markup(
        '<svg viewBox="0 0 {:.1f} {:.1f}" role="img" aria-label="{}">'
        '<path d="{}" fill="#f4f4ee" stroke="#888" stroke-width="0.3" fill-rule="evenodd"/>'
        '<path d="{}" fill="none" stroke="#9c9" stroke-width="0.4" stroke-linecap="round"/>'
        '<path d="{}" fill="none" stroke="#c50" stroke-width="0.35" stroke-linejoin="round"/>'
        "{}{}{}{}</svg>"
    ).format(
        *size,
        plan.notes.language.say(WORDS["map"]),
        *(_area(plan, placed), rows, line),
        *(_row_numbers(plan, placed), _marks(plan, placed)),
        *(_north(plan, placed, size), _scale_bar(placed.scale, size)),
    )


def _map_of(plan: HandoffPlan) -> tuple[_Map, Float]:
    """Return how metres come on paper, and the size of the drawing in millimetres."""
    everything = [shapely.get_coordinates(plan.grid.drivable_m), plan.grid.xy_m, plan.route.line_m]
    xy = np.concatenate(everything)
    spread = np.ptp(xy, axis=0)
    turned = bool(spread[1] > spread[0])
    flat = _Map(turned, np.zeros(2), 1.0, np.zeros(2))(xy)
    low, span = flat.min(axis=0), np.maximum(np.ptp(flat, axis=0), 1.0)
    room = np.array([_WIDE_MM, _HIGH_MM]) - 2 * _MARGIN_MM
    scale = float((room / span).min())
    # in the middle of the page's width
    corner = np.array([(_WIDE_MM - span[0] * scale) / 2, _MARGIN_MM])
    return _Map(turned, low, scale, corner), np.array([_WIDE_MM, span[1] * scale + 2 * _MARGIN_MM])


def _row_numbers(plan: HandoffPlan, placed: _Map) -> Markup:
    """Return the numbers of the rows at their low ends, as far as there is room."""
    grid = plan.grid
    lines, first = np.unique(grid.row_line, return_index=True)
    gap_mm = grid.row_spacing_m * placed.scale
    every = next(k for k in (1, 2, 5, 10, 20, 50, 100, 10**9) if k * gap_mm >= 2.5)
    ends = placed(before_rows(grid, first))
    texts = [
        Markup('<text x="{:.2f}" y="{:.2f}" text-anchor="middle">{}</text>').format(x, y, sign)
        for line, sign, (x, y) in zip(
            lines.tolist(), grid.line_signs.values(), ends.tolist(), strict=True
        )
        if line == 0 or (line + 1) % every == 0
    ]
    return Markup(
        '<g font-size="2.4" font-family="sans-serif" fill="#363" dominant-baseline="central">{}</g>'
    ).format(Markup().join(texts))


def _area(plan: HandoffPlan, placed: _Map) -> str:
    rings = shapely.get_rings(shapely.get_parts(plan.grid.drivable_m))
    return "".join(_path(placed(shapely.get_coordinates(ring))) + "Z" for ring in rings)


def _marks(plan: HandoffPlan, placed: _Map) -> Markup:
    """Return a dot for each stop, with its number as far as there is room."""
    if not plan.stops:
        return Markup()
    every = next(k for k in (1, 5, 10, 20, 50, 100, 10**9) if len(plan.stops) / k <= _MOST_NUMBERS)
    places = placed(plan.grid.xy_m[plan.route.plant])
    marks = []
    for stop, (x, y) in zip(plan.stops, places.tolist(), strict=True):
        marks.append(Markup('<circle cx="{:.2f}" cy="{:.2f}" r="0.7"/>').format(x, y))
        if stop.order == 1 or stop.order % every == 0:
            number = Markup('<text x="{:.2f}" y="{:.2f}">{}</text>')
            marks.append(number.format(x + 0.9, y - 0.6, stop.order))
    x, y = placed(plan.route.line_m[0])[0].tolist()
    begin = Markup('<rect x="{:.2f}" y="{:.2f}" width="2" height="2" fill="#c50"/>')
    marks.append(begin.format(x - 1, y - 1))
    return Markup('<g font-size="2.6" font-family="sans-serif">{}</g>').format(Markup().join(marks))


def _north(plan: HandoffPlan, placed: _Map, size: Float) -> Markup:
    """Return an arrow to true north in the upper right corner."""
    frame = plan.grid.frame
    ahead = frame.xy_m(np.array([[frame.lon, frame.lat + 1e-4]]))
    step = placed(ahead)[0] - placed(np.zeros(2))[0]
    step = step / np.hypot(*step) * 4.0
    angle = np.degrees(np.arctan2(step[0], -step[1]))
    return Markup(
        '<g transform="translate({:.1f} 10.0) rotate({:.1f})" class="north">'
        '<path d="M0 5V-5M-1.6 -2.4L0 -5L1.6 -2.4" fill="none" stroke="#000" stroke-width="0.4"/>'
        '<text y="-5.6" font-size="3" text-anchor="middle">N</text></g>'
    ).format(size[0] - 8.0, angle)


def _scale_bar(scale: float, size: Float) -> Markup:
    """Return a bar of a round number of metres, about a fifth of the drawing."""
    wish = size[0] / 5 / scale
    decade = 10 ** np.floor(np.log10(wish))
    metres = decade * max(k for k in (1, 2, 5) if k * decade <= wish)
    y = size[1] - 2.0
    return Markup(
        '<path d="M4.0 {:.2f}h{:.2f}" stroke="#000" stroke-width="0.6"/>'
        '<text x="4.0" y="{:.2f}" font-size="2.6" class="scale">{:g} m</text>'
    ).format(y, metres * scale, y - 1, metres)


def _path(xy: Float) -> str:
    return "M" + "L".join(_xy(place) for place in xy)


def _xy(place: Float) -> str:
    x, y = np.ravel(place)
    return f"{x:.2f} {y:.2f}"
