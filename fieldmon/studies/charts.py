"""Plots as SVG: no library, no file, no internet; colours follow the page's light or dark."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    #: from a value on each axis to a place in the drawing
    At = Callable[[float, float], tuple[float, float]]

_WIDTH, _RIGHT, _TOP, _BOTTOM = 640, 20, 28, 40
_LETTER = 6.6
# a chart of ranges is so wide at least, however long its labels; a legend has so much room, and
# begins with a sign
_LEAST, _LEGEND, _SIGN = 260, 130, 40
_ANCHORS = {False: "middle", True: "end"}
_ROW = 22
_HEIGHT = 320
_LINES = 5


@dataclass(frozen=True)
class Range:
    """A row of a range chart: a line from low to high, a dot at the mean, a cross at `other`."""

    label: str
    low: float
    mean: float
    high: float
    other: float = math.nan


@dataclass(frozen=True)
class Line:
    """A line of a line chart, in a band from low to high where those are given."""

    label: str
    x: Sequence[float]
    y: Sequence[float]
    low: Sequence[float] = ()
    high: Sequence[float] = ()


def range_chart(title: str, rows: Sequence[Range], axis: str, even: float | None = None) -> Markup:
    """Return a chart with one row a configuration, as an ``<svg>`` element; empty without rows.

    A line is drawn through `even`, where neither side is ahead.
    """
    rows = [row for row in rows if not math.isnan(row.mean)]
    if not rows:
        return Markup()
    values = [v for row in rows for v in (row.low, row.high, row.other) if not math.isnan(v)]
    values += [] if even is None else [even]
    low, high, step = _scale(min(values), max(values))
    height = _TOP + _ROW * len(rows) + _BOTTOM
    bottom = height - _BOTTOM
    left = 16 + _LETTER * max(len(row.label) for row in rows)
    right = max(_WIDTH - _RIGHT, left + _LEAST)

    def x(value: float) -> float:
        return left + (value - low) / (high - low) * (right - left)

    parts = [_vertical(x(tick), bottom, f"{tick:g}") for tick in _ticks(low, high, step)]
    if even is not None:
        parts.append(
            Markup('<line x1="{:.1f}" y1="{}" x2="{:.1f}" y2="{}" class="even"/>').format(
                x(even), _TOP, x(even), bottom
            )
        )
    for k, row in enumerate(rows):
        y = _TOP + _ROW * (k + 0.5)
        parts += [_text(left - 8, y + 4, row.label, "end"), _bar(row, x, y)]
    # what is longer than its axis ends with it
    longer = _LETTER * len(axis) > right - left
    middle = (left + right) / 2
    parts.append(_text(right if longer else middle, height - 8, axis, _ANCHORS[longer]))
    return _svg(title, height, parts, right + _RIGHT)


def line_chart(
    title: str, lines: Sequence[Line], axes: tuple[str, str], *, powers: bool = False
) -> Markup:
    """Return a chart of lines with a legend, as an ``<svg>`` element; empty without points.

    With `powers` every step up the chart is ten times the last; values must be above 0 then.
    """
    if powers:
        lines = [_in_powers(line) for line in lines]
    known = [point for line in lines for point in _known(line.x, line.y)]
    if not known:
        return Markup()
    xs, ys = zip(*known, strict=True)
    across = _scale(min(xs), max(xs))
    up = (math.floor(min(ys)), math.ceil(max(ys)), 1.0) if powers else _scale(0, max(ys))
    up = (up[0], max(up[1], up[0] + 1), up[2])
    left, right, bottom = 50, _WIDTH - _LEGEND, _HEIGHT - _BOTTOM
    width = max(_WIDTH, right + _SIGN + _LETTER * max(len(line.label) for line in lines))

    def at(x: float, y: float) -> tuple[float, float]:
        return (
            left + (x - across[0]) / (across[1] - across[0]) * (right - left),
            bottom - (max(y, up[0]) - up[0]) / (up[1] - up[0]) * (bottom - _TOP),
        )

    parts = [_vertical(at(tick, 0)[0], bottom, f"{tick:g}") for tick in _ticks(*across)]
    parts += [
        _text(left - 6, at(across[0], tick)[1] + 4, f"{10**tick if powers else tick:g}", "end")
        for tick in _ticks(*up)
    ]
    for k, line in enumerate(lines):
        parts += [_band(line, at, k), _drawn(line, at, k), *_legend(line.label, right, k)]
    parts.append(_text((left + right) / 2, _HEIGHT - 8, axes[0], "middle"))
    parts.append(_text(left, _TOP - 8, axes[1], "start"))
    return _svg(title, _HEIGHT, parts, width)


def _in_powers(line: Line) -> Line:
    """Return a line with the powers of ten that its values are; of none there is none."""
    y, low, high = (
        [math.log10(v) if v > 0 else math.nan for v in values]
        for values in (line.y, line.low, line.high)
    )
    return Line(line.label, line.x, y, low, high)


def _known(x: Sequence[float], y: Sequence[float]) -> list[tuple[float, float]]:
    """Return the points that have a value."""
    return [point for point in zip(x, y, strict=True) if not math.isnan(point[1])]


def _band(line: Line, at: At, k: int) -> Markup:
    """Return the area between the low and the high of a line; nothing where it has none."""
    if not line.low:
        return Markup()
    forth, back = _known(line.x, line.high), _known(line.x, line.low)
    corners = _points([*forth, *reversed(back)], at)
    return Markup('<polygon points="{}" class="band b{}"/>').format(corners, k % _LINES)


def _drawn(line: Line, at: At, k: int) -> Markup:
    points = _points(_known(line.x, line.y), at)
    return Markup('<polyline points="{}" class="{}"><title>{}</title></polyline>').format(
        points, _style(k), line.label
    )


def _legend(label: str, right: float, k: int) -> list[Markup]:
    """Return a line's sign and name, right of the chart."""
    y = _TOP + 18 * k + 6
    sign = Markup('<line x1="{}" y1="{}" x2="{}" y2="{}" class="{}"/>').format(
        right + 10, y, right + 34, y, _style(k)
    )
    return [sign, _text(right + _SIGN, y + 4, label, "start")]


