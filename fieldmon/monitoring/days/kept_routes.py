"""Routes in a season's file: the line for a driver, the stops for whoever inspects."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from shapely import LineString

from fieldmon.compute.digest import digest
from fieldmon.monitoring.changes import logged_days
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import beside_plot, blob, insert, point_blobs, touch
from fieldmon.planning.members import person_key
from fieldmon.plot.local_clock import grid_clock, local_clock
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    import sqlite3
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.monitoring.season.open_season import OpenSeason
    from fieldmon.monitoring.season.season_days import SeasonDays
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.treating.closures import Closure
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantNumbers

# hexadecimal digits that a phone, too, counts exactly
_PLAN_DIGITS = 12


def begins(settings: MonitoringSettings, today: DayPlan, begun_s: float) -> datetime:
    """Return the local time at which a route begins: `begun_s`, when work did, or half-way."""
    gone_s = today.scene.robot.day_s - today.scene.seconds_left
    on = settings.date(today.scene.day)
    now_s = grid_clock(today.scene.grid).second_after(on, begun_s, gone_s)
    return datetime.combine(on, time()) + timedelta(seconds=round(now_s))


def keep(
    db: sqlite3.Connection,
    settings: MonitoringSettings,
    numbered: PlantNumbers,
    today: DayPlan,
    who: str = "",
) -> bool:
    """Keep a day's route, of one of a team, unless it is the one kept last; tell whether it was.

    It has a stop or more. The season's own is kept anew after that of another.
    """
    if is_kept(db, today, who):
        return False
    last = kept_last(db, today.scene.day).get(person_key(who))
    revision, line = 1 if last is None else last.revision + 1, today.route.line_lonlat()
    row = _row(db, settings, today, line) | {"revision": revision, "who": who}
    cursor = db.execute(
        f"INSERT INTO routes ({', '.join(row)}) VALUES ({', '.join('?' * len(row))})",  # noqa: S608 - ours
        tuple(row.values()),
    )
    insert(db, schema.STOPS, _stops(cursor.lastrowid, numbered, today.route))
    bounds = (*line.min(axis=0).tolist(), *line.max(axis=0).tolist())
    for table in (schema.ROUTES, schema.STOPS):
        touch(db, table.name, bounds)
    return True


def _row(
    db: sqlite3.Connection, settings: MonitoringSettings, today: DayPlan, line: NDArray[np.float64]
) -> dict[str, object]:
    """Return what the table of routes says of a day's route, whose driven line is given."""
    day, route = today.scene.day, today.route
    return {
        "geom": beside_plot(db, blob(LineString(line))) if len(line) > 1 else None,
        "day": day,
        "date": str(settings.date(day)),
        "sampler": settings.sampler,
        "starts": _start(route).isoformat(),
        "seconds": route.end_s,
        "drive_m": route.drive_m,
        "stops": len(route),
        "expected": route.expected_visible,
        "at_plant": today.scene.at,
        "seconds_left": today.scene.seconds_left,
        "digest": _digest(today),
    }


def _stops(number: int | None, numbered: PlantNumbers, route: Route) -> list[tuple[object, ...]]:
    """Return the rows of the stops of a route with a number."""
    begin, clock = _start(route), grid_clock(route.aisles.grid)
    stops = zip(
        point_blobs(route.stops_lonlat()),
        [number] * len(route),
        range(1, len(route) + 1),
        route.plant.tolist(),
        numbered.line[route.plant].tolist(),
        numbered.number[route.plant].tolist(),
        route.arrive_s.tolist(),
        [clock.after(begin, round(s)).isoformat() for s in route.arrive_s.tolist()],
        route.believed.tolist(),
        strict=True,
    )
    return list(stops)


def _start(route: Route) -> datetime:
    """Return when a planned route begins."""
    assert route.notes is not None  # noqa: S101 - whoever planned said
    assert route.notes.start is not None  # noqa: S101 - when it begins
    return route.notes.start


def in_words(settings: MonitoringSettings, today: DayPlan) -> dict[str, Any]:
    """Return what the season's log says of a route."""
    return {
        "date": str(settings.date(today.scene.day)),
        "stops": len(today.route),
        "sampler": settings.sampler,
        "expected": today.route.expected_visible,
        "digest": _digest(today),
    }


def is_kept(db: sqlite3.Connection, today: DayPlan, who: str = "") -> bool:
    """Tell whether a day's route, of one of a team, is the one kept last."""
    last = kept_last(db, today.scene.day)
    return is_last(last, who) and last[person_key(who)].digest == _digest(today)


def is_last(last: dict[str, KeptRoute], who: str = "") -> bool:
    """Return whether somebody's route of those kept last counts: the season's own if none is newer.

    Another's ends that one, as of who is left alone.
    """
    own = last.get(person_key(who))
    if own is None or who:
        return own is not None
    return own.number == max(one.number for one in last.values())


def days(db: sqlite3.Connection) -> NDArray[np.int64]:
    """Return the days ``(k,)`` of which a route is kept, in order."""
    rows = db.execute("SELECT DISTINCT day FROM routes ORDER BY day")
    return np.array([day for (day,) in rows], np.int64)


class KeptRoute(NamedTuple):
    """A route that is kept: its number in the file, which of its day it is, its digest, its begin.

    It begins `at` a plant, or at the gate (-1), and at a local time; None: no route.
    """

    number: int
    revision: int
    digest: str
    at: int = GATE
    begins: datetime | None = None

    @property
    def plan(self) -> int:
        """Return a number that other plans have not, and this one has in every copy of the file."""
        return int(self.digest[:_PLAN_DIGITS], 16) if self.digest else self.number


