"""A season's days in figures: what was done on them, and what was still out there afterwards."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import Worded, estimate, figure, worded
from fieldmon.infestation.inspections import FOUND
from fieldmon.infestation.plot_estimate import PlotEstimate
from fieldmon.infestation.records import PRESENT
from fieldmon.monitoring.changes.transactions import get_meta, set_meta
from fieldmon.samplers.base import NEVER

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from fieldmon.monitoring.estimates.history import History


# so near to a whole number are chances of plants that are known to be infested
_CERTAIN = 0.01
# by which rules the figures of days were worked out, and from which day on
_RULES = "rules of figures"


def found_pct(found: int, left: float) -> float:
    """Return the plants found in percent of those and of what is left; 100 if there is neither.

    Examples
    --------
    >>> [round(found_pct(4, left)) for left in (34.0, 161, 7)]
    [11, 2, 36]
    """
    everything = found + left
    return 100.0 * found / everything if everything else 100.0


def flagged_said(left: DayFigures | PlotEstimate, flagged: float) -> list[Worded]:
    """Return what is to be said beside how many are still infested, if any of them are flagged.

    Parameters
    ----------
    left
        How many are infested and not found yet.
    flagged
        How many plants that were found are still infested (`Status.flagged`).
    """
    if round(flagged, 1) == 0.0:
        return []
    # of those that are certain it is a count
    is_count = abs(flagged - round(flagged)) < _CERTAIN
    n = figure(round(flagged)) if is_count else estimate(flagged)
    return [
        worded(
            "Of those still infested, about {left} ({low:,} to {high:,}) are not found yet, and "
            "{n} were found and only flagged.",
            left=estimate(left.expected), low=left.low, high=left.high, n=n,
        )
    ]  # fmt: skip


@dataclass(frozen=True)
class DayFigures:
    """A day after its work.

    Parameters
    ----------
    on
        Its date.
    inspected_today, found_today
        Plants inspected and found infested on it, as `Progress` has them.
    expected
        Plants infested and not found yet, as expected.
    low, high
        The interval that holds 90 % of what that number may be.
    chance_clean
        Chance that no plant is infested any more.
    """

    on: date
    inspected_today: int
    found_today: int
    expected: float
    low: int
    high: int
    chance_clean: float

    @classmethod
    def of(cls, on: date, progress: Progress, estimate: PlotEstimate) -> DayFigures:
        """Return the figures of a day from what was done and what is believed."""
        done = progress.inspected_today, progress.found_today
        return cls(on, *done, estimate.expected, estimate.low, estimate.high, estimate.chance_clean)

    @property
    def estimate(self) -> PlotEstimate:
        """How many are infested and not found yet."""
        return PlotEstimate(self.expected, self.low, self.high, self.chance_clean)

    def share_found_pct(self, found: int) -> tuple[float, float, float]:
        """Return `found` plants in percent of those and of what is left: guess, low and high."""
        value, low, high = (found_pct(found, n) for n in (self.expected, self.high, self.low))
        return value, low, high


@dataclass(frozen=True, eq=False)
class Progress:
    """How far the inspections are after a day's work.

    Parameters
    ----------
    inspected, found
        Plants inspected so far at least once, and plants found infested so far.
    finds
        Finds so far, a plant once a day: more than `found` where plants were found again.
    inspected_today, found_today
        Plants inspected and found infested on this day.
    days_since
        ``(r,)`` days since any plant of each row was inspected; NaN: never.
    """

    inspected: int
    found: int
    finds: int
    inspected_today: int
    found_today: int
    days_since: NDArray[np.float64]

    @classmethod
    def of(cls, history: History, day: int) -> Progress:
        """Return the progress up to a day, given by its number."""
        grid, state = history.grid, history.states(day)
        today, done = history.on(day).inspected, history.until(day)
        found = done.take(done.result == FOUND)
        last = np.full(grid.n_rows, NEVER, np.int64)
        np.maximum.at(last, grid.row, history.last_inspected(day))
        return cls(
            inspected=int(np.count_nonzero(state >= 0)),
            found=int(np.count_nonzero(state == PRESENT)),
            finds=len(set(zip(found.plant.tolist(), found.date.tolist(), strict=True))),
            inspected_today=len(np.unique(today.plant)),
            found_today=len(np.unique(today.plant[today.result == FOUND])),
            days_since=np.where(last == NEVER, np.nan, day - last),
        )


@dataclass(frozen=True)
class PlannedAndDone:
    """The stops of a day's kept plan, held to what was done.

    Done is a plant that somebody told of, be it that it could not be inspected.

    Parameters
    ----------
    planned
        Stops of the plan kept last, with those of plans before it that were done.
    done, added
        Plants done of these, and besides them.
    hours
        From the begin of the first plan to the end of the last one, those of all together.
    people
        How many they are: each has a plan.
    """

    planned: int
    done: int
    added: int
    hours: float
    people: int = 1

    @property
    def left(self) -> int:
        """Return how many stops nobody told of."""
        return self.planned - self.done

    @classmethod
    def of(
        cls, kept: Iterable[tuple[NDArray[np.int32], NDArray[np.int32]]],
        told: NDArray[np.int32], hours: Sequence[float],
    ) -> PlannedAndDone:  # fmt: skip
        """Return it of each one's plans, the plants of the last one and of all, and those told of.

        Examples
        --------
        >>> last, of_all, seen = (np.array(plants) for plants in ([3, 4], [1, 2, 3, 4], [1, 3, 9]))
        >>> PlannedAndDone.of([(last, of_all)], seen, [4.0])
        PlannedAndDone(planned=3, done=2, added=1, hours=4.0, people=1)
        """
        seen = set(told.tolist())
        planned: set[int] = set()
        for last, of_all in kept:
            planned |= {*last.tolist()} | (seen & {*of_all.tolist()})
        done = len(planned & seen)
        return cls(len(planned), done, len(seen) - done, sum(hours), len(hours))


def note_rules(db: sqlite3.Connection, rules: str, since: int) -> None:
    """Note that the figures of days from `since` on were worked out by these rules."""
    before = _noted(db)
    if before is not None and before[0] == rules:
        since = min(since, before[1])
    set_meta(db, _RULES, f"{rules} {since}")


def holds(db: sqlite3.Connection, rules: str, day: int) -> bool:
    """Return whether the figures kept of a day are what these rules make of it."""
    noted = _noted(db)
    return noted is not None and noted[0] == rules and day >= noted[1]


def _noted(db: sqlite3.Connection) -> tuple[str, int] | None:
    rules, _, since = (get_meta(db, _RULES) or "").partition(" ")
    return (rules, int(since)) if since else None


def kept(db: sqlite3.Connection) -> tuple[DayFigures, ...]:
    """Return the figures that stand in the file: of days on which something happened, in order."""
    rows = db.execute(
        "SELECT date, inspected, found, expected_left, low, high, chance_clean "
        "FROM days ORDER BY day"
    )
    return tuple(DayFigures(date.fromisoformat(on), *more) for on, *more in rows)
