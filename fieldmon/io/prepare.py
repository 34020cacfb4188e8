"""The one way from files to a prepared plot, for the command line, the app and the library.

`prepare` makes one plot, `prepare_estate` reads every plot of a file with its records. Whoever
keeps what was read, and draws on plots in between, goes the same way step by step: `lay` or
`lay_around`, `records_on`, `without_missing`, `risk_on`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeVar

import shapely

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FieldmonError, ObservationError, PlotError, SettingError
from fieldmon.infestation.observations import Observations
from fieldmon.io.drawn_rows import with_rows
from fieldmon.io.import_report import ImportMessage, doubtful, gathered, guessed
from fieldmon.io.open_sea import said_of_place
from fieldmon.io.options import source_name
from fieldmon.io.read import (
    read_crews,
    read_lines,
    read_plants,
    read_plots,
    read_records,
    read_records_by_plot,
    read_rows,
)
from fieldmon.io.readers.crews import Crew
from fieldmon.io.readers.nearby import on_other_plots, on_plants, records_on_plot
from fieldmon.io.readers.places import NamedPlaces, labelled, plots_called
from fieldmon.io.sources import PlantingChoices
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot, planting_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import Source
    from fieldmon.io.readers.places import Plants
    from fieldmon.io.sources import (
        CanopySource,
        PlotRequest,
        PlotSources,
        RecordSource,
        RiskSource,
        Role,
    )
    from fieldmon.plot.field import Field

T = TypeVar("T")

_MOST_NAMED = 12
#: some kilometres: records further from all plots than that belong to none
_NEARBY_DEG = 0.05
_SPACINGS = ("row_spacing_m", "plant_spacing_m")


@dataclass(frozen=True)
class SourceMessage:
    """One thing that the import of a file has to say.

    Parameters
    ----------
    role
        What the file is to the plot: whose option or button answers.
    source
        The file's name.
    message
        What there is to say.
    """

    role: Role
    source: str
    message: ImportMessage


@dataclass(frozen=True, eq=False)
class Laid:
    """A plot with its plants, what had to be assumed for them, and what is said of its rows."""

    plot: Plot

    @property
    def assumed(self) -> tuple[Assumed, ...]:
        """Return what nobody said of its rows."""
        return self.plot.assumed

    @property
    def messages(self) -> tuple[ImportMessage, ...]:
        """Return how measured plants stand in rows, and what is doubtful about it."""
        from fieldmon.io.import_report import doubtful, seen  # noqa: PLC0415

        if not self.plot.grid.in_rows:
            said = worded("Plants are taken to stand in no rows, and are visited by nearness.")
            return (seen(said),)
        rows, drawn = self.plot.rows, self.plot.field.row_lines
        if rows is None and self.plot.field.plants is None and len(drawn.geoms) > 1:
            return (
                seen(
                    worded("Plants stand along the {n} rows that were drawn.", n=len(drawn.geoms))
                ),
            )
        if rows is None:
            return ()
        found = (seen(worded("Rows were found: {how}.", how=rows.how)),) if rows.in_rows else ()
        return (*found, *(doubtful(sentence) for sentence in rows.doubts))


@dataclass(frozen=True, eq=False)
class Prepared:
    """A plot that is ready to be planned, simulated or begun a season on.

    Parameters
    ----------
    plot
        The plot, without the plants that are missing.
    records
        The records on it or near it.
    risk
        ``(n,)`` risk of its plants from a raster, NaN where that says nothing; None without one.
    messages
        What the imports had to say, in order.
    assumed
        What nobody said.
    """

    plot: Plot
    records: Observations
    risk: NDArray[np.float64] | None
    messages: tuple[SourceMessage, ...]
    assumed: tuple[Assumed, ...]


@dataclass(frozen=True, eq=False)
class EstateRecords:
    """The records of several plots.

    Parameters
    ----------
    anywhere
        Those that belong to a plot by their position.
    named
        Those that name a plot's rows and plants, by the plot's name; empty where records do not.
    """

    anywhere: Observations = field(default_factory=Observations.none)
    named: Mapping[str, Observations] = field(default_factory=dict)

    def candidates(self, name: str) -> Observations:
        """Return the records among which those of a plot are."""
        return self.named.get(name, self.anywhere)

    def on(self, plot: Field) -> Observations:
        """Return the records on a plot or near it; there may be none."""
        return records_on_plot(self.candidates(plot.name), plot)


@dataclass(frozen=True, eq=False)
class Estate:
    """Every plot of a file.

    Parameters
    ----------
    fields
        The plots, with their paths.
    crews
        Who works on each, by name, as the file says.
    records
        The records of all of them.
    messages
        What the imports had to say, in order.
    """

    fields: tuple[Field, ...]
    crews: Mapping[str, Crew]
    records: EstateRecords
    messages: tuple[SourceMessage, ...]

    def crew(self, field: Field) -> Crew:
        """Return who works on a plot."""
        return self.crews.get(field.name, Crew())


class Listener(Protocol):
    """Hears what there is to say while files are read, be a later one of no use or not."""

    def message(self, said: SourceMessage, /) -> None:
        """Hear what an import has to say."""

    def laid(self, laid: Laid, /) -> None:
        """Hear of the plot, before its records are read."""


def prepare(request: PlotRequest, listener: Listener | None = None) -> Prepared:
    """Return one plot with its records and its risk.

    Raise `ChoiceNeeded` where a file leaves a choice; its ``role`` says which file. A file of
    several plots, of which none is chosen, asks for ``"feature"`` and is no file's question.
    """
    hearing = _Hearing(listener)
    sources = request.sources
    drawn = sources.rows, sources.contours
    if sources.plants is not None and any(one is not None for one in drawn):
        raise SettingError(
            worded(
                "Plants stand where they were measured, or along rows that "
                "were drawn: give their positions or the rows, not both."
            )
        )
    laid, measured = _laid(request, hearing)
    if (file := sources.plot or sources.plants or sources.rows) is not None:
        role: Role = "plot" if sources.plot else "plants" if sources.plants else "rows"
        hearing.say(role, file, said_of_place(laid.plot.field))
    if sources.plants is not None:
        hearing.say("plants", sources.plants, laid.messages)
    elif sources.rows is not None:
        hearing.say("rows", sources.rows, laid.messages)
    if listener is not None:
        listener.laid(laid)
    plot, records, risk = laid.plot, Observations.none(), None
    if (asked := request.records) is not None:
        named = partial(_every_field, sources)
        records = hearing.read(
            "records", asked.file, partial(records_on, plot, asked, named, measured)
        )
    if (canopy := request.canopy) is not None:
        plot = hearing.read("canopy", canopy.file, partial(without_missing, plot, canopy))
    if (raster := request.risk) is not None:
        risk = hearing.read("risk", raster.file, partial(risk_on, plot, raster))
    return Prepared(plot, records, risk, tuple(hearing.messages), laid.assumed)


def _laid(request: PlotRequest, hearing: _Hearing) -> tuple[Laid, Plants | None]:
    """Return the plot with its plants, and those measured on it."""
    sources, measured = request.sources, None
    if sources.plot is None and sources.plants is None and sources.rows is not None:
        return _along_rows(request, hearing), None
    if sources.plot is None:
        measured = _measured(sources, hearing)
        return lay_around(sources, measured, request.planting), measured
    field = one_of(_fields(sources, hearing))
    if sources.plants is not None:
        measured = _measured(sources, hearing)
        field = with_plants(field, measured)
    field = with_rows((field,), sources, request.planting, hearing)[0]
    field = _with_paths((field,), sources, hearing)[0]
    gate = field.gate if sources.gate is None else sources.gate
    return lay(replace(field, gate=gate), request.planting), measured


def prepare_estate(request: PlotRequest, listener: Listener | None = None) -> Estate:
    """Return every plot of a file, or the one that is chosen, and the records of all of them.

    Where records name rows and plants, each plot gets its own; where they do not say of which
    plot, and there are several, ask for ``"plot"``. Plants, gate and rasters are of one plot only
    and left out of account.
    """
    hearing = _Hearing(listener)
    sources, records = request.sources, EstateRecords()
    if (file := sources.plot) is None:
        raise SettingError(worded("Give a file of plots."))

    def read() -> Imported[tuple[tuple[Field, ...], dict[str, Crew]]]:
        plots, crews = read_crews(file, sources.plot_options)
        return plots.having((plots.value, crews))

    fields, crews = hearing.read("plot", file, read)
    hearing.say("plot", file, gathered(one for each in fields for one in said_of_place(each)))
    fields = with_rows(fields, sources, request.planting, hearing)
    fields = _with_paths(fields, sources, hearing)
    if (asked := request.records) is not None:
        lay_one = partial(lay, choices=request.planting)
        records = hearing.read("records", asked.file, partial(records_of, fields, asked, lay_one))
    return Estate(fields, crews, records, tuple(hearing.messages))


def one_of(fields: tuple[Field, ...]) -> Field:
    """Return the only plot; ask which is meant where there are several."""
    if len(fields) == 1:
        return fields[0]
    names = tuple(field.name for field in fields)
    raise ChoiceNeeded(
        worded(
            "One plot must be chosen, but the file holds {n}: {some}. Choose "
            "one by name or number.",
            n=len(names),
            some=_some(names),
        ),
        "feature",
        names,
    )


def lay(field: Field, choices: PlantingChoices | None = None) -> Laid:
    """Return a field with its plants: those measured, or laid as said, stated or usual."""
    choices = choices or PlantingChoices()
    if not choices.in_rows:
        return Laid(Plot.of(replace(field, in_rows=False)))
    given = choices.given()
    planting = planting_of(field, **given)
    missing = [name for name in _SPACINGS if name not in given and getattr(field, name) is None]
    if field.blocks:
        told = [[getattr(block, name) for block in field.blocks] for name in missing]
        missing = [name for name, each in zip(missing, told, strict=True) if None in each]
    if len(field.row_lines.geoms) > 1:  # rows are as far apart as they were drawn
        missing = [name for name in missing if name != "row_spacing_m"]
    assumed = tuple(Assumed(name, getattr(planting, name)) for name in missing)
    plot = Plot.of(field, planting)
    return Laid(plot if field.plants is not None else replace(plot, assumed=assumed))


def lay_around(
    sources: PlotSources, measured: Plants, choices: PlantingChoices | None = None
) -> Laid:
    """Return the plot of measured plants whose boundary nobody drew, called as their file."""
    choices = choices or PlantingChoices()
    planting = Planting(**choices.given())  # type: ignore[arg-type]
    name = "plants" if sources.plants is None else Path(source_name(sources.plants)).stem
    if not choices.in_rows:
        return Laid(Plot.among(name, measured.lonlat.copy(), sources.gate))
    plants = measured.lonlat.copy()
    return Laid(Plot.around(name, plants, planting, sources.gate, measured.names))


def with_plants(field: Field, measured: Plants) -> Field:
    """Return a field with the plants measured on it, and what their rows and blocks are called."""
    plants, (row, block) = measured.lonlat.copy(), measured.names
    return replace(field, plants=plants, plant_rows=row, plant_blocks=block)


def _along_rows(request: PlotRequest, hearing: _Hearing) -> Laid:
    """Return the plot of rows that were drawn, whose boundary nobody drew."""
    sources = request.sources
    if (file := sources.rows) is None or sources.contours is not None:
        raise SettingError(worded("Rows along contours need the plot on which they run."))
    rows = hearing.read("rows", file, partial(read_rows, file, sources.rows_options))
    name = Path(source_name(file)).stem
    planting = Planting(**request.planting.given())  # type: ignore[arg-type]
    plot = Plot.along(name, rows, planting, sources.gate)
    said = worded("No boundary was given: the plot is where rows, aisles and headlands reach.")
    hearing.say("rows", file, (guessed(said),))
    if "plant_spacing_m" in request.planting.given():
        return Laid(plot)
    return Laid(replace(plot, assumed=(Assumed("plant_spacing_m", planting.plant_spacing_m),)))


def records_on(
    plot: Plot,
    source: RecordSource,
    fields: Callable[[], tuple[Field, ...]] | None = None,
    measured: Plants | None = None,
) -> Imported[Observations]:
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
    try:
        read = read_records(source.file, source.options, near=plot.field)
    except ChoiceNeeded as question:
        if question.option not in {"plants", "plots"}:
            raise
        known = (plot.field,) if fields is None else fields()
        places = NamedPlaces.of(known, plot.grid, measured, plot.field.name)
        read = read_records(source.file, source.options, plot.field, places)
    except ObservationError:
        if fields is not None and (elsewhere := _elsewhere(plot.field, source, fields)):
            raise elsewhere from None
        raise
    return read.having(read.value, on_plants(read.value, plot.grid))


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
    try:
        read = read_records(source.file, source.options)
    except ChoiceNeeded as question:
        if question.option == "plots":
            read = read_records(source.file, source.options, places=NamedPlaces(fields))
            return read.having(EstateRecords(read.value))
        if question.option != "plants":
            raise
        return _by_plant(fields, source, lay, question.choices)
    return read.having(EstateRecords(read.value), _far_from_all(fields, source, read.value))


def _far_from_all(
    fields: tuple[Field, ...], source: RecordSource, records: Observations
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


def without_missing(plot: Plot, source: CanopySource) -> Imported[Plot]:
    """Return a plot without the plants where the canopy is low; those unseen stay."""
    from fieldmon.io.rasters.at_plants import read_missing  # noqa: PLC0415 - half a second
    from fieldmon.io.rasters.values import RasterOptions  # noqa: PLC0415

    options = source.options or RasterOptions()
    read = read_missing(source.file, options, plot, source.below, source.how)
    return read.having(plot.without(read.value))


def risk_on(plot: Plot, source: RiskSource) -> Imported[NDArray[np.float64]]:
    """Return the risk of each plant ``(n,)`` from a raster, NaN where it says nothing."""
    from fieldmon.infestation.raster_risk import RiskSettings  # noqa: PLC0415
    from fieldmon.io.rasters.at_plants import read_risk  # noqa: PLC0415 - half a second
    from fieldmon.io.rasters.values import RasterOptions  # noqa: PLC0415

    settings, options = source.settings or RiskSettings(), source.options or RasterOptions()
    return read_risk(source.file, options, plot, settings, source.how)


class _Hearing:
    """Keeps what imports have to say, and tells it on; marks questions with the file's role."""

    def __init__(self, listener: Listener | None) -> None:
        self.listener = listener
        self.messages: list[SourceMessage] = []

    def read(self, role: Role, source: Source, read: Callable[[], Imported[T]]) -> T:
        try:
            imported = read()
        except ChoiceNeeded as question:
            raise ChoiceNeeded(question.args[0], question.option, question.choices, role) from None
        self.say(role, source, imported.messages)
        return imported.value

    def say(self, role: Role, source: Source, messages: tuple[ImportMessage, ...]) -> None:
        """Keep what there is to say of a file, and tell it on."""
        for message in messages:
            said = SourceMessage(role, source_name(source), message)
            self.messages.append(said)
            if self.listener is not None:
                self.listener.message(said)


