"""Findings that come back from the field, looked up on the plot: which plant, what, when, by whom.

Decisions
---------
- A plant is known by its number in the grid, as every file given out has it (column ``plant``);
  else by row and number in it, as people count; else by position. Where a file has a row but no
  number in it, ``plant`` is read as that number.
- What was not filled in stays unknown: blank records are no findings. "Could not inspect" is one,
  and is kept with its note.
- A position is snapped to the nearest plant. It is doubtful where, within its accuracy, another
  plant could be the nearest, or where it lies further than half the spacing from the nearest,
  along the row or across. Doubtful findings are listed and left out unless one asks for them.
- Where both faces of a plant are inspected and a file does not say which, it is the first face,
  and the import says so.
- Two findings are the same if plant, time (or day, where there is no clock time), result, count
  and who are: see `Findings.digest`. Notes and the order of a file do not count, so a file that
  comes twice, sorted anew or filled in further, brings only what is new.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED
from fieldmon.infestation.observations import ABSENT, PRESENT, UNKNOWN
from fieldmon.io.import_report import (
    Imported,
    ImportMessage,
    Remedy,
    doubtful,
    dropped,
    guessed,
    seen,
)
from fieldmon.io.read import read_reported
from fieldmon.io.readers.reported import FindingsOptions, Reported
from fieldmon.plot.grid import row_label

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.options import Source
    from fieldmon.plot.grid import PlantGrid

_RESULTS = {PRESENT: FOUND, ABSENT: CLEAN, UNKNOWN: SKIPPED}
_LISTED = 20  # doubtful findings that are named one by one
_NEIGHBOURS = 13  # plants among which the nearest and its rivals are: two rings, or both faces
_FARTHEST_DEG = 1.0
_TOUCH_M = 1e-3
_TAKE = Remedy("take_doubtful", "yes", "Take it all the same")


@dataclass(frozen=True, eq=False)
class Findings:
    """What was seen on plants, one entry a finding, ``(k,)`` each, in the file's order.

    Parameters
    ----------
    plant
        int32, number in the grid.
    result
        int8: `FOUND`, `CLEAN` or `SKIPPED` (could not be inspected).
    count
        Pests counted; NaN where they were not.
    when
        datetime64[s], local time; NaT where the file has no clock time.
    day
        datetime64[D]: of `when`, else as the file or the options say; NaT where nothing does.
    who, notes
        Text; empty where there is none.
    source_row
        Which record of the file, from 1.
    digest
        32 hexadecimal digits, equal for the same finding whichever file it comes from.
    """

    plant: NDArray[np.int32]
    result: NDArray[np.int8]
    count: NDArray[np.float64]
    when: NDArray[np.datetime64]
    day: NDArray[np.datetime64]
    who: NDArray[np.str_]
    notes: NDArray[np.str_]
    source_row: NDArray[np.int64]
    digest: NDArray[np.str_]

    def __post_init__(self) -> None:
        for values in vars(self).values():
            values.setflags(write=False)

    def __len__(self) -> int:
        """Return the number of findings."""
        return len(self.plant)

    @property
    def second(self) -> NDArray[np.float64]:
        """Return the seconds since local midnight, ``(k,)``; NaN where there is no clock time."""
        since = (self.when - self.when.astype("datetime64[D]")) / np.timedelta64(1, "s")
        return np.asarray(since, dtype=np.float64)

    def take(self, which: NDArray[np.generic]) -> Findings:
        """Return the findings at the given indices or mask."""
        return Findings(**{name: values[which].copy() for name, values in vars(self).items()})


def read_findings(
    source: Source, grid: PlantGrid, options: FindingsOptions | None = None
) -> Imported[Findings]:
    """Return the findings that a file brings for a plot, and all there is to say about them.

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
    chosen = options or FindingsOptions()
    reported = read_reported(source, chosen)
    found, more = look_up(reported.value, grid, chosen)
    return reported.having(found, more)


