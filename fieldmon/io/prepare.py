"""The one way from files to a prepared plot, for the command line, the app and the library.

`prepare` makes one plot, `prepare_estate` reads every plot of a file with its records. Whoever
keeps what was read, and draws on plots in between, goes the same way step by step: `lay` or
`lay_around`, `records_on` (in `plot_records`), `without_missing`, `risk_on`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import first_few, joined, worded
from fieldmon.errors import ChoiceNeeded, FileProblem, SettingError
from fieldmon.infestation.records import Records
from fieldmon.io.drawn_rows import with_rows
from fieldmon.io.guessed_bearing import doubts_of_bearing, guessed_bearing
from fieldmon.io.import_report import ImportMessage, WrongRows, gathered, guessed
from fieldmon.io.open_sea import said_of_place
from fieldmon.io.options import source_name
from fieldmon.io.plot_records import MOST_NAMED, records_of, records_on
from fieldmon.io.plot_request import PlantingChoices
from fieldmon.io.prepared_plots import (
    Estate,
    EstateRecords,
    Laid,
    Listener,
    Prepared,
    SourceMessage,
)
from fieldmon.io.read import (
    read_crews,
    read_lines,
    read_plants,
    read_plots,
    read_rows,
)
from fieldmon.io.readers.nearby import plants_on
from fieldmon.io.unused_row_settings import unused_of
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.planting import Planting
from fieldmon.plot.plants_outside import distance_m
from fieldmon.plot.plot import Plot, planting_of, plot_among, plot_around, plot_of
from fieldmon.plot.row_report import told_by_hand

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.io.import_report import Imported
    from fieldmon.io.options import Source
    from fieldmon.io.plot_request import (
        CanopySource,
        PlotRequest,
        PlotSources,
        RiskSource,
        Role,
    )
    from fieldmon.io.readers.places import Plants
    from fieldmon.plot.field import Field

T = TypeVar("T")

_FARTHEST_GATE_M = 10_000.0
_SPACINGS = ("row_spacing_m", "plant_spacing_m")


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
        role = sources.first
        exchanged = getattr(sources, f"{role}_options").swap_axes
        hearing.say(role, file, said_of_place(laid.plot.field, exchanged=exchanged))
    role = "plants" if sources.plants is not None else "rows"
    if (file := getattr(sources, role)) is not None:
        hearing.say(role, file, laid.messages)
        hearing.say(role, file, unused_of(laid.plot.field, request.planting))
    elif (file := sources.plot) is not None:
        hearing.say("plot", file, unused_of(laid.plot.field, request.planting))
        hearing.say("plot", file, doubts_of_bearing(laid.plot.field, request.planting))
    if listener is not None:
        listener.laid(laid)
    plot, records, risk = laid.plot, Records.none(), None
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
        laid = _along_rows(request, hearing)
        refuse_far_gate(sources.gate, laid.plot.field)
        return laid, None
    if sources.plot is None:
        measured = _measured(sources, hearing)
        laid = lay_around(sources, measured, request.planting)
        refuse_far_gate(sources.gate, laid.plot.field)
        return laid, measured
    field = one_of(_fields(sources, hearing))
    refuse_far_gate(sources.gate, field)
    if sources.plants is not None:
        on = partial(plants_on, _measured(sources, hearing), field, sources.plants_options.far)
        measured = hearing.read("plants", sources.plants, on)
        field = with_plants(field, measured)
    _refuse_wrong_rows(field, request.planting, hearing)
    field = with_rows((field,), sources, request.planting, hearing)[0]
    field = _with_paths((field,), sources, hearing)[0]
    gate = field.gate if sources.gate is None else sources.gate
    return lay(replace(field, gate=gate), request.planting), measured


def refuse_far_gate(gate: tuple[float, float] | None, field: Field) -> None:
    """Raise `SettingError` where a gate told by hand lies where nobody drives from in a day."""
    if gate is None:
        return
    away_m = float(distance_m(np.array([gate]), field)[0])
    if away_m > _FARTHEST_GATE_M:
        raise SettingError(
            worded(
                "The gate at {lon:g}, {lat:g} (longitude, latitude) lies {away} from {name}. "
                "Correct it.",
                lon=gate[0],
                lat=gate[1],
                away=distance_figure(away_m),
                name=field.name,
            )
        )


def _refuse_wrong_rows(field: Field, by_hand: PlantingChoices, hearing: _Hearing) -> None:
    """Raise `FileProblem` where a column says what no rows are, unless it is said by hand."""
    each, file = [], ""
    for said in hearing.messages:
        wrong = said.message
        if not isinstance(wrong, WrongRows) or wrong.setting in by_hand.given():
            continue
        if (wrong.feature or "").split(" / ")[0] == field.name:
            file = file or said.source
            each.append(
                worded(
                    "column {column!r} must be {rule}, but it is {value:g}",
                    column=wrong.column, rule=wrong.rule, value=wrong.value,
                )
            )  # fmt: skip
    if each:
        raise FileProblem(
            worded(
                "{file}: of plot {name!r}, {each}. Correct it, or say it by hand.",
                file=file, name=field.name, each=joined("; ", each),
            )
        )  # fmt: skip


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

    fields, crews = hearing.read("plot", file, partial(read_crews, file, sources.plot_options))
    exchanged = sources.plot_options.swap_axes
    places = (one for each in fields for one in said_of_place(each, exchanged=exchanged))
    hearing.say("plot", file, gathered(places))
    fields = with_rows(fields, sources, request.planting, hearing)
    unused = (one for each in fields for one in unused_of(each, request.planting))
    hearing.say("plot" if sources.rows is None else "rows", sources.rows or file, gathered(unused))
    doubts = (one for each in fields for one in doubts_of_bearing(each, request.planting))
    hearing.say("plot", file, gathered(doubts))
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
            some=first_few(names, MOST_NAMED),
        ),
        "feature",
        names,
    )


def lay(field: Field, choices: PlantingChoices | None = None) -> Laid:
    """Return a field with its plants: those measured, or laid as said, stated or usual."""
    choices = choices or PlantingChoices()
    if not choices.in_rows:
        return Laid(plot_of(replace(field, in_rows=False)))
    given = choices.given()
    plot = plot_of(field, planting_of(field, **given))
    assumed = (*assumed_of(field, choices), *_of_one_row(plot, given))
    return Laid(replace(_told(plot, given), assumed=assumed))


def assumed_of(field: Field, choices: PlantingChoices) -> tuple[Assumed, ...]:
    """Return what is assumed of a field's rows, where plants are laid as said, stated or usual."""
    given = choices.given()
    planting = planting_of(field, **given)
    missing = [name for name in _SPACINGS if name not in given and getattr(field, name) is None]
    if field.blocks:
        told = [[getattr(block, name) for block in field.blocks] for name in missing]
        missing = [name for name, each in zip(missing, told, strict=True) if None in each]
    if len(field.row_lines.geoms) > 1:  # rows are as far apart as they were drawn
        missing = [name for name in missing if name != "row_spacing_m"]
    if field.plants is not None:
        missing = []
    made = [Assumed(name, getattr(planting, name)) for name in missing]
    if (bearing := guessed_bearing(field, choices)) is not None:
        made.append(Assumed("row_bearing_deg", bearing.bearing_deg))
    return tuple(made)