def kept_last(db: sqlite3.Connection, day: int) -> dict[str, KeptRoute]:
    """Return the route kept last for a day of each who has one, by `person_key`."""
    last: dict[str, KeptRoute] = {}
    wanted = (
        "SELECT who, fid, revision, digest, at_plant, starts FROM routes WHERE day = ? ORDER BY fid"
    )
    for who, number, revision, mark, at, starts in db.execute(wanted, (day,)):
        # older files may write a name in two ways, and count each
        before = last.get(person_key(who), KeptRoute(0, 0, ""))
        last[person_key(who)] = KeptRoute(
            number, max(revision, before.revision), mark, GATE if at is None else at,
            datetime.fromisoformat(starts),
        )  # fmt: skip
    return last


def plants(db: sqlite3.Connection, kept: KeptRoute | None) -> NDArray[np.int32]:
    """Return the plants ``(k,)`` of a route that is kept; empty if there is none."""
    wanted = "SELECT plant FROM stops WHERE route = ? ORDER BY stop"
    rows = () if kept is None else db.execute(wanted, (kept.number,))
    return np.array([plant for (plant,) in rows], np.int32)


@dataclass(frozen=True, eq=False)
class KeptPlans:
    """All that is kept of a day's plans for one: who, and what of it.

    Parameters
    ----------
    who
        As by `person_key`; empty where one works.
    last, of_all
        Plants of the plan kept last, and of all of them.
    begins, ends
        When the first begins, and the last ends. Of several that begin where the first does no
        work was done by but the last: that one is the first.
    at
        The plants where the first and the last begin, -1: the gate.
    """

    who: str
    last: NDArray[np.int32]
    of_all: NDArray[np.int32]
    begins: datetime
    ends: datetime
    at: tuple[int, int]

    def __repr__(self) -> str:
        return f"<KeptPlans: {len(self.last)} stops, {self.hours():.1f} h>"

    def share_of(self, counted: NDArray[np.int32], told: NDArray[np.int32]) -> float:
        """Return which part of the stops some of the last plan are, with all those done before."""
        done = np.intersect1d(self.of_all, told)
        every = len(np.union1d(self.last, done))
        return len(np.union1d(counted, done)) / every if every else 1.0

    def hours(self, begun: datetime | None = None) -> float:
        """Return the hours that they take; `begun`: when the work they were made for began."""
        return (self.ends - (self.begins if begun is None else begun)).total_seconds() / 3600


def of_day(db: sqlite3.Connection, day: int) -> list[KeptPlans]:
    """Return what is kept of a day's plans, for each who has one."""
    rows = db.execute(
        "SELECT who, starts, seconds, at_plant FROM routes WHERE day = ? ORDER BY fid", (day,)
    ).fetchall()
    stops = db.execute(
        "SELECT DISTINCT who, plant FROM stops JOIN routes ON routes.fid = route WHERE day = ?",
        (day,),
    ).fetchall()
    made = []
    for who, last in kept_last(db, day).items():
        own = [
            (datetime.fromisoformat(t), s, at) for name, t, s, at in rows if person_key(name) == who
        ]
        # files of before do not say where a plan begins
        same = [t for t, _, at in own if at is not None and at == own[0][2] and t <= own[-1][0]]
        begins = same[-1] if same else own[0][0]
        ends = own[-1][0] + timedelta(seconds=own[-1][1])
        first, newest = (GATE if at is None else at for _, _, at in (own[0], own[-1]))
        every = {plant for name, plant in stops if person_key(name) == who}
        of_all = np.array(sorted(every), np.int32)
        made.append(KeptPlans(who, plants(db, last), of_all, begins, ends, (first, newest)))
    return made


def _digest(today: DayPlan) -> str:
    plant, arrive_s = today.route.plant, np.round(today.route.arrive_s, 3)
    stands = today.scene.at, round(today.scene.seconds_left, 3)
    return digest(plant.astype("<i4"), arrive_s.astype("<f8"), stands, length=24, end=b"")


def planned_only(season: OpenSeason, until: date) -> tuple[date, ...]:
    """Return the planned days `until` a date of which nothing is recorded, in order.

    Each is over on the plot, and was planned to be worked, see `logged_days.to_be_worked`.
    That a plant could not be inspected is a record, too.
    """
    clock = local_clock(season.plot.field)
    last = min(until, clock.today() - timedelta(days=1))
    with season.reading() as now:  # both of one moment
        contents, planned = now.contents, days(now.db)
        missing = planned[~np.isin(planned, contents.history.days)]
        dates = [contents.settings.date(day) for day in missing.tolist()]
        over = [day for day in dates if day <= last]
        return logged_days.to_be_worked(now.db, over, clock) if over else ()


def closed_to_kept(
    season: SeasonDays, on: date, who: str = "", kept_as: str | None = None
) -> tuple[Closure, ...]:
    """Return what is closed to the route kept of a day: by its own begin, if that is later.

    Once something of their day is recorded, it is by the clock. `on` as in `Season.plan`;
    `kept_as`: by which name the route of `who` is kept; None: their own.
    """
    with season.reading(), season.store.one_moment():
        work = season.work(on, who)
        own = str(work.shifts.who or "") if kept_as is None else kept_as
        with season.store.reading() as db:
            kept = kept_last(db, work.day).get(person_key(own))
        now = local_clock(season.plot.field).now()
        begins = None if kept is None else kept.begins
        if len(work.inspections):  # whoever is out goes on now
            begins = now if now.date() == on else None
        if begins is None:
            return season.closed(on, who)
        begins_s = (begins - datetime.combine(on, time())).total_seconds()
        late_s = grid_clock(season.plot.grid).seconds_between(on, work.begun_s, begins_s)
        day_s = work.shifts.shift.robot.day_s
        return season.closed(on, who, min(max(day_s - late_s, 0.0), day_s))
