"""What is known and planned on the chosen day: of a season's findings, else of records."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, datetime, time, timedelta
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from fieldmon.infestation.inspections import FOUND, SKIPPED
from fieldmon.infestation.level_range import first_level_range
from fieldmon.infestation.records import usable
from fieldmon.monitoring import day_was_worked
from fieldmon.monitoring.estimates import plant_states
from fieldmon.monitoring.estimates.last_days import last_date
from fieldmon.monitoring.settings.shift_work import made_by
from fieldmon.planning import day_bound
from fieldmon.plot.local_clock import grid_clock

from . import cached

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.infestation.learnt import Learnt
    from fieldmon.infestation.level_range import LevelRange
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.infestation.records import Records
    from fieldmon.monitoring import DayFigures, PlannedAndDone, Progress
    from fieldmon.monitoring.estimates.found_again import FoundAgain
    from fieldmon.monitoring.estimates.told_detection import ToldOtherwise
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.route import Route
    from fieldmon.plot.local_clock import LocalClock
    from fieldmon.plot.plot import Plot

    from .choices import Choices

#: when work starts where no season says it
STARTS = time(6, 0)
# plans are not changed once made
_LEVELS: WeakKeyDictionary[DayPlan, LevelRange] = WeakKeyDictionary()
_BOUNDED: WeakKeyDictionary[DayPlan, DayPlan] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class DayRoute:
    """A route on the map, the local time at which it starts, and whether it was worked."""

    route: Route
    begins: datetime
    worked: bool = False

    def at(self, seconds: float) -> datetime:
        """Return the local time so many seconds after the start."""
        if self.worked:  # from one time noted to another
            return self.begins + timedelta(seconds=round(seconds))
        return self._clock.after(self.begins, round(seconds))

    @cached_property
    def _clock(self) -> LocalClock:
        return grid_clock(self.route.aisles.grid)


def starts(choices: Choices, plan: DayPlan, who: str | None = None) -> datetime:
    """Return the local time at which the planned route, or what is left of it, starts.

    `who` is whose route it is; None: of the one whose day is shown.
    """
    if (said := _said_start(plan.route)) is not None:
        return said
    gone = timedelta(seconds=plan.scene.robot.day_s - plan.scene.seconds_left)
    return work_begins(choices, who) + gone


def ends(choices: Choices, who: str | None) -> datetime:
    """Return the local time at which a robot's planned day ends.

    Where nothing is left of it, as after its hours, that is when these end.
    """
    plan = choices.plan_of(who)
    if not len(plan.route):
        return work_begins(choices, who) + timedelta(seconds=plan.scene.robot.day_s)
    return DayRoute(plan.route, starts(choices, plan, who)).at(plan.route.end_s)


def _said_start(route: Route) -> datetime | None:
    return None if route.notes is None else route.notes.start


def work_begins(choices: Choices, who: str | None = None) -> datetime:
    """Return the local time at which the day's work starts; None: of the one whose day is shown."""
    if (season := choices.season) is None:
        return datetime.combine(choices.on, STARTS)
    settings = season.planned_by(choices.on)
    who = who or choices.whose_day
    late_s = settings.member(who).starts_s if who else 0.0
    return datetime.combine(choices.on, settings.starts) + timedelta(seconds=late_s)


def route(choices: Choices) -> DayRoute:
    """Return the route as it was driven on a day that was worked, or as it is planned."""
    plan, season = choices.plan(), choices.season
    if season is not None and day_was_worked(season, choices.on, plan.route):
        of = choices.day, choices.whose_day
        done = cached.worked(choices.key, choices.revision, of, season)
        return DayRoute(done, _said_start(done) or work_begins(choices), worked=True)
    return DayRoute(plan.route, starts(choices, plan))


def with_bound(choices: Choices, plan: DayPlan) -> DayPlan:
    """Return the planned day whose route says what no other can expect to find.

    Of one of a team that says little, as others share the aisles.
    """
    if choices.whose_day:
        return plan
    if plan not in _BOUNDED:
        _BOUNDED[plan] = day_bound.with_bound(plan)
    return _BOUNDED[plan]


def given_out(choices: Choices) -> NDArray[np.int32]:
    """Return the plants of the route that a season keeps as given out for the day, or none."""
    of = choices.day, choices.whose_day
    return cached.kept_route(choices.key, choices.revision, of, choices.open_season)


def is_given_out(choices: Choices, plan: DayPlan) -> bool:
    """Return whether a season keeps just this plan as given out: later news may bring another."""
    kept = given_out(choices)
    return bool(len(kept)) and np.array_equal(kept, plan.route.plant)


def planned_and_done(choices: Choices) -> PlannedAndDone | None:
    """Return the plan that a season keeps of the day, held to what was done; None: none."""
    of = choices.day, choices.whose_day
    return cached.planned_and_done(choices.key, choices.revision, of, choices.open_season)


