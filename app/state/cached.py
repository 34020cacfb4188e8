"""What a day and a season come to, kept between clicks.

Keys are digests and frozen settings, never arrays.
Streamlit hashes large arrays from a sample of their cells; a plot that differs in one plant would
be taken for the same. So values that cannot be keyed come in as ``_arguments``, which Streamlit
leaves out, beside a key that stands for them. `cached_files` and `cached_simulations` do the same.

Results come while a page is made. So a key that names a revision is read before what it stands for,
or else names what was read by its digest: what is older than its key would be shown to everybody.
"""

from __future__ import annotations

from datetime import date
from typing import TYPE_CHECKING, TypeVar, cast

import numpy as np
import streamlit as st

from fieldmon.infestation import hotspots
from fieldmon.infestation.hotspots import HotSpots, NewestRecords, hot_spots
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.monitoring import worked_route
from fieldmon.monitoring.days import day_ahead, estate_day, kept_routes, kept_wishes
from fieldmon.monitoring.estimates import figures_of_day, treatment_effect
from fieldmon.monitoring.estimates.plant_states import hot_spots_on
from fieldmon.planning.plan import DayPlan, PlanSettings, plan_believed
from fieldmon.reports import season as reports
from fieldmon.reports.day import DayFacts

from ..words import language, texts
from ..words.language import Late
from . import opened_seasons

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray
    from pydeck import Layer

    from fieldmon.compute.units import Units
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.infestation.learnt import Learnt
    from fieldmon.infestation.level_range import LevelRange
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.infestation.records import Records
    from fieldmon.monitoring import DayFigures, KeptMessage, PlannedAndDone, Progress, Season
    from fieldmon.monitoring.advice.advice import Advice
    from fieldmon.monitoring.days.estate_day import EstatePlot, EstateTurn
    from fieldmon.monitoring.estimates.found_again import FoundAgain
    from fieldmon.monitoring.estimates.told_detection import ToldOtherwise
    from fieldmon.monitoring.estimates.treatment_effect import TreatmentEffect
    from fieldmon.monitoring.settings.advice_settings import AdviceSettings
    from fieldmon.planning.route import Route
    from fieldmon.planning.wishes import Wishes
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.reports.content import Report

    Array = NDArray[np.float64]

Written = TypeVar("Written")

#: shown while something is made, in the language of whoever waits
WORKING = Late(lambda: texts.WORKING)
FEW = 24
# maps of many plants are megabytes each, a day's figures a few numbers
_MAPS, _DAYS, _FILMS = 60, 200, 6


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def day_plan(
    key: str,
    day: str,
    settings: PlanSettings,
    sampler_name: str,
    _plot: Plot,
    _known: tuple[Records, Array | None],
    wishes: Wishes,
) -> DayPlan:
    """Return the planned day; `key` stands for plot, records and risk, the last two `_known`."""
    known = first_belief(key, day, settings.prior, _plot, _known)
    return plan_believed(_plot, known, settings, wishes)


@st.cache_resource(max_entries=FEW, show_spinner=False)
def first_belief(
    key: str,
    day: str,
    prior: PriorSettings,
    _plot: Plot,
    _known: tuple[Records, Array | None],
) -> tuple[Array, TracedPairs]:
    """Return the chance map of a day and what a season believes that begins with it."""
    chance = chance_map(key, day, prior, _plot, _known)
    return chance, TracedPairs.of(_plot.grid, chance)


@st.cache_resource(max_entries=FEW, show_spinner=False)
def chance_map(
    key: str,
    day: str,
    prior: PriorSettings,
    _plot: Plot,
    _known: tuple[Records, Array | None],
) -> Array:
    """Return the chance map of a day, whoever is to work on it; `key` as above."""
    records, at_risk = _known
    on = np.datetime64(day, "D")
    return prior_chance(_plot.grid, _plot.field, records, on, prior, at_risk)


@st.cache_resource(max_entries=FEW, show_spinner=False)
def newest_records(key: str, _plot: Plot, _records: Records) -> NewestRecords:
    """Return what records say of plants; `key` stands for the plot, its records and the day."""
    return hotspots.newest_records(_plot.grid, _records)


@st.cache_resource(max_entries=FEW, show_spinner=False)
def recorded_hot_spots(key: str, _plot: Plot, _records: Records) -> HotSpots:
    """Return where records cluster; `key` as above."""
    return hot_spots(_plot.grid, newest_records(key, _plot, _records).state)


