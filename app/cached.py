"""Everything the app keeps between clicks. Keys are digests and frozen settings, never arrays.

Streamlit hashes large arrays from a sample of their cells; a plot that differs in one plant would
be taken for the same. So values that cannot be keyed come in as ``_arguments``, which Streamlit
leaves out, beside a key that stands for them.
"""

from __future__ import annotations

from hashlib import sha256
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.hotspots import HotSpots, hot_spots, record_states
from fieldmon.infestation.prior import PriorSettings, prior_chance, start_infested
from fieldmon.infestation.spread import Spread
from fieldmon.io import read
from fieldmon.io.import_report import ImportMessage, Severity
from fieldmon.io.rasters.at_plants import read_missing, read_risk
from fieldmon.io.rasters.read import read_backdrop
from fieldmon.monitoring import Season
from fieldmon.monitoring.transactions import get_meta
from fieldmon.planning.plan import DayPlan, PlanSettings, plan_from
from fieldmon.plot.plot import Plot
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import SeasonFigures, figures
from fieldmon.simulation.season import Day, SeasonSettings, Start, days

from . import figures as day_figures
from . import maps, texts
from .comparing import Asked, Comparison

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import date
    from pathlib import Path

    from numpy.typing import NDArray
    from shapely import MultiLineString

    from fieldmon.infestation.observations import Observations
    from fieldmon.infestation.raster_risk import RiskSettings
    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions, Source
    from fieldmon.io.rasters.values import Backdrop, RasterOptions
    from fieldmon.monitoring import KeptMessage
    from fieldmon.planning.route import Route
    from fieldmon.plot.field import Field
    from fieldmon.plot.layout import Planting
    from fieldmon.plot.robot import Robot

    from .figures import DayFigures, Known

    Array = NDArray[np.float64]

_FEW = 24
# maps of many plants are megabytes each
_MAPS = 60


def digest(data: bytes) -> str:
    """Return what stands for a file's bytes in keys."""
    return sha256(data).hexdigest()


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def plots(key: str, options: PlotOptions, _source: Source) -> Imported[tuple[Field, ...]]:  # noqa: ARG001
    """Return the plots of a file."""
    return read.read_plots(_source, options)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def records(
    key: str,  # noqa: ARG001
    options: RecordOptions,
    _source: Source,
    _near: Field,
) -> Imported[Observations]:
    """Return the records on and near a plot; `key` stands for the file and the plot."""
    return read.read_records(_source, options, near=_near)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def measured_plants(key: str, options: ReadOptions, _source: Source) -> np.ndarray:  # noqa: ARG001
    """Return positions of measured plants, ``(n, 2)`` degrees."""
    lonlat: np.ndarray = read.read_plants(_source, options).value.lonlat
    return lonlat


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def paths(source: Path) -> MultiLineString:
    """Return the lines of one of the program's own files."""
    return read.read_lines(source).value


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def plot(key: str, planting: Planting, _field: Field) -> Plot:  # noqa: ARG001
    """Return a field's plants and aisles."""
    return Plot.of(_field, planting)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def plot_around(key: str, planting: Planting | None, _plants: np.ndarray) -> Plot:  # noqa: ARG001
    """Return the plot of measured plants that have no drawn boundary."""
    return Plot.around("plants", _plants, planting)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def today(
    key: str,
    day: str,
    robot: Robot,
    sampler_name: str,
    _plot: Plot,
    _known: tuple[Observations, Array | None],
) -> DayPlan:
    """Return the planned day; `key` stands for plot, records and risk, the last two `_known`."""
    chance = believed(key, day, _plot, _known)
    return plan_from(_plot, chance, PlanSettings(robot, sampler(sampler_name)))


@st.cache_resource(max_entries=_FEW)
def believed(
    key: str,  # noqa: ARG001
    day: str,
    _plot: Plot,
    _known: tuple[Observations, Array | None],
) -> Array:
    """Return the chance map of a day, whoever is to work on it; `key` as above."""
    records, at_risk = _known
    on = np.datetime64(day, "D")
    return prior_chance(_plot.grid, _plot.field, records, on, PriorSettings(), at_risk)


@st.cache_resource(max_entries=_FEW)
def recorded_states(key: str, _plot: Plot, _records: Observations) -> NDArray[np.int8]:  # noqa: ARG001
    """Return what records say of plants; `key` stands for the plot, its records and the day."""
    return record_states(_plot.grid, _records)


@st.cache_resource(max_entries=_FEW)
def recorded_hot_spots(key: str, _plot: Plot, _records: Observations) -> HotSpots:
    """Return where records cluster; `key` as above."""
    return hot_spots(_plot.grid, recorded_states(key, _plot, _records))


# -- seasons that are kept


def project(path: Path) -> Season:
    """Open a season; all sessions share it, and each call of it reads what is new in the file."""
    inode = path.stat().st_ino if path.is_file() else 0
    return _project(path, inode)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def _project(path: Path, inode: int) -> Season:  # noqa: ARG001 - another file of the same name
    return Season(path)


def revision(season: Season) -> str:
    """Return what changes with every change of a season, whoever made it."""
    with season.store.reading() as db:
        kept = get_meta(db, "revision")
        counted = db.execute(
            "SELECT count(*), max(fid), total(undone) FROM inspections WHERE plant IS NOT NULL"
        ).fetchone()
    return f"{kept} {counted}"


