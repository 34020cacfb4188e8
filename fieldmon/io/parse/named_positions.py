"""Where records lie that name a plot, or a row and a plant, instead of a position."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import text
from fieldmon.io.options import RecordOptions
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.degrees import all_degrees
from fieldmon.io.readers.places import (
    NamedPlaces,
    PlacedByName,
    by_plant,
    by_plot,
    by_plot_and_plant,
    plots_called,
)

if TYPE_CHECKING:
    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import ReadOptions


class _NamingColumns(NamedTuple):
    """The columns that name plots, rows and plants; None, or an empty name: there is none."""

    plot: str | None
    row: str | None
    plant: str


def placed_by_name(layer: Layer, options: ReadOptions, places: NamedPlaces) -> PlacedByName:
    """Return where records lie that name a plant or a plot."""
    row = options.column("row") or find("row", layer.columns)
    taken = frozenset({row} if row else ())
    plant = options.column("plant") or find("plant", layer.columns, taken)
    if isinstance(options, RecordOptions) and options.place == "plant" and plant is None:
        raise _no_plants_named(layer)
    told = options.column("plot")  # "" says that no column names a plot
    plot = find("plot", layer.columns) if told is None else told
    # where plots are known but no plants, a record is somewhere on the plot that it names
    no_plants = places.plants is None and not places.plants_of
    if plant and (row or not plot) and not (plot and places.plots and no_plants):
        return _by_plant(layer, _NamingColumns(plot, row, plant), options, places)
    if plot and places.plants is not None and not places.plots:
        return by_plant(None, layer.column(plot), places.plants)
    if plot:
        return by_plot(layer.column(plot), places)
    if half := [f"{name!r} ({role})" for role, name in options.columns if role in {"lon", "lat"}]:
        raise ChoiceNeeded(
            worded(
                "Longitudes and latitudes must both be named, but only {value} is. Name the other.",
                value=half[0],
            ),
            "columns",
            could_be_positions(layer, options),
        )
    raise ChoiceNeeded(
        worded(
            "{file} must have a column of longitudes and one of latitudes (or eastings and "
            "northings, or rows and plants), but none were recognised among: {names}. Name "
            "them.",
            file=layer.name,
            names=", ".join(layer.columns),
        ),
        "columns",
        could_be_positions(layer, options),
    )


def _no_plants_named(layer: Layer) -> FileProblem:
    """Return what to say where plants are to be taken that records do not name."""
    return FileProblem(
        worded(
            "Records must name plants if place=plant takes these, but no column of {file} was "
            "recognised as the plant among: {names}. Name it, or leave place out.",
            file=layer.name,
            names=", ".join(layer.columns),
        )
    )


def could_be_positions(layer: Layer, options: ReadOptions) -> tuple[str, ...]:
    """Return how columns of unknown name could be named: longitudes and latitudes, or plants."""
    taken = {name for _, name in options.columns}
    free = [name for name in layer.columns if name not in taken]
    roles = [role for role in ("lon", "lat") if options.column(role) is None]
    hold = [name for name in free if np.isfinite(all_degrees(layer.columns[name][:50])).any()]
    if len(hold) >= len(roles):
        return tuple(f"{role}={name}" for role in roles for name in hold)
    return tuple(f"{role}={name}" for role in ("plant", "plot") for name in free)


def _by_plant(
    layer: Layer, names: _NamingColumns, options: ReadOptions, places: NamedPlaces
) -> PlacedByName:
    """Return where records lie that name plants, on the plot that they name or on the only one."""
    if places.plants is None and not places.plants_of:
        raise _plants_needed(layer, names.plot)
    row, plant = None if names.row is None else layer.column(names.row), layer.column(names.plant)
    of_block = _block_column(layer, names, options, places)
    block = None if of_block is None else layer.column(of_block)
    if of_block is not None and of_block == names.plot:
        names = names._replace(plot=None)
    by_hand = options.plot if isinstance(options, RecordOptions) else None
    if names.plot:
        plot = layer.column(names.plot)
        if places.plants is None or plots_called({text(v) for v in plot}, places.plots):
            return by_plot_and_plant(plot, row, plant, places, block)
    elif by_hand is not None:
        plot = np.full(len(layer), by_hand, dtype=object)
        return by_plot_and_plant(plot, row, plant, places, block)
    if places.plants is None:
        raise _plants_needed(layer, names.plot)
    _check_one_plot(layer, names.plot)
    return by_plant(row, plant, places.plants, block)


def _block_column(
    layer: Layer, names: _NamingColumns, options: ReadOptions, places: NamedPlaces
) -> str | None:
    """Return the column that names blocks of plots that have several; None: there is none.

    A column that could name plots as well names these if it holds the name of one.
    """
    told = options.column("block")
    if told is not None:
        return told or None
    known = [places.plants, *places.plants_of.values()]
    if all(plants is None or plants.block is None for plants in known):
        return None
    taken = frozenset(name for name in (names.row, names.plant) if name)
    found = find("block", layer.columns, taken)
    if found is not None and found == names.plot:
        of_plots = plots_called({text(v) for v in layer.column(found)}, places.plots)
        return None if of_plots else found
    return found


def _plants_needed(layer: Layer, plot: str | None) -> ChoiceNeeded:
    """Return the question for the plants that records name, with the plots they name."""
    plots = sorted({text(v) for v in layer.column(plot)} - {""}) if plot else []
    return ChoiceNeeded(
        worded(
            "The records name plants instead of positions. Give the plants they name: the "
            "plot's own rows and numbers, or a file with their positions."
        ),
        "plants",
        tuple(plots),
    )


def _check_one_plot(layer: Layer, plot: str | None) -> None:
    """Ask for one plot: row 3, plant 7 is another place on each."""
    if not plot:
        return
    names = sorted({text(v) for v in layer.column(plot)} - {""})
    if len(names) > 1:
        raise ChoiceNeeded(
            worded(
                "Records that name rows and plants must be of one plot, but column {plot!r} "
                "names {n}: {names}. Choose the records of one of them, or say that no column "
                "names a plot: columns=plot=.",
                plot=plot,
                n=len(names),
                names=", ".join(names[:12]),
            ),
            "where",
            tuple(f"{plot}={name}" for name in names),
        )