def season(path: Path) -> Season:
    """Open a season; all sessions share it, and each call of it reads what is new in the file."""
    if opened_seasons.is_open(path):
        return opened_seasons.opened(path)
    with st.spinner(texts.WORKING):
        return opened_seasons.opened(path)


def revision_on(season: Season, on: date, who: str | None = None) -> str:
    """Return what changes with all that is recorded, and when plants that were closed open."""
    closed = season.closed(on, who or "")
    return " ".join([season.revision, *(f"{one.until}" for one in closed)])


@st.cache_resource(max_entries=FEW, show_spinner=False)
def import_messages(key: str, _season: Season) -> tuple[KeptMessage, ...]:
    """Return what the imports had to say when a season began."""
    return _season.messages()


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def season_plan(
    key: str,
    revision: str,
    of: tuple[str, str | None],
    _season: Season,
    wished: tuple[Wishes, bool],
) -> DayPlan:
    """Return what is left of a season's day for one of its team, or for the one who works."""
    on, part = _day_of(of)
    wishes, anew = wished
    return day_ahead.planned(_season, on, part, wishes=wishes, anew=anew)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def season_plan_now(
    key: str,
    revision: str,
    minute: str,
    of: tuple[str, str | None],
    _season: Season,
    wished: tuple[Wishes, bool],
) -> DayPlan:
    """Return the same by the clock; `minute` is that of today, and empty on another day."""
    on, part = _day_of(of)
    plan = season_plan(key, revision, of, _season, wished)
    return day_ahead.by_the_clock(_season, on, part, plan)


def _day_of(of: tuple[str, str | None]) -> tuple[date, day_ahead.WorkPart]:
    day, who = of
    return date.fromisoformat(day), day_ahead.WorkPart(name=who or "")


@st.cache_resource(max_entries=FEW, show_spinner=False)
def estate_plot(key: str, revision: str, day: str, _season: Season) -> EstatePlot:
    """Return a season's plot as its day begins, for a day shared with other plots."""
    return estate_day.EstatePlot.of(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=_DAYS, show_spinner=False)
def turn_plan(key: str, robot: Robot, _turn: EstateTurn) -> DayPlan:
    """Return the day of one who has only some hours for a plot; `key` stands for the rest."""
    return _turn.plan()


@st.cache_resource(max_entries=FEW, show_spinner=False)
def kept_route(
    key: str,
    revision: str,
    of: tuple[str, str | None],
    _season: Season,
) -> NDArray[np.int32]:
    """Return the plants of the route that was given out for a day; empty if none was."""
    day, who = of
    return _season.kept_route(date.fromisoformat(day), who or "")


@st.cache_resource(max_entries=_DAYS, show_spinner=False)
def wishes_kept(key: str, revision: str, day: str, _season: Season) -> Wishes:
    """Return what is kept as wanted of a season's day besides."""
    return kept_wishes.wishes_kept(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=_DAYS, show_spinner=False)
def planned_only(key: str, revision: str, day: str, _season: Season) -> tuple[date, ...]:
    """Return the planned days up to a day of which nothing is recorded."""
    return kept_routes.planned_only(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=FEW, show_spinner=False)
def planned_and_done(
    key: str,
    revision: str,
    of: tuple[str, str | None],
    _season: Season,
) -> PlannedAndDone | None:
    """Return a day's kept plan, held to what was done; None: none was kept."""
    day, who = of
    return _season.planned_and_done(date.fromisoformat(day), who)


@st.cache_resource(max_entries=FEW, show_spinner=False)
def worked(
    key: str,
    revision: str,
    of: tuple[str, str | None],
    _season: Season,
) -> Route:
    """Return a day's route as it was worked; empty if nothing was recorded."""
    day, who = of
    return worked_route(_season, date.fromisoformat(day), who)


@st.cache_resource(max_entries=FEW, show_spinner=False)
def kept_days(key: str, revision: str, _season: Season) -> tuple[DayFigures, ...]:
    """Return the figures of a season's days on which something happened, in order."""
    return _season.days()