@st.cache_resource(max_entries=_FEW)
def remarks(path: str, _season: Season) -> tuple[KeptMessage, ...]:  # noqa: ARG001
    """Return what the imports had to say when a season began."""
    return _season.messages()


def finding_of(remark: KeptMessage) -> ImportMessage:
    """Return a kept remark as a finding, its remedy gone: the plants are laid."""
    return ImportMessage(Severity(remark.severity), remark.sentence, remark.feature)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def season_today(path: str, revision: str, day: str, _season: Season) -> DayPlan:  # noqa: ARG001
    """Return what is left of a season's day."""
    return _season.plan(np.datetime64(day).item(), keep=False)


@st.cache_resource(max_entries=_FEW)
def season_route(path: str, revision: str, day: str, _season: Season) -> Array:  # noqa: ARG001
    """Return the plants of the route that was given out for a day; empty if none was."""
    return _season.kept_route(np.datetime64(day).item())


@st.cache_resource(max_entries=_FEW)
def season_done(path: str, revision: str, day: str, _season: Season) -> Route:  # noqa: ARG001
    """Return a day's way as it was worked; empty if nothing was recorded."""
    return day_figures.done(_season, np.datetime64(day).item())


@st.cache_resource(max_entries=_FEW)
def kept_figures(path: str, revision: str, _season: Season) -> dict[str, DayFigures]:  # noqa: ARG001
    """Return the figures of a season's days on which something happened."""
    return day_figures.kept(_season)


def day_in_figures(path: str, revision: str, day: str, season: Season) -> DayFigures:
    """Return a day of a season in figures."""
    kept = kept_figures(path, revision, season)
    return kept[day] if day in kept else _worked_out(path, revision, day, season)


@st.cache_resource(max_entries=200)
def _worked_out(path: str, revision: str, day: str, _season: Season) -> DayFigures:  # noqa: ARG001
    return day_figures.of(_season, np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def known(path: str, revision: str, day: str, _season: Season) -> Known:  # noqa: ARG001
    """Return what is known up to a day of a season."""
    return day_figures.known(_season, np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def season_hot_spots(path: str, revision: str, day: str, _season: Season) -> HotSpots:  # noqa: ARG001
    """Return where finds cluster on a day of a season."""
    number = _season.settings.day(np.datetime64(day).item())
    return hot_spots(_season.plot.grid, _season.history.states(number))


@st.cache_resource(max_entries=_MAPS)
def evening(path: str, revision: str, day: str, _season: Season) -> Array:  # noqa: ARG001
    """Return the chance map of a day after what was recorded of it."""
    return _season.evening(np.datetime64(day).item())


@st.cache_resource(max_entries=_MAPS)
def morning(path: str, revision: str, day: str, _season: Season) -> Array:  # noqa: ARG001
    """Return the chance map of a morning."""
    return _season.morning(np.datetime64(day).item())


def days_of(season: Season, until: date) -> list[str]:
    """Return the days of a season from the first up to one, ISO."""
    first = np.datetime64(season.settings.begins, "D")
    return [str(day) for day in np.arange(first, np.datetime64(until, "D") + 1)]


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def backdrop(key: str, options: RasterOptions, _source: Source, _near: Field) -> Backdrop:  # noqa: ARG001
    """Return a picture of the ground about a plot."""
    return read_backdrop(_source, options, _near).value


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def risk(
    key: str,  # noqa: ARG001
    options: RasterOptions,
    settings: RiskSettings,
    _source: Source,
    _plot: Plot,
) -> Imported[Array]:
    """Return the risk of a plot's plants from a raster; `key` stands for raster and plot."""
    return read_risk(_source, options, _plot, settings)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def without_missing(
    key: str,  # noqa: ARG001
    options: RasterOptions,
    below: float,
    _source: Source,
    _plot: Plot,
) -> Imported[Plot]:
    """Return a plot without the plants that a raster shows to be missing; `key` as above."""
    read = read_missing(_source, options, _plot, below)
    return read.having(_plot.without(read.value))


@st.cache_resource(max_entries=_MAPS)
def layers(key: str, _make: Callable[[], list[maps.Layer]]) -> list[maps.Layer]:  # noqa: ARG001
    """Return map layers, made once; `key` stands for all that they show."""
    return _make()


# -- simulated seasons


@st.cache_resource(max_entries=8)
def comparison(
    key: str,  # noqa: ARG001
    asked: Asked,
    robot: Robot,
    _plot: Plot,
    _chance: Array,
) -> Comparison:
    """Return the comparison of these settings on this plot; it is at work or will be."""
    return Comparison(asked, _plot, _chance, robot)


@st.cache_resource(max_entries=_FEW, show_spinner=texts.WORKING)
def season(
    key: str,  # noqa: ARG001
    sampler_name: str,
    numbers: tuple[int, float, float, int],
    robot: Robot,
    _plot: Plot,
    _chance: np.ndarray,
) -> tuple[list[Day], SeasonFigures]:
    """Return a simulated season and its figures; `key` stands for plot, records and day.

    `numbers` are days, share infested at the start, spread a night, and seed.
    """
    n_days, share, rate, seed = numbers
    drawn = start_infested(_chance, share, RandomStreams(seed).of("start"))
    begin = Start(drawn[_plot.grid.vine], _chance)
    settings = SeasonSettings(n_days=n_days, spread=Spread(rate))
    chance = RandomStreams(seed)
    walk = list(days(_plot.aisles, robot, sampler(sampler_name), begin, settings, chance))
    return walk, figures(walk)
