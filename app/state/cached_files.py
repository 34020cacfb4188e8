"""What files come to, kept between clicks as `cached` keeps what a day and a season come to."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import streamlit as st

from fieldmon.io import plot_records, prepare, read
from fieldmon.io.rasters.read import looks_like_heights as _looks_like_heights
from fieldmon.io.rasters.read import read_backdrop, read_relief
from fieldmon.io.readers import nearby
from fieldmon.monitoring.season.copies_to_merge import merge_ahead
from fieldmon.plot.row_detection import rows_from_plants

from .cached import FEW, WORKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray
    from shapely import MultiLineString

    from fieldmon.infestation.records import Records
    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import PlotOptions, ReadOptions, Source, Upload
    from fieldmon.io.plot_request import (
        CanopySource,
        PlantingChoices,
        PlotSources,
        RecordSource,
        RiskSource,
    )
    from fieldmon.io.rasters.values import Backdrop, RasterOptions
    from fieldmon.io.readers.places import Plants
    from fieldmon.io.readers.points_and_lines import DrawnBlocks
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.season.copies_to_merge import MergedFile
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.row_detection import RowDirection

    Array = NDArray[np.float64]

Tried = TypeVar("Tried")

# what is tried may lead to many maps
_MANY = 60


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def plots(key: str, options: PlotOptions, _source: Source) -> Imported[tuple[Field, ...]]:
    """Return the plots of a file."""
    return read.read_plots(_source, options)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def records(
    key: str,
    _source: RecordSource,
    _plot: Plot,
    _fields: tuple[Field, ...],
    _measured: Plants | None,
) -> Imported[Records]:
    """Return the records on and near a plot; `key` stands for the file and the plot.

    They may name one of `_fields`, or rows and plants, the measured ones by their own labels.
    """
    return plot_records.records_on(_plot, _source, lambda: _fields, _measured)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def merging(key: str, _season: Season, _copy: Upload) -> MergedFile:
    """Return what merging a copy of a season would bring; `key` stands for both as they are."""
    return merge_ahead(_season, _copy)


@st.cache_resource(max_entries=_MANY, show_spinner=WORKING)
def tried(key: str, _make: Callable[[], Tried]) -> Tried:
    """Return what an answer to an import's question leads to, be it nowhere.

    `key` stands for the file, what was answered before, and the answer.
    """
    return _make()


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def weather(key: str, options: WeatherOptions, _source: Source) -> Imported[Weather]:
    """Return the weather of a file."""
    return read.read_weather(_source, options)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def measured_plants(
    key: str,
    options: ReadOptions,
    _source: Source,
) -> Imported[Plants]:
    """Return measured plants: positions, and labels if the file has any."""
    return read.read_plants(_source, options)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def plants_on(key: str, far: str | None, _measured: Plants, _field: Field) -> Imported[Plants]:
    """Return which measured plants are those of a plot."""
    return nearby.plants_on(_measured, _field, far)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def drawn_rows(
    key: str,
    options: ReadOptions,
    _source: Source,
) -> Imported[MultiLineString]:
    """Return rows that were drawn, or those of end posts."""
    return read.read_rows(_source, options)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def drawn_blocks(
    key: str,
    options: PlotOptions,
    _source: Source,
) -> Imported[DrawnBlocks]:
    """Return blocks as areas, or the lines that part a plot."""
    return read.read_blocks(_source, options)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def paths(source: Path) -> MultiLineString:
    """Return the lines of one of the program's own files."""
    return read.read_lines(source).value


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def plot(key: str, choices: PlantingChoices, _field: Field) -> Plot:
    """Return a field with its plants and aisles."""
    return prepare.lay(_field, choices).plot


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def plot_around(
    key: str,
    choices: PlantingChoices,
    _sources: PlotSources,
    _measured: Plants,
) -> Plot:
    """Return the plot of measured plants that have no drawn boundary."""
    return prepare.lay_around(_sources, _measured, choices).plot


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def backdrop(key: str, options: RasterOptions, _source: Source, _near: Field) -> Imported[Backdrop]:
    """Return a picture of the ground about a plot."""
    return read_backdrop(_source, options, _near)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def relief(key: str, options: RasterOptions, _source: Source, _near: Field) -> Imported[Backdrop]:
    """Return the relief about a plot, of a raster of heights."""
    return read_relief(_source, options, _near)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def looks_like_heights(key: str, options: RasterOptions, _source: Source) -> bool:
    """Return whether a raster is more likely heights than a picture."""
    return _looks_like_heights(_source, options)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def risk(
    key: str,
    _source: RiskSource,
    _plot: Plot,
) -> Imported[Array]:
    """Return the risk of a plot's plants from a raster; `key` stands for raster and plot."""
    return prepare.risk_on(_plot, _source)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def without_missing(
    key: str,
    _source: CanopySource,
    _plot: Plot,
) -> Imported[Plot]:
    """Return a plot without the plants that a raster shows to be missing; `key` as above."""
    return prepare.without_missing(_plot, _source)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def directions(key: str, _plants: Array) -> tuple[RowDirection, ...]:
    """Return the directions in which measured plants stand in rows, whatever was said of them."""
    return rows_from_plants(_plants).directions
