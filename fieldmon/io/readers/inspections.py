"""Inspections that come back from the field, looked up on the plot: which plant, what, when, who.

Decisions
---------
- What was not filled in stays unknown: blank records are no inspections. "Could not inspect" is
  one, and is kept with its note.
- Which plot is meant `other_plots` says, which plant `placed_records`, and which records are one
  inspection `inspection_visits`. What a season holds already is told there: see
  `fieldmon.monitoring.inspecting.inspection_table`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ObservationError
from fieldmon.infestation.inspection_columns import BESIDE
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.import_report import (
    Imported,
    ImportMessage,
    Remedy,
    UnreadDates,
    doubtful,
    dropped,
    seen,
)
from fieldmon.io.read import read_inspection_rows
from fieldmon.io.readers.date_doubts import amid_past
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspection_places import from_plants_m
from fieldmon.io.readers.inspection_visits import about_repeats, once_each, whole_plants
from fieldmon.io.readers.other_plots import of_this_plot
from fieldmon.io.readers.placed_records import about_places, own_doubts, placed_on_plot
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import Source
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.plot.grid import PlantGrid

_RESULTS = {PRESENT: FOUND, ABSENT: CLEAN, UNKNOWN: SKIPPED}
_NAMED = 10  # plants of which a file contradicts itself


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
    n_others = len(rows.value) - len(here)
    inspections, more = look_up(here, grid, options, n_others)
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
    placed = placed_on_plot(rows, grid, options)
    off_m = from_plants_m(rows, grid, np.arange(len(rows)), placed.plant)
    moved = (off_m > grid.plant_spacing_m / 2) & (placed.plant >= 0)
    doubts: dict[int, str] = dict.fromkeys(
        np.flatnonzero(moved).tolist(),
        worded("it stands elsewhere than its plant (empty its position if the plant is right)"),
    )
    doubts |= dict.fromkeys(np.flatnonzero(np.isnat(rows.day)).tolist(), worded("it has no date"))
    # of a day to come the season may have them itself
    ahead = amid_past(rows.day).keys() - own_doubts(rows).keys()
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
    rows: InspectionRows, grid: PlantGrid, options: InspectionOptions, n_others: int = 0
) -> tuple[Inspections, tuple[ImportMessage, ...]]:
    """Return what a file says with its plants, and what was left out or guessed on the way.

    `n_others` of its records were left out before, as they are of other plots.
    """
    placed = placed_on_plot(rows, grid, options)
    rows, plant = placed.rows, placed.plant
    taken = plant >= 0
    if not options.take_doubtful:
        taken[list(placed.doubts)] = False
    taken[list(placed.problems)] = False
    said = about_places(placed, grid, options, taken)
    whole, records, of_leaves = whole_plants(rows, plant, np.flatnonzero(taken))
    inspections = _inspections(whole, plant, records)
    once = once_each(whole, inspections, records)
    said += [*of_leaves, *_about_contradictions(whole, grid, plant, records)]
    said += about_repeats(len(inspections) - len(once))
    if len(rows) > 1 and not taken.all():
        said.append(_what_became(plant[taken], n_others + int((~taken).sum()), rows.n_silent))
    return once, tuple(said)


def _what_became(plant: NDArray[np.int64], n_out: int, n_silent: int) -> ImportMessage:
    """Return what became of all records of a file: those taken are of the plants ``(k,)``."""
    numbers = {
        "total": len(plant) + n_out + n_silent,
        "taken": len(plant),
        "plants": len(np.unique(plant)),
        "out": n_out,
        "silent": n_silent,
    }
    said = worded(
        "Of {total} {total:record|records} {taken} {taken:was|were} taken, of {plants} "
        "{plants:plant|plants}; {out} {out:was|were} left out.",
        **numbers,
    )
    if n_silent:
        said = worded(
            "Of {total} {total:record|records} {taken} {taken:was|were} taken, of {plants} "
            "{plants:plant|plants}; {out} {out:was|were} left out, and {silent} "
            "{silent:says|say} no result.",
            **numbers,
        )
    return doubtful(said) if n_out > len(plant) else seen(said)


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