def chance(choices: Choices) -> cached.Array:
    """Return ``(n,)`` what is believed on the day, after what was recorded of it."""
    if choices.season is None:
        return choices.plan().chance
    return evening(choices, choices.day)


def believed(choices: Choices) -> tuple[float, float]:
    """Return the share infested and the spread a night that a season believes, both in percent."""
    if choices.season is None:
        return 2.0, 10.0
    share = 100.0 * float(chance(choices).mean())
    return (
        min(max(round(share, 1), 0.1), 50.0),
        100.0 * choices.season.settings.belief.spread.rate_per_day,
    )


def evening(choices: Choices, day: str) -> cached.Array:
    """Return ``(n,)`` what a season believes on the evening of a day (ISO)."""
    return cached.evening(choices.key, choices.revision, day, choices.open_season)


def level_range(choices: Choices) -> LevelRange:
    """Return how far the chances of that day may be off together."""
    if choices.season is None:
        plan = choices.plan()
        if plan not in _LEVELS:
            _LEVELS[plan] = first_level_range(choices.plot.grid, plan.chance)
        return _LEVELS[plan]
    return cached.level_range(choices.key, choices.revision, choices.day, choices.season)


def morning(choices: Choices, day: str) -> cached.Array:
    """Return ``(n,)`` what a season believed on the morning of a day (ISO)."""
    return cached.morning(choices.key, choices.revision, day, choices.open_season)


def states(choices: Choices) -> NDArray[np.int8]:
    """Return ``(n,)`` found (1), clean (0) or never inspected (-1), by records and inspections."""
    if choices.season is None:
        return cached.newest_records(*_recorded(choices)).state
    history, settings = choices.season.history, choices.season.settings
    return plant_states.shown_states(history, settings.day(choices.on))


def not_inspected(choices: Choices) -> NDArray[np.int8]:
    """Return ``(n,)`` 1 nobody could inspect it last time, 2 it is gone, 0 neither."""
    season = choices.season
    if season is None:
        return np.zeros(len(choices.plot.grid), np.int8)
    return plant_states.not_inspected(season.history, season.settings.day(choices.on))


def not_inspected_said(choices: Choices) -> list[Worded]:
    """Return how many plants a season could not inspect last time, and how many are gone."""
    season = choices.open_season
    return plant_states.not_inspected_said(season.history, season.settings.day(choices.on))


def states_apart(choices: Choices) -> tuple[NDArray[np.int8], NDArray[np.bool_]]:
    """Return `states`, found only by a season's inspections, and ``(n,)`` finds of records alone.

    Without a season all is by records, and none is apart.
    """
    if choices.season is None:
        known = states(choices)
        return known, np.zeros(len(known), np.bool_)
    history, settings = choices.season.history, choices.season.settings
    return plant_states.shown_apart(history, settings.day(choices.on))


def hot_spots(choices: Choices) -> HotSpots:
    """Return the hot spots of the day: of findings in a season, else of records."""
    if choices.season is None:
        return cached.recorded_hot_spots(*_recorded(choices))
    return season_hot_spots(choices, choices.day)


def finds_apart(choices: Choices) -> tuple[NDArray[np.bool_], NDArray[np.bool_]] | None:
    """Return ``(n,)`` which finds are only of records, and which count no more; None: no season."""
    if choices.season is None:
        return None
    history, settings = choices.season.history, choices.season.settings
    return plant_states.finds_apart(history, settings.day(choices.on))


def season_hot_spots(choices: Choices, day: str) -> HotSpots:
    """Return a season's hot spots on a day (ISO)."""
    return cached.season_hot_spots(choices.key, choices.revision, day, choices.open_season)


def ages(choices: Choices) -> NDArray[np.int64]:
    """Return ``(n,)`` days since each plant was inspected, or its record made; -1: never."""
    newest = cached.newest_records(*_recorded(choices)).day
    since = (np.datetime64(choices.day, "D") - newest).astype(np.int64)
    recorded = np.where(np.isnat(newest), -1, since)
    if choices.season is None:
        return recorded
    day = choices.season.settings.day(choices.on)
    last = choices.season.history.last_inspected(day)
    return np.where(last < 0, recorded, day - last)


def counts(choices: Choices) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return how often each plant was inspected, and found, in a season up to the day, ``(n,)``."""
    done = choices.open_season.history.inspections
    here = (done.date <= np.datetime64(choices.day)) & (done.result != SKIPPED)
    n = len(choices.plot.grid)
    finds = here & (done.result == FOUND)
    return np.bincount(done.plant[here], minlength=n), np.bincount(done.plant[finds], minlength=n)


def progress(choices: Choices) -> Progress:
    """Return how far a season's inspections are."""
    return cached.progress(choices.key, choices.revision, choices.day, choices.open_season)


