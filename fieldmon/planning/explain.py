"""Why a day goes where it goes, in sentences for the person who drives it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import cKDTree

from fieldmon.compute.wording import counted, joined, worded
from fieldmon.plot.grid import plant_numbers, row_ends
from fieldmon.samplers.base import NEVER

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.planning.workday import Workday
    from fieldmon.samplers.base import Scene

# an infestation is followed so far from a find: three plants or rows, whichever is more
_AROUND = 3.0
# rows that lie this near are one block, and more blocks than this are told together
_GAP, _BLOCKS = 2, 6
# more finds than this, and one, are told together
_FINDS = 5


def explain(
    scene: Scene,
    work: Workday,
    finds: NDArray[np.int32] | None = None,
    found_on: Sequence[str] = (),
    recorded: NDArray[np.bool_] | None = None,
) -> list[str]:
    """Return what a day's stops are for: those around finds first, then the blocks of rows.

    Parameters
    ----------
    finds
        ``(f,)`` plants found infested lately.
    found_on
        ``(f,)`` when each was found, as it is to be said: "Tuesday", "day 3".
    recorded
        ``(n,)`` plants of which records speak that are older than all inspections.
    """
    if not len(work):
        return [worded("No plant can be reached in the hours left.")]
    finds = np.empty(0, np.int32) if finds is None else finds
    near = _nearest_find(scene, work.plant, finds)
    recorded = np.zeros(len(scene.grid), bool) if recorded is None else recorded
    blocks = _blocks(scene, work.plant[near < 0], recorded)
    return _told_finds(scene, near, finds, found_on) + blocks


def _told_finds(
    scene: Scene, near: NDArray[np.intp], finds: NDArray[np.int32], found_on: Sequence[str]
) -> list[str]:
    """Return a sentence for each find with plants to look at around it, the most plants first."""
    which, count = np.unique(near[near >= 0], return_counts=True)
    order = np.argsort(-count, kind="stable")
    few = order if len(order) <= _FINDS + 1 else order[:_FINDS]
    said: list[str] = []
    for find, around in zip(which[few].tolist(), count[few].tolist(), strict=True):
        line, number = (int(part[0]) for part in plant_numbers(scene.grid, finds[[find]]))
        words: dict[str, Any] = {
            "plants": counted(around, "plant"), "row": scene.grid.line_signs[line],
            "number": number,
        }  # fmt: skip
        if not scene.grid.in_rows:
            sentence = worded("{plants} around the find at plant {number}.", **words)
        elif len(found_on) and any(map(str.isdigit, found_on[find])):  # a date
            sentence = worded("{plants} around the find of {day} in row {row}, plant {number}.",
                              day=found_on[find], **words)  # fmt: skip
        elif len(found_on):
            sentence = worded("{plants} around {day}'s find in row {row}, plant {number}.",
                              day=found_on[find], **words)  # fmt: skip
        else:
            sentence = worded("{plants} around the find in row {row}, plant {number}.", **words)
        said.append(sentence)
    if len(few) == len(order):
        return said
    rest = order[_FINDS:]
    around = counted(int(count[rest].sum()), "plant")
    return [*said, worded("{plants} around {n} other {n:find|finds}.", plants=around, n=len(rest))]


def _nearest_find(
    scene: Scene, plants: NDArray[np.int32], finds: NDArray[np.int32]
) -> NDArray[np.intp]:
    """Return which find each plant ``(k,)`` is near, -1 if none."""
    if not len(finds):
        return np.full(len(plants), -1)
    reach_m = _AROUND * max(scene.grid.row_spacing_m, scene.grid.plant_spacing_m)
    tree = cKDTree(scene.grid.xy_m[finds])
    _, find = tree.query(scene.grid.xy_m[plants], distance_upper_bound=reach_m)
    near: NDArray[np.intp] = np.where(find == len(finds), -1, find)
    return near


def _blocks(scene: Scene, plants: NDArray[np.int32], recorded: NDArray[np.bool_]) -> list[str]:
    """Return a sentence for each block of rows, in the order of the first stop in it."""
    if not len(plants):
        return []
    line = plant_numbers(scene.grid, plants).line
    # as they lie on the ground, whatever their numbers
    place = scene.grid.row_line[scene.grid.row[plants]]
    places = np.unique(place)
    block_of_place = np.cumsum(np.diff(places, prepend=places[0]) > _GAP)
    block = block_of_place[np.searchsorted(places, place)]
    order = list(dict.fromkeys(block.tolist()))
    if len(order) > _BLOCKS:
        order, block = [0], np.zeros_like(block)
    return [_block(scene, plants[block == each], line[block == each], recorded) for each in order]


def _block(
    scene: Scene,
    plants: NDArray[np.int32],
    line: NDArray[np.int64],
    recorded: NDArray[np.bool_],
) -> str:
    low, high = row_ends(scene.grid, line)
    plants_said = counted(len(plants), "plant")
    where = worded("in rows {low} to {high}", low=low, high=high)
    if not scene.grid.in_rows:
        where = worded("in no rows")
    elif low == high:
        where = worded("in row {row}", row=low)
    last = scene.last_inspected[plants]
    # they seem inspected today, but somebody wishes for them
    skipped, flagged = (
        np.zeros(len(plants), np.bool_) if left_out is None else left_out[plants]
        for left_out in (scene.skipped, scene.flagged)
    )
    wished = scene.left_out[plants]
    unseen = last == NEVER
    never = int(np.count_nonzero(unseen & ~recorded[plants]))
    known = int(np.count_nonzero(unseen)) - never
    if never == len(plants):
        return worded("{plants} {where}: never inspected yet.", plants=plants_said, where=where)
    said = [worded("{n} known from records only", n=known)] if known else []
    tried, found = int(np.count_nonzero(skipped)), int(np.count_nonzero(flagged))
    if seen := len(plants) - never - known - tried - found:
        days = counted(round(float(np.median(scene.day - last[~unseen & ~wished]))), "day")
        since = worded("not inspected for {days}", days=days)
        if seen < len(plants):
            since = worded("{n} not inspected for {days}", n=seen, days=days)
        said = [since, *said]
    if never:
        said.append(worded("{n} never inspected yet", n=never))
    if tried:
        said.append(worded("{n} nobody could inspect last time", n=tried))
    if found:
        said.append(worded("{n} found and only flagged", n=found))
    all_said = joined(", ", said)
    return worded("{plants} {where}: {said}.", plants=plants_said, where=where, said=all_said)
