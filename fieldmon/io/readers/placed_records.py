"""Records of inspections placed on the plot, and what is to be said of their places.

Decisions
---------
- Which plant is meant `inspection_places` says. Doubtful records are listed and left out unless one
  asks for them.
- Where both faces of a plant are inspected and a file does not say which, it is the first face,
  and the import says so.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import worded
from fieldmon.infestation.nearby_plants import outside_m
from fieldmon.io.import_report import Remedy, doubtful, dropped, guessed
from fieldmon.io.readers.date_doubts import amid_past
from fieldmon.io.readers.inspection_file.inspection_rows import UNSAID
from fieldmon.io.readers.inspection_options import TAKE
from fieldmon.io.readers.inspection_places import (
    below_first,
    by_label,
    by_name,
    by_number,
    by_position,
    from_zero,
    misplaced,
)
from fieldmon.io.readers.lost_zeros import lost_zeros
from fieldmon.io.readers.nearby import doubt_of_order

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.plot.grid import PlantGrid

_LISTED = 20  # doubtful records that are named one by one


class PlacedRecords(NamedTuple):
    """Records of a file on the plot.

    Parameters
    ----------
    rows
        The records, with names of rows and plants read as numbers.
    plant
        ``(m,)`` the plant of each, -1 for none.
    numbered
        ``(m,)`` the plant that each names by its number, -1 for none.
    by_position
        ``(m,)`` which only their positions tell.
    problems, doubts
        Why records cannot be placed, or are doubtful, by index.
    said
        What else there is to say of names.
    """

    rows: InspectionRows
    plant: NDArray[np.int64]
    numbered: NDArray[np.int64]
    by_position: NDArray[np.bool_]
    problems: dict[int, str]
    doubts: dict[int, str]
    said: tuple[ImportMessage, ...]


def placed_on_plot(
    rows: InspectionRows, grid: PlantGrid, options: InspectionOptions
) -> PlacedRecords:
    """Place records by the names of plants, else by their numbers, labels and positions."""
    rows, misnamed, said_of_names = by_name(rows, grid)
    named = by_number(rows, grid)
    plant, problems = named.plant, named.problems | misnamed
    labelled = by_label(rows, grid, plant < 0)
    plant = np.where(labelled.plant >= 0, labelled.plant, plant)
    problems |= labelled.problems
    doubts = misplaced(rows, grid, plant) | named.doubts
    open_yet = (plant < 0) & np.isfinite(rows.lonlat).all(axis=1)
    open_yet &= ~np.isin(np.arange(len(rows)), list(problems))
    snapped = by_position(rows, grid, np.flatnonzero(open_yet), options)
    plant = np.where(snapped.plant >= 0, snapped.plant, plant)
    problems |= snapped.problems
    doubts = doubts | from_zero(rows, grid, labelled.plant) | snapped.doubts | own_doubts(rows)
    doubts |= lost_zeros(rows, grid, labelled.plant) | amid_past(rows.day)
    problems |= _unknown_faces(rows, grid, plant)
    below = below_first(rows, grid)
    for i in np.flatnonzero(plant < 0).tolist():
        problems.setdefault(i, _nowhere(rows, i, below_one=bool(below[i])))
    said = (*said_of_names, *labelled.said)
    return PlacedRecords(rows, plant, named.plant, open_yet, problems, doubts, said)


def about_places(
    placed: PlacedRecords, grid: PlantGrid, options: InspectionOptions, taken: NDArray[np.bool_]
) -> list[ImportMessage]:
    """Return what to say of where records were placed, of which those marked were `taken`."""
    rows, problems, by_position = placed.rows, placed.problems, placed.by_position
    doubts = {i: why for i, why in placed.doubts.items() if i not in problems}
    return [
        *_listed(rows, problems, dropped, None),
        *_listed(rows, doubts, doubtful, None if options.take_doubtful else TAKE),
        *_about_order(rows, grid),
        *_about_numbers(rows, grid, placed.numbered, taken),
        *_about_labels(rows, taken),
        *placed.said,
        *_about_faces(rows, grid, placed.plant, taken),
        *_about_accuracy(rows, options, by_position & taken),
        *_too_coarse(rows, grid, options, by_position),
    ]


def _unknown_faces(
    rows: InspectionRows, grid: PlantGrid, plant: NDArray[np.int64]
) -> dict[int, str]:
    """Return which records name a face of a plant ``(m,)`` in a word that nobody knows."""
    if rows.face_word is None:
        return {}
    named = (rows.face_word != "") & (rows.plant < 0) & (rows.face == 0) & (plant >= 0)
    named[named] = grid.twin[plant[named]] >= 0
    return {
        i: worded(
            "its face is {word!r}, but faces are called 1 and 2, or a and b",
            word=str(rows.face_word[i]),
        )
        for i in np.flatnonzero(named).tolist()
    }


def _nowhere(rows: InspectionRows, record: int, *, below_one: bool) -> str:
    """Return why a record has no plant."""
    if below_one:
        return worded("rows and plants are counted from 1, but it says 0 or less")
    if unread := str(rows.unread[record]):
        return worded("it names no plant, and {at} is no position", at=unread)
    if called := _named_alone(rows, record):
        return worded(
            "{called!r} does not name a plant for certain. Write its number on the whole plot, or "
            "its row and its number in it, as 3/12 or R3/12",
            called=called,
        )
    return worded("it names no plant and has no position")


def _named_alone(rows: InspectionRows, record: int) -> str:
    """Return what a record names as its plant where no other column names a row; else nothing."""
    if rows.plant_called is None or (rows.row_called is not None and rows.row_called[record]):
        return ""
    return str(rows.plant_called[record])


def own_doubts(rows: InspectionRows) -> dict[int, str]:
    """Return what records are doubted for as they were read, by index."""
    return {i: str(rows.doubt[i]) for i in np.flatnonzero(rows.doubt != "").tolist()}


def _verdict(is_out: bool, is_taken: bool, why: str) -> str:  # noqa: FBT001 - what of three
    """Return what is said of a record, and why."""
    if is_out:
        return worded("It cannot be placed: {why}.", why=why)
    if is_taken:
        return worded("It is doubtful and was taken as asked: {why}.", why=why)
    return worded("It is doubtful: {why}.", why=why)


def _listed(
    rows: InspectionRows,
    why: dict[int, str],
    make: Callable[[str, str | None, Remedy | None], ImportMessage],
    remedy: Remedy | None,
) -> list[ImportMessage]:
    """Return a message for each of the first records, and one for the rest."""
    records, said = sorted(why), partial(_verdict, make is dropped, remedy is None)
    messages = [
        make(said(why[i]), f"record {rows.source_row[i]}", remedy) for i in records[:_LISTED]
    ]
    if len(records) > _LISTED:
        messages.append(
            make(
                worded(
                    "{n} more {n:record is|records are} so.",
                    n=len(records) - _LISTED,
                ),
                None,
                remedy,
            )
        )
    return messages


def _about_order(rows: InspectionRows, grid: PlantGrid) -> list[ImportMessage]:
    lonlat = rows.lonlat[np.isfinite(rows.lonlat).all(axis=1)]
    return doubt_of_order(outside_m(grid, lonlat), outside_m(grid, lonlat[:, ::-1]))


def _about_numbers(
    rows: InspectionRows, grid: PlantGrid, plant: NDArray[np.int64], taken: NDArray[np.bool_]
) -> list[ImportMessage]:
    """Return what to say of plants named by a number that nothing else in the file bears out."""
    alone = taken & (plant >= 0) & (rows.line == UNSAID) & ~np.isfinite(rows.lonlat).all(axis=1)
    if not alone.any():
        return []
    said = worded(
        "{n} {n:record names|records name} a plant by its number alone: taken as files given "
        "out count them, 0 to "
        "{last} on the whole plot.",
        n=int(alone.sum()),
        last=len(grid) - 1,
    )
    return [guessed(said)]


def _about_labels(rows: InspectionRows, taken: NDArray[np.bool_]) -> list[ImportMessage]:
    """Return what to say of plants whose row and number in it stand in one cell."""
    one = np.flatnonzero(taken & (rows.plant < 0) & (rows.line != UNSAID)).tolist()
    cells = [cell for i in one if (cell := _named_alone(rows, i))]
    if not cells:
        return []
    said = worded(
        "{n} {n:record names|records name} a row and a plant in one cell ({cell!r}): the first "
        "number was taken for the row, the second for the plant in it.",
        n=len(cells),
        cell=cells[0],
    )
    return [guessed(said)]


def _about_faces(
    rows: InspectionRows, grid: PlantGrid, plant: NDArray[np.int64], taken: NDArray[np.bool_]
) -> list[ImportMessage]:
    unsaid = taken & (rows.plant < 0) & (rows.face == 0)
    unsaid[unsaid] = grid.twin[plant[unsaid]] >= 0
    if not unsaid.any():
        return []
    said = worded(
        "{n} {n:record does|records do} not say which face of a plant; taken for the first.",
        n=int(unsaid.sum()),
    )
    return [guessed(said)]


def _about_accuracy(
    rows: InspectionRows, options: InspectionOptions, snapped: NDArray[np.bool_]
) -> list[ImportMessage]:
    unsaid = snapped & np.isnan(rows.accuracy_m)
    if options.accuracy_m is not None or not unsaid.any():
        return []
    said = worded(
        "{n} {n:position states|positions state} no accuracy and {n:was|were} taken as exact.",
        n=int(unsaid.sum()),
    )
    return [
        guessed(
            said, None, Remedy("accuracy_m", "3", worded("Say how far off they may be, in metres"))
        )
    ]


def _too_coarse(
    rows: InspectionRows,
    grid: PlantGrid,
    options: InspectionOptions,
    snapped: NDArray[np.bool_],
) -> list[ImportMessage]:
    """Return a doubt about positions so far off that none can name a plant."""
    apart_m = min(grid.plant_spacing_m, grid.row_spacing_m)
    told = 0.0 if options.accuracy_m is None else options.accuracy_m
    accuracy_m = np.where(np.isnan(rows.accuracy_m), told, rows.accuracy_m)
    n = int(np.count_nonzero(snapped & (2 * accuracy_m >= apart_m)))
    if not n or options.take_doubtful:
        return []
    said = worded(
        "{n} {n:position is|positions are} stated to be as far off as half the way to the next "
        "plant ({apart}) or more: such positions name no plant.",
        n=n,
        apart=distance_figure(apart_m),
    )
    return [doubtful(said, None, TAKE)]
