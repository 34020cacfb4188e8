"""Reading in one call each, for the public library; what imports doubt comes as a warning.

The command line and the app read in the same way, by `fieldmon.io.prepare`, and show messages.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from fieldmon.compute.arguments import must_be
from fieldmon.compute.kinds import must_be_of
from fieldmon.compute.wording import worded
from fieldmon.errors import ImportDoubt, SettingError
from fieldmon.io.library_calls import answered, chosen, must_be_file, warn_of
from fieldmon.io.options import (
    PlotOptions,
    ReadOptions,
    RecordOptions,
    yes_or_no,
)
from fieldmon.io.plot_records import records_on
from fieldmon.io.plot_request import (
    PlantingChoices,
    PlotRequest,
    PlotSources,
    RecordSource,
    RiskSource,
)
from fieldmon.io.prepare import prepare, risk_on
from fieldmon.io.read import read_plots as read_fields
from fieldmon.io.read import read_weather as read_weather_file
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspections import read_inspections as read_on_grid
from fieldmon.io.readers.pest_file import pest_of
from fieldmon.io.readers.weather_options import WeatherOptions
from fieldmon.plot.local_clock import utc_now
from fieldmon.plot.plot import must_be_plot

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.infestation.records import Records
    from fieldmon.io.options import Source
    from fieldmon.pests.pest import Pest
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot

#: files of rows, blocks and paths that a plot may have besides
_DRAWN = ("rows", "blocks", "contours", "paths")


def read_plot(
    source: Source | None = None,
    feature: str | int | None = None,
    plants: Source | None = None,
    *,
    planting: PlantingChoices | None = None,
    gate: tuple[float, float] | None = None,
    **options: object,
) -> Plot:
    r"""Return one plot of a file with its plants in rows.

    Parameters
    ----------
    source
        Path of a shapefile, GeoPackage, GeoJSON, KML...; also zipped. None: nobody drew a
        boundary; the plot is where its `plants` are, or its ``rows``.
    feature
        Name of the plot, or its number from 1, where the file holds several.
    plants
        File with positions of measured plants; None: plants are laid.
    planting
        Bearing, spacings, headland and faces where the file's own are not wanted; None: found in
        the file, or assumed (rows 4 m, plants 3 m), with a warning.
    gate
        ``(lon, lat)`` where days start and end; None: the nearest row end.
    **options
        What else the first file leaves open, as the messages name it: ``crs="EPSG:2039"``,
        ``columns={"lon": "Ost", "lat": "Nord"}``, ``near=(35.1, 30.3)``; and ``doubles="one"`` of
        plants measured twice, ``far="keep"`` of a few that stand kilometres away. ``rows``,
        ``blocks``, ``contours`` and ``paths`` are more files: rows or their end posts, areas of
        blocks or lines that part them, a raster of heights, and lines along which insects enter.
        ``guess_blocks=True`` parts the plot as its outline asks for.

    Returns
    -------
    Plot
        Its ``grid`` holds n plants; `Plot.to_geopandas` gives them as points.

    Warns
    -----
    ImportDoubt
        For everything that was guessed, dropped or is doubtful.

    Raises
    ------
    ChoiceNeeded
        If the file leaves a choice; the sentence says which option answers.
    FileProblem
        If a file cannot be read.
    PlotError
        If no plant has room.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> plot.n_plants, plot.grid.n_rows
    (3825, 45)
    >>> with open("vines.csv", "w") as file:
    ...     print("lon,lat", *(f"35.0000{x},30.000{y}" for x in "048" for y in range(10, 30, 2)),
    ...           sep="\n", file=file)
    >>> fm.read_plot(plants="vines.csv")
    <Plot vines: 30 plants in 3 rows>
    """
    if source is not None:
        must_be_file(source)
    if plants is not None:
        must_be_file(plants, "A file of plants")
    must_be_of("A plot's name or number", "str | int | None", feature)
    must_be_of("A plot's planting", "PlantingChoices | None", planting)
    must_be_of("A plot's gate", "tuple[float, float] | None", gate)
    drawn: dict[str, Any] = {name: options.pop(name) for name in _DRAWN if name in options}
    for name, file in drawn.items():
        if file is not None:
            must_be_file(file, f"A file of {name}")
    drawn["guess_blocks"] = yes_or_no("guess_blocks", options.pop("guess_blocks", False))
    sources = PlotSources(source, plants=plants, gate=gate, **drawn)
    sources = replace(sources, **_how_read(sources, feature, options))
    with answered(sources.first):
        ready = prepare(PlotRequest(sources, planting or PlantingChoices()))
    warn_of(said.message for said in ready.messages)
    for assumed in ready.assumed:
        warnings.warn(f"{assumed} (planting=PlantingChoices(...))", ImportDoubt, stacklevel=2)
    return ready.plot


def read_plots(source: Source, **options: object) -> tuple[Field, ...]:
    """Return the outlines of all plots of a file, without plants.

    Parameters
    ----------
    source
        Path of a shapefile, GeoPackage, GeoJSON, KML...; also zipped.
    **options
        What the file leaves open, as `read_plot` takes it: ``crs="EPSG:2039"``.

    Returns
    -------
    tuple of Field
        In the file's order; `Plot.of` lays plants on one.

    Warns
    -----
    ImportDoubt
        For everything that was guessed, dropped or is doubtful.

    Raises
    ------
    ChoiceNeeded
        If the file leaves a choice; the sentence says which option answers.
    FileProblem
        If it cannot be read.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fields = fm.read_plots("sample_data/paran_estate.zip")
    >>> [field.name for field in fields][:4]
    ['Gate', 'Pond', 'Wadi', 'Big field']
    >>> fm.Plot.of(fields[0]).n_plants
    3825
    """
    must_be_file(source)
    wanted = chosen(PlotOptions(), options)
    with answered():
        read = read_fields(source, wanted)
    warn_of(read.messages)
    return read.value


def read_records(source: Source, near: Plot, **options: object) -> Records:
    """Return the dated pest records on a plot or near it.

    Parameters
    ----------
    source
        Path of a CSV, Excel, shapefile, GeoPackage, GeoJSON or KML file, with positions, with rows
        and plants, or with names of plots.
    near
        The plot; records more than 100 m away are kept apart.
    **options
        What the file leaves open: ``date_order="dmy"``, ``crs="EPSG:2039"``,
        ``columns={"date": "Datum", "count": "Milben"}``.

    Returns
    -------
    Records
        m records, an array entry each.

    Warns
    -----
    ImportDoubt
        For everything that was guessed, dropped or is doubtful.

    Raises
    ------
    ChoiceNeeded
        If the file leaves a choice.
    FileProblem
        If it cannot be read.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> records = fm.read_records("sample_data/mite_records.csv", near=plot)
    >>> len(records), int((records.present == 1).sum())
    (329, 86)
    """
    must_be_file(source)
    must_be_plot(near)
    asked = RecordSource(source, chosen(RecordOptions(), options))
    with answered():
        read = records_on(near, asked)
    warn_of(read.messages)
    return read.value


def read_inspections(source: Source, plot: Plot, **options: object) -> Inspections:
    r"""Return what was found at which plants, from a route file filled in or any table of finds.

    Parameters
    ----------
    source
        CSV, TSV, Excel, GeoJSON, GeoPackage, shapefile, KML or GPX, with plants by number, by row
        and number in it, or by position. Blank lines stay unknown.
    plot
        Whose plants they are.
    **options
        What the file leaves open: ``day="2026-11-18"``, ``who="Ann"``, ``zone="Asia/Jerusalem"``,
        ``accuracy_m="3"``.

    Returns
    -------
    Inspections
        k inspections, an array entry each; `Season.record` takes them.

    Warns
    -----
    ImportDoubt
        For everything that was guessed, left out or is doubtful.

    Raises
    ------
    ChoiceNeeded
        If the file leaves a choice.
    FileProblem
        If it cannot be read.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> table = "plant,found,date\n17,yes,2026-11-18\n18,no,2026-11-18\n19,,2026-11-18\n"
    >>> with open("day.csv", "w") as file:
    ...     _ = file.write(table)
    >>> seen = fm.read_inspections("day.csv", plot)
    >>> seen.plant.tolist(), seen.result.tolist()
    ([17, 18], [1, 0])
    """
    must_be_file(source)
    must_be_plot(plot)
    wanted = chosen(InspectionOptions(), options).on(plot.field)
    with answered():
        read = read_on_grid(source, plot.grid, wanted, (plot.field.name,))
    warn_of(read.messages)
    return read.value


def read_pest(said: str | PathLike[str]) -> Pest:
    """Return a pest: the name of one that comes with fieldmon, or the path of a TOML file.

    Parameters
    ----------
    said
        ``"spider-mite"``, ``"western-flower-thrips"``, ... or ``"mite.toml"``, a path too.

    Returns
    -------
    Pest
        Its stages, how it grows and moves, with who says so.

    Raises
    ------
    FileProblem
        If it is neither, or the file is no pest: the sentence says which line.

    Examples
    --------
    >>> import fieldmon as fm
    >>> mite = fm.read_pest("spider-mite")
    >>> [stage.name for stage in mite.stages]
    ['egg', 'larva', 'protonymph', 'deutonymph']
    """
    must_be(
        "A pest must be its name or its file's path", said, (str, PathLike), 'Give "spider-mite".'
    )
    return pest_of(fspath(said))


def read_weather(source: Source, plot: Plot, **options: object) -> Weather:
    r"""Return the weather of a station's table, or of IPM Decisions' JSON, by hours or days.

    Parameters
    ----------
    source
        Path of a CSV, Excel or JSON file.
    plot
        Where it is: times that name no zone are its own.
    **options
        What the file leaves open: ``wind_unit="km/h"``, ``temperature_unit="F"``,
        ``date_order="dmy"``, ``zone="UTC"``.

    Returns
    -------
    Weather
        n hours or days, an array entry each. What begins later than now is marked as forecast.

    Warns
    -----
    ImportDoubt
        For everything that was guessed, left out or is doubtful, gaps among it.

    Raises
    ------
    ChoiceNeeded
        If the file leaves a choice.
    FileProblem
        If it cannot be read, or its units or values make no sense.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> table = "Date,Tmin (F),Tmax (F)\n2025-11-18,50,68\n2025-11-19,50,70\n"
    >>> with open("station.csv", "w") as file:
    ...     _ = file.write(table)
    >>> fm.read_weather("station.csv", plot).high_c.round(1).tolist()
    [20.0, 21.1]
    """
    must_be_file(source)
    must_be_plot(plot)
    wanted = chosen(WeatherOptions(now=utc_now()), options).on(plot.field)
    with answered():
        read = read_weather_file(source, wanted)
    warn_of(read.messages)
    return read.value


def read_risk(
    source: Source, plot: Plot, meaning: str | None = None, *, mean_share: float | None = None,
    low_is_risky: bool = False, how: str | None = None, **options: object,
) -> NDArray[np.float64]:  # fmt: skip
    """Return the risk of each plant from a raster, for `plan_day` and `Season.create`.

    Parameters
    ----------
    source
        Path of a GeoTIFF or another raster that says where it lies.
    plot
        Whose plants they are.
    meaning
        What its numbers are: ``"chance"``, ``"percent"``, or of what only shows which plants are at
        more risk ``"rank"`` (their order) or ``"score"`` (how far from the average). None: as the
        file says, which those written by fieldmon do.
    mean_share
        Of rank and score: share of the plants that are infested for this reason.
    low_is_risky
        Of rank and score: whether low values are the risky ones, as of a vegetation index.
    how
        What of a plant's ground counts: ``"mean"`` (None, too), ``"nearest"``, ``"bilinear"`` or
        ``"highest"``.
    **options
        What the file leaves open: ``band="2"``, ``nodata="0"``, ``crs="EPSG:2039"``.

    Returns
    -------
    ndarray
        ``(n,)`` chances; NaN where the raster says nothing.

    Warns
    -----
    ImportDoubt
        For everything that was guessed, left out or is doubtful.

    Raises
    ------
    ChoiceNeeded
        If the file leaves a choice, or nobody says what its numbers are.
    ObservationError
        If they are not what they are said to be.
    FileProblem
        If it cannot be read.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np, rasterio
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> lies = rasterio.transform.from_bounds(*plot.field.boundary.bounds, 200, 200)
    >>> shape = {"width": 200, "height": 200, "count": 1, "dtype": "float32"}
    >>> with rasterio.open("ndvi.tif", "w", crs="EPSG:4326", transform=lies, **shape) as file:
    ...     file.write(np.linspace(0.2, 0.8, 40_000, dtype="float32").reshape(1, 200, 200))
    >>> risk = fm.read_risk("ndvi.tif", plot, "rank", mean_share=0.03, low_is_risky=True)
    >>> risk.shape, round(float(risk.mean()), 4)
    ((3825,), 0.03)
    >>> day = fm.plan_day(plot, on="2026-11-18", risk=risk)
    """
    must_be_file(source)
    must_be_plot(plot)
    must_be_of("'mean_share' of read_risk", "float | None", mean_share)
    must_be_of("'low_is_risky' of read_risk", "bool", low_is_risky)
    must_be_of("'meaning' of read_risk", "str | None", meaning)
    must_be_of("'how' of read_risk", "str | None", how)
    from fieldmon.infestation.prior.raster_risk import RiskSettings  # noqa: PLC0415 - with scipy
    from fieldmon.io.rasters.values import RasterOptions  # noqa: PLC0415 - half a second

    said: tuple[Any, float | None, bool] = meaning, mean_share, low_is_risky
    settings = None if said == (None, None, False) else RiskSettings(*said)
    wanted: Any = chosen(RasterOptions(), options), how
    with answered():
        read = risk_on(plot, RiskSource(source, settings, *wanted))
    warn_of(read.messages)
    return read.value


def _how_read(
    sources: PlotSources, feature: str | int | None, options: dict[str, object]
) -> dict[str, Any]:
    """Return how a plot's files are read: what is said is of the first one."""
    if sources.plot is None:
        if feature is not None:
            raise SettingError(
                worded(
                    "Only a file of plots has one that is chosen, but feature is {feature!r} and "
                    "there is none. Leave it out, or give the file of plots first.",
                    feature=feature,
                )
            )
        said = chosen(ReadOptions(), options)
        return {"rows_options" if sources.plants is None else "plants_options": said}
    said = chosen(PlotOptions(), options)
    if feature is not None:
        said = said.choose("feature", str(feature))
    measured = ReadOptions(doubles=said.doubles, far=said.far)
    return {"plot_options": said, "plants_options": measured}
