"""Maps of plants in rows and columns, each infested or not, from text tables."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import first_few
from fieldmon.errors import FileProblem, ObservationError
from fieldmon.infestation.records import PRESENT, UNKNOWN
from fieldmon.io.formats.layer import text
from fieldmon.io.formats.tables import read_text_table
from fieldmon.io.options import ReadOptions, RecordOptions
from fieldmon.io.parse.dates import dates
from fieldmon.io.parse.result_words import MAYBE_GONE, ResultWords, plain_word
from fieldmon.io.parse.values import decimal_mark, is_missing, number, numbers
from fieldmon.io.readers.inspection_file.results import result_of
from fieldmon.io.readers.known_rows import VERY_FAR_M
from fieldmon.plot.layout import rectangle
from fieldmon.plot.missing_plants import without
from fieldmon.plot.planting import PLANTED, Planting
from fieldmon.plot.travel import Aisles

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer

_MOST_PLANTS = 1_000_000
# so many cells or files are named
_SHOWN, _NAMED = 3, 5
# files that may have been meant as maps
_TABLES = frozenset({".csv", ".tsv", ".txt", ".xls", ".xlsx", ".ods"})
# a day and a month without a year: as a number, 30.4 comes after 1.6
_DAY_AND_MONTH = re.compile(r"(\d{1,2})\.(\d{1,2})")
_DOTTED = re.compile(r"\d{1,2}\.\d{1,2}\.\d{2}")
_DAYS, _MONTHS = 31, 12


@dataclass(frozen=True, eq=False)
class PlantMap:
    """A mapped plot, every plant's state at one date or several.

    Parameters
    ----------
    name
        What it is called: its file in the folder of maps without the ending, and its part.
    dates
        ``(d,)`` the earliest first: numbers as the file writes them, days as 2026-11-18.
    infested
        ``(d, n)`` plants row by row.
    known
        ``(d, n)`` of which plants the state is known; others may not stand there at all.
    n_rows, n_plants
        Rows, and plants in each.
    row_m, plant_m
        Distances between rows and between plants.
    """

    name: str
    dates: tuple[str, ...]
    infested: NDArray[np.bool_]
    known: NDArray[np.bool_]
    n_rows: int
    n_plants: int
    row_m: float
    plant_m: float

    def __post_init__(self) -> None:
        shape = (len(self.dates), self.n_rows * self.n_plants)
        for entries in (self.infested, self.known):
            if entries.shape != shape:
                raise ObservationError(
                    f"The map {self.name} must have one entry a plant and date {shape}, "
                    f"but it has {entries.shape}."
                )

    def name_on(self, date: str) -> str:
        """Return what it is called on one of its dates."""
        return f"{self.name} {date}".rstrip()

    def aisles(self, stand: NDArray[np.bool_] | None = None) -> Aisles:
        """Return its plants, or those that `stand` ``(n,)``, and the ways between them."""
        planting = Planting(row_spacing_m=self.row_m, plant_spacing_m=self.plant_m)
        whole = rectangle(self.n_rows, self.n_plants, planting)
        return Aisles.of(whole if stand is None or stand.all() else without(whole, ~stand))


@dataclass(frozen=True)
class MapColumns:
    """Which columns of a map file hold what, and how far its plants stand apart.

    Parameters
    ----------
    row, plant, state
        Number of the row, number of the plant in it, and its state: a count or a severity, or a
        word for infested or clean, as in records. Of NA, an empty cell and a plant that is gone
        the state is unknown.
    row_m, plant_m
        Distances between rows and between plants.
    date, part
        When it was (a number, or 2026-11-18), and which of several plots; empty: the file has one.
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
# what a map of one's own must be called, and has to hold
_OWN_ENDING, _OWN_COLUMNS = ".map.csv", ("row", "plant", "infested", "row_m", "plant_m")

# which setting of a planting each distance is
_SPACING_OF = {"row_m": "row_spacing_m", "plant_m": "plant_spacing_m"}


def read_plant_maps(folder: Path, public: Collection[str] = tuple(PUBLIC_MAPS)) -> list[PlantMap]:
    """Return the maps of a folder and its folders, by file name.

    Raise `FileProblem` if there is none, or two have one name.

    Read are the `public` maps, and maps of one's own: tables ``NAME.map.csv`` with the columns row,
    plant, infested, row_m and plant_m (the distances in metres), and date and plot where there are
    several.
    """
    if not folder.is_dir():
        but = "is a file" if folder.exists() else "does not exist"
        raise FileProblem(f"Maps must be in a folder that exists, but {folder} {but}.")
    files = sorted(path for path in folder.rglob("*") if _is_map(path, public))
    if not files:
        raise FileProblem(
            f"The folder {folder} must hold a map of plants, one of {', '.join(public)}, or one of "
            f"your own: NAME{_OWN_ENDING} with the columns {', '.join(_OWN_COLUMNS)} (and date and "
            "plot if there are several). But it holds none."
        )
    maps = []
    for path in files:
        if path.name.casefold() == _OWN_ENDING:
            raise FileProblem(
                f"A map must have a name, as NAME{_OWN_ENDING}, but {path} has none. Give it one."
            )
        maps += read_plant_map(path, _columns_of(path), str(path.relative_to(folder).as_posix()))
    _must_differ(each.name_on(date) for each in maps for date in each.dates)
    return maps


