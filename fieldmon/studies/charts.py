"""Plots as SVG text: no library, no file, no internet; colours follow the page's light or dark."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_WIDTH, _RIGHT, _TOP, _BOTTOM = 640, 20, 28, 40
_LETTER = 6.6
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


def range_chart(title: str, rows: Sequence[Range], axis: str) -> str:
    """Return a chart with one row a configuration, as an ``<svg>`` element."""
    rows = [row for row in rows if not math.isnan(row.mean)]
    if not rows:
        return ""
    values = [v for row in rows for v in (row.low, row.high, row.other) if not math.isnan(v)]
    low, high, step = _scale(min(values), max(values))
    height = _TOP + _ROW * len(rows) + _BOTTOM
    bottom = height - _BOTTOM
    left = 16 + _LETTER * max(len(row.label) for row in rows)

    def x(value: float) -> float:
        return left + (value - low) / (high - low) * (_WIDTH - left - _RIGHT)

    parts = [_vertical(x(tick), bottom, f"{tick:g}") for tick in _ticks(low, high, step)]
    for k, row in enumerate(rows):
        y = _TOP + _ROW * (k + 0.5)
        parts.append(_text(left - 8, y + 4, row.label, "end"))
        parts.append(
            f'<line x1="{x(row.low):.1f}" y1="{y}" x2="{x(row.high):.1f}" y2="{y}" class="range"/>'
        )
        parts.append(f'<circle cx="{x(row.mean):.1f}" cy="{y}" r="4" class="mean"/>')
        if not math.isnan(row.other):
            at = x(row.other)
            parts.append(
                f'<path d="M{at - 4:.1f} {y - 4}l8 8m0 -8l-8 8" class="other"><title>thesis '
                f"{row.other:g}</title></path>"
            )
    parts.append(_text((left + _WIDTH - _RIGHT) / 2, height - 8, axis, "middle"))
    return _svg(title, height, parts)


def line_chart(title: str, lines: Sequence[Line], axes: tuple[str, str]) -> str:
    """Return a chart of lines from (0 %, ...) with a legend, as an ``<svg>`` element."""
    points = [
        (x, y) for line in lines for x, y in zip(line.x, line.y, strict=True) if not math.isnan(y)
    ]
    if not points:
        return ""
    x_low, x_high, x_step = _scale(min(x for x, _ in points), max(x for x, _ in points))
    y_low, y_high, y_step = _scale(0, max(y for _, y in points))
    left, right, bottom = 50, _WIDTH - 130, _HEIGHT - _BOTTOM

    def at(x: float, y: float) -> tuple[float, float]:
        return (
            left + (x - x_low) / (x_high - x_low) * (right - left),
            bottom - (y - y_low) / (y_high - y_low) * (bottom - _TOP),
        )

    parts = [
        _vertical(at(tick, 0)[0], bottom, f"{tick:g}") for tick in _ticks(x_low, x_high, x_step)
    ]
    parts += [
        _text(left - 6, at(x_low, tick)[1] + 4, f"{tick:g}", "end")
        for tick in _ticks(y_low, y_high, y_step)
    ]
    for k, line in enumerate(lines):
        parts.append(_band(line, at, k))
        pairs = [at(x, y) for x, y in zip(line.x, line.y, strict=True) if not math.isnan(y)]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in pairs)
        style = f'class="line c{k % _LINES}{" dashed" if k >= _LINES else ""}"'
        parts.append(
            f'<polyline points="{path}" {style}><title>{escape(line.label)}</title></polyline>'
        )
        y = _TOP + 18 * k + 6
        parts.append(f'<line x1="{right + 10}" y1="{y}" x2="{right + 34}" y2="{y}" {style}/>')
        parts.append(_text(right + 40, y + 4, line.label, "start"))
    parts.append(_text((left + right) / 2, _HEIGHT - 8, axes[0], "middle"))
    parts.append(_text(left, _TOP - 8, axes[1], "start"))
    return _svg(title, _HEIGHT, parts)


def _band(line: Line, at: Callable[[float, float], tuple[float, float]], k: int) -> str:
    """Return the area between the low and the high of a line; nothing where it has none."""
    if not line.low:
        return ""
    forth = [(x, y) for x, y in zip(line.x, line.high, strict=True) if not math.isnan(y)]
    back = [(x, y) for x, y in zip(line.x, line.low, strict=True) if not math.isnan(y)]
    corners = (at(x, y) for x, y in [*forth, *reversed(back)])
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
    return f'<polygon points="{points}" class="band b{k % _LINES}"/>'


def _scale(low: float, high: float) -> tuple[float, float, float]:
    """Return round ends around low..high and a round step between ticks."""
    width = max(high - low, 1e-9)
    power = 10.0 ** math.floor(math.log10(width / 5))
    step = next(power * k for k in (1, 2, 5, 10) if width / (power * k) <= 6)
    start, end = math.floor(low / step) * step, math.ceil(high / step) * step
    return start, end if end > start else start + step, step


def _ticks(low: float, high: float, step: float) -> list[float]:
    return [round(low + k * step, 10) for k in range(round((high - low) / step) + 1)]


def _vertical(x: float, bottom: float, label: str) -> str:
    line = f'<line x1="{x:.1f}" y1="{_TOP}" x2="{x:.1f}" y2="{bottom}" class="grid"/>'
    return line + _text(x, bottom + 16, label, "middle")


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def _svg(title: str, height: float, parts: Sequence[str]) -> str:
    return (
        f'<figure><figcaption>{escape(title)}</figcaption><svg viewBox="0 0 {_WIDTH} {height}" '
        f'role="img" aria-label="{escape(title)}">{"".join(parts)}</svg></figure>'
    )