def look_up(
    reported: Reported, grid: PlantGrid, options: FindingsOptions
) -> tuple[Findings, tuple[ImportMessage, ...]]:
    """Return what was reported with its plants, and what was left out or guessed on the way."""
    named = _by_number(reported, grid)
    plant, problems, doubts = named.plant, named.problems, named.doubts
    labelled = _by_label(reported, grid, plant < 0)
    plant = np.where(labelled.plant >= 0, labelled.plant, plant)
    problems |= labelled.problems
    doubts = _misplaced(reported, grid, plant) | doubts
    open_yet = (plant < 0) & np.isfinite(reported.lonlat).all(axis=1)
    open_yet &= ~np.isin(np.arange(len(reported)), list(problems))
    snapped = _by_position(reported, grid, np.flatnonzero(open_yet), options)
    plant = np.where(snapped.plant >= 0, snapped.plant, plant)
    problems |= snapped.problems
    doubts = doubts | snapped.doubts | _own_doubts(reported)
    for i in np.flatnonzero(plant < 0).tolist():
        problems.setdefault(i, "it names no plant and has no position")
    taken = plant >= 0
    if not options.take_doubtful:
        taken[list(doubts)] = False
    taken[list(problems)] = False
    said = [
        *_listed(reported, problems, "cannot be placed", None),
        *_listed(
            reported,
            {i: why for i, why in doubts.items() if i not in problems},
            "is doubtful" + (" and was taken as asked" if options.take_doubtful else ""),
            None if options.take_doubtful else _TAKE,
        ),
        *_about_faces(reported, grid, plant, taken),
        *_about_accuracy(reported, options, open_yet & taken),
    ]
    findings = _findings(reported, plant, np.flatnonzero(taken))
    once = _once_each(findings)
    if len(once) < len(findings):
        n_again = len(findings) - len(once)
        said.append(seen(f"{n_again} record(s) say again what another one says; taken once."))
    return once, tuple(said)


class _Placed(NamedTuple):
    """Plants ``(m,)``, -1 for none; why records cannot be placed, or are doubtful, by index."""

    plant: NDArray[np.int64]
    problems: dict[int, str]
    doubts: dict[int, str]


def _by_number(reported: Reported, grid: PlantGrid) -> _Placed:
    """Place records that name the plant's number, and hold it against whatever else they say."""
    stated = reported.plant
    plant = np.where((stated >= 0) & (stated < len(grid)), stated, -1)
    problems = {
        i: f"plant {stated[i]} is none of 0 to {len(grid) - 1} on this plot"
        for i in np.flatnonzero((stated >= len(grid)) | (stated < -1)).tolist()
    }
    doubts = {}
    here = np.flatnonzero(plant >= 0)
    label = row_label(grid, plant[here])
    line, number = reported.line[here], reported.number[here]
    other = (line > 0) & ((label.line != line) | (label.number != number))
    for k in np.flatnonzero(other).tolist():
        doubts[int(here[k])] = (
            f"plant {plant[here[k]]} is {_label(grid, plant[here[k]])} on this plot, but the "
            f"record says row {line[k]}, number {number[k]}"
        )
    return _Placed(plant, problems, doubts)


def _misplaced(reported: Reported, grid: PlantGrid, plant: NDArray[np.int64]) -> dict[int, str]:
    """Return which records name a plant ``(m,)`` that stands elsewhere than their position."""
    here = np.flatnonzero(plant >= 0)
    far_m = _away_m(reported, grid, here, plant[here])
    spacing_m = max(grid.row_spacing_m, grid.plant_spacing_m)
    reach_m = spacing_m + 3 * np.nan_to_num(reported.accuracy_m[here])
    return {
        int(here[k]): f"{_label(grid, plant[here[k]])} is {far_m[k]:.1f} m from the record's "
        "position: is it a file for another plot?"
        for k in np.flatnonzero(far_m > reach_m).tolist()
    }


