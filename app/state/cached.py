"""Everything the app keeps between clicks. Keys are digests and frozen settings, never arrays.

Streamlit hashes large arrays from a sample of their cells; a plot that differs in one plant would
be taken for the same. So values that cannot be keyed come in as ``_arguments``, which Streamlit
leaves out, beside a key that stands for them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import streamlit as st

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation import hotspots
from fieldmon.infestation.hotspots import HotSpots, NewestRecords, hot_spots
from fieldmon.infestation.prior import prior_chance
from fieldmon.infestation.spread import Spread
from fieldmon.infestation.traced_pairs import TracedPairs
from fieldmon.io import plot_records, prepare, read
from fieldmon.io.rasters.read import looks_like_heights as _looks_like_heights
from fieldmon.io.rasters.read import read_backdrop, read_relief
from fieldmon.monitoring import worked_route
from fieldmon.planning.plan import DayPlan, PlanSettings, plan_believed, plan_in
from fieldmon.plot.row_detection import rows_from_plants
from fieldmon.reports import season as reports
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import SeasonMetrics, season_metrics
from fieldmon.simulation.season import SeasonSettings, SimulatedDay, simulated_days
from fieldmon.simulation.start import season_start

from ..words import language, texts
from ..words.language import Late
from . import opened_seasons
from .comparison import Comparison
from .driving import DayInTime, DriveRun
from .live_drive import LiveDrive

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray
    from pydeck import Layer
    from shapely import MultiLineString

    from fieldmon.compute.units import Units
    from fieldmon.drive.simulated import MadeUp
    from fieldmon.drive.vda5050.wire import Broker, RobotName
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.infestation.learnt import Learnt
    from fieldmon.infestation.level_range import LevelRange
    from fieldmon.infestation.observations import Observations
    from fieldmon.infestation.prior_settings import PriorSettings
    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import PlotOptions, ReadOptions, Source
    from fieldmon.io.rasters.values import Backdrop, RasterOptions
    from fieldmon.io.readers.places import Plants
    from fieldmon.io.readers.points_and_lines import DrawnBlocks
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.io.sources import (
        CanopySource,
        PlantingChoices,
        PlotSources,
        RecordSource,
        RiskSource,
    )
    from fieldmon.monitoring import DayFigures, KeptMessage, Progress, Season
    from fieldmon.monitoring.advice import Advice, AdviceSettings
    from fieldmon.pests.weather import Weather
    from fieldmon.planning.route import Route
    from fieldmon.planning.wishes import Wishes
    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.row_detection import RowDirection
    from fieldmon.reports.content import Report
    from fieldmon.samplers.base import Sampler, Scene
    from fieldmon.simulation.worker import LaidPlot

    from .comparison import ComparisonSettings

    Array = NDArray[np.float64]

Tried = TypeVar("Tried")

#: shown while something is made, in the language of whoever waits
_WORKING = Late(lambda: texts.WORKING)
_FEW = 24
# maps of many plants are megabytes each, a day's figures a few numbers
_MAPS, _DAYS, _FILMS = 60, 200, 6


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def plots(key: str, options: PlotOptions, _source: Source) -> Imported[tuple[Field, ...]]:
    """Return the plots of a file."""
    return read.read_plots(_source, options)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def records(
    key: str,
    _source: RecordSource,
    _plot: Plot,
    _fields: tuple[Field, ...],
    _measured: Plants | None,
) -> Imported[Observations]:
    """Return the records on and near a plot; `key` stands for the file and the plot.

    They may name one of `_fields`, or rows and plants, the measured ones by their own labels.
    """
    return plot_records.records_on(_plot, _source, lambda: _fields, _measured)


@st.cache_resource(max_entries=_MAPS, show_spinner=_WORKING)
def tried(key: str, _make: Callable[[], Tried]) -> Tried:
    """Return what an answer to an import's question leads to, be it nowhere.

    `key` stands for the file, what was answered before, and the answer.
    """
    return _make()


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def weather(key: str, options: WeatherOptions, _source: Source) -> Imported[Weather]:
    """Return the weather of a file."""
    return read.read_weather(_source, options)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def measured_plants(
    key: str,
    options: ReadOptions,
    _source: Source,
) -> Imported[Plants]:
    """Return measured plants: positions, and labels if the file has any."""
    return read.read_plants(_source, options)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def drawn_rows(
    key: str,
    options: ReadOptions,
    _source: Source,
) -> Imported[MultiLineString]:
    """Return rows that were drawn, or those of end posts."""
    return read.read_rows(_source, options)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def drawn_blocks(
    key: str,
    options: PlotOptions,
    _source: Source,
) -> Imported[DrawnBlocks]:
    """Return blocks as areas, or the lines that part a plot."""
    return read.read_blocks(_source, options)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def paths(source: Path) -> MultiLineString:
    """Return the lines of one of the program's own files."""
    return read.read_lines(source).value


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def plot(key: str, choices: PlantingChoices, _field: Field) -> Plot:
    """Return a field with its plants and aisles."""
    return prepare.lay(_field, choices).plot


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def plot_around(
    key: str,
    choices: PlantingChoices,
    _sources: PlotSources,
    _measured: Plants,
) -> Plot:
    """Return the plot of measured plants that have no drawn boundary."""
    return prepare.lay_around(_sources, _measured, choices).plot


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def day_plan(
    key: str,
    day: str,
    settings: PlanSettings,
    sampler_name: str,
    _plot: Plot,
    _known: tuple[Observations, Array | None],
    wishes: Wishes,
) -> DayPlan:
    """Return the planned day; `key` stands for plot, records and risk, the last two `_known`."""
    known = first_belief(key, day, settings.prior, _plot, _known)
    return plan_believed(_plot, known, settings, wishes)


