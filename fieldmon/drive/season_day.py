"""A day of a season on disk, driven: every plant told is in the file before the next is asked."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.drive.day_clock import second_now, time_of
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring.days.day_ahead import DayAhead, through
from fieldmon.monitoring.days.kept_wishes import wishes_kept
from fieldmon.monitoring.estimates.asked_day import AskedDay, PlantToInspect, plant_to_inspect
from fieldmon.monitoring.file.connections import kept_open
from fieldmon.monitoring.phones.scouts import codes_on, inside
from fieldmon.monitoring.season.season_inspections import recorded
from fieldmon.monitoring.settings.shift_work import Besides
from fieldmon.pests.weather import DAY_S
from fieldmon.planning.members import person_key
from fieldmon.plot.local_clock import grid_clock

if TYPE_CHECKING:
    from collections.abc import Sequence
    from contextlib import AbstractContextManager
    from datetime import date, time

    from fieldmon.monitoring.season.season_file import Season
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.wishes import Wishes

#: a robot that is so much later or earlier than planned is planned for anew
REPLAN_AFTER_S = 30.0


class SeasonDay(AskedDay):
    """A day of a season that is asked for the next plant and told what was seen there.

    All that is told of a day is one batch, and every plan is kept. Who begins again after a crash
    goes on from the plant told last, at its time, with what is left of the plan given out last. Who
    is out with a code works beside it: their rows are left to them.

    Parameters
    ----------
    season, on
        The season and the day.
    source
        What the batch is called: the robot.
    wishes
        What people want of the day besides; None: what is kept of it.
    name
        Who inspects, as the record has it; "": nobody is named.

    Raises
    ------
    SettingError
        If somebody else has a code by that name.
    """

    late_s = REPLAN_AFTER_S

    @kept_open()
    def __init__(
        self, season: Season, on: date, source: str = "robot", wishes: Wishes | None = None,
        name: str = "",
    ) -> None:  # fmt: skip
        codes = codes_on(season, on)
        if name and person_key(name) in map(person_key, codes):
            raise SettingError(
                f"A robot must be called otherwise than those with a code for {on}, but both are "
                f"called {name}. End that code, or give the robot another --serial."
            )
        self._name = name
        #: first and last row of each part that is left to somebody
        self.left_out = tuple(rows for rows in codes.values() if rows is not None)
        self._season, self._on = season, on
        self._wishes = self._without(wishes)
        self._who = Besides(tuple(codes)) if codes else None
        #: the second of the day at which its work began, from which seconds count here
        self.begun_s = season.work(on, self._who or "").begun_s
        self._source = f"{source} {on}"
        #: plans that it went by, the one it began or went on with included
        self.replanned = 0
        #: whether it goes on with what is left of the plan given out last
        self.goes_on = self._begin(None)
        super().__init__(self._gone_s)

    def __repr__(self) -> str:
        """Say which day of which season."""
        return f"<SeasonDay {self._on} of {self._season.path.name}>"

    def _begin(self, now: time | None) -> bool:
        """Go on with what is left of the plan given out last, or by a new one; tell which."""
        with self._entering():
            last = self._season, self._on, self._who or "", self.left_out
            left = None if self.batch is None else left_of_plan(*last, now)
        goes_on = left is not None and len(left.route) > 0
        if left is not None and goes_on:
            self._go_by(left)
        else:
            self._plan(now)
        self.replanned = 1
        return goes_on

    def now_s(self) -> tuple[float, str]:
        """Return what `second_now` does, of its robot."""
        return second_now(self._season, self._on, self._who or "")

    def begin_at(self, now_s: float) -> None:
        """Begin now, or go on, seconds since the day's midnight: results count from then."""
        if not len(self._season.work(self._on, self._who or "").inspections):
            self.begun_s = now_s
            return
        clock = grid_clock(self._season.plot.grid)
        gone_s = clock.seconds_between(self._on, self.begun_s, now_s)
        if gone_s > self._gone_s + REPLAN_AFTER_S:
            self.goes_on = self._begin(time_of(now_s))
            self._clock_s = self._gone_s

    @property
    def on(self) -> date:
        """The day."""
        return self._on

    @property
    def left_s(self) -> float:
        """Seconds of the day's hours that are left."""
        return max(0.0, self._today.scene.robot.day_s - self._gone_s)

    @property
    def batch(self) -> int | None:
        """The batch of the day, as it is numbered now: merging may change that; None: none yet."""
        return begun_batch(self._season, self._source)

    @property
    def at(self) -> int:
        """Where the robot stands: a plant, or -1 for the gate."""
        return self._at

    @property
    def gone_s(self) -> float:
        """Seconds of the day that are gone."""
        return self._gone_s

    def ask(self) -> PlantToInspect | None:
        """Return the plant to inspect next; None where the day's hours allow no other."""
        if self._asked is None and self._next < len(self._today.route):
            self._asked = self._stop(self._next)
        return self._asked

    def ahead(self, n: int) -> list[int]:
        """Return up to n plants that follow the one asked for if nothing is found."""
        plants: list[int] = self._today.route.plant[self._next + 1 : self._next + 1 + n].tolist()
        return plants

    @kept_open()
    def tell(self, found: bool | None, at_s: float | None = None) -> None:  # noqa: FBT001 - a result
        """Record what was seen at the plant that was asked for; None: it could not be inspected.

        `at_s` is when it was done, seconds since the day began; None: as charged.
        """
        self._tell(found, at_s)

    def _take(self, stop: PlantToInspect, found: bool | None, now_s: float) -> None:  # noqa: FBT001
        clock = grid_clock(self._season.plot.grid)
        at_s = clock.second_after(self._on, self.begun_s, now_s)
        one = as_inspection(stop.plant, found, (self._on, at_s), self._name)
        recorded(self._season, one, self._source, into=self.batch)

    def _go_on(self, stop: PlantToInspect, found: bool | None, *, is_late: bool) -> None:  # noqa: FBT001
        self._at, self._gone_s = stop.plant, self._clock_s
        self._next += 1
        if found or found is None or is_late:
            self._plan()

    def _without(self, wishes: Wishes | None) -> Wishes | None:
        """Return what people want but for the plants that are left to somebody."""
        if not self.left_out:
            return wishes
        if wishes is None:
            wishes = wishes_kept(self._season, self._on)
        theirs = np.any(
            [inside(self._season.plant_numbers, rows) for rows in self.left_out], axis=0
        )
        return wishes.never(tuple(np.flatnonzero(theirs).tolist()))

    def _plan(self, now: time | None = None) -> None:
        with self._entering():
            self._go_by(self._season.plan(self._on, now, wishes=self._wishes, who=self._who))

    def _entering(self) -> AbstractContextManager[None]:
        """Let a robot enter where people may not be yet."""
        on_foot = self._season.planned_by(self._on).robot.on_foot
        return nullcontext() if on_foot else self._season.entering_treated()

    def _go_by(self, today: DayPlan) -> None:
        season, on, who = self._season, self._on, self._who
        self._today: DayPlan = today
        self._next = 0
        self._at = today.scene.at
        # a first result that came late or early shows that the day began otherwise
        since_s = season.work(on, who or "").begun_s - self.begun_s
        self._gone_s = since_s + today.scene.robot.day_s - today.scene.seconds_left
        self._since_s = self._gone_s
        self.replanned += 1

    def _stop(self, k: int) -> PlantToInspect:
        route, plant = self._today.route, int(self._today.route.plant[k])
        arrive_s = self._since_s + float(route.arrive_s[k])
        long = float(route.leave_s[k] - route.arrive_s[k]), float(route.detects[k])
        return plant_to_inspect(self._season.plot.grid, plant, arrive_s, *long)