def not_read(folder: Path, public: Collection[str] = tuple(PUBLIC_MAPS)) -> str:
    """Return which tables of a folder `read_plant_maps` passes over, in a sentence; "": none."""
    names = sorted(
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.suffix.casefold() in _TABLES and path.is_file() and not _is_map(path, public)
    )
    if not names:
        return ""
    return (
        f"Not read as {'a map' if len(names) == 1 else 'maps'}: {first_few(names, _NAMED)} "
        f"({len(names)}). A map of your own is called NAME{_OWN_ENDING}."
    )


def _is_map(path: Path, public: Collection[str]) -> bool:
    return path.name in public or path.name.casefold().endswith(_OWN_ENDING)


def _must_differ(names: Iterable[str]) -> None:
    """Raise `FileProblem` unless each map and date has a name of its own."""
    name, times = Counter(names).most_common(1)[0]
    if times > 1:
        raise FileProblem(
            f"The maps of a folder must have different names, of file, plot and date, but {times} "
            f"are called {name!r}. Give one of the files another name."
        )


def _columns_of(path: Path) -> MapColumns:
    """Return the columns of a public map, or of one's own."""
    if path.name in PUBLIC_MAPS:
        return PUBLIC_MAPS[path.name]
    layer = _table(path, (*_OWN_COLUMNS, "date", "plot"))
    missing = [name for name in _OWN_COLUMNS if name not in layer.columns]
    if missing:
        raise FileProblem(
            f"{path.name} must have the columns {', '.join(_OWN_COLUMNS)}, but "
            f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing."
        )
    row_m, plant_m = (_distance(layer, name, path.name) for name in _OWN_COLUMNS[3:])
    date, part = (name if name in layer.columns else "" for name in ("date", "plot"))
    return MapColumns("row", "plant", "infested", row_m, plant_m, date, part)


def _distance(layer: Layer, column: str, file: str) -> float:
    """Return a distance, which is the same in each line."""
    read = numbers(layer.columns[column])
    value = float(read[0]) if len(read) and (read == read[0]).all() else float("nan")
    if not 0.0 < value < float("inf"):
        cells = sorted({text(cell) for cell in layer.columns[column]})[:3]
        raise FileProblem(
            f"The column {column} of {file} must hold one distance in metres, the same in each "
            f"line, but it holds {', '.join(cell or 'an empty cell' for cell in cells)}."
        )
    rule = PLANTED[_SPACING_OF[column]].broken(value)
    if rule or value > VERY_FAR_M:
        raise FileProblem(
            f"The column {column} of {file} must be {rule or f'{VERY_FAR_M:g} metres at most'}, "
            f"but it is {value:g}. Write it in metres: 2.5, not 250."
        )
    return value


def _table(path: Path, wanted: Iterable[str]) -> Layer:
    """Return the table of a file; its columns are called as `wanted`, in whatever case they are."""
    try:
        layer = read_text_table(path, path.name, ReadOptions())
        lower = {name.casefold(): name for name in wanted if name not in layer.columns}
        names = {name: lower.pop(name.casefold(), name) for name in layer.columns}
        return replace(layer, columns={names[name]: cells for name, cells in layer.columns.items()})
    except OSError as error:
        raise FileProblem(f"{path} must be readable, but it is not ({error.strerror}).") from error


def read_plant_map(path: Path, columns: MapColumns, file: str = "") -> list[PlantMap]:
    """Return the plots of one file, each with all its dates.

    `file` is where it lies in the folder of maps, by which they are called; "": its name.
    """
    needed = [name for name in vars(columns).values() if isinstance(name, str) and name]
    layer = _table(path, needed)
    missing = [name for name in needed if name not in layer.columns]
    if missing:
        raise FileProblem(
            f"{path.name} must have the columns {', '.join(needed)}, "
            f"but {', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing."
        )
    parts = _texts(layer, columns.part)
    name = file or path.name
    is_own = name.casefold().endswith(_OWN_ENDING)
    stem = name[: -len(_OWN_ENDING)] if is_own else name.removesuffix(path.suffix)
    named = stem if columns.part == "" else f"{stem} "
    return [
        _map(named + part, layer.take(parts == part), columns, path.name)
        for part in np.unique(parts).tolist()
    ]