@st.cache_resource(max_entries=_FEW)
def first_belief(
    key: str,
    day: str,
    prior: PriorSettings,
    _plot: Plot,
    _known: tuple[Observations, Array | None],
) -> tuple[Array, TracedPairs]:
    """Return the chance map of a day and what a season believes that begins with it."""
    chance = chance_map(key, day, prior, _plot, _known)
    return chance, TracedPairs.of(_plot.grid, chance)


@st.cache_resource(max_entries=_FEW)
def chance_map(
    key: str,
    day: str,
    prior: PriorSettings,
    _plot: Plot,
    _known: tuple[Observations, Array | None],
) -> Array:
    """Return the chance map of a day, whoever is to work on it; `key` as above."""
    records, at_risk = _known
    on = np.datetime64(day, "D")
    return prior_chance(_plot.grid, _plot.field, records, on, prior, at_risk)


@st.cache_resource(max_entries=_FEW)
def newest_records(key: str, _plot: Plot, _records: Observations) -> NewestRecords:
    """Return what records say of plants; `key` stands for the plot, its records and the day."""
    return hotspots.newest_records(_plot.grid, _records)


@st.cache_resource(max_entries=_FEW)
def recorded_hot_spots(key: str, _plot: Plot, _records: Observations) -> HotSpots:
    """Return where records cluster; `key` as above."""
    return hot_spots(_plot.grid, newest_records(key, _plot, _records).state)


# -- seasons that are kept


def season(path: Path) -> Season:
    """Open a season; all sessions share it, and each call of it reads what is new in the file."""
    if opened_seasons.is_open(path):
        return opened_seasons.opened(path)
    with st.spinner(texts.WORKING):
        return opened_seasons.opened(path)


@st.cache_resource(max_entries=_FEW)
def import_messages(path: str, _season: Season) -> tuple[KeptMessage, ...]:
    """Return what the imports had to say when a season began."""
    return _season.messages()


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def season_plan(
    path: str,
    revision: str,
    of: tuple[str, str | None],
    _season: Season,
    wishes: Wishes,
) -> DayPlan:
    """Return what is left of a season's day for one of its team, or for the one who works."""
    day, who = of
    return _season.plan(np.datetime64(day).item(), keep=False, wishes=wishes, who=who)