def begun_batch(season: Season, source: str) -> int | None:
    """Return the batch of a day that was begun before; None: it was not."""
    begun = [
        one.number
        for one in season.batches()
        if one.source == source and one.kind == "findings" and not one.undone
    ]
    return begun[0] if begun else None


def left_of_plan(
    season: Season,
    on: date,
    who: str | Besides = "",
    left_out: Sequence[tuple[int, int]] = (),
    now: time | None = None,
) -> DayPlan | None:
    """Return what is left of the plan given out last; None: the day is to be planned anew.

    So it is if a plant was found since, or could not be inspected, or the hours left are too few.

    Parameters
    ----------
    season, on, who
        As of `Season.plan`.
    left_out
        First and last row of each part that is left to others.
    now
        Local time; None: that of the last result.
    """
    ahead, scene = DayAhead.of(season, on), season.scene(on, now, who)
    name = person_key(who) if isinstance(who, str) else ""
    if (kept := ahead.last.get(name)) is None:
        return None
    done = season.work(on, who).inspections
    before = np.flatnonzero(done.plant == kept.at)
    since = done.result[before[-1] + 1 if len(before) else 0 :]
    plants = ahead.plants[name]
    is_left = scene.are_open(plants)
    for rows in left_out:
        is_left &= ~inside(season.plant_numbers, rows)[plants]
    left = through(scene, plants[is_left])
    fits = left.route.end_s <= scene.seconds_left + REPLAN_AFTER_S
    return left if fits and (since == CLEAN).all() else None


def as_inspection(
    plant: int,
    found: bool | None,  # noqa: FBT001 - a result
    when: tuple[date, float],
    who: str = "",
) -> Inspections:
    """Return what was seen at a plant, on a day at a second since its midnight, as a season has it.

    None: it could not be inspected. Files hold whole seconds; past midnight it is the next date.
    """
    result = SKIPPED if found is None else FOUND if found else CLEAN
    days, second = divmod(np.round(when[1]), DAY_S)
    return Inspections.of(
        np.array([plant]),
        np.array([result]),
        np.datetime64(when[0]) + np.timedelta64(int(days), "D"),
        second=np.array([second]),
        who=np.array([who], object),
    )