def _map(name: str, layer: Layer, columns: MapColumns, file: str) -> PlantMap:
    row, plant = (_numbers(layer, column, file) for column in (columns.row, columns.plant))
    when, date = _dates(_texts(layer, columns.date), file, columns.date)
    n_rows, n_plants = int(row.max()), int(plant.max())
    if n_rows * n_plants > _MOST_PLANTS:
        raise FileProblem(
            f"{file} must map {_MOST_PLANTS} plants at most, but it has {n_rows} rows of "
            f"{n_plants}."
        )
    infested = np.zeros((len(when), n_rows * n_plants), np.bool_)
    known = np.zeros_like(infested)
    at = date, (row - 1) * n_plants + plant - 1
    lines = np.zeros(infested.shape, np.int64)
    np.add.at(lines, at, 1)
    if (lines != 1).any():
        on, which = np.argwhere(lines != 1)[0]
        raise FileProblem(
            f"{file} must have one line for each of its {n_rows} rows of {n_plants} plants"
            f"{' and each date' if columns.date else ''}, but row {which // n_plants + 1}, plant "
            f"{which % n_plants + 1}{f' on {when[on]}' if columns.date else ''} has "
            f"{lines[on, which]}. Write NA as the state of a plant that nobody knows of, or that "
            "is not there."
        )
    infested[at], known[at] = _states(_texts(layer, columns.state).tolist(), columns.state, file)
    return PlantMap(
        name=name,
        dates=when,
        infested=infested,
        known=known,
        n_rows=n_rows,
        n_plants=n_plants,
        row_m=columns.row_m,
        plant_m=columns.plant_m,
    )


def _dates(
    cells: NDArray[np.str_], file: str, column: str
) -> tuple[tuple[str, ...], NDArray[np.intp]]:
    """Return the dates, the earliest first, and which of them each cell is.

    Numbers as years or days, or days of a calendar as records have them.
    """
    distinct, which = np.unique(cells, return_inverse=True)
    if len(distinct) == 1:  # of a single one there is no order
        return (str(distinct[0]),), which
    times = np.array([number(each) for each in distinct.tolist()])
    if np.isfinite(times).all():
        _must_be_numbers(distinct.tolist(), times, file, column)
    else:
        dotted = all(_DOTTED.match(cell) for cell in distinct.tolist())  # nobody dots a month first
        read = dates(distinct.astype(object), "dmy" if dotted else None)
        if np.isnat(read.day).any() or read.is_ambiguous or read.n_mixed:
            raise FileProblem(
                f"The column {column} of {file} must tell the order of its maps by numbers (as "
                f"years, or days) or dates as 2026-11-18, but it holds {_some(distinct.tolist())}."
            )
        days, of = np.unique(read.day, return_inverse=True)
        return tuple(days.astype(str).tolist()), of[which]
    order = np.argsort(times, kind="stable")
    return tuple(distinct[order].tolist()), np.argsort(order)[which]


def _must_be_numbers(cells: list[str], times: NDArray[np.float64], file: str, column: str) -> None:
    """Raise `FileProblem` if cells may be days of a year that are in another order as numbers."""
    parts = [_DAY_AND_MONTH.fullmatch(cell) for cell in cells]
    for day, month in ((1, 2), (2, 1)):
        as_days = [(int(p[month]), int(p[day])) for p in parts if p is not None]
        if len(as_days) < len(cells) or not all(
            1 <= m <= _MONTHS and 1 <= d <= _DAYS for m, d in as_days
        ):
            continue
        if np.argsort(times).tolist() != sorted(range(len(cells)), key=as_days.__getitem__):
            raise FileProblem(
                f"The column {column} of {file} must tell the order of its maps, but "
                f"{_some(cells)} may be numbers, or days and months without a year. Write "
                "2026-04-30 for days, and numbers without a point."
            )


def _some(cells: list[str]) -> str:
    return first_few([cell or "an empty cell" for cell in cells], _SHOWN)


def _states(
    cells: list[str], column: str, file: str
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which plants are infested, and of which it is known, as records say it."""
    words, mark = ResultWords(cells, RecordOptions()), decimal_mark(cells) or "."
    said = {}
    for cell in set(cells):
        read = result_of(cell, mark, words)
        if not (read.is_read or is_missing(cell) or plain_word(cell) in MAYBE_GONE):
            raise FileProblem(
                f"The column {column} of {file} must say of each plant whether it is infested: a "
                f"number from 0, a word as yes or clean, or NA; but it holds {cell!r}."
            )
        said[cell] = read.result
    results = np.array([said[cell] for cell in cells])
    return results == PRESENT, results != UNKNOWN


def _texts(layer: Layer, column: str) -> NDArray[np.str_]:
    if column == "":
        return np.full(len(layer), "")
    return np.array([text(value) for value in layer.columns[column]])


def _numbers(layer: Layer, column: str, file: str) -> NDArray[np.int64]:
    numbers = np.array([number(text(value)) for value in layer.columns[column]])
    whole = (numbers >= 1.0) & (numbers <= _MOST_PLANTS) & (numbers == np.round(numbers))
    if not whole.all():
        wrong = text(layer.columns[column][np.argmin(whole)])
        raise FileProblem(
            f"The column {column} of {file} must count rows or plants, with whole numbers from 1 "
            f"to {_MOST_PLANTS}, but it holds {wrong!r}. Positions in metres or degrees are no "
            "such numbers."
        )
    return numbers.astype(np.int64)