def _style(k: int) -> str:
    """Return the classes of the k-th line: five colours, then the same dashed."""
    return f"line c{k % _LINES}{' dashed' if k >= _LINES else ''}"


def _points(values: Sequence[tuple[float, float]], at: At) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in (at(*value) for value in values))


def _scale(low: float, high: float) -> tuple[float, float, float]:
    """Return round ends around low..high and a round step between ticks."""
    width = max(high - low, 1e-9)
    power = 10.0 ** math.floor(math.log10(width / 5))
    step = next(power * k for k in (1, 2, 5, 10) if width / (power * k) <= 6)
    start, end = math.floor(low / step) * step, math.ceil(high / step) * step
    return start, end if end > start else start + step, step


def _ticks(low: float, high: float, step: float) -> list[float]:
    return [round(low + k * step, 10) for k in range(round((high - low) / step) + 1)]


def _bar(row: Range, x: Callable[[float], float], y: float) -> Markup:
    """Return a row's line and dot, and its cross where there is another value."""
    bar = Markup(
        '<line x1="{:.1f}" y1="{}" x2="{:.1f}" y2="{}" class="range"/>'
        '<circle cx="{:.1f}" cy="{}" r="4" class="mean"/>'
    ).format(x(row.low), y, x(row.high), y, x(row.mean), y)
    if math.isnan(row.other):
        return bar
    return bar + Markup(
        '<path d="M{:.1f} {}l8 8m0 -8l-8 8" class="other"><title>thesis {:g}</title></path>'
    ).format(x(row.other) - 4, y - 4, row.other)


def _vertical(x: float, bottom: float, label: str) -> Markup:
    line = Markup('<line x1="{:.1f}" y1="{}" x2="{:.1f}" y2="{}" class="grid"/>').format(
        x, _TOP, x, bottom
    )
    return line + _text(x, bottom + 16, label, "middle")


def _text(x: float, y: float, text: str, anchor: str) -> Markup:
    return Markup('<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>').format(
        x, y, anchor, text
    )


def _svg(title: str, height: float, parts: Sequence[Markup], width: float = _WIDTH) -> Markup:
    return Markup(
        '<figure><figcaption>{}</figcaption><div class="wide" tabindex="0"><svg viewBox="0 0 {:g} '
        '{}" role="img" aria-label="{}">{}</svg></div></figure>'
    ).format(title, width, height, title, Markup().join(parts))