@st.cache_resource(max_entries=_DAYS, show_spinner=False)
def day_figures(key: str, revision: str, day: str, _season: Season) -> DayFigures:
    """Return a day of a season in figures."""
    return figures_of_day.day_figures(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def progress(key: str, revision: str, day: str, _season: Season) -> Progress:
    """Return how far the inspections are after a day of a season."""
    return figures_of_day.progress(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=_DAYS, show_spinner=False)
def still_infested(key: str, revision: str, day: str, _season: Season) -> PlotEstimate:
    """Return how many plants are still infested after a day of a season, flagged ones too."""
    return figures_of_day.still_infested(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def flagged(key: str, revision: str, day: str, _season: Season) -> float:
    """Return how many plants found are still infested after a day of a season."""
    return figures_of_day.flagged(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=_DAYS, show_spinner=False)
def found_again(key: str, revision: str, day: str, _season: Season) -> FoundAgain | None:
    """Return how many plants taken as treated were found again up to a day of a season."""
    return figures_of_day.found_again(_season, date.fromisoformat(day))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def learnt(key: str, revision: str, day: str, _season: Season) -> tuple[Learnt, ...]:
    """Return what the inspections up to a day of a season tell of the insects."""
    return _season.learnt(date.fromisoformat(day))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def other_detections(
    key: str, revision: str, day: str, _season: Season
) -> tuple[ToldOtherwise, ...]:
    """Return with which inspections up to a day of a season another detection rate was said."""
    return _season.other_detections(date.fromisoformat(day))


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def learnt_efficacy(
    key: str, revision: str, day: str, product: str, _season: Season
) -> TreatmentEffect | None:
    """Return what a season learnt until a day of how well a product works."""
    return treatment_effect.learnt_efficacy(_season.effects(date.fromisoformat(day)), product)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def advice(
    key: str,
    revision: str,
    day: str,
    settings: AdviceSettings,
    _season: Season,
) -> Advice:
    """Return what a season advises on a day, by these settings."""
    return _season.advice(date.fromisoformat(day), settings)


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def forecast(key: str, revision: str, day: str, _season: Season) -> Forecast:
    """Return how many plants are infested on the mornings after a day of a season."""
    return _season.forecast(date.fromisoformat(day))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def season_hot_spots(key: str, revision: str, day: str, _season: Season) -> HotSpots:
    """Return where finds cluster on a day of a season."""
    number = _season.settings.day(date.fromisoformat(day))
    return hot_spots_on(_season.history, number)


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def evening(key: str, revision: str, day: str, _season: Season) -> Array:
    """Return the chance map of a day after what was recorded of it."""
    return _season.evening(date.fromisoformat(day))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def level_range(key: str, revision: str, day: str, _season: Season) -> LevelRange:
    """Return how far that chance map may be off as a whole."""
    return _season.level_range(date.fromisoformat(day))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def morning(key: str, revision: str, day: str, _season: Season) -> Array:
    """Return the chance map of a morning."""
    return _season.morning(date.fromisoformat(day))


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def season_report(
    key: str,
    revision: str,
    day: str,
    units: Units,
    _season: Season,
) -> Report:
    """Return the report of a season up to a day."""
    return reports.season_report(_season, date.fromisoformat(day), units)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def day_of_each(
    key: str,
    now: tuple[str, str],
    days: tuple[str, date | None],
    _season: Season,
    wished: tuple[Wishes, bool],
) -> tuple[DayFacts, ...]:
    """Return a day (ISO, and today's) of a season and, where several work, that of each of them.

    `now` is `revision_on` and the minute of today, which is empty on another day.
    """
    day, today = days
    return DayFacts.each_of_season(_season, date.fromisoformat(day), today, wished)


def layers(key: str, make: Callable[[], list[Layer]]) -> list[Layer]:
    """Return map layers, made once a language; `key` stands for all that they show."""
    return _layers(f"{language.current()} {key}", make)


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def _layers(key: str, _make: Callable[[], list[Layer]]) -> list[Layer]:
    return _make()


def written(key: str, make: Callable[[], Written]) -> Written:
    """Return what a day is said in, or played from, made once a language; `key` as above."""
    return cast("Written", _written(f"{language.current()} {key}", make))


@st.cache_resource(max_entries=_MAPS, show_spinner=False)
def _written(key: str, _make: Callable[[], object]) -> object:
    return _make()


@st.cache_resource(max_entries=_FILMS, show_spinner=False)
def frames(key: str, _make: Callable[[], list[list[Layer]]]) -> list[list[Layer]]:
    """Return the layers of each day of a season, kept together: they are more than maps are kept.

    `key` stands for all that they show, their language too.
    """
    return _make()
