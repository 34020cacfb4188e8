"""Which plants a file of inspections names, and where it says they are."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import Remedy, doubtful
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.lengths import accuracies
from fieldmon.io.parse.named_positions import could_be_positions
from fieldmon.io.parse.positions import located
from fieldmon.io.parse.values import is_missing, numbers
from fieldmon.io.readers.inspection_file.inspection_rows import UNSAID
from fieldmon.io.readers.inspection_file.plant_labels import plants_called
from fieldmon.plot.plant_names import FACES, faces_called

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.readers.inspection_file.columns import InspectionColumns
    from fieldmon.io.readers.inspection_options import InspectionOptions

#: a plant in the name of a waypoint of ours, with what stands before and behind it: ``R3/17``, or
#: with the row's name, ``R101·5A/17``
PLANT_IN_NAME = re.compile(r"(?:^|\s)(?:\d+\s+)?R(\d{1,7})(?:·[^\s/]*)?/(\d{1,6})([ab]?)(?=\s|$)")
_ROW = "\0row"
_NAMED = 5  # cells that a sentence shows


class NamedPlants(NamedTuple):
    """The number in the grid, or row, number in it and face, by which a file names each ``(n,)``.

    And what to say of names that could be either.
    """

    plant: NDArray[np.int64]
    line: NDArray[np.int64]
    number: NDArray[np.int64]
    face: NDArray[np.int8]
    messages: tuple[ImportMessage, ...] = ()


def named_plants(
    layer: Layer, columns: InspectionColumns, options: InspectionOptions
) -> NamedPlants:
    """Return the plant's number in the grid, or row, number and face, by which a file names it."""
    n = len(layer)
    plant = np.full(n, -1, np.int64)
    line, number = np.full((2, n), UNSAID)
    face = np.zeros(n, np.int8)
    if columns.line is not None and columns.number is not None:
        line, number = (_whole(layer, name, UNSAID) for name in (columns.line, columns.number))
        unsaid = (line == UNSAID) | (number == UNSAID)
        line[unsaid] = number[unsaid] = UNSAID
    if columns.face is not None:
        face[:] = faces_called(map(text, layer.column(columns.face)))
    messages: tuple[ImportMessage, ...] = ()
    if columns.plant is not None:
        alone = options.column("row") == ""  # numbered through the whole plot, as was told
        called = plants_called(layer.column(columns.plant), alone=alone)
        plant[list(called.numbers)] = list(called.numbers.values())
        for i, label in called.labels.items():
            if line[i] == UNSAID:
                line[i], number[i], face[i] = label
        messages = _about_either(columns.plant, [s for i, s in called.either.items()
                                                 if line[i] == UNSAID])  # fmt: skip
    if columns.marks is not None:
        for i, value in enumerate(layer.column(columns.marks)):
            found = PLANT_IN_NAME.search(text(value))
            if found and plant[i] < 0:
                line[i], number[i] = int(found.group(1)), int(found.group(2))
                face[i] = FACES.get(found.group(3).casefold(), 0)
    return NamedPlants(plant, line, number, face, messages)


def _about_either(column: str, cells: list[str]) -> tuple[ImportMessage, ...]:
    """Return a doubt about cells that may be a number with thousands, or row and plant."""
    if not cells:
        return ()
    row, plant = (int(part) for part in re.split(r"\D", cells[0]))
    said = worded(
        "{n} {n:cell|cells} of column {column!r} may be {n:the number of a plant|numbers of "
        "plants} with thousands, or a row and a plant in it ({cells}), and {n:was|were} read as "
        "neither. Write {whole} for the first, {label} for the second.",
        n=len(cells),
        column=column,
        cells=first_few([repr(cell) for cell in dict.fromkeys(cells)], _NAMED),
        whole=re.sub(r"\D", "", cells[0]),
        label=f"{row}/{plant}",
    )
    label = worded("Take them as numbers on the whole plot")
    return (doubtful(said, None, Remedy("columns", "row=", label)),)


def unknown_faces(layer: Layer, columns: InspectionColumns) -> NDArray[np.str_]:
    """Return what is named as the face ``(n,)`` where it is none that is known, else nothing."""
    if columns.face is None:
        return np.full(len(layer), "", dtype=np.str_)
    cells = [text(v) for v in layer.column(columns.face)]
    known = (faces_called(cells) > 0) | [is_missing(cell) for cell in cells]
    return np.where(known, "", np.array(cells, dtype=np.str_))


def _whole(layer: Layer, name: str, otherwise: int) -> NDArray[np.int64]:
    values = numbers(layer.column(name))
    good = np.isfinite(values) & (values == np.round(values)) & (np.abs(values) < 2**31)
    return np.where(good, np.where(good, values, 0), otherwise).astype(np.int64)


def positions_in(
    layer: Layer, columns: InspectionColumns, options: InspectionOptions
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.str_], tuple[ImportMessage, ...]]:
    """Return positions ``(n, 2)``, their accuracy ``(n,)`` and what cannot be read of them.

    NaN where there is none; empty where it can be read, or there is none. Each record whose
    position cannot be read is told by itself later.
    """
    lonlat, accuracy_m = np.full((len(layer), 2), np.nan), np.full(len(layer), np.nan)
    unread = np.full(len(layer), "", dtype=object)
    roles = {role for role in ("lon", "lat", "x", "y", "position") if _has(layer, role, options)}
    given = layer.geometry is not None or roles >= {"lon", "lat"} or "position" in roles
    is_named = columns.plant is not None or columns.number is not None
    if not given and (is_named or not roles >= {"x", "y"}):
        if not is_named:
            raise _which_plants(layer, columns, options)
        return lonlat, accuracy_m, unread, ()
    rows = np.empty(len(layer), dtype=object)
    rows[:] = range(len(layer))
    try:
        found = located(replace(layer, columns={**layer.columns, _ROW: rows}, messages=()), options)
    except (ChoiceNeeded, FileProblem):
        if not is_named:
            raise
        return lonlat, accuracy_m, unread, ()
    kept = found.layer.columns[_ROW].astype(np.int64)
    name = options.column("accuracy") or find("accuracy", layer.columns)
    column = found.layer.column(name) if name else np.full(len(kept), None)
    stated_m, doubts = accuracies(column, name or "", options.decimal)
    lonlat[kept] = found.lonlat
    accuracy_m[kept] = np.fmax(stated_m, found.accuracy_m)
    messages = (*found.messages, *doubts)
    if found.unread is not None and not found.unread.n_dotted:
        unread[list(found.unread.written)] = list(found.unread.written.values())
        told = found.unread.messages()
        messages = tuple(one for one in messages if one not in told)
    return lonlat, accuracy_m, unread.astype(np.str_), messages


def _which_plants(
    layer: Layer, columns: InspectionColumns, options: InspectionOptions
) -> ChoiceNeeded:
    """Return the question which columns say the plants, where none was recognised."""
    taken = {columns.line, columns.result, columns.number_found}
    named = [f"plant={name}" for name in layer.columns]
    choices = dict.fromkeys((*named, *could_be_positions(layer, options)))
    return ChoiceNeeded(
        worded(
            "{name} must say which plants were inspected (a plant's "
            "number, a row and a number in it, or a position), but "
            "its columns are {names}. Name them.",
            name=layer.name,
            names=", ".join(layer.columns),
        ),
        "columns",
        tuple(one for one in choices if one.partition("=")[2] not in taken),
    )


def _has(layer: Layer, role: str, options: InspectionOptions) -> bool:
    return (options.column(role) or find(role, layer.columns)) is not None