@st.cache_resource(max_entries=_FEW)
def season_scene(path: str, revision: str, day: str, _season: Season) -> Scene:
    """Return what is known and believed on a season's day before it is planned."""
    return _season.plan(np.datetime64(day).item(), keep=False).scene


@st.cache_resource(max_entries=_DAYS)
def turn_plan(key: str, robot: Robot, sampler_name: str, _scene: Scene) -> DayPlan:
    """Return the day of one who has only some hours for a plot; `key` stands for the scene."""
    scene = replace(_scene, robot=robot, seconds_left=robot.day_s)
    return plan_in(scene, sampler(sampler_name))


@st.cache_resource(max_entries=_FEW)
def kept_route(
    path: str,
    revision: str,
    of: tuple[str, str | None],
    _season: Season,
) -> Array:
    """Return the plants of the route that was given out for a day; empty if none was."""
    day, who = of
    return _season.kept_route(np.datetime64(day).item(), who or "")


@st.cache_resource(max_entries=_FEW)
def worked(
    path: str,
    revision: str,
    of: tuple[str, str | None],
    _season: Season,
) -> Route:
    """Return a day's route as it was worked; empty if nothing was recorded."""
    day, who = of
    return worked_route(_season, np.datetime64(day).item(), who)


@st.cache_resource(max_entries=_FEW)
def kept_days(path: str, revision: str, _season: Season) -> tuple[DayFigures, ...]:
    """Return the figures of a season's days on which something happened, in order."""
    return _season.days()


