"""Which plant each record of inspections means: by its number, by its row, or by its position.

Decisions
---------
- A plant is known by its number in the grid, as every file given out has it (column ``plant``);
  else by row and number in it, as people count, or by their names in the plot's file; else by
  position. Where a file has a row but no
  number in it, ``plant`` is read as that number.
- Where a plot has several blocks and a file names them, rows may be counted from 1 in each. How
  they were counted is said.
- A position is snapped to the nearest plant. It is doubtful where, within its accuracy, another
  plant could be the nearest, or where it lies further than half the spacing from the nearest,
  along the row or across.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from fieldmon.compute.wording import runs, worded
from fieldmon.infestation.records import NEARBY_M
from fieldmon.io.import_report import guessed
from fieldmon.io.readers.inspection_file.inspection_rows import UNSAID
from fieldmon.plot.grid import block_number, plant_numbers, row_in_block
from fieldmon.plot.named_rows import CalledPlants, CalledRows, called_blocks, key

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.plot.grid import PlantGrid

    #: what the rows or the plants of records are called
    Names = NDArray[np.str_]

_NEIGHBOURS = 13  # plants among which the nearest and its rivals are: two rings, or both faces
_FARTHEST_DEG = 1.0
_TOUCH_M = 1e-3


class PlantsFound(NamedTuple):
    """Plants ``(m,)``, -1 for none; why records cannot be placed, or are doubtful, by index.

    And what else there is to say.
    """

    plant: NDArray[np.int64]
    problems: dict[int, str]
    doubts: dict[int, str]
    said: tuple[ImportMessage, ...] = ()


def by_number(rows: InspectionRows, grid: PlantGrid) -> PlantsFound:
    """Place records that name the plant's number, and hold it against whatever else they say."""
    stated = rows.plant
    plant = np.where((stated >= 0) & (stated < len(grid)), stated, -1)
    problems: dict[int, str] = {
        i: worded(
            "plant {plant} is none of 0 to {last} on this plot",
            plant=stated[i],
            last=len(grid) - 1,
        )
        for i in np.flatnonzero((stated >= len(grid)) | (stated < -1)).tolist()
    }
    doubts: dict[int, str] = {}
    here = np.flatnonzero(plant >= 0)
    numbered = plant_numbers(grid, plant[here])
    line, number = rows.line[here], rows.number[here]
    other = (line != UNSAID) & ((numbered.line != line) | (numbered.number != number))
    for k in np.flatnonzero(other).tolist():
        doubts[int(here[k])] = worded(
            "plant {plant} is {label} on this plot, but the record says row {row}, number {number}",
            plant=plant[here[k]],
            label=_label(grid, plant[here[k]]),
            row=line[k],
            number=number[k],
        )
    return PlantsFound(plant, problems, doubts)


def misplaced(rows: InspectionRows, grid: PlantGrid, plant: NDArray[np.int64]) -> dict[int, str]:
    """Return which records name a plant ``(m,)`` that stands elsewhere than their position."""
    here = np.flatnonzero(plant >= 0)
    far_m = from_plants_m(rows, grid, here, plant[here])
    spacing_m = max(grid.row_spacing_m, grid.plant_spacing_m)
    reach_m = spacing_m + 3 * np.nan_to_num(rows.accuracy_m[here])
    return {
        int(here[k]): worded(
            "{plant} is {far_m:.1f} m from the record's position: is it a file for another plot?",
            plant=_label(grid, plant[here[k]]),
            far_m=far_m[k],
        )
        if np.isfinite(far_m[k])
        else worded("it lies far from the plot")
        for k in np.flatnonzero(far_m > reach_m).tolist()
    }