def _fields(sources: PlotSources, hearing: _Hearing) -> tuple[Field, ...]:
    """Return the plots of the file that are meant."""
    file = sources.plot
    if file is None:
        return ()
    return hearing.read("plot", file, partial(read_plots, file, sources.plot_options))


def _every_field(sources: PlotSources) -> tuple[Field, ...]:
    """Return all plots of the file; what it has to say was said before."""
    if sources.plot is None:
        return ()
    return read_plots(sources.plot, replace(sources.plot_options, feature=None)).value


def _measured(sources: PlotSources, hearing: _Hearing) -> Plants:
    file = sources.plants
    if file is None:
        raise SettingError(worded("Give a file of plots, or the positions of a plot's plants."))
    return hearing.read("plants", file, partial(read_plants, file, sources.plants_options))


def _with_paths(
    fields: tuple[Field, ...], sources: PlotSources, hearing: _Hearing
) -> tuple[Field, ...]:
    file = sources.paths
    if file is None:
        return fields
    read = partial(read_lines, file, sources.paths_options, fields[0])
    lines = hearing.read("paths", file, read)
    return tuple(replace(field, paths=lines) for field in fields)


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
    none = Observations.none()
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
            some=_some(names),
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


def _some(names: tuple[str, ...]) -> str:
    return ", ".join(names[:_MOST_NAMED]) + (", ..." if len(names) > _MOST_NAMED else "")
