"""The records of a plot, or of many: by where they are, or by the rows and plants they name."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import shapely

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded, FieldmonError, ObservationError, PlotError
from fieldmon.infestation.records import Records
from fieldmon.io.import_report import Imported, ImportMessage, doubtful
from fieldmon.io.options import source_name
from fieldmon.io.prepared_plots import EstateRecords, Laid
from fieldmon.io.read import (
    read_records,
    read_records_by_plot,
)
from fieldmon.io.readers.nearby import on_other_plots, on_plants, without_corners
from fieldmon.io.readers.placed_twice import PlacedTwice
from fieldmon.io.readers.places import NamedPlaces, labelled, plots_called

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.io.plot_request import (
        RecordSource,
    )
    from fieldmon.io.readers.places import Plants
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot

#: names of plots in a sentence
MOST_NAMED = 12
#: some kilometres: records further from all plots than that belong to none
_NEARBY_DEG = 0.05


def records_on(
    plot: Plot,
    source: RecordSource,
    fields: Callable[[], tuple[Field, ...]] | None = None,
    measured: Plants | None = None,
) -> Imported[Records]:
    """Return the records on a plot or near it.

    They give positions, or name rows and plants, or plots.

    Parameters
    ----------
    plot
        The plot with all of its plants, also those that a raster shows to be missing.
    source
        The records.
    fields
        Returns every plot of the plot's file, for records that name plots, and to say on which of
        them records lie of which none is near; called only then.
    measured
        The plot's measured plants, whose labels records may name.
    """
    apart_m = plot.grid.plant_spacing_m
    try:
        read = read_records(source.file, source.options, plot.field, apart_m=apart_m)
        read = _doubted(read, partial(_doubts_of, plot, fields, measured))
    except ChoiceNeeded as question:
        if question.option not in {"plants", "plots"}:
            raise
        known = (plot.field,) if fields is None else fields()
        places = NamedPlaces.of(known, plot.grid, measured, plot.field.name)
        read = read_records(source.file, source.options, plot.field, places, apart_m)
    except ObservationError:
        if fields is not None and (elsewhere := _elsewhere(plot.field, source, fields)):
            raise elsewhere from None
        raise
    return read.having(read.value, on_plants(read.value, plot.grid))


def _doubted(
    read: Imported[Records], doubts: Callable[[PlacedTwice], list[ImportMessage]]
) -> Imported[Records]:
    """Return what was read with doubts in place of what is said of records placed twice."""
    twice = next((one for one in read.messages if isinstance(one, PlacedTwice)), None)
    said = [] if twice is None else doubts(twice)
    if not said:
        return read
    return Imported(read.value, (*(one for one in read.messages if one is not twice), *said))


def _doubts_of(
    plot: Plot,
    fields: Callable[[], tuple[Field, ...]] | None,
    measured: Plants | None,
    twice: PlacedTwice,
) -> list[ImportMessage]:
    """Return the doubts of the records of one plot, of a file that may hold others."""
    said = _doubts_on(plot.field, lambda: plot.grid, measured, twice)
    if fields is None or not twice.plots:
        return said
    return [*said, *twice.on_wrong_plots(plot.field, fields(), _spacing_m(plot.grid))]


def _doubts_on(
    field: Field, make: Callable[[], PlantGrid], measured: Plants | None, twice: PlacedTwice
) -> list[ImportMessage]:
    """Return a doubt where records on a plot lie elsewhere than the plants of it that they name."""
    here = twice.on(field)
    if not len(here.lonlat):
        return []
    try:
        grid = make()
    except PlotError:  # it carries no plants, which is said where they are asked for
        return []
    return here.doubts(NamedPlaces.of((field,), grid, measured, field.name), _spacing_m(grid))


def _doubts_on_all(
    fields: tuple[Field, ...], lay: Callable[[Field], Laid], twice: PlacedTwice
) -> list[ImportMessage]:
    """Return the same of every plot: of those that records name, or else on which they lie."""
    if named := plots_called(twice.plots, fields):
        try:
            grids = {each.name: lay(each).plot.grid for each in named}
        except PlotError:
            return []
        plants = {each.name: labelled(grids[each.name], None, each.blocks) for each in named}
        spacing_m = max(map(_spacing_m, grids.values()))
        return twice.doubts(NamedPlaces(fields, plants_of=plants), spacing_m)
    return [
        replace(doubt, feature=each.name if len(fields) > 1 else None)
        for each in fields
        for doubt in _doubts_on(each, partial(_grid_of, each, lay), None, twice)
    ]


def _grid_of(field: Field, lay: Callable[[Field], Laid]) -> PlantGrid:
    return lay(field).plot.grid


def _spacing_m(grid: PlantGrid) -> float:
    return max(grid.row_spacing_m, grid.plant_spacing_m)


def _elsewhere(
    field: Field, source: RecordSource, fields: Callable[[], tuple[Field, ...]]
) -> ObservationError | None:
    """Return what to say where records that can be read lie on other plots of the plot's file."""
    try:
        every = read_records(source.file, source.options).value
    except FieldmonError:  # they were refused for what they are, not for where they lie
        return None
    return on_other_plots(every, field, fields())