def last_visit(choices: Choices, until: date) -> date | None:
    """Return the last day up to a date on which any plant was inspected; None: there is none."""
    days = choices.open_season.history.inspections.inspected.date
    days = days[days <= np.datetime64(until, "D")]
    return days[-1].item() if len(days) else None


def planned_only(choices: Choices, until: date) -> tuple[date, ...]:
    """Return the planned days up to a date of which nothing is recorded."""
    if choices.today is not None:  # a day that is not over yet will be
        until = min(until, choices.today - timedelta(days=1))
    return cached.planned_only(choices.key, choices.revision, str(until), choices.open_season)


class Inspected(NamedTuple):
    """How many plants were inspected, and found of these."""

    inspected: int
    found: int


def inspected_by_shown(choices: Choices) -> Inspected:
    """Return what was inspected on the day by whoever of a team is shown, else by all."""
    told = choices.open_season.history.inspections.on(choices.on).inspected
    own = made_by(told, choices.whose_day)
    return Inspected(len(np.unique(own.plant)), len(np.unique(own.plant[own.result == FOUND])))


def n_done(choices: Choices) -> int:
    """Return how many plants whoever is shown told of on the day, inspected or not."""
    told = choices.open_season.history.inspections.on(choices.on)
    return len(np.unique(made_by(told, choices.whose_day).plant))


def still_infested(choices: Choices, day: str) -> PlotEstimate:
    """Return how many plants are still infested after a day, flagged ones among them."""
    return cached.still_infested(choices.key, choices.revision, day, choices.open_season)


def flagged(choices: Choices) -> float:
    """Return how many of the plants found are still infested, as expected: flagged only."""
    return cached.flagged(choices.key, choices.revision, choices.day, choices.open_season)


def found_again(choices: Choices) -> FoundAgain | None:
    """Return how many plants taken as treated were found again, where that is hardly chance."""
    return cached.found_again(choices.key, choices.revision, choices.day, choices.open_season)


def learnt(choices: Choices) -> tuple[Learnt, ...]:
    """Return what a season's inspections tell of the insects."""
    return cached.learnt(choices.key, choices.revision, choices.day, choices.open_season)


def other_detections(choices: Choices) -> tuple[ToldOtherwise, ...]:
    """Return with which inspections another detection rate was said than the season's own."""
    return cached.other_detections(choices.key, choices.revision, choices.day, choices.open_season)


def forecast(choices: Choices) -> Forecast:
    """Return how many plants are infested after the day shown if nobody inspects any more."""
    return cached.forecast(choices.key, choices.revision, choices.day, choices.open_season)


def figures(choices: Choices, day: str) -> DayFigures:
    """Return a day (ISO) of a season in figures."""
    return cached.day_figures(choices.key, choices.revision, day, choices.open_season)


def figures_so_far(choices: Choices) -> list[DayFigures]:
    """Return the days up to the chosen one on which something happened, and that one."""
    kept = cached.kept_days(choices.key, choices.revision, choices.open_season)
    return [*(one for one in kept if one.on < choices.on), figures(choices, choices.day)]


def treated(choices: Choices, day: str) -> int:
    """Return how many plants of a season were treated on a day (ISO)."""
    on = [one.place.plants for one in choices.open_season.treatments() if str(one.on) == day]
    return int(np.count_nonzero(np.any(on, axis=0))) if on else 0


def found(choices: Choices) -> NDArray[np.int32]:
    """Return the plants found on the day, by number; none without a season."""
    if choices.season is None:
        return np.empty(0, np.int32)
    done = choices.season.history.inspections.on(choices.on)
    return np.unique(done.plant[done.result == FOUND])


def season_days(choices: Choices) -> list[str]:
    """Return the days (ISO) of a season from its first up to its last or the chosen one."""
    season = choices.open_season
    until: date = max(choices.on, last_date(season))
    first = np.datetime64(season.settings.begins, "D")
    return [str(day) for day in np.arange(first, np.datetime64(until, "D") + 1)]


def messages_on_records(choices: Choices) -> list[str]:
    """Return what planning says about records it cannot use."""
    on = np.datetime64(_known_on(choices))
    return list(usable(choices.records, on, choices.prior).messages())


def _known_on(choices: Choices) -> str:
    """Return the day (ISO) up to which records count.

    The chosen day; in a season its first day, for that is what it began with.
    """
    return choices.day if choices.season is None else str(choices.season.settings.begins)


def records_known(choices: Choices) -> Records:
    """Return the records that count: in a season those from which it began."""
    return _recorded(choices)[2]


def _recorded(choices: Choices) -> tuple[str, Plot, Records]:
    """Return the records that are known, their plot, and a key for both."""
    on = _known_on(choices)
    known = usable(choices.records, np.datetime64(on)).records
    return f"{choices.key} {on}", choices.plot, known
