"""Places that records may name instead of giving a position: plots, and plants."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np
import shapely

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, dropped, guessed, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.parse.values import is_missing
from fieldmon.plot.grid import row_label

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

_MOST_NAMED = 12


@dataclass(frozen=True, eq=False)
class Plants:
    """Measured positions of plants, with what the file calls them.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees.
    row, plant
        ``(n,)`` labels of the row and of the plant; empty where the file has none.
    """

    lonlat: NDArray[np.float64]
    row: NDArray[np.str_]
    plant: NDArray[np.str_]

    def __post_init__(self) -> None:
        for values in (self.lonlat, self.row, self.plant):
            values.setflags(write=False)

    def __len__(self) -> int:
        """Return the number of plants."""
        return len(self.lonlat)


@dataclass(frozen=True, eq=False)
class Places:
    """What records may name.

    Parameters
    ----------
    plots
        A record that names one of them lies somewhere on it.
    plants
        A record that names a row and a plant, or a plant alone, lies there.
    """

    plots: tuple[Field, ...] = ()
    plants: Plants | None = None

    @classmethod
    def of(cls, plots: tuple[Field, ...], grid: PlantGrid, measured: Plants | None = None) -> Self:
        """Return plots by name, and plants by the labels of their file or as the grid counts."""
        if measured is not None and (measured.plant != "").all():
            return cls(plots, measured)
        label = np.stack(row_label(grid), axis=1)
        once, first = np.unique(label, axis=0, return_index=True)
        names = once.astype(np.str_)
        return cls(plots, Plants(grid.lonlat(first), names[:, 0], names[:, 1]))


@dataclass(frozen=True, eq=False)
class Named:
    """Where records lie that name a place.

    Parameters
    ----------
    lonlat
        ``(n, 2)`` degrees; NaN where the name is unknown.
    accuracy_m
        ``(n,)`` how far from there the record may be; NaN where that is not known.
    findings
        What the join had to say.
    """

    lonlat: NDArray[np.float64]
    accuracy_m: NDArray[np.float64]
    messages: tuple[ImportMessage, ...]


def by_plant(row: NDArray[np.object_] | None, plant: NDArray[np.object_], places: Places) -> Named:
    """Return where records lie that name a plant, or a row and a plant in it."""
    plants = places.plants
    if plants is None:
        raise ChoiceNeeded(
            "The records name plants instead of positions. Give the plants they name: the plot's "
            "own rows and numbers, or a file with their positions.",
            "places",
        )
    if row is None:
        known, wanted = list(plants.plant), _names(plant)
    else:
        known = [f"{r}/{p}" for r, p in zip(plants.row, plants.plant, strict=True)]
        both = zip(_names(row), _names(plant), strict=True)
        wanted = [f"{r}/{p}" if r and p else "" for r, p in both]
    match, how = _join(wanted, known)
    lonlat = np.where(match[:, None] >= 0, plants.lonlat[match], np.nan)
    messages = (*how, *_unmatched(wanted, match, "plant"))
    return Named(lonlat, np.full(len(wanted), np.nan), messages)


def by_plot(names: NDArray[np.object_], places: Places) -> Named:
    """Return where records lie that name a plot: at its middle, as far off as the plot is wide."""
    if not places.plots:
        raise ChoiceNeeded(
            "The records name plots instead of positions. Give the file with the plots they name.",
            "places",
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
        f"{int(there.sum())} record(s) name a plot and lie somewhere on it: they were put at its "
        "middle, with the plot's radius as their accuracy."
    )
    return Named(lonlat, accuracy, (*how, said, *_unmatched(wanted, match, "plot")))


def _names(column: NDArray[np.object_]) -> list[str]:
    return ["" if is_missing(value) else text(value) for value in column]


def _join(wanted: list[str], known: list[str]) -> tuple[NDArray[np.int64], list[ImportMessage]]:
    """Return which known name each wanted one is, -1 for none, and how they were compared.

    Names are compared as they are; else without capitals, spaces and marks; else by their digits
    alone, if those tell all of them apart.
    """
    for key, how in _KEYS:
        keys = [key(name) for name in known]
        if len(set(keys)) < len(keys) or not all(keys):
            continue
        index = {k: i for i, k in enumerate(keys)}
        match = np.array([index.get(key(name), -1) if name else -1 for name in wanted], dtype=int)
        if (match >= 0).any():
            return match, [guessed(f"Names were compared {how}.")] if how else []
    return np.full(len(wanted), -1), []


def _digits(name: str) -> str:
    return "".join(re.findall(r"\d", name))


_KEYS: tuple[tuple[Callable[[str], str], str], ...] = (
    (str.strip, ""),
    (plain, "without capitals, spaces and marks"),
    (_digits, "by their digits alone"),
)


def _unmatched(wanted: list[str], match: NDArray[np.int64], what: str) -> list[ImportMessage]:
    missing = [name for name, found in zip(wanted, match, strict=True) if found < 0]
    named = sorted({name for name in missing if name})
    messages = []
    if named:
        shown = ", ".join(named[:_MOST_NAMED]) + (", ..." if len(named) > _MOST_NAMED else "")
        n = sum(bool(name) for name in missing)
        messages.append(
            dropped(f"{n} record(s) name {len(named)} {what}(s) that are not known: {shown}.")
        )
    if len(missing) > sum(bool(name) for name in missing):
        n = sum(not name for name in missing)
        messages.append(dropped(f"{n} record(s) name no {what} at all."))
    return messages