def lay_around(
    sources: PlotSources, measured: Plants, choices: PlantingChoices | None = None
) -> Laid:
    """Return the plot of measured plants whose boundary nobody drew, called as their file."""
    choices = choices or PlantingChoices()
    planting = Planting(**choices.given())  # type: ignore[arg-type]
    name = "plants" if sources.plants is None else Path(source_name(sources.plants)).stem
    if not choices.in_rows:
        return Laid(plot_among(name, measured.lonlat.copy(), sources.gate))
    plants = measured.lonlat.copy()
    plot = plot_around(name, plants, planting, sources.gate, measured.names)
    given = choices.given()
    return Laid(replace(_told(plot, given), assumed=_of_one_row(plot, given)))


def _of_one_row(plot: Plot, given: dict[str, float]) -> tuple[Assumed, ...]:
    """Return what is assumed of measured plants in one row: how far apart rows are, none tells."""
    field, grid = plot.field, plot.grid
    if field.plants is None or grid.n_lines > 1:
        return ()
    if "row_spacing_m" in given or field.row_spacing_m is not None:
        return ()
    return (Assumed("row_spacing_m", grid.row_spacing_m),)


def _told(plot: Plot, given: dict[str, float]) -> Plot:
    """Return a plot that knows which spacings of its measured plants were said by hand."""
    if plot.rows is None:
        return plot
    return replace(plot, rows=told_by_hand(plot.rows, plot.grid, given))


def with_plants(field: Field, measured: Plants) -> Field:
    """Return a field with the plants measured on it, and what they, rows and blocks are called."""
    return measured.names.on(replace(field, plants=measured.lonlat.copy()))


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


def without_missing(plot: Plot, source: CanopySource) -> Imported[Plot]:
    """Return a plot without the plants where the canopy is low; those unseen stay."""
    from fieldmon.io.rasters.at_plants import read_missing  # noqa: PLC0415 - half a second
    from fieldmon.io.rasters.values import RasterOptions  # noqa: PLC0415

    options = source.options or RasterOptions()
    read = read_missing(source.file, options, plot, source.below, source.how)
    return read.having(plot.without(read.value))


def risk_on(plot: Plot, source: RiskSource) -> Imported[NDArray[np.float64]]:
    """Return the risk of each plant ``(n,)`` from a raster, NaN where it says nothing."""
    from fieldmon.io.rasters.at_plants import read_risk  # noqa: PLC0415 - half a second
    from fieldmon.io.rasters.values import RasterOptions  # noqa: PLC0415

    options = source.options or RasterOptions()
    return read_risk(source.file, options, plot, source.settings, source.how)


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
