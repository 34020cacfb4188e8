"""What the reading process does: one function for each of `io.read`.

What lays out rows takes longest to load: who reads a table of results does not wait for it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.io.formats.open_layer import layers_of, open_layer
from fieldmon.io.readers.inspection_file.rows import rows_of
from fieldmon.io.readers.records import records_by_plot, records_of
from fieldmon.io.readers.weather import weather_in
from fieldmon.io.sandbox.workroom import Workroom

if TYPE_CHECKING:
    from shapely import MultiLineString, MultiPolygon

    from fieldmon.infestation.records import Records
    from fieldmon.io.formats.layer import LayerInfo
    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions, Source
    from fieldmon.io.readers.crews import Crew
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.io.readers.phone_file import PhoneFile
    from fieldmon.io.readers.places import NamedPlaces, Plants
    from fieldmon.io.readers.points_and_lines import DrawnBlocks
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.field import Field


def layers(folder: str, source: Source) -> tuple[LayerInfo, ...]:
    """Return the layers of a source."""
    return layers_of(source, Workroom(Path(folder)))


def plots(folder: str, source: Source, options: PlotOptions) -> Imported[tuple[Field, ...]]:
    """Return the plots of a source."""
    from fieldmon.io.readers.plots import plots_of  # noqa: PLC0415

    return plots_of(open_layer(source, options, Workroom(Path(folder))), options)


def crews(
    folder: str, source: Source, options: PlotOptions
) -> Imported[tuple[tuple[Field, ...], dict[str, Crew]]]:
    """Return the plots of a source, and who works on each."""
    from fieldmon.io.readers.crews import crews_of  # noqa: PLC0415
    from fieldmon.io.readers.plots import named_areas, plots_of  # noqa: PLC0415

    layer = open_layer(source, options, Workroom(Path(folder)))
    who = crews_of(*named_areas(layer, options))
    plots = plots_of(layer, options)
    return plots.having((plots.value, who.value), who.messages)


def treated(folder: str, source: Source, options: PlotOptions) -> Imported[MultiPolygon]:
    """Return the area that a source says was treated."""
    from fieldmon.io.readers.treated_areas import treated_of  # noqa: PLC0415

    return treated_of(open_layer(source, options, Workroom(Path(folder))), options)


def records(
    folder: str,
    source: Source,
    options: RecordOptions,
    places: NamedPlaces | None,
    apart_m: float | None = None,
) -> Imported[Records]:
    """Return the records of a source."""
    layer = open_layer(source, options, Workroom(Path(folder)))
    return records_of(layer, options, places, apart_m)


def plot_records(
    folder: str, source: Source, options: RecordOptions, places: NamedPlaces
) -> Imported[dict[str, Records]]:
    """Return the records of a source that name their plots, by plot."""
    layer = open_layer(source, options, Workroom(Path(folder)))
    return records_by_plot(layer, options, places)


def plants(folder: str, source: Source, options: ReadOptions) -> Imported[Plants]:
    """Return the plants of a source."""
    from fieldmon.io.readers.points_and_lines import plants_of  # noqa: PLC0415

    return plants_of(open_layer(source, options, Workroom(Path(folder))), options)


def lines(folder: str, source: Source, options: ReadOptions) -> Imported[MultiLineString]:
    """Return the lines of a source."""
    from fieldmon.io.readers.points_and_lines import lines_of  # noqa: PLC0415

    return lines_of(open_layer(source, options, Workroom(Path(folder))), options)


def drawn_rows(folder: str, source: Source, options: ReadOptions) -> Imported[MultiLineString]:
    """Return the rows of a source that holds lines, or end posts."""
    from fieldmon.io.readers.points_and_lines import drawn_rows_of  # noqa: PLC0415

    return drawn_rows_of(open_layer(source, options, Workroom(Path(folder))), options)


def drawn_blocks(folder: str, source: Source, options: PlotOptions) -> Imported[DrawnBlocks]:
    """Return the blocks of a source that holds areas, or lines that part a plot."""
    from fieldmon.io.readers.points_and_lines import drawn_blocks_of  # noqa: PLC0415

    return drawn_blocks_of(open_layer(source, options, Workroom(Path(folder))), options)


def inspection_rows(
    folder: str, source: Source, options: InspectionOptions
) -> Imported[InspectionRows]:
    """Return what a file says of plants that were inspected."""
    return rows_of(source, options, Workroom(Path(folder)))


def phone_file(folder: str, source: Source) -> Imported[PhoneFile]:
    """Return what a phone saved."""
    from fieldmon.io.readers.phone_file import phone_file_of  # noqa: PLC0415

    return phone_file_of(source, Workroom(Path(folder)))


def weather(folder: str, source: Source, options: WeatherOptions) -> Imported[Weather]:
    """Return the weather of a source."""
    return weather_in(source, options, Workroom(Path(folder)))
