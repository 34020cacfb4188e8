"""Everything that is read from a file is read by one of these.

A source is a path, an `Upload`, or several of them that belong together. What a file leaves open
is asked by `ChoiceNeeded`; what is unusable is a `FileProblem`; all else that there is to say
stands in the messages. The file itself is opened in a process of its own (`sandbox.process`).
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldmon.compute.wording import worded
from fieldmon.compute.working_folder import working_folder
from fieldmon.errors import ChoiceNeeded, ObservationError, PlotError
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions, Source
from fieldmon.io.readers.nearby import of_plot
from fieldmon.io.sandbox import process

if TYPE_CHECKING:
    from shapely import MultiLineString, MultiPolygon

    from fieldmon.infestation.records import Records
    from fieldmon.io.formats.layer import LayerInfo
    from fieldmon.io.import_report import Imported
    from fieldmon.io.readers.crews import Crew
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.io.readers.phone_file import PhoneFile
    from fieldmon.io.readers.places import NamedPlaces, Plants
    from fieldmon.io.readers.points_and_lines import DrawnBlocks
    from fieldmon.io.readers.weather_options import WeatherOptions
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.field import Field


def _read(task: str, source: Source, *arguments: Any) -> Any:  # noqa: ANN401 - each caller says
    # the reading process may have been started in another folder than the one we are in by now
    if isinstance(source, str | Path):
        source = Path(source).absolute()
    # the folder is made and removed here: a reading process that was stopped cannot tidy up
    with working_folder() as folder:
        return process.call(f"fieldmon.io.sandbox.tasks:{task}", folder, source, *arguments)


def list_layers(source: Source) -> tuple[LayerInfo, ...]:
    """Return the layers of a source: what can be chosen as `member` and `layer`."""
    layers: tuple[LayerInfo, ...] = _read("layers", source)
    return layers


def read_plots(source: Source, options: PlotOptions | None = None) -> Imported[tuple[Field, ...]]:
    """Return the plots of a source in degrees WGS84, all of them unless one is chosen."""
    plots: Imported[tuple[Field, ...]] = _read("plots", source, options or PlotOptions())
    return plots


def read_crews(
    source: Source, options: PlotOptions | None = None
) -> Imported[tuple[tuple[Field, ...], dict[str, Crew]]]:
    """Return the plots of a source as `read_plots`, and by name who works on each."""
    read: Imported[tuple[tuple[Field, ...], dict[str, Crew]]] = _read(
        "crews", source, options or PlotOptions()
    )
    return read


def read_treated(source: Source) -> Imported[MultiPolygon]:
    """Return the area that a file says was treated, as the zones of a decision, degrees WGS84."""
    area: Imported[MultiPolygon] = _read("treated", source, PlotOptions())
    return area


def read_records(
    source: Source,
    options: RecordOptions | None = None,
    near: Field | None = None,
    places: NamedPlaces | None = None,
    apart_m: float | None = None,
) -> Imported[Records]:
    """Return the pest records of a source.

    Parameters
    ----------
    source
        Path or upload.
    options
        What was chosen about how to read it.
    near
        Only records on this plot or close by; the others are counted in the messages.
    places
        Plots or plants that records may name instead of giving a position.
    apart_m
        From plant to plant: positions that are off by half of it tell no plants apart. None: as
        usual.
    """
    options = options or RecordOptions()
    records: Imported[Records]
    try:
        records = _read("records", source, options, places, apart_m)
    except ChoiceNeeded as question:
        if question.option != "crs" or near is None or options.near is not None:
            raise
        # the plot tells which coordinate systems are likely: ask again with those
        records = _read("records", source, replace(options, near=_middle(near)), places, apart_m)
    if near is None:
        return records
    try:
        kept, more = of_plot(records.value, near)
    except ObservationError:
        if options.near is None:
            # where they lie on another part of the earth, their coordinate system is asked for
            _read("records", source, replace(options, near=_middle(near)), places, apart_m)
        raise
    return records.having(kept, more)


def _middle(field: Field) -> tuple[float, float]:
    west, south, east, north = field.boundary.bounds
    return (west + east) / 2, (south + north) / 2


def read_records_by_plot(
    source: Source, options: RecordOptions, places: NamedPlaces
) -> Imported[dict[str, Records]]:
    """Return the records of a source that name a plot, a row and a plant, by the plots' names."""
    records: Imported[dict[str, Records]] = _read("plot_records", source, options, places)
    return records


def read_plants(source: Source, options: ReadOptions | None = None) -> Imported[Plants]:
    """Return measured positions of plants, with their labels if the file has any."""
    plants: Imported[Plants] = _read("plants", source, options or ReadOptions())
    return plants


def read_lines(
    source: Source, options: ReadOptions | None = None, near: Field | None = None
) -> Imported[MultiLineString]:
    """Return lines (rows, paths, roads) in degrees WGS84; ask where they lie far from a plot."""
    options = options or ReadOptions()
    if near is not None and options.near is None:
        options = replace(options, near=_middle(near))
    lines: Imported[MultiLineString] = _read("lines", source, options)
    return lines


def read_rows(source: Source, options: ReadOptions | None = None) -> Imported[MultiLineString]:
    """Return rows of plants in degrees WGS84, from lines or from end posts, two a row.

    Raise `PlotError` where a line is no row, but a track along several.
    """
    from fieldmon.plot.row_drawing import turns_back  # noqa: PLC0415 - only for rows

    rows: Imported[MultiLineString] = _read("drawn_rows", source, options or ReadOptions())
    for number, line in enumerate(rows.value.geoms, 1):
        if turns_back(line):
            raise PlotError(
                worded(
                    "A row must lead one way, but line {number} of {n} turns back beside itself, "
                    "as a track along several rows does. Cut it at its turns: a line, or a track "
                    "segment of a GPX, for each row.",
                    number=number,
                    n=len(rows.value.geoms),
                )
            )
    return rows


def read_blocks(source: Source, options: PlotOptions | None = None) -> Imported[DrawnBlocks]:
    """Return blocks of a plot in degrees WGS84, as areas or as the lines that part it."""
    blocks: Imported[DrawnBlocks] = _read("drawn_blocks", source, options or PlotOptions())
    return blocks


def read_inspection_rows(source: Source, options: InspectionOptions) -> Imported[InspectionRows]:
    """Return what a file says of plants that were inspected, before they are looked up."""
    rows: Imported[InspectionRows] = _read("inspection_rows", source, options)
    return rows


def read_phone_file(source: Source) -> Imported[PhoneFile]:
    """Return what a phone saved to a file because it could not send it."""
    saved: Imported[PhoneFile] = _read("phone_file", source)
    return saved


def read_weather(source: Source, options: WeatherOptions) -> Imported[Weather]:
    """Return the weather of a source, by the hour or by the day."""
    weather: Imported[Weather] = _read("weather", source, options)
    return weather
