"""A season's days in figures, read from its file where it has them. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring.settings import seconds
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import Workday
from fieldmon.plot.travel import GATE, driven_s
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.monitoring import Season
    from fieldmon.planning.route import Route


@dataclass(frozen=True)
class DayFigures:
    """A day after its work: inspected, found, and what is still expected out there."""

    on: date
    inspected: int
    found: int
    expected: float
    low: int
    high: int
    clean: float


@dataclass(frozen=True, eq=False)
class Known:
    """What is known up to a day: plants inspected and found, days since each row was seen (NaN)."""

    inspected: int
    found: int
    inspected_today: int
    found_today: int
    days_since: NDArray[np.float64]


def kept(project: Season) -> dict[str, DayFigures]:
    """Return the figures of the days on which something happened, by ISO date, in order.

    They stand in the season's file, written by each recording; to work them out anew takes
    thousands of drawn fields a day.
    """
    with project.store.reading() as db:
        rows = db.execute(
            "SELECT date, inspected, found, expected_left, low, high, chance_clean "
            "FROM days ORDER BY day"
        ).fetchall()
    return {day: DayFigures(date.fromisoformat(day), *more) for day, *more in rows}


def of(project: Season, on: date) -> DayFigures:
    """Return the figures of any day."""
    now = project.status(on)
    out = now.estimate
    return DayFigures(
        on, now.inspected_today, now.found_today, out.expected, out.low, out.high, out.chance_clean
    )


def done(project: Season, on: date) -> Route:
    """Return the way from plant to plant as a day was worked, at the times noted.

    Where a time is missing, all are those that driving and looking cost.
    """
    setup, aisles = project.settings, project.plot.aisles
    today = project.history.inspections.on(on)
    robot, n = setup.robot, len(today)
    if np.isfinite(today.second).all():
        today = today.take(np.argsort(today.second, kind="stable"))
    scene = Scene(
        aisles=aisles, robot=robot, chance=project.morning(on), seconds_left=robot.day_s,
        last_inspected=np.full(len(aisles.grid), NEVER, np.int32),
    )  # fmt: skip
    places = np.concatenate([[GATE], today.plant, [GATE] if robot.returns else []]).astype(np.int64)
    drive_s = np.array([
        driven_s(aisles.travel, scene.clock, places[k : k + 2]) for k in range(len(places) - 1)
    ])  # fmt: skip
    leave_s = np.maximum(today.second - seconds(setup.starts), 0.0)
    if not np.isfinite(leave_s).all():
        leave_s = np.cumsum(drive_s[:n] + robot.visit_s)
    # a find is noted while standing there: the time of arrival is not known, and not needed
    work = Workday(
        plant=today.plant, arrive_s=leave_s, found=today.result == FOUND, stop_s=np.zeros(n),
        detects=np.full(n, robot.detects),
        end_s=float(leave_s[-1] + drive_s[n:].sum()) if n else 0.0,
    )  # fmt: skip
    return route_of(scene, work)


def known(project: Season, on: date) -> Known:
    """Return what is known up to a day."""
    day, grid, history = project.settings.day(on), project.plot.grid, project.history
    today, state = history.on(day).inspected, history.states(day)
    last = np.full(grid.n_rows, -1, np.int64)
    np.maximum.at(last, grid.row, history.last_inspected(day))
    return Known(
        inspected=int(np.count_nonzero(state >= 0)),
        found=int(np.count_nonzero(state == 1)),
        inspected_today=len(today),
        found_today=int(np.count_nonzero(today.result == FOUND)),
        days_since=np.where(last < 0, np.nan, day - last),
    )
