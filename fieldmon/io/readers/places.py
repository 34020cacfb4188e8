"""Places that records may name instead of giving a position: plots, and plants."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING, Self

import numpy as np
import shapely

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded, ObservationError
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, dropped, guessed, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.parse.values import is_missing
from fieldmon.plot.grid import block_number, nearest_plants, plant_numbers, row_in_block
from fieldmon.plot.plant_names import PlantNames

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from numpy.typing import NDArray

    from fieldmon.plot.block import Block
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

_MOST_NAMED = 12
# a measured plant is that of the grid which stands so near
_SAME_M = 0.01
# a row or a plant 0 in a name such as "0/12"
_ZERO = re.compile(r"(?:^|/)0+(?=/|$)")


@dataclass(frozen=True, eq=False)
class Plants:
    """Measured positions of plants, with what the file calls them.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees.
    row, plant
        ``(n,)`` labels of the row and of the plant; empty where the file has none.
    block
        ``(n,)`` labels of the block; None: there are none.
    also
        Other labels ``(n,)`` of blocks and of rows by which people may name the same plants, and
        whether these rows count from 1 in each block; what stands first is preferred.
    numbers
        The numbers ``(n,)`` of rows and of plants here, where their labels say more; else None.
    """

    lonlat: NDArray[np.float64]
    row: NDArray[np.str_]
    plant: NDArray[np.str_]
    block: NDArray[np.str_] | None = None
    also: tuple[tuple[NDArray[np.str_], NDArray[np.str_], bool], ...] = ()
    numbers: tuple[NDArray[np.str_], NDArray[np.str_]] | None = None

    def __post_init__(self) -> None:
        for values in (self.lonlat, self.row, self.plant):
            values.setflags(write=False)

    @property
    def names(self) -> PlantNames:
        """Return the names of rows and of plants, and those of blocks where all plants have one."""
        block = None if self.block is None or (self.block == "").any() else self.block
        row, plant = (one if (one != "").any() else None for one in (self.row, self.plant))
        return PlantNames(row, block, plant)

    def __len__(self) -> int:
        """Return the number of plants."""
        return len(self.lonlat)

    def take(self, which: NDArray[np.bool_]) -> Self:
        """Return those plants."""
        return replace(
            self,
            lonlat=self.lonlat[which],
            row=self.row[which],
            plant=self.plant[which],
            block=None if self.block is None else self.block[which],
            also=tuple((block[which], row[which], within) for block, row, within in self.also),
            numbers=None
            if self.numbers is None
            else (self.numbers[0][which], self.numbers[1][which]),
        )


@dataclass(frozen=True, eq=False)
class NamedPlaces:
    """What records may name.

    Parameters
    ----------
    plots
        A record that names one of them lies somewhere on it.
    plants
        A record that names a row and a plant, or a plant alone, lies there.
    plants_of
        The plants of plots by the plots' names, for records that name their plot too.
    """

    plots: tuple[Field, ...] = ()
    plants: Plants | None = None
    plants_of: Mapping[str, Plants] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        plots: tuple[Field, ...],
        grid: PlantGrid,
        measured: Plants | None = None,
        plot: str | None = None,
    ) -> Self:
        """Return plots by name, and the plants of one `plot` (its name, if it is one of them)."""
        own = next((known.blocks for known in plots if known.name == plot), ())
        plants = labelled(grid, measured, own)
        return cls(plots, plants, {} if plot is None else {plot: plants})


def labelled(
    grid: PlantGrid, measured: Plants | None = None, blocks: tuple[Block, ...] = ()
) -> Plants:
    """Return a plot's plants by the labels of their file, or as the grid counts.

    Of a plot of several blocks rows are counted on from block to block, and also from 1 in each;
    blocks are known by their number, and by what they were called when they were drawn.
    """
    if measured is not None and (measured.plant != "").all():
        return _numbered(measured, grid)
    numbered = np.stack(plant_numbers(grid), axis=1)
    once, first = np.unique(numbered, axis=0, return_index=True)
    lonlat, row, plant = grid.lonlat(first), *once.astype(np.str_).T
    if grid.n_blocks == 1:
        return Plants(lonlat, row, plant)
    number = block_number(grid, first).astype(np.str_)
    within = row_in_block(grid, first).astype(np.str_)
    own = [] if grid.block_named is None else [grid.block_named[block_number(grid, first) - 1]]
    known = [*own, number, *_called(lonlat, blocks)]
    ways = [(block, row, False) for block in known]
    ways += [(block, within, True) for block in known]
    return Plants(lonlat, row, plant, known[0], tuple(ways[1:]))


def _numbered(measured: Plants, grid: PlantGrid) -> Plants:
    """Return measured plants with their numbers on the plot, where their labels say more."""
    if grid.line_named is None and grid.plant_named is None:
        return measured
    plant, _ = nearest_plants(grid, measured.lonlat, _SAME_M)
    if (plant < 0).any():
        return measured
    row, number = (part.astype(np.str_) for part in plant_numbers(grid, plant))
    return replace(measured, numbers=(row, number))


def _called(lonlat: NDArray[np.float64], blocks: tuple[Block, ...]) -> list[NDArray[np.str_]]:
    """Return what the block of each plant ``(n,)`` is called, if all have names of their own."""
    names = np.array([block.name for block in blocks], dtype=np.str_)
    if len(names) == 0 or (names == "").any() or len(np.unique(names)) < len(names):
        return []
    areas = shapely.STRtree([block.area for block in blocks])
    return [names[areas.nearest(shapely.points(lonlat))]]


def plots_called(names: Iterable[str], plots: tuple[Field, ...]) -> tuple[Field, ...]:
    """Return which plots are meant by names, however these are written."""
    match, _ = _join(list(names), [plot.name for plot in plots])
    return tuple(plots[i] for i in np.unique(match[match >= 0]))


@dataclass(frozen=True, eq=False)
class PlacedByName:
    """Where records lie that name a place.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees; NaN where the name is unknown.
    accuracy_m
        ``(n,)`` how far from there the record may be; NaN where that is not known.
    messages
        What the join had to say.
    plot
        ``(n,)`` name of the plot that each is on by its own words; None where they name none.
    """

    lonlat: NDArray[np.float64]
    accuracy_m: NDArray[np.float64]
    messages: tuple[ImportMessage, ...]
    plot: NDArray[np.str_] | None = None


def by_plant(
    row: NDArray[np.object_] | None,
    plant: NDArray[np.object_],
    plants: Plants,
    block: NDArray[np.object_] | None = None,
) -> PlacedByName:
    """Return where records lie that name a plant, or a row and a plant in it, perhaps its block.

    Raise `ObservationError` where rows of several blocks have the names they give, and they name
    no block.
    """
    parts: list[tuple[NDArray[np.str_], ...]]
    if row is None:
        wanted, parts = _names(plant), [(plants.plant,)]
    elif plants.block is None or block is None:
        wanted, parts = _both(row, plant), [(plants.row, plants.plant)]
        if plants.numbers is not None:  # names of rows may stand beside numbers of plants
            named = (plants.row, plants.plant)
            parts = list(product(*zip(named, plants.numbers, strict=True)))
    else:
        wanted = _both(block, row, plant)
        ways = [(plants.block, plants.row), *((b, r) for b, r, _ in plants.also)]
        parts = [(b, r, plants.plant) for b, r in ways]
    known = [["/".join(names) for names in zip(*part, strict=True)] for part in parts]
    if plants.block is not None and block is None and len(set(known[0])) < len(known[0]):
        raise ObservationError(_which_block(plants))
    joined = [_join(wanted, names) for names in known]
    # of ways that place as many, one that compares them as they are
    best = int(np.argmax([2 * np.count_nonzero(match >= 0) + (not how) for match, how in joined]))
    match, how = joined[best]
    _refuse_from_zero(wanted, match, known[best])
    lonlat = np.where(match[:, None] >= 0, plants.lonlat[match], np.nan)
    about = _about_blocks(plants, best, row, block) if (match >= 0).any() else []
    messages = (*how, *about, *_unmatched(wanted, match, "plant"))
    return PlacedByName(lonlat, np.full(len(wanted), np.nan), messages)


def _refuse_from_zero(wanted: list[str], match: NDArray[np.int64], known: list[str]) -> None:
    """Refuse records of a row or plant 0 where the plot has none: all may be one off."""
    if (match < 0).all() or any(_ZERO.search(name) for name in known):
        return
    zero = [name for name, at in zip(wanted, match, strict=True) if at < 0 and _ZERO.search(name)]
    if zero:
        raise ObservationError(
            worded(
                "Rows and plants of this plot are counted from 1, but {n} "
                "{n:record says|records say} 0: {some}. "
                "Add 1 to all where they were counted from 0; else leave these out.",
                n=len(zero),
                some=first_few(sorted(set(zero)), _MOST_NAMED),
            )
        )


def _both(*columns: NDArray[np.object_]) -> list[str]:
    """Return one name of several, empty where one of them is missing."""
    parts = zip(*(_names(column) for column in columns), strict=True)
    return ["/".join(names) if all(names) else "" for names in parts]


def _which_block(plants: Plants) -> str:
    names = [] if plants.block is None else sorted(set(plants.block.tolist()))
    return worded(
        "Records must name the block of their plants, since each of {n} blocks ({names}) has rows "
        "of the same names. Give them a column of blocks, or positions.",
        n=len(names),
        names=first_few(names, _MOST_NAMED),
    )


def _about_blocks(
    plants: Plants,
    way: int,
    row: NDArray[np.object_] | None,
    block: NDArray[np.object_] | None,
) -> list[ImportMessage]:
    """Return how rows of several blocks were counted."""
    if row is None or not plants.also:
        return []
    if block is not None:
        if way and plants.also[way - 1][2]:
            return [guessed(worded("Rows were taken as counted from 1 in each block."))]
        return [guessed(worded("Rows were taken as counted on from block to block."))]
    said = worded(
        "{n} {n:record names|records name} no block: {n:its row was|their rows were} taken as "
        "counted on from block to block, 1 "
        "to {last}. Where each block counts its rows from 1, give a column of blocks.",
        n=len(row),
        last=len(set(plants.row.tolist())),
    )
    return [guessed(said)]


def by_plot_and_plant(
    plot: NDArray[np.object_],
    row: NDArray[np.object_] | None,
    plant: NDArray[np.object_],
    places: NamedPlaces,
    block: NDArray[np.object_] | None = None,
) -> PlacedByName:
    """Return where records lie that name a plot, and a row and a plant on it.

    Records on plots whose plants are not known have no place: they are not asked for.
    """
    names = [known.name for known in places.plots]
    wanted = _names(plot)
    match, how = _join(wanted, names)
    lonlat = np.full((len(wanted), 2), np.nan)
    of = np.array([names[i] if i >= 0 else "" for i in match], dtype=np.str_)
    messages = [*how, *_unmatched(wanted, match, "plot"), *_elsewhere(of, places)]
    for name, plants in places.plants_of.items():
        which = of == name
        if not which.any():
            continue
        own_row, own_block = (None if c is None else c[which] for c in (row, block))
        there = by_plant(own_row, plant[which], plants, own_block)
        lonlat[which] = there.lonlat
        about = name if len(places.plants_of) > 1 else None
        messages += [replace(message, feature=about) for message in there.messages]
    return PlacedByName(lonlat, np.full(len(wanted), np.nan), tuple(messages), of)


def _elsewhere(plot: NDArray[np.str_], places: NamedPlaces) -> list[ImportMessage]:
    """Return what to say of records on plots that are known, but not their plants."""
    others = [name for name in plot.tolist() if name and name not in places.plants_of]
    return [dropped(of_other_plots(others))] if others else []


def of_other_plots(others: list[str]) -> str:
    """Return what to say of records that name other plots."""
    named = sorted(set(others))
    return worded(
        "{n} {n:record is|records are} of {plots} other {plots:plot|plots}: {names}.",
        n=len(others),
        plots=len(named),
        names=first_few(named, _MOST_NAMED),
    )


def by_plot(names: NDArray[np.object_], places: NamedPlaces) -> PlacedByName:
    """Return where records lie that name a plot: at its middle, as far off as the plot is wide."""
    if not places.plots:
        raise ChoiceNeeded(
            worded(
                "The records name plots instead of positions. Give the file with the plots "
                "they name."
            ),
            "plots",
        )
    wanted = _names(names)
    match, how = _join(wanted, [field.name for field in places.plots])
    middle = shapely.get_coordinates(
        [shapely.point_on_surface(field.boundary) for field in places.plots]
    )
    reach = np.array([np.sqrt(area_m2(field.boundary) / np.pi) for field in places.plots])
    there = match >= 0
    lonlat = np.where(there[:, None], middle[match], np.nan)
    accuracy = np.where(there, reach[match], np.nan)
    said = seen(
        worded(
            "{n} {n:record names a plot and lies|records name a plot and lie} somewhere on it: "
            "{n:it was|they were} put at its "
            "middle, with the plot's radius as their accuracy.",
            n=int(there.sum()),
        )
    )
    return PlacedByName(lonlat, accuracy, (*how, said, *_unmatched(wanted, match, "plot")))


def _names(column: NDArray[np.object_]) -> list[str]:
    return ["" if is_missing(value) else text(value) for value in column]


def _join(wanted: list[str], known: list[str]) -> tuple[NDArray[np.int64], list[ImportMessage]]:
    """Return which known name each wanted one is, -1 for none, and how they were compared.

    Names are compared as they are, or as numbers where more are known so (03 and 3.0 are 3); else
    without capitals, spaces and marks; else by their digits alone, if those tell all of them apart.
    """
    most, best, said = 0, np.full(len(wanted), -1), ""
    for key, how in _KEYS:
        keys = [key(name) for name in known]
        if len(set(keys)) < len(keys) or not all(keys) or (most and key is not _as_numbers):
            continue
        index = {k: i for i, k in enumerate(keys)}
        match = np.array([index.get(key(name), -1) if name else -1 for name in wanted], dtype=int)
        if int((match >= 0).sum()) > most:
            most, best, said = int((match >= 0).sum()), match, how
    return best, [guessed(worded("Names were compared {how}.", how=said))] if said else []


def _as_numbers(name: str) -> str:
    return "/".join(_WHOLE.sub(r"\1", part.strip()) for part in name.split("/"))


def _digits(name: str) -> str:
    return "".join(re.findall(r"\d", name))


#: a whole number as tables write it: with zeros in front, or with a point behind
_WHOLE = re.compile(r"^0*(\d+)(?:\.0)?$")
_KEYS: tuple[tuple[Callable[[str], str], str], ...] = (
    (str.strip, ""),
    (_as_numbers, "as numbers: 03 and 3.0 are 3"),
    (plain, "without capitals, spaces and marks"),
    (_digits, "by their digits alone"),
)


def _unmatched(wanted: list[str], match: NDArray[np.int64], what: str) -> list[ImportMessage]:
    missing = [name for name, found in zip(wanted, match, strict=True) if found < 0]
    named = sorted({name for name in missing if name})
    messages = []
    if named:
        n = sum(bool(name) for name in missing)
        messages.append(
            dropped(
                worded(
                    "{n} {n:record names|records name} {total} {what}{total:|s} not known: {some}.",
                    n=n,
                    total=len(named),
                    what=what,
                    some=first_few(named, _MOST_NAMED),
                )
            )
        )
    if len(missing) > sum(bool(name) for name in missing):
        n = sum(not name for name in missing)
        messages.append(
            dropped(worded("{n} {n:record names|records name} no {what} at all.", n=n, what=what))
        )
    return messages
