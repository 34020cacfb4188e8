"""Maps of plants in rows and columns, each infested or not, from text tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import FileProblem, ObservationError
from fieldmon.io.formats.layer import text
from fieldmon.io.formats.tables import read_text_table
from fieldmon.io.options import ReadOptions
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.travel import Aisles

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer

_CLEAN = frozenset({"", "0", "n", "no", "na", "nan", "none"})
_MOST_PLANTS = 1_000_000


@dataclass(frozen=True, eq=False)
class PlantMap:
    """A mapped plot, every plant's state at one date or several.

    Parameters
    ----------
    name
        What it is called.
    dates
        ``(d,)`` as the file writes them, in order.
    infested
        ``(d, n)`` plants row by row.
    n_rows, n_plants
        Rows, and plants in each.
    row_m, plant_m
        Distances between rows and between plants.
    """

    name: str
    dates: tuple[str, ...]
    infested: NDArray[np.bool_]
    n_rows: int
    n_plants: int
    row_m: float
    plant_m: float

    def __post_init__(self) -> None:
        shape = (len(self.dates), self.n_rows * self.n_plants)
        if self.infested.shape != shape:
            raise ObservationError(
                f"The map {self.name} must have one entry a plant and date {shape}, "
                f"but it has {self.infested.shape}."
            )

    def aisles(self) -> Aisles:
        """Return its plants and the ways between them."""
        planting = Planting(row_spacing_m=self.row_m, plant_spacing_m=self.plant_m)
        return Aisles.of(rectangle(self.n_rows, self.n_plants, planting))


@dataclass(frozen=True)
class MapColumns:
    """Which columns of a map file hold what, and how far its plants stand apart.

    Parameters
    ----------
    row, plant, state
        Number of the row, number of the plant in it, and its state (0, N or NA: not infested).
    row_m, plant_m
        Distances between rows and between plants.
    date, part
        The date or time, and which of several plots; empty: the file has one.
    """

    row: str
    plant: str
    state: str
    row_m: float
    plant_m: float
    date: str = ""
    part: str = ""


PUBLIC_MAPS = {
    # distances as published with the data
    "citrus_ctv_IVI3and4.csv": MapColumns("y", "x", "i", 6.0, 2.0, date="t"),
    "hop_viruses_HpLV.csv": MapColumns("x", "y", "i", 2.1, 1.8, date="t"),
    # the distances of these are ours: our source gives none
    "gumpertz.pepper.txt": MapColumns("row", "quadrat", "disease", 1.0, 1.0, part="field"),
    "beall.webworms.txt": MapColumns("row", "col", "y", 1.0, 1.0),
    "DidymellaWatermelon.csv": MapColumns("EW_row", "NS_col", "severity", 2.0, 1.0, date="dap"),
}
"""Public maps by file name."""


def read_plant_maps(folder: Path) -> list[PlantMap]:
    """Return the maps of a folder and its folders, by file name; raise `FileProblem` if none."""
    if not folder.is_dir():
        raise FileProblem(f"The folder of maps {folder} must exist, but it does not.")
    files = sorted(path for path in folder.rglob("*") if path.name in PUBLIC_MAPS)
    if not files:
        raise FileProblem(
            f"The folder {folder} must hold a map of plants, one of {', '.join(PUBLIC_MAPS)}, "
            "but it holds none."
        )
    return [each for path in files for each in read_plant_map(path, PUBLIC_MAPS[path.name])]


def read_plant_map(path: Path, columns: MapColumns) -> list[PlantMap]:
    """Return the plots of one file, each with all its dates."""
    try:
        layer = read_text_table(path, path.name, ReadOptions())
    except OSError as error:
        raise FileProblem(f"{path} must be readable, but it is not ({error.strerror}).") from error
    needed = [name for name in vars(columns).values() if isinstance(name, str) and name]
    missing = [name for name in needed if name not in layer.columns]
    if missing:
        raise FileProblem(
            f"{path.name} must have the columns {', '.join(needed)}, "
            f"but {', '.join(missing)} is missing."
        )
    parts = _texts(layer, columns.part)
    named = path.stem if columns.part == "" else f"{path.stem} "
    return [
        _map(named + part, layer.take(parts == part), columns, path.name)
        for part in np.unique(parts).tolist()
    ]


def _map(name: str, layer: Layer, columns: MapColumns, file: str) -> PlantMap:
    row, plant = (_numbers(layer, column, file) for column in (columns.row, columns.plant))
    dates, date = np.unique(_texts(layer, columns.date), return_inverse=True)
    n_rows, n_plants = int(row.max()), int(plant.max())
    if n_rows * n_plants > _MOST_PLANTS:
        raise FileProblem(
            f"{file} must map {_MOST_PLANTS} plants at most, but it has {n_rows} rows of "
            f"{n_plants}."
        )
    infested = np.zeros((len(dates), n_rows * n_plants), np.bool_)
    state = np.array([value.lower() not in _CLEAN for value in _texts(layer, columns.state)])
    infested[date, (row - 1) * n_plants + plant - 1] = state
    order = sorted(range(len(dates)), key=lambda k: (len(dates[k]), dates[k]))
    return PlantMap(
        name=name,
        dates=tuple(str(dates[k]) for k in order),
        infested=infested[order],
        n_rows=n_rows,
        n_plants=n_plants,
        row_m=columns.row_m,
        plant_m=columns.plant_m,
    )


def _texts(layer: Layer, column: str) -> NDArray[np.str_]:
    if column == "":
        return np.full(len(layer), "")
    return np.array([text(value) for value in layer.columns[column]])


def _numbers(layer: Layer, column: str, file: str) -> NDArray[np.int64]:
    try:
        numbers = np.array([int(text(value)) for value in layer.columns[column]], np.int64)
    except ValueError as error:
        raise FileProblem(
            f"The column {column} of {file} must hold whole numbers, but {error}."
        ) from error
    if not numbers.size or numbers.min() < 1:
        raise FileProblem(f"The column {column} of {file} must count plants from 1.")
    return numbers
