"""What a day and its hot spots are, in sentences; the app says the same."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import (
    KeptText,
    Worded,
    counted,
    estimate,
    hours_figure,
    joined,
    worded,
)
from fieldmon.plot.grid import plant_numbers, row_ends
from fieldmon.reports import words

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.compute.units import Units
    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.monitoring import LogEntry
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.local_clock import LocalClock

_MOST_SPOTS = 8
# of the corrections of one time
_MOST_CORRECTED = 3


def headline(route: Route, day: str) -> str:
    """Return what there is to do on a day, in one sentence."""
    if not len(route):
        return worded(words.HEADLINE_NONE, day=day)
    line = plant_numbers(route.aisles.grid, route.plant).line
    low, high = row_ends(route.aisles.grid, line)
    rows, finds = worded(words.ROW, low=low), route.expected_finds
    stops = route.aisles.grid.counted(len(route))
    if not route.aisles.grid.in_rows:
        rows = worded(words.NO_ROWS)
    elif low != high:
        rows = worded(words.ROWS, low=low, high=high)
    return worded(
        words.HEADLINE, plants=stops, rows=rows, day=day,
        hours=hours_figure(route.end_s / 3600),
        finds=worded(words.FEW_FINDS, n=finds) if round(finds, 1) < 10
        else counted(round(finds), "find"),
    )  # fmt: skip


def hot_spot_meanings(
    grid: PlantGrid,
    spots: HotSpots,
    apart: tuple[NDArray[np.bool_], NDArray[np.bool_]] | None = None,
) -> list[str]:
    """Return where each hot spot is and what it means, in words; of eight at most.

    `apart` are a season's `finds_apart`, which are said: those known from the records of before
    alone, and those that count no more.
    """
    if not len(spots):
        return [worded(words.HOT_NONE)]
    said: list[str] = []
    brought, treated = _beside(grid, spots, apart)
    for k in range(min(len(spots), _MOST_SPOTS)):
        p = float(spots.p[k])
        chance = worded(words.CHANCE_P_SMALL)
        if p >= 1e-4:
            chance = worded(words.CHANCE_P, n=max(round(1 / p), 1))
        meaning = worded(
                words.HOT_MEANS, rows=_place(grid, np.flatnonzero(spots.of_plant == k)),
                found=spots.found[k], inspected=spots.inspected[k], plants=spots.plants[k],
                expected=estimate(spots.expected[k]), p=chance,
            )  # fmt: skip
        more = [
            worded(words_of, n=of[k])
            for words_of, of in ((words.HOT_BROUGHT, brought), (words.HOT_TREATED, treated))
            if of[k]
        ]
        said.append(joined(" ", [meaning, *more]) if more else meaning)
    return said


def _beside(
    grid: PlantGrid, spots: HotSpots, apart: tuple[NDArray[np.bool_], NDArray[np.bool_]] | None
) -> list[list[int]]:
    """Return how many finds of each hot spot are only of records, and how many count no more."""
    counted_: list[list[int]] = []
    for which in apart or (np.zeros(len(grid), bool),) * 2:
        of = spots.of_plant[np.unique(grid.vine[which])]  # the two faces of a vine are one
        counted_.append(np.bincount(of[of >= 0], minlength=len(spots)).tolist())
    return counted_


def _place(grid: PlantGrid, plants: NDArray[np.intp]) -> Worded:
    """Return which rows and which of their plants these are, in words."""
    numbered = plant_numbers(grid, plants)
    first, last = row_ends(grid, numbered.line)
    low, high = int(numbered.number.min()), int(numbered.number.max())
    if not grid.in_rows:
        return worded(words.HOT_PLANTS, low=low, high=high)
    if first == last:
        return worded(words.HOT_ROW, first=first, low=low, high=high)
    return worded(words.HOT_ROWS, first=first, last=last, low=low, high=high)


def changed_later(log: Iterable[LogEntry], clock: LocalClock, units: Units) -> list[Worded]:
    """Return a sentence for each time that something was taken back or corrected, by whom and when.

    What was done in a copy that was merged is among them, and said to be.
    """
    said = []
    for entry in log:
        for one in (entry, *entry.theirs):
            if one.kind not in ("undone", "corrected"):
                continue
            at = clock.at(datetime.fromisoformat(one.at))
            told = words.CHANGED_LATER_LINE if one is entry else words.CHANGED_LATER_THERE
            said.append(
                worded(
                    told, day=units.day(at.date()), time=f"{at:%H:%M}",
                    who=words.isolated(one.who) if one.who else words.CERT_NOT_SAID,
                    said=KeptText(one.sentence(_MOST_CORRECTED)),
                )
            )  # fmt: skip
    return said
