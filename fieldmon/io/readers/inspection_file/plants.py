"""Which plants a file of inspections names, and where it says they are."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.parse.columns import find
from fieldmon.io.parse.lengths import accuracies
from fieldmon.io.parse.named_positions import could_be_positions
from fieldmon.io.parse.positions import located
from fieldmon.io.parse.values import is_missing, numbers
from fieldmon.io.readers.inspection_file.inspection_rows import UNSAID
from fieldmon.plot.plant_names import FACES, faces_called

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.readers.inspection_file.columns import InspectionColumns
    from fieldmon.io.readers.inspection_options import InspectionOptions

_LABEL = re.compile(r"^[^\d\s]{0,8}\s*(\d{1,6})\s*[/\-.,:;\s]\s*[^\d\s]{0,8}\s*(\d{1,6})([abAB]?)$")
#: a plant in the name of a waypoint of ours, with what stands before and behind it: ``R3/17``, or
#: with the row's name, ``R101·5A/17``
PLANT_IN_NAME = re.compile(r"(?:^|\s)(?:\d+\s+)?R(\d{1,7})(?:·[^\s/]*)?/(\d{1,6})([ab]?)(?=\s|$)")
_ROW = "\0row"


def named_plants(
    layer: Layer, columns: InspectionColumns
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int8]]:
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
    if columns.plant is not None:
        plant = _whole(layer, columns.plant, -1)
    labels = columns.plant if columns.marks is None else columns.marks
    if labels is not None:
        pattern = _LABEL if columns.marks is None else PLANT_IN_NAME
        for i, value in enumerate(layer.column(labels)):
            found = pattern.search(text(value))
            if found and plant[i] < 0:
                line[i], number[i] = int(found.group(1)), int(found.group(2))
                face[i] = FACES.get(found.group(3).casefold(), 0)
    return plant, line, number, face


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
            taken = {columns.line, columns.result, columns.number_found}
            named = [f"plant={name}" for name in layer.columns]
            choices = dict.fromkeys((*named, *could_be_positions(layer, options)))
            raise ChoiceNeeded(
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


def _has(layer: Layer, role: str, options: InspectionOptions) -> bool:
    return (options.column(role) or find(role, layer.columns)) is not None
