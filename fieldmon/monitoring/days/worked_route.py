"""The route of a day as it was worked, from the results that were recorded of it."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.inspections import FOUND
from fieldmon.infestation.tracing.traced_pairs import in_sight
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.monitoring.changes.earlier_settings import settings_on
from fieldmon.monitoring.estimates.figures_of_day import believed
from fieldmon.monitoring.estimates.last_days import default_date
from fieldmon.monitoring.settings.settings import seconds
from fieldmon.monitoring.settings.shift_work import Besides, Shift, aisles_from, made_by
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import Workday
from fieldmon.plot.travel import GATE, driven_s
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.season.season_file import Season
    from fieldmon.planning.route import Route


def day_was_worked(season: Season, on: date, ahead: Route, today: date | None = None) -> bool:
    """Tell whether a day is over, given what is left of its route: it is shown as it was worked.

    A day planned ahead ends none. `today` by the calendar; None: somebody may still go on with a
    day that has passed.
    """
    passed = on < default_date(season) or (today is not None and on < today)
    return (not len(ahead) or passed) and bool(len(season.history.on(season.settings.day(on))))


def past_midnight(season: Season, on: date) -> Inspections:
    """Return what was inspected after midnight in the shift of a day: it is dated the next day."""
    if on < season.settings.begins:
        return season.inspections.take(slice(0))
    names = tuple(one.name for one in season.planned_by(on).team)
    each: tuple[str | Besides, ...] = (*names, Besides(names)) if names else ("",)
    works = [season.work(on, one) for one in each]
    rows = np.unique(np.concatenate([one.shifts.past_midnight(one.day) for one in works]))
    return works[0].shifts.inspections.take(rows)


def worked_route(season: Season, on: date, who: str | None = None) -> Route:
    """Return the way from plant to plant as a day was worked, at the times noted.

    By the settings of then: who worked, and from when, unless the first time noted shows that work
    began earlier or later, see `Season.work`; its notes say when it began.
    Where a time is missing, all are those that driving and inspecting cost. Chances are those by
    which the day's first route is planned. Empty if nothing was recorded. Of a team it is the way
    of the one named; None: that of all results in turn.
    """
    settings, aisles = settings_on(season, on), season.plot.aisles
    robot, starts_s = settings.robot, seconds(settings.starts)
    # a team that was changed since has others
    if who is not None and (member := settings.named(who)) is not None:
        robot, aisles = member.robot, aisles_from(season.plot, member.gate)
        starts_s += member.starts_s
    history, day = season.history, settings.day(on)
    morning = believed(season, on).morning
    done = _in_order(made_by(history.on(day), who))
    begun_s = history.work(Shift(aisles, robot, starts_s), who).begun_s(day)
    # after midnight the work of the day before may go on
    begun_s = float(np.fmin(begun_s, done.second.min(initial=np.inf)))
    scene = Scene(
        aisles=aisles, robot=robot, chance=in_sight(morning).chance.copy(),
        infested=morning.chance.copy(), seconds_left=robot.day_s,
        last_inspected=np.full(len(aisles.grid), NEVER, np.int32),
    )  # fmt: skip
    n, drive_s = len(done), _drive_s(scene, done.plant)
    robot = scene.robot
    # a find is noted while standing there: the time of arrival is not known, and not needed
    leave_s, stop_s = np.maximum(done.second - begun_s, 0.0), np.zeros(n)
    if not np.isfinite(leave_s).all():
        leave_s, stop_s = np.cumsum(drive_s[:n] + robot.visit_s), np.full(n, robot.visit_s)
    work = Workday(
        plant=done.plant, arrive_s=leave_s - stop_s, found=done.result == FOUND, stop_s=stop_s,
        detects=np.full(n, robot.detects),
        end_s=float(leave_s[-1] + drive_s[n:].sum()) if n else 0.0,
    )  # fmt: skip
    begins = datetime.combine(on, time()) + timedelta(seconds=round(begun_s))
    notes = RouteNotes(season.plot.field.name, settings.sampler, begins, who)
    return replace(route_of(scene, work), notes=notes)


def _in_order(done: Inspections) -> Inspections:
    """Return a day's inspections by time, if all have one, else as they were recorded."""
    if np.isfinite(done.second).all():
        return done.take(np.argsort(done.second, kind="stable"))
    return done


def _drive_s(scene: Scene, plants: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return the seconds from the gate to each plant in turn, and back if the robot returns."""
    back = [GATE] if scene.robot.returns else []
    places = np.concatenate([[GATE], plants, back]).astype(np.int64)
    legs = [places[k : k + 2] for k in range(len(places) - 1)]
    return np.array([driven_s(scene.aisles.travel, scene.clock, leg) for leg in legs])