def from_plants_m(
    rows: InspectionRows, grid: PlantGrid, records: NDArray[np.intp], plant: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Return how far records lie from plants, NaN without a position, infinity beyond a degree."""
    lonlat = rows.lonlat[records]
    near = _is_near(lonlat, grid)
    away_m = np.where(np.isfinite(lonlat).all(axis=1), np.inf, np.nan)
    if near.any():
        step = grid.frame.xy_m(lonlat[near]) - grid.xy_m[plant[near]]
        away_m[near] = np.hypot(step[:, 0], step[:, 1])
    return away_m


def _is_near(lonlat: NDArray[np.float64], grid: PlantGrid) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        off = lonlat - (grid.frame.lon, grid.frame.lat)
        off[:, 0] = (off[:, 0] + 180.0) % 360.0 - 180.0  # across the date line it is near, too
        off = np.abs(off)
        return np.asarray((off < _FARTHEST_DEG).all(axis=1), dtype=bool)


def by_name(
    rows: InspectionRows, grid: PlantGrid
) -> tuple[InspectionRows, dict[int, str], tuple[ImportMessage, ...]]:
    """Return records with the numbers of plants that they call as the plot's file does.

    And why some cannot be placed, and what else there is to say.
    """
    own = (grid.line_called, grid.line_named, grid.plant_called, grid.plant_named)
    if rows.row_called is None or rows.plant_called is None or all(one is None for one in own):
        return rows, {}, ()
    names = rows.row_called, rows.plant_called
    rows, messages = _by_plant_alone(rows, names, grid)
    rows, problems = _by_row_and_plant(rows, names, grid)
    return rows, problems, messages


def _by_plant_alone(
    rows: InspectionRows, names: tuple[Names, Names], grid: PlantGrid
) -> tuple[InspectionRows, tuple[ImportMessage, ...]]:
    """Return records with the plants that they name without a row, and what to say of these."""
    row_called, plant_called = names
    plants, plant = CalledPlants(grid), rows.plant.copy()
    alone = (rows.line == UNSAID) & _has_no_place(rows)
    alone &= (row_called == "") & (plant_called != "")
    for i in np.flatnonzero(alone).tolist():
        found = plants.plant(str(plant_called[i]))
        alone[i] = found is not None
        if found is not None:
            plant[i] = found
    if not alone.any():
        return rows, ()
    line, number, numbered = rows.line.copy(), rows.number.copy(), plant_numbers(grid, plant[alone])
    line[alone], number[alone] = numbered.line, numbered.number
    said = worded(
        "{n} {n:record names a plant|records name plants} alone: taken as the plot's file "
        "calls {n:it|them}.",
        n=int(alone.sum()),
    )
    return replace(rows, plant=plant, line=line, number=number), (guessed(said),)


def _by_row_and_plant(
    rows: InspectionRows, names: tuple[Names, Names], grid: PlantGrid
) -> tuple[InspectionRows, dict[int, str]]:
    """Return records with the rows and plants that they name as numbers, and why some are none."""
    row_called, plant_called = names
    called, plants, blocks = CalledRows(grid), CalledPlants(grid), called_blocks(grid)
    line, number, open_yet = rows.line.copy(), rows.number.copy(), _has_no_place(rows)
    problems: dict[int, str] = {}
    for i in np.flatnonzero((row_called != "") & (rows.plant < 0)).tolist():
        row, said = str(row_called[i]), str(plant_called[i])
        of = str(rows.block[i]) if grid.n_blocks > 1 else ""
        meant = called.meant(row, blocks.get(key(of), 0) if of else None)
        if len(meant) > 1:
            problems[i] = worded(
                "{row} may be any of rows {some} here, by their numbers or by their names in the "
                "file of plants",
                row=row,
                some=runs(meant),
            )
            continue
        labels = [(one, which) for one in meant for which in plants.meant(one, said)]
        if len(labels) == 1:
            line[i], number[i] = labels[0]
        elif labels or (open_yet[i] and not (row.isdecimal() and said.isdecimal())):
            problems[i] = _unknown(called, row, said, [which for _, which in labels])
    return replace(rows, line=line, number=number), problems


def _has_no_place(rows: InspectionRows) -> NDArray[np.bool_]:
    return np.asarray(~np.isfinite(rows.lonlat.sum(axis=1)), dtype=bool)


def _unknown(called: CalledRows, row: str, plant: str, numbers: list[int]) -> str:
    """Return why no one plant is meant: its row is none of the plot, or has none or several."""
    if numbers:
        return worded(
            "plant {plant} may be any of plants {some} of row {row} here, by their numbers or by "
            "their names in the file of plants",
            plant=plant,
            some=runs(numbers),
            row=row,
        )
    if called.meant(row):
        return worded("row {row} has no plant {plant} here", row=row, plant=plant)
    return worded(
        "no row is called {row} here. Rows of this plot are {some}", row=row, some=called.listed()
    )


def by_label(rows: InspectionRows, grid: PlantGrid, wanted: NDArray[np.bool_]) -> PlantsFound:
    """Place records that name a row and a number in it."""
    plant = np.full(len(rows), -1, np.int64)
    is_named = (rows.line != UNSAID) & ~below_first(rows, grid)
    records = np.flatnonzero(wanted & is_named)
    if not len(records):
        return PlantsFound(plant, {}, {})
    first, said = _labelled(rows, grid, records)
    is_there = first >= 0
    second = (rows.face[records] == 2) & (grid.twin[first] >= 0)
    plant[records] = np.where(is_there, np.where(second, grid.twin[first], first), -1)
    problems: dict[int, str] = {
        i: worded(
            "there is no plant {number} in row {row}{of_block}",
            number=rows.number[i],
            row=rows.line[i],
            of_block=_of_block(rows, grid, i),
        )
        for i in records[~is_there].tolist()
    }
    return PlantsFound(plant, problems, {}, said)


def below_first(rows: InspectionRows, grid: PlantGrid) -> NDArray[np.bool_]:
    """Return which records name a row or a plant below 1, where the plot has none so low."""
    numbered = plant_numbers(grid)
    row = min(1, int(numbered.line.min()), int(row_in_block(grid).min()))
    plant = min(1, int(numbered.number.min()))
    below: NDArray[np.bool_] = (rows.line != UNSAID) & ((rows.line < row) | (rows.number < plant))
    return below


def from_zero(rows: InspectionRows, grid: PlantGrid, plant: NDArray[np.int64]) -> dict[int, str]:
    """Return a doubt for each plant ``(m,)`` named by its row where others of the file say row 0.

    Who counts from 0 means the next plant or row each time, and only the first of them shows it.
    """
    if not below_first(rows, grid).any():
        return {}
    why: str = worded(
        "others in the file say row 0 or plant 0: rows and plants are counted from 1 here. Add 1 "
        "where they were counted from 0"
    )
    return dict.fromkeys(np.flatnonzero(plant >= 0).tolist(), why)


def _of_block(rows: InspectionRows, grid: PlantGrid, record: int) -> str:
    if grid.n_blocks == 1 or not rows.block[record]:
        return worded(" on this plot")
    return worded(
        " of block {block} (blocks are 1 to {last} on this plot)",
        block=rows.block[record],
        last=grid.n_blocks,
    )


def _labelled(
    rows: InspectionRows, grid: PlantGrid, records: NDArray[np.intp]
) -> tuple[NDArray[np.int64], tuple[ImportMessage, ...]]:
    """Return the first face of the plant that each record names by row and number; -1 for none.

    Where it names the block too, rows of all records are counted on from block to block, as files
    given out have them, or from 1 in each if more of them are found so.
    """
    numbered = plant_numbers(grid)
    known, line = _key(numbered.line, numbered.number), rows.line[records]
    first = _found(known, _key(line, rows.number[records]))
    named = np.flatnonzero((rows.block[records] != "") & (grid.n_blocks > 1))
    said = _about_blocks(grid, len(records) - len(named))
    if not len(named):
        return first, said
    of_plant, within = block_number(grid), row_in_block(grid)
    numbers = called_blocks(grid)
    block = np.array([numbers.get(key(name), 0) for name in rows.block[records[named]].tolist()])
    first[named] = np.where(of_plant[first[named]] == block, first[named], -1)
    # the row as its block counts, then as all are counted on
    of_row = _found(_key(of_plant, within), _key(block, line[named]))
    also = _found(known, _key(numbered.line[of_row], rows.number[records[named]]))
    also = np.where(of_row >= 0, also, -1)
    if np.count_nonzero(also >= 0) > np.count_nonzero(first[named] >= 0):
        first[named] = also
        said = (*said, guessed(worded("Rows were taken as counted from 1 in each block.")))
    return first, said


def _about_blocks(grid: PlantGrid, unnamed: int) -> tuple[ImportMessage, ...]:
    """Return what to say of records that name a row, but not which block's."""
    if grid.n_blocks == 1 or not unnamed or not grid.counts_on:
        return ()
    said = worded(
        "{n} {n:record names|records name} no block: {n:its row was|their rows were} taken as "
        "counted on from block to block, 1 "
        "to {last}. Where each block counts its rows from 1, give a column of blocks.",
        n=unnamed,
        last=int(grid.line_number.max()),
    )
    return (guessed(said),)


def _found(known: NDArray[np.int64], wished: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the first place at which each wished key is known; -1 for none."""
    keys, first = np.unique(known, return_index=True)
    at = np.minimum(np.searchsorted(keys, wished), len(keys) - 1)
    return np.where(keys[at] == wished, first[at], -1)


def _key(line: NDArray[np.int64], number: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return one number for a row and a number in it; both have 31 bits at most."""
    key: NDArray[np.int64] = (line << 31) | number
    return key


def by_position(
    rows: InspectionRows, grid: PlantGrid, records: NDArray[np.intp], options: InspectionOptions
) -> PlantsFound:
    """Snap records to the nearest plant, and tell where that is doubtful.

    Another plant could be the nearest if the line halfway between the two is closer to the
    position than its accuracy.
    """
    plant = np.full(len(rows), -1, np.int64)
    near = _is_near(rows.lonlat[records], grid)
    far: str = worded("it lies far from the plot")
    problems: dict[int, str] = dict.fromkeys(records[~near].tolist(), far)
    records = records[near]
    if not len(records):
        return PlantsFound(plant, problems, {})
    xy_m = grid.frame.xy_m(rows.lonlat[records])
    first, rival, margin_m = _nearest(grid, xy_m)
    plant[records] = first
    step = np.abs(_along_and_across(grid, first, xy_m - grid.xy_m[first]))
    half = np.array([grid.plant_spacing_m, grid.row_spacing_m]) / 2 + _TOUCH_M
    stated = rows.accuracy_m[records]
    told = 0.0 if options.accuracy_m is None else options.accuracy_m
    accuracy_m = np.where(np.isnan(stated), told, stated)
    doubts: dict[int, str] = {}
    for k in np.flatnonzero(margin_m <= accuracy_m + _TOUCH_M).tolist():
        doubts[int(records[k])] = worded(
            "with an accuracy of {accuracy_m:.2g} m it may be {plant} or {other}",
            accuracy_m=accuracy_m[k],
            plant=_label(grid, first[k]),
            other=_label(grid, rival[k]),
        )
    away_m = np.hypot(*step.T)
    for k in np.flatnonzero((step > half).any(axis=1)).tolist():
        doubts[int(records[k])] = worded(
            "it lies {away_m:.1f} m from the nearest plant, {plant}, which is more than half the "
            "spacing",
            away_m=away_m[k],
            plant=_label(grid, first[k]),
        )
    # as far as records of pests are kept apart, no plant is meant
    for k in np.flatnonzero(away_m > np.maximum(NEARBY_M, 2 * accuracy_m)).tolist():
        problems[int(records[k])] = worded(
            "it lies {away_m:.0f} m from the nearest plant", away_m=away_m[k]
        )
    return PlantsFound(plant, problems, doubts)


def _along_and_across(
    grid: PlantGrid, plant: NDArray[np.int64], way_m: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return ways ``(m, 2)`` from plants as metres along their rows and across."""
    if grid.aisles_m is None or grid.aisle is None:
        return way_m
    ahead = grid.aisles_m.ahead(grid.aisle[grid.row[plant]], grid.along_m[plant])
    aside = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    return np.stack([(way_m * ahead).sum(axis=1), (way_m * aside).sum(axis=1)], axis=1)


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
    numbered = plant_numbers(grid, np.array([plant]))
    return worded(
        "row {line}, number {number}",
        line=numbered.line[0],
        number=numbered.number[0],
    )