def _away_m(
    reported: Reported, grid: PlantGrid, rows: NDArray[np.intp], plant: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Return how far records lie from plants, NaN without a position, infinity beyond a degree."""
    lonlat = reported.lonlat[rows]
    near = _is_near(lonlat, grid)
    away_m = np.where(np.isfinite(lonlat).all(axis=1), np.inf, np.nan)
    if near.any():
        step = grid.frame.xy_m(lonlat[near]) - grid.xy_m[plant[near]]
        away_m[near] = np.hypot(step[:, 0], step[:, 1])
    return away_m


def _is_near(lonlat: NDArray[np.float64], grid: PlantGrid) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        off = np.abs(lonlat - (grid.frame.lon, grid.frame.lat))
        return np.asarray((off < _FARTHEST_DEG).all(axis=1), dtype=bool)


def _by_label(reported: Reported, grid: PlantGrid, wanted: NDArray[np.bool_]) -> _Placed:
    """Place records that name a row and a number in it."""
    plant = np.full(len(reported), -1, np.int64)
    rows = np.flatnonzero(wanted & (reported.line > 0) & (reported.number > 0))
    if not len(rows):
        return _Placed(plant, {}, {})
    label = row_label(grid)
    known, first_face = np.unique(_key(label.line, label.number), return_index=True)
    wished = _key(reported.line[rows], reported.number[rows])
    at = np.minimum(np.searchsorted(known, wished), len(known) - 1)
    is_there = known[at] == wished
    first = first_face[at]
    second = (reported.face[rows] == 2) & (grid.twin[first] >= 0)
    plant[rows] = np.where(is_there, np.where(second, grid.twin[first], first), -1)
    problems = {
        i: f"there is no plant {reported.number[i]} in row {reported.line[i]} on this plot"
        for i in rows[~is_there].tolist()
    }
    return _Placed(plant, problems, {})


def _key(line: NDArray[np.int64], number: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return one number for a row and a number in it; both have 31 bits at most."""
    key: NDArray[np.int64] = (line << 31) | number
    return key


def _by_position(
    reported: Reported, grid: PlantGrid, rows: NDArray[np.intp], options: FindingsOptions
) -> _Placed:
    """Snap records to the nearest plant, and tell where that is doubtful.

    Another plant could be the nearest if the line halfway between the two is closer to the
    position than its accuracy.
    """
    plant = np.full(len(reported), -1, np.int64)
    near = _is_near(reported.lonlat[rows], grid)
    problems = dict.fromkeys(rows[~near].tolist(), "it lies far from the plot")
    rows = rows[near]
    if not len(rows):
        return _Placed(plant, problems, {})
    xy_m = grid.frame.xy_m(reported.lonlat[rows])
    first, rival, margin_m = _nearest(grid, xy_m)
    plant[rows] = first
    step = np.abs(xy_m - grid.xy_m[first])
    half = np.array([grid.plant_spacing_m, grid.row_spacing_m]) / 2 + _TOUCH_M
    stated = reported.accuracy_m[rows]
    told = 0.0 if options.accuracy_m is None else options.accuracy_m
    accuracy_m = np.where(np.isnan(stated), told, stated)
    doubts = {}
    for k in np.flatnonzero(margin_m <= accuracy_m + _TOUCH_M).tolist():
        doubts[int(rows[k])] = (
            f"with an accuracy of {accuracy_m[k]:.2g} m it may be {_label(grid, first[k])} or "
            f"{_label(grid, rival[k])}"
        )
    for k in np.flatnonzero((step > half).any(axis=1)).tolist():
        doubts[int(rows[k])] = (
            f"it lies {np.hypot(*step[k]):.1f} m from the nearest plant, {_label(grid, first[k])}, "
            "which is more than half the spacing"
        )
    return _Placed(plant, problems, doubts)


def _nearest(
    grid: PlantGrid, xy_m: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Return the nearest plant ``(m,)``, the rival nearest to taking its place, and by how much."""
    among = min(_NEIGHBOURS, len(grid))
    distance_m, near = cKDTree(grid.xy_m).query(xy_m, k=np.arange(1, among + 1))
    vine = grid.vine[near]
    first = vine[:, 0].astype(np.int64)
    apart = np.hypot(*(grid.xy_m[near] - grid.xy_m[near[:, :1]]).transpose(2, 0, 1))
    gap = distance_m**2 - distance_m[:, :1] ** 2
    other = (vine != vine[:, :1]) & (apart > 0)
    margin_m = np.divide(gap, 2 * apart, out=np.full_like(gap, np.inf), where=other)
    best = np.argmin(margin_m, axis=1)
    at = np.arange(len(xy_m))
    return first, vine[at, best].astype(np.int64), margin_m[at, best]


def _label(grid: PlantGrid, plant: int) -> str:
    label = row_label(grid, np.array([plant]))
    return f"row {label.line[0]}, number {label.number[0]}"


def _own_doubts(reported: Reported) -> dict[int, str]:
    return {i: str(reported.doubt[i]) for i in np.flatnonzero(reported.doubt != "").tolist()}


def _listed(
    reported: Reported, why: dict[int, str], verdict: str, remedy: Remedy | None
) -> list[ImportMessage]:
    """Return a finding for each of the first records, and one for the rest."""
    make = dropped if verdict.startswith("cannot") else doubtful
    rows = sorted(why)
    findings = [
        make(f"It {verdict}: {why[i]}.", f"record {reported.source_row[i]}", remedy)
        for i in rows[:_LISTED]
    ]
    if len(rows) > _LISTED:
        findings.append(make(f"{len(rows) - _LISTED} more record(s) are so.", None, remedy))
    return findings


def _about_faces(
    reported: Reported, grid: PlantGrid, plant: NDArray[np.int64], taken: NDArray[np.bool_]
) -> list[ImportMessage]:
    unsaid = taken & (reported.plant < 0) & (reported.face == 0)
    unsaid[unsaid] = grid.twin[plant[unsaid]] >= 0
    if not unsaid.any():
        return []
    said = f"{int(unsaid.sum())} record(s) do not say which face of a plant; taken for the first."
    return [guessed(said)]


def _about_accuracy(
    reported: Reported, options: FindingsOptions, snapped: NDArray[np.bool_]
) -> list[ImportMessage]:
    unsaid = snapped & np.isnan(reported.accuracy_m)
    if options.accuracy_m is not None or not unsaid.any():
        return []
    said = f"{int(unsaid.sum())} position(s) state no accuracy and were taken as exact."
    return [
        guessed(said, None, Remedy("accuracy_m", "3", "Say how far off they may be, in metres"))
    ]


def _findings(reported: Reported, plant: NDArray[np.int64], rows: NDArray[np.intp]) -> Findings:
    # a clean plant has none of them; what could not be inspected was not counted
    result = np.array([_RESULTS[int(code)] for code in reported.result[rows]], dtype=np.int8)
    count = np.where(result == FOUND, reported.count[rows], np.nan)
    count[count == 0] = np.nan
    return Findings(
        plant=plant[rows].astype(np.int32),
        result=result,
        count=count,
        when=reported.when[rows],
        day=reported.day[rows],
        who=reported.who[rows],
        notes=reported.notes[rows],
        source_row=reported.source_row[rows],
        digest=digests(
            plant[rows],
            np.where(
                np.isnat(reported.when[rows]),
                reported.day[rows].astype(np.str_),
                reported.when[rows].astype(np.str_),
            ),
            result,
            count,
            reported.who[rows],
        ),
    )


def digests(
    plant: NDArray[np.integer],
    time: NDArray[np.str_],
    result: NDArray[np.int8],
    count: NDArray[np.float64],
    who: NDArray[np.str_],
) -> NDArray[np.str_]:
    """Return 32 hexadecimal digits for each finding ``(k,)``.

    ``time`` is ISO 8601 to the second, or the day alone where there is no clock time, or ``NaT``.
    """
    columns = zip(
        plant.tolist(), time.tolist(), result.tolist(), count.tolist(), who.tolist(), strict=True
    )
    texts = ("\x1f".join((str(p), t, str(r), f"{c:.9g}", w.strip())) for p, t, r, c, w in columns)
    return np.array([hashlib.sha256(t.encode()).hexdigest()[:32] for t in texts], dtype="U32")


def _once_each(findings: Findings) -> Findings:
    _, first = np.unique(findings.digest, return_index=True)
    return findings.take(np.sort(first))