def records_of(
    fields: tuple[Field, ...], source: RecordSource, lay: Callable[[Field], Laid]
) -> Imported[EstateRecords]:
    """Return the records of several plots; `lay` makes the plants that records name."""
    stated = (each.plant_spacing_m for each in fields if each.plant_spacing_m is not None)
    apart_m = min(stated, default=None)
    try:
        read = read_records(source.file, source.options, apart_m=apart_m)
    except ChoiceNeeded as question:
        if question.option == "plots":
            read = read_records(source.file, source.options, places=NamedPlaces(fields))
            return read.having(EstateRecords(read.value))
        if question.option != "plants":
            raise
        return _by_plant(fields, source, lay, question.choices)
    read = _doubted(read, partial(_doubts_on_all, fields, lay))
    records, corners = without_corners(read.value, fields)
    far = _far_from_all(fields, source, records)
    return read.having(EstateRecords(records), [*corners, *far])


def _far_from_all(
    fields: tuple[Field, ...], source: RecordSource, records: Records
) -> list[ImportMessage]:
    """Return a doubt where no record lies near any plot; ask where all are on another continent."""
    west, south, east, north = shapely.total_bounds([field.boundary for field in fields])
    lon, lat = records.lonlat.T
    margin = _NEARBY_DEG
    near = (lon > west - margin) & (lon < east + margin)
    near &= (lat > south - margin) & (lat < north + margin)
    if near.any():
        return []
    middle = ((west + east) / 2, (south + north) / 2)
    if source.options.near is None:
        read_records(source.file, replace(source.options, near=middle))
    return [
        doubtful(worded("Not one record lies near any of the plots; they say nothing about them."))
    ]


def _by_plant(
    fields: tuple[Field, ...],
    source: RecordSource,
    lay: Callable[[Field], Laid],
    plots: tuple[str, ...],
) -> Imported[EstateRecords]:
    """Return records that name rows and plants, each on its own plot; `plots` are those named."""
    if len(fields) == 1:
        (only,) = fields
        places = NamedPlaces.of(fields, lay(only).plot.grid, None, only.name)
        read = read_records(source.file, source.options, places=places)
        return read.having(EstateRecords(named={only.name: read.value}))
    named_plots = plots_called(plots, fields) if plots else (_plot_by_hand(fields, source),)
    places = NamedPlaces(fields, plants_of=_plants_of(named_plots, lay))
    by_plot = read_records_by_plot(source.file, source.options, places)
    none = Records.none()
    named = {field.name: by_plot.value.get(field.name, none) for field in fields}
    return by_plot.having(EstateRecords(named=named))


def _plot_by_hand(fields: tuple[Field, ...], source: RecordSource) -> Field:
    """Return the plot whose rows and plants records name without naming it; ask for it."""
    by_hand = source.options.plot
    if by_hand is not None and (called := plots_called((by_hand,), fields)):
        return called[0]
    names = tuple(field.name for field in fields)
    wrong = "" if by_hand is None else f" (it is not {by_hand!r})"
    raise ChoiceNeeded(
        worded(
            "Records that name rows and plants must be of a known plot, but "
            "{source_name} does not say of which{wrong}. Choose one of {n}: "
            "{some}.",
            source_name=source_name(source.file),
            wrong=wrong,
            n=len(names),
            some=first_few(names, MOST_NAMED),
        ),
        "plot",
        names,
    )


def _plants_of(fields: tuple[Field, ...], lay: Callable[[Field], Laid]) -> dict[str, Plants]:
    """Return the plants of plots by name, but of those that cannot carry any."""
    plants: dict[str, Plants] = {}
    problem = None
    for each in fields:
        try:
            plants[each.name] = labelled(lay(each).plot.grid, None, each.blocks)
        except PlotError as error:
            problem = error
    if problem is not None and not plants:
        raise problem
    return plants