@st.cache_resource(max_entries=_DAYS)
def day_figures(path: str, revision: str, day: str, _season: Season) -> DayFigures:
    """Return a day of a season in figures."""
    return _season.day_figures(np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def progress(path: str, revision: str, day: str, _season: Season) -> Progress:
    """Return how far the inspections are after a day of a season."""
    return _season.progress(np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def learnt(path: str, revision: str, day: str, _season: Season) -> tuple[Learnt, ...]:
    """Return what the inspections up to a day of a season tell of the insects."""
    return _season.learnt(np.datetime64(day).item())


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def advice(
    path: str,
    revision: str,
    day: str,
    settings: AdviceSettings,
    _season: Season,
) -> Advice:
    """Return what a season advises on a day, by these settings."""
    return _season.advice(np.datetime64(day).item(), settings)


@st.cache_resource(max_entries=_MAPS)
def forecast(path: str, revision: str, day: str, _season: Season) -> Forecast:
    """Return how many plants are infested on the mornings after a day of a season."""
    return _season.forecast(np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def season_hot_spots(path: str, revision: str, day: str, _season: Season) -> HotSpots:
    """Return where finds cluster on a day of a season."""
    number = _season.settings.day(np.datetime64(day).item())
    return hot_spots(_season.plot.grid, _season.history.known(number))


@st.cache_resource(max_entries=_MAPS)
def evening(path: str, revision: str, day: str, _season: Season) -> Array:
    """Return the chance map of a day after what was recorded of it."""
    return _season.evening(np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def level_range(path: str, revision: str, day: str, _season: Season) -> LevelRange:
    """Return how far that chance map may be off as a whole."""
    return _season.level_range(np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def morning(path: str, revision: str, day: str, _season: Season) -> Array:
    """Return the chance map of a morning."""
    return _season.morning(np.datetime64(day).item())


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def season_report(
    path: str,
    revision: str,
    day: str,
    units: Units,
    _season: Season,
) -> Report:
    """Return the report of a season up to a day."""
    return reports.season_report(_season, np.datetime64(day).item(), units)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def backdrop(key: str, options: RasterOptions, _source: Source, _near: Field) -> Imported[Backdrop]:
    """Return a picture of the ground about a plot."""
    return read_backdrop(_source, options, _near)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def relief(key: str, options: RasterOptions, _source: Source, _near: Field) -> Imported[Backdrop]:
    """Return the relief about a plot, of a raster of heights."""
    return read_relief(_source, options, _near)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def looks_like_heights(key: str, options: RasterOptions, _source: Source) -> bool:
    """Return whether a raster is more likely heights than a picture."""
    return _looks_like_heights(_source, options)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def risk(
    key: str,
    _source: RiskSource,
    _plot: Plot,
) -> Imported[Array]:
    """Return the risk of a plot's plants from a raster; `key` stands for raster and plot."""
    return prepare.risk_on(_plot, _source)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def without_missing(
    key: str,
    _source: CanopySource,
    _plot: Plot,
) -> Imported[Plot]:
    """Return a plot without the plants that a raster shows to be missing; `key` as above."""
    return prepare.without_missing(_plot, _source)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def directions(key: str, _plants: Array) -> tuple[RowDirection, ...]:
    """Return the directions in which measured plants stand in rows, whatever was said of them."""
    return rows_from_plants(_plants).directions


def layers(key: str, make: Callable[[], list[Layer]]) -> list[Layer]:
    """Return map layers, made once a language; `key` stands for all that they show."""
    return _layers(f"{language.current()} {key}", make)


@st.cache_resource(max_entries=_MAPS)
def _layers(key: str, _make: Callable[[], list[Layer]]) -> list[Layer]:
    return _make()


@st.cache_resource(max_entries=_FILMS)
def frames(key: str, _make: Callable[[], list[list[Layer]]]) -> list[list[Layer]]:
    """Return the layers of each day of a season, kept together: they are more than maps are kept.

    `key` stands for all that they show, their language too.
    """
    return _make()


# -- simulated seasons


@st.cache_resource(max_entries=8)
def comparison(
    key: str,
    settings: ComparisonSettings,
    robot: Robot,
    _laid: LaidPlot,
) -> Comparison:
    """Return the comparison of these settings on this plot; it is at work or will be.

    `key` stands for the plot, its chances and its pest.
    """
    return Comparison(settings, _laid, robot)


@st.cache_resource(max_entries=8)
def drive_run(
    key: str,
    kind: str,
    made_up: MadeUp,
    _plot: Plot,
    _scene: Scene,
    _sampler: Sampler,
) -> DriveRun:
    """Return a day driven by a simulated robot, done or to be; `key` stands for the scene."""
    return DriveRun(kind, _plot, _scene, _sampler, made_up)


@st.cache_resource(max_entries=8)
def live_drive(key: str, broker: Broker, robot: RobotName, _scene: Scene) -> LiveDrive:
    """Return a robot's day as it is driven; `key` stands for the plot and the day."""
    return LiveDrive(broker, robot, _scene)


@st.cache_resource(max_entries=8, show_spinner=_WORKING)
def recorded_drive(key: str, _data: bytes, _plot: Plot, _scene: Scene) -> DayInTime:
    """Return a day that was driven; `key` stands for the scene and the file."""
    return DayInTime.of_file(_data, _plot, _scene)


@st.cache_resource(max_entries=_FEW, show_spinner=_WORKING)
def simulated_season(
    key: str,
    sampler_name: str,
    numbers: tuple[int, float, float, int],
    robot: Robot,
    _laid: LaidPlot,
) -> tuple[list[SimulatedDay], SeasonMetrics]:
    """Return a simulated season and its figures; `key` stands for plot, records, day and pest.

    `numbers` are days, share infested at the start, spread a night, and seed.
    """
    n_days, share, rate, seed = numbers
    streams = RandomStreams(seed)
    plot, chance, pest_in_weather = _laid
    robot = robot if pest_in_weather is None else pest_in_weather.pest.seen_by(robot)
    start = season_start(plot.grid, chance, share, streams)
    settings = SeasonSettings(n_days=n_days, spread=Spread(rate), pest=pest_in_weather)
    decides = sampler(sampler_name)
    walk = list(simulated_days(plot.aisles, robot, decides, start, settings, streams))
    return walk, season_metrics(walk)
