"""Charts of a season's days as drawings for paper."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import figure
from fieldmon.reports import colours
from fieldmon.reports.drawing import Areas, Discs, Drawing, Lettering, Part, Strokes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.units import Units
    from fieldmon.reports.content import Size

    Floats = NDArray[np.float64]

_LEFT, _RIGHT, _TOP, _FOOT = 12.0, 4.0, 3.0, 7.0
_DATES_MM = 19.0
# a bar's width is its day's, but no more than this
_WIDEST_MM = 9.0
# days further apart than this are not joined by a line
_MOST_APART = 3
_DOTS_APART_MM = 2.0


@dataclass(frozen=True, eq=False)
class DayChart:
    """Values by day: bars, or a line with its interval.

    Parameters
    ----------
    days
        Dates, in order.
    value
        ``(d,)`` a value a day; NaN: nothing is to be said of it yet.
    units
        Of the dates.
    low, high
        ``(d,)`` the interval about each value, for a line; None: bars.
    top
        The highest value there can be, if there is one: 100 for percent.
    marks
        Days to be marked, each with a word.
    """

    days: tuple[date, ...]
    value: Floats
    units: Units
    low: Floats | None = None
    high: Floats | None = None
    top: float | None = None
    marks: tuple[tuple[date, str], ...] = ()

    def draw(self, size: Size) -> Drawing:
        """Return the chart on so much paper."""
        place = _Axes.of(self, size)
        shown = self._bars(place) if self.low is None else self._line(place)
        return Drawing(*size, (*place.parts(self.units), *shown, *self._marks(place)))

    def _marks(self, place: _Axes) -> list[Part]:
        """Return a dashed line through each day marked, with its word beside."""
        parts: list[Part] = []
        seen = [(day, word) for day, word in self.marks if self.days[0] <= day <= self.days[-1]]
        for day, word in seen:
            x = float(place.x((day,))[0])
            line = np.array([[x, _TOP - 2.0], [x, place.size[1] - _FOOT]])
            parts += [
                Strokes((line,), colours.ACCENT, 0.35, dashed=True),
                Lettering(x + 1.0, _TOP - 1.5, word, 6.5, colours.ACCENT),
            ]
        return parts

    def _bars(self, place: _Axes) -> list[Part]:
        half = min(0.4 * place.per_day, _WIDEST_MM / 2)
        x, y = place.x(self.days), place.y(self.value)
        foot = place.y(np.zeros(1))[0]
        rings = [
            np.array([[a - half, foot], [a - half, b], [a + half, b], [a + half, foot]])
            for a, b in zip(x.tolist(), y.tolist(), strict=True)
            if b < foot
        ]
        parts: list[Part] = [Areas((ring,), fill=colours.BAR) for ring in rings]
        return [*parts, *self._numbers(x, y, half)]

    def _numbers(self, x: Floats, y: Floats, half: float) -> list[Part]:
        """Return what each bar comes to above it, where all have room."""
        if 2 * half < 4.0:
            return []
        return [
            Lettering(a, b - 1.6, figure(value, ",.0f"), 6.0, colours.INK, "middle")
            for a, b, value in zip(x.tolist(), y.tolist(), self.value.tolist(), strict=True)
        ]

    def _line(self, place: _Axes) -> list[Part]:
        assert self.low is not None  # noqa: S101 - a line has its interval
        assert self.high is not None  # noqa: S101 - as above
        told = np.flatnonzero(~np.isnan(self.value))
        if not len(told):
            return []
        days = tuple(self.days[k] for k in told.tolist())
        x, y = place.x(days), place.y(self.value[told])
        low, high = place.y(self.low[told]), place.y(self.high[told])
        gap = np.diff([day.toordinal() for day in days]) > _MOST_APART
        runs = np.split(np.arange(len(x)), np.flatnonzero(gap) + 1)
        parts: list[Part] = []
        for run in runs:
            band = np.concatenate([np.stack([x[run], high[run]], 1),
                                   np.stack([x[run], low[run]], 1)[::-1]])  # fmt: skip
            parts.append(Areas((band,), fill=colours.BAR, opacity=0.55))
        # an interval of one day alone has no area
        whiskers = tuple(
            np.array([[x[run[0]], low[run[0]]], [x[run[0]], high[run[0]]]])
            for run in runs if len(run) == 1
        )  # fmt: skip
        lines = tuple(np.stack([x[run], y[run]], 1) for run in runs if len(run) > 1)
        joins = tuple(np.stack([x[[a[-1], b[0]]], y[[a[-1], b[0]]]], 1) for a, b in pairwise(runs))
        parts += [Strokes(whiskers, colours.BAR, 1.2)] if whiskers else []
        parts += [Strokes(joins, colours.ROUTE, 0.3, dashed=True)] if joins else []
        parts += [Strokes(lines, colours.ROUTE, 0.6)] if lines else []
        # dots so near each other would be a thick line: those that none joins, and the newest
        crowded = len(x) > 1 and float(np.median(np.diff(x))) < _DOTS_APART_MM
        alone = np.array([*(run[0] for run in runs if len(run) == 1), len(x) - 1])
        dots = np.unique(alone) if crowded else np.arange(len(x))
        return [*parts, Discs(np.stack([x[dots], y[dots]], 1), 0.75, fill=colours.ROUTE)]


@dataclass(frozen=True, eq=False)
class _Axes:
    """Where days and values lie on paper."""

    size: Size
    first: int
    last: int
    ticks: Floats

    @classmethod
    def of(cls, chart: DayChart, size: Size) -> _Axes:
        first, last = chart.days[0].toordinal(), chart.days[-1].toordinal()
        highest = chart.value if chart.high is None else chart.high
        top = float(np.nanmax(highest, initial=0.0)) if chart.top is None else chart.top
        return cls(size, first, last, _ticks(top, whole=chart.low is None))

    @property
    def per_day(self) -> float:
        """Millimetres a day."""
        return (self.size[0] - _LEFT - _RIGHT) / (self.last - self.first + 1)

    def x(self, days: tuple[date, ...]) -> Floats:
        number = np.array([day.toordinal() - self.first for day in days], np.float64)
        return _LEFT + (number + 0.5) * self.per_day

    def y(self, value: Floats) -> Floats:
        high = self.size[1] - _TOP - _FOOT
        down: Floats = _TOP + high * (1.0 - value / self.ticks[-1])
        return down

    def parts(self, units: Units) -> list[Part]:
        """Return the grid lines with their numbers, and dates below."""
        right, ys = self.size[0] - _RIGHT, self.y(self.ticks)
        lines = tuple(np.array([[_LEFT, y], [right, y]]) for y in ys.tolist())
        numbers = [
            Lettering(_LEFT - 1.5, y, figure(tick, ",.10g"), 6.5, colours.SOFT, "end")
            for tick, y in zip(self.ticks.tolist(), ys.tolist(), strict=True)
        ]
        return [
            Strokes(lines[1:], colours.FAINT, 0.15),
            Strokes(lines[:1], colours.SOFT, 0.3),
            *numbers,
            *self._dates(units),
        ]

    def _dates(self, units: Units) -> list[Part]:
        fit = max(int((self.size[0] - _LEFT - _RIGHT) / _DATES_MM), 1)
        n = self.last - self.first + 1
        every = next(k for k in (1, 2, 7, 14, 28, 56, 112, 10**9) if n / k <= fit)
        shown = [date.fromordinal(day) for day in range(self.first, self.last + 1, every)]
        at = self.x(tuple(shown)).tolist()
        return [
            Lettering(x, self.size[1] - 3.2, units.day(day), 6.5, colours.SOFT, "middle")
            for x, day in zip(at, shown, strict=True)
        ]


def _ticks(top: float, *, whole: bool) -> Floats:
    """Return three to six round values from 0 to `top` or just above it."""
    least = 1.0 if whole else 0.1
    wish = max(top, 3 * least) / 4
    decade = 10.0 ** np.floor(np.log10(wish))
    step = next(k * decade for k in (1, 2, 5, 10) if k * decade >= wish * 0.999)
    step = max(step, least)
    ticks: Floats = step * np.arange(int(np.ceil(max(top, step) / step - 1e-9)) + 1)
    return ticks
