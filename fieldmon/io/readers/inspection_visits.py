"""Records of a file that are one inspection.

Decisions
---------
- Records of several leaves of a plant in one visit are one inspection, found if any leaf is.
- Of the inspections of one visit (`visits`) that are the same but for their notes, one is taken,
  with the notes of all. At clearly other times of a day each is a look of its own, as the belief
  has it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.infestation.records import ABSENT, PRESENT
from fieldmon.io.import_report import guessed, seen
from fieldmon.io.parse.joined_notes import joined_notes
from fieldmon.io.readers.visits import visits_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows


def about_repeats(n: int) -> list[ImportMessage]:
    """Return what to say of so many records that say again what another one says."""
    if not n:
        return []
    said = worded("{n} {n:record says|records say} again what another one says; taken once.", n=n)
    return [seen(said)]


def _at_s(rows: InspectionRows, records: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return when records were made, seconds from anywhere; NaN where no time is known."""
    when = rows.when[records]
    return np.where(np.isnat(when), np.nan, when.astype(np.int64))


def whole_plants(
    rows: InspectionRows, plant: NDArray[np.int64], records: NDArray[np.intp]
) -> tuple[InspectionRows, NDArray[np.intp], list[ImportMessage]]:
    """Return rows and records in which several leaves of a plant are one inspection.

    It is found if any leaf is, with the pests of all leaves. Where a leaf is told of twice, the
    visit stays as it is.
    """
    if rows.leaf is None or not (rows.leaf[records] != "").any():
        return rows, records, []
    leaves = records[rows.leaf[records] != ""]
    columns = (plant[leaves], rows.day[leaves].astype(np.int64), rows.who[leaves])
    rest = np.full(len(leaves), "") if rows.rest is None else rows.rest[leaves]
    alike = zip(*(column.tolist() for column in (*columns, rest)), strict=True)
    visit = visits_of(alike, _at_s(rows, leaves))
    result, count = rows.result.copy(), rows.count.copy()
    others, n_plants = list[int](), 0
    order = np.argsort(visit, kind="stable")
    visits, begins = np.unique(visit[order], return_index=True)
    for one, of in zip(visits.tolist(), np.split(leaves[order], begins[1:]), strict=True):
        if len(of) == 1 or len(set(rows.leaf[of].tolist())) < len(of):
            continue
        found = of[rows.result[of] == PRESENT]
        first = int(leaves[one])
        if len(found):
            result[first], count[first] = PRESENT, rows.count[found].sum()
        elif (rows.result[of] == ABSENT).any():
            result[first], count[first] = ABSENT, 0.0
        others += [k for k in of.tolist() if k != first]
        n_plants += 1
    if not n_plants:
        return rows, records, []
    said = worded(
        "{n} {n:record|records} of single leaves became {plants} {plants:inspection|inspections} "
        "of whole plants, found where any leaf is; counts were added.",
        n=len(others) + n_plants,
        plants=n_plants,
    )
    kept = records[~np.isin(records, others)]
    return replace(rows, result=result, count=count), kept, [guessed(said)]


def once_each(
    rows: InspectionRows, inspections: Inspections, records: NDArray[np.intp]
) -> Inspections:
    """Return the first of each visit that are the same but for their notes, with those of all."""
    told = [words[records].tolist() for words in (rows.rest, rows.leaf) if words is not None]
    columns = zip(
        inspections.plant.tolist(),
        inspections.date.astype(np.int64).tolist(),  # a day that is no time is one number too
        inspections.result.tolist(),
        [f"{count:.9g}" for count in inspections.count.tolist()],
        [who.strip() for who in inspections.who],
        *told,
        strict=True,
    )
    first = visits_of(columns, inspections.second)
    kept = np.unique(first)
    if len(kept) == len(first):
        return inspections
    noted: dict[int, list[str]] = {}
    for visit, note in zip(first.tolist(), inspections.notes, strict=True):
        noted.setdefault(visit, []).append(str(note))
    notes = np.array([joined_notes(noted[visit]) for visit in kept.tolist()], object)
    return replace(inspections.take(kept), notes=notes)
