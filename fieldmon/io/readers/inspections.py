"""Inspections that come back from the field, looked up on the plot: which plant, what, when, who.

Decisions
---------
- What was not filled in stays unknown: blank records are no inspections. "Could not inspect" is
  one, and is kept with its note.
- Which plot is meant `other_plots` says, which plant `inspection_places`. Doubtful records are
  listed and left out unless one asks for them.
- Where both faces of a plant are inspected and a file does not say which, it is the first face,
  and the import says so.
- Records of several leaves of a plant in one visit are one inspection, found if any leaf is.
- Of the inspections of one visit (`visits`) that are the same but for their notes, one is taken,
  with the notes of all. At clearly other times of a day each is a look of its own, as the belief
  has it. What a season holds already is told there: see
  `fieldmon.monitoring.inspecting.inspection_table`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ObservationError
from fieldmon.infestation.inspection_columns import BESIDE
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.infestation.nearby_plants import outside_m
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.import_report import (
    Imported,
    ImportMessage,
    Remedy,
    UnreadDates,
    doubtful,
    dropped,
    guessed,
    seen,
)
from fieldmon.io.parse.joined_notes import joined_notes
from fieldmon.io.read import read_inspection_rows
from fieldmon.io.readers.date_doubts import amid_past
from fieldmon.io.readers.inspection_file.inspection_rows import UNSAID
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspection_places import (
    below_first,
    by_label,
    by_name,
    by_number,
    by_position,
    from_plants_m,
    from_zero,
    misplaced,
)
from fieldmon.io.readers.nearby import doubt_of_order
from fieldmon.io.readers.other_plots import of_this_plot
from fieldmon.io.readers.visits import visits_of
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.io.options import Source
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.plot.grid import PlantGrid

_RESULTS = {PRESENT: FOUND, ABSENT: CLEAN, UNKNOWN: SKIPPED}
_NAMED = 10  # plants of which a file contradicts itself
_LISTED = 20  # doubtful records that are named one by one
_TAKE = Remedy("take_doubtful", "yes", worded("Take it all the same"))


def read_inspections(
    source: Source,
    grid: PlantGrid,
    options: InspectionOptions | None = None,
    called: tuple[str, ...] = (),
) -> Imported[Inspections]:
    """Return the inspections that a file brings for a plot, and all there is to say about them.

    What the file says is of another plot than one `called` so is left out.

    CSV, TSV, Excel, GeoJSON, GeoPackage, shapefile, GPX and KML: with plants by number, by row and
    number in it, or by position; also the route files given out, filled in. In a file that has
    neither results nor counts, names such as ``+3``, ``+``, ``-``, ``0`` and ``clean`` are read.

    Raises
    ------
    FileProblem
        Where the file cannot be read at all.
    ChoiceNeeded
        Where the file leaves open which layer or column is meant.
    """
    chosen = options or InspectionOptions()
    return on_plot(read_inspection_rows(source, chosen), grid, chosen, called)


def on_plot(
    rows: Imported[InspectionRows],
    grid: PlantGrid,
    options: InspectionOptions,
    called: tuple[str, ...] = (),
) -> Imported[Inspections]:
    """Return the inspections of rows that were read, as `read_inspections` does."""
    here, of_others = of_this_plot(rows.value, grid, called, options)
    inspections, more = look_up(here, grid, options)
    return rows.having(inspections, (*of_others, *more))


def exported(
    rows: InspectionRows, grid: PlantGrid, options: InspectionOptions
) -> tuple[Inspections, list[str], dict[int, str]]:
    """Return inspections exported from a season one by one, and the digest of each there.

    And of records whose plant is not sure, which are left out, why, by their number in the file.
    """
    rows = rows.take(rows.exported)
    if not len(rows):
        return Inspections.none(), [], {}
    placed = _placed(rows, grid, options)
    off_m = from_plants_m(rows, grid, np.arange(len(rows)), placed.plant)
    moved = (off_m > grid.plant_spacing_m / 2) & (placed.plant >= 0)
    doubts: dict[int, str] = dict.fromkeys(
        np.flatnonzero(moved).tolist(),
        worded("it stands elsewhere than its plant (empty its position if the plant is right)"),
    )
    doubts |= dict.fromkeys(np.flatnonzero(np.isnat(rows.day)).tolist(), worded("it has no date"))
    # of a day to come the season may have them itself
    ahead = amid_past(rows.day).keys() - _own_doubts(rows).keys()
    doubts |= {k: why for k, why in placed.doubts.items() if k not in ahead} | placed.problems
    sure = np.setdiff1d(np.arange(len(rows)), np.array([*doubts], np.intp))
    marks = [] if placed.rows.mark is None else placed.rows.mark[sure].tolist()
    why = {int(rows.source_row[k]): doubts[k] for k in sorted(doubts)}
    return _inspections(placed.rows, placed.plant, sure), marks, why


def dated(read: Imported[Inspections]) -> Imported[Inspections]:
    """Leave out, and say so, which inspections have no date where others have one.

    Where none has one they stay: the day of the work is then to be asked for. Raise
    `ObservationError` where what they say as their date is none: no other day may be put there.
    """
    without = np.isnat(read.value.date)
    unread = [one.sentence for one in read.messages if isinstance(one, UnreadDates)]
    if unread and len(without) and without.all():
        raise ObservationError(unread[0])
    if not without.any() or without.all():
        return read
    said = worded(
        "{n} {n:record has|records have} no date, as others have: left out. Give them one.",
        n=int(without.sum()),
    )
    day = Remedy("day", "2026-04-06", worded("Say the day of those that have none"))
    way_out = None if unread else day
    return read.having(read.value.take(~without), (dropped(said, None, way_out),))


def look_up(
    rows: InspectionRows, grid: PlantGrid, options: InspectionOptions
) -> tuple[Inspections, tuple[ImportMessage, ...]]:
    """Return what a file says with its plants, and what was left out or guessed on the way."""
    placed = _placed(rows, grid, options)
    rows, plant = placed.rows, placed.plant
    taken = plant >= 0
    if not options.take_doubtful:
        taken[list(placed.doubts)] = False
    taken[list(placed.problems)] = False
    said = _about_places(placed, grid, options, taken)
    whole, records, of_leaves = _whole_plants(rows, plant, np.flatnonzero(taken))
    inspections = _inspections(whole, plant, records)
    once = _once_each(whole, inspections, records)
    said += [*of_leaves, *_about_contradictions(whole, grid, plant, records)]
    said += _about_repeats(len(inspections) - len(once))
    if len(rows) > 1 and not taken.all():
        said.append(_what_became(len(rows), plant[taken]))
    return once, tuple(said)


class _Placed(NamedTuple):
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


def _placed(rows: InspectionRows, grid: PlantGrid, options: InspectionOptions) -> _Placed:
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
    doubts = doubts | from_zero(rows, grid, labelled.plant) | snapped.doubts | _own_doubts(rows)
    doubts |= amid_past(rows.day)
    problems |= _unknown_faces(rows, grid, plant)
    below = below_first(rows, grid)
    for i in np.flatnonzero(plant < 0).tolist():
        problems.setdefault(i, _nowhere(str(rows.unread[i]), below_one=bool(below[i])))
    said = (*said_of_names, *labelled.said)
    return _Placed(rows, plant, named.plant, open_yet, problems, doubts, said)


def _about_places(
    placed: _Placed, grid: PlantGrid, options: InspectionOptions, taken: NDArray[np.bool_]
) -> list[ImportMessage]:
    """Return what to say of where records were placed, of which those marked were `taken`."""
    rows, problems, by_position = placed.rows, placed.problems, placed.by_position
    doubts = {i: why for i, why in placed.doubts.items() if i not in problems}
    return [
        *_listed(rows, problems, dropped, None),
        *_listed(rows, doubts, doubtful, None if options.take_doubtful else _TAKE),
        *_about_order(rows, grid),
        *_about_numbers(rows, grid, placed.numbered, taken),
        *placed.said,
        *_about_faces(rows, grid, placed.plant, taken),
        *_about_accuracy(rows, options, by_position & taken),
        *_too_coarse(rows, grid, options, by_position),
    ]


def _about_repeats(n: int) -> list[ImportMessage]:
    """Return what to say of so many records that say again what another one says."""
    if not n:
        return []
    said = worded("{n} {n:record says|records say} again what another one says; taken once.", n=n)
    return [seen(said)]


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


def _what_became(n_records: int, plant: NDArray[np.int64]) -> ImportMessage:
    """Return how many records of a file were taken, of the plants ``(k,)`` of these."""
    n_out = n_records - len(plant)
    said = worded(
        "Of {total} {total:record|records} {taken} {taken:was|were} taken, of {plants} "
        "{plants:plant|plants}; {out} {out:was|were} left out.",
        total=n_records,
        taken=len(plant),
        plants=len(np.unique(plant)),
        out=n_out,
    )
    return doubtful(said) if 2 * n_out > n_records else seen(said)


def _about_contradictions(
    rows: InspectionRows, grid: PlantGrid, plant: NDArray[np.int64], records: NDArray[np.intp]
) -> list[ImportMessage]:
    """Return a doubt about plants that are both found and clean on one day, with the records."""
    told: dict[tuple[int, int], dict[int, int]] = {}
    for i in records.tolist():
        if rows.result[i] != UNKNOWN:
            key = int(plant[i]), int(rows.day[i].astype(np.int64))
            told.setdefault(key, {}).setdefault(int(rows.result[i]), int(rows.source_row[i]))
    both = {at: sorted(one.values()) for (at, _), one in told.items() if len(one) > 1}
    if not both:
        return []
    numbered = plant_numbers(grid, np.array([*both]))
    names = [
        worded(
            "row {line}, plant {number} (records {some})",
            line=line,
            number=number,
            some=", ".join(map(str, some)),
        )
        for line, number, some in zip(numbered.line, numbered.number, both.values(), strict=True)
    ]
    said = worded(
        "In this file {n} {n:plant is|plants are} both found and clean on one day: {some}.",
        n=len(both),
        some=first_few(names, _NAMED),
    )
    return [doubtful(said)]


def _nowhere(unread: str, *, below_one: bool) -> str:
    """Return why a record has no plant."""
    if below_one:
        return worded("rows and plants are counted from 1, but it says 0 or less")
    if unread:
        return worded("it names no plant, and {at} is no position", at=unread)
    return worded("it names no plant and has no position")


def _own_doubts(rows: InspectionRows) -> dict[int, str]:
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
    return [doubtful(said, None, _TAKE)]


def _inspections(
    rows: InspectionRows, plant: NDArray[np.int64], records: NDArray[np.intp]
) -> Inspections:
    """Return what rows say about plants they were placed at."""
    # a clean plant has none of them; what could not be inspected was not counted
    result = np.array([_RESULTS[int(code)] for code in rows.result[records]], dtype=np.int8)
    count = np.where(result == FOUND, rows.count[records], np.nan)
    count[count == 0] = np.nan
    when, date = rows.when[records], rows.day[records]
    since_midnight = when - when.astype("datetime64[D]")
    beside = {one.name: getattr(rows, one.name) for one in BESIDE}
    return Inspections.of(
        plant[records],
        result,
        date,
        second=since_midnight / np.timedelta64(1, "s"),
        count=count,
        **{name: column[records] for name, column in beside.items() if column is not None},
    )


def _at_s(rows: InspectionRows, records: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return when records were made, seconds from anywhere; NaN where no time is known."""
    when = rows.when[records]
    return np.where(np.isnat(when), np.nan, when.astype(np.int64))


def _whole_plants(
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


def _once_each(
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
