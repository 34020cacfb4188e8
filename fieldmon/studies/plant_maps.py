"""Maps of plants in rows and columns, each infested or not, from text tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import FileProblem
from fieldmon.io.formats.layer import text
from fieldmon.io.formats.tables import read_text_table
from fieldmon.io.options import ReadOptions
from fieldmon.studies.thesis.chapter5.mapped_plots import PlantMap

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer

_CLEAN = frozenset({"", "0", "n", "no", "na", "nan", "none"})
_MOST_PLANTS = 1_000_000


@dataclass(frozen=True)
class Layout:
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


LAYOUTS = {
    # distances as published with the data
    "citrus_ctv_IVI3and4.csv": Layout("y", "x", "i", 6.0, 2.0, date="t"),
    "hop_viruses_HpLV.csv": Layout("x", "y", "i", 2.1, 1.8, date="t"),
    # the distances of these are ours: our source gives none
    "gumpertz.pepper.txt": Layout("row", "quadrat", "disease", 1.0, 1.0, part="field"),
    "beall.webworms.txt": Layout("row", "col", "y", 1.0, 1.0),
    "DidymellaWatermelon.csv": Layout("EW_row", "NS_col", "severity", 2.0, 1.0, date="dap"),
}
"""Public maps by file name."""


def read_plant_maps(folder: Path) -> list[PlantMap]:
    """Return the maps of a folder and its folders, by file name; raise `FileProblem` if none."""
    if not folder.is_dir():
        raise FileProblem(f"The folder of maps {folder} must exist, but it does not.")
    files = sorted(path for path in folder.rglob("*") if path.name in LAYOUTS)
    if not files:
        raise FileProblem(
            f"The folder {folder} must hold a map of plants, one of {', '.join(LAYOUTS)}, "
            "but it holds none."
        )
    return [each for path in files for each in read_plant_map(path, LAYOUTS[path.name])]


def read_plant_map(path: Path, layout: Layout) -> list[PlantMap]:
    """Return the plots of one file, each with all its dates."""
    try:
        layer = read_text_table(path, path.name, ReadOptions())
    except OSError as error:
        raise FileProblem(f"{path} must be readable, but it is not ({error.strerror}).") from error
    needed = [name for name in vars(layout).values() if isinstance(name, str) and name]
    missing = [name for name in needed if name not in layer.columns]
    if missing:
        raise FileProblem(
            f"{path.name} must have the columns {', '.join(needed)}, "
            f"but {', '.join(missing)} is missing."
        )
    parts = _texts(layer, layout.part)
    named = path.stem if layout.part == "" else f"{path.stem} "
    return [
        _map(named + part, layer.take(parts == part), layout, path.name)
        for part in np.unique(parts).tolist()
    ]


def _map(name: str, layer: Layer, layout: Layout, file: str) -> PlantMap:
    row, plant = (_numbers(layer, column, file) for column in (layout.row, layout.plant))
    dates, date = np.unique(_texts(layer, layout.date), return_inverse=True)
    n_rows, n_plants = int(row.max()), int(plant.max())
    if n_rows * n_plants > _MOST_PLANTS:
        raise FileProblem(
            f"{file} must map {_MOST_PLANTS} plants at most, but it has {n_rows} rows of "
            f"{n_plants}."
        )
    infested = np.zeros((len(dates), n_rows * n_plants), np.bool_)
    state = np.array([value.lower() not in _CLEAN for value in _texts(layer, layout.state)])
    infested[date, (row - 1) * n_plants + plant - 1] = state
    order = sorted(range(len(dates)), key=lambda k: (len(dates[k]), dates[k]))
    return PlantMap(
        name=name,
        dates=tuple(str(dates[k]) for k in order),
        infested=infested[order],
        n_rows=n_rows,
        n_plants=n_plants,
        row_m=layout.row_m,
        plant_m=layout.plant_m,
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
