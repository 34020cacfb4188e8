"""Dynamic, the thesis's sampler: the nearest suspicious plant next, more of them after a find."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import as_compiled
from fieldmon.compute.jit import inner_inlined, inner_loop, loop
from fieldmon.errors import SettingError
from fieldmon.plot.travel import Clock, in_time, travel_s
from fieldmon.samplers.base import Sampler, Scene, Stops

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Csr, PlantGrid
    from fieldmon.plot.travel_table import TravelTable
    from fieldmon.samplers.base import WouldFind

# the upper bits of a positive float64 rise with it, in 8 steps an octave: 7 to 13 % each
_LEVEL_BITS = 49
_OCTAVE = 8
# a bound stays one however its sum is rounded
_NEARLY = 1.0 - 1e-9


class _Open(NamedTuple):
    """The open list: a flag per plant, and per row how many are open and between which.

    And room to count plants by how many levels they are below the most suspicious, and for those
    that come into question.
    """

    flag: NDArray[np.bool_]
    n_open: NDArray[np.int64]
    low: NDArray[np.int64]
    high: NDArray[np.int64]
    tally: NDArray[np.int64]
    asked: NDArray[np.int32]

    @classmethod
    def on(cls, grid: PlantGrid, steps: int) -> _Open:
        """Return an empty list, with room for so many levels."""
        return cls(
            np.zeros(len(grid), np.bool_),
            np.zeros(grid.n_rows, np.int64),
            grid.row_start[1:].copy(),
            grid.row_start[:-1] - 1,
            np.empty(steps, np.int64),
            np.empty(len(grid), np.int32),
        )


@dataclass(frozen=True)
class Dynamic(Sampler):
    """Drive to the nearest plant of an open list until the day is over.

    The open list starts with the suspicious plants. An inspected plant leaves it; after a find the
    plants next to it, along and across the rows, join it unless they were inspected today. When it
    is empty it is refilled with suspicious plants not yet visited today.

    The thesis does not say who is suspicious. Here it is every plant whose chance of infestation
    is at least half that of the most suspicious one not yet visited today, but no more plants
    than the day can still hold: the more suspicious first, in steps of about a tenth, then in
    the order of the rows.

    Parameters
    ----------
    suspicious
        Share of the most suspicious plant's chance from which a plant is suspicious (our choice).
    at_once
        How much of what the day can still hold is opened at once (our choice: all).
    """

    suspicious: float = 0.5
    at_once: float = 1.0

    def __post_init__(self) -> None:
        for name in ("suspicious", "at_once"):
            if not 0.0 < getattr(self, name) <= 1.0:
                raise SettingError(
                    f"Dynamic's {name} must be above 0 and at most 1, "
                    f"but it is {getattr(self, name)}."
                )

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day."""
        steps = round(-_OCTAVE * math.log2(self.suspicious))
        grid, chance_bits = scene.grid, as_compiled(scene.chance.view(np.int64))
        finds = as_compiled(would_find.view(np.uint8))
        return scene.walked(
            _walk,
            (grid.adjacent, scene.aisles.onward_m, chance_bits, finds),
            (scene.last_inspected == scene.day, _Open.on(grid, steps)),
            (scene.at, steps, self.at_once),
        )


@loop
def _walk(
    travel: TravelTable,
    clock: Clock,
    plants: tuple[Csr, NDArray[np.float32], NDArray[np.int64], NDArray[np.uint8]],
    lists: tuple[NDArray[np.bool_], _Open],
    start: tuple[int, int, float],
    stops: Stops,
) -> int:
    at, steps, at_once = start
    adjacent, onward_m, chance_bits, would_find = plants
    inspected, opened = lists
    now_s, k, left = 0.0, 0, 0
    while k < stops.plant.size:
        if left == 0:
            room = int(at_once * ((clock.seconds_left - now_s) // clock.visit_s))
            left = _refill(travel, opened, (inspected, chance_bits), (max(room, 1), steps))
            if left == 0:
                break
        plant, way_s = _nearest(travel, clock, opened, onward_m, at)
        if not in_time(travel, clock, plant, now_s + way_s):
            break
        now_s += way_s
        stops.plant[k], stops.arrive_s[k] = plant, now_s
        now_s += clock.visit_s
        k += 1
        at = plant
        inspected[plant] = True
        opened.flag[plant] = False
        opened.n_open[travel.row[plant]] -= 1
        left -= 1
        if would_find[plant]:
            for e in range(adjacent.start[plant], adjacent.start[plant + 1]):
                left += _open(travel, opened, inspected, adjacent.plant[e])
    return k


@inner_inlined
def _open(travel: TravelTable, opened: _Open, inspected: NDArray[np.bool_], plant: int) -> int:
    """Put a plant on the open list; return how many joined it (0 or 1)."""
    if inspected[plant] or opened.flag[plant]:
        return 0
    row = travel.row[plant]
    opened.flag[plant] = True
    opened.n_open[row] += 1
    opened.low[row] = min(opened.low[row], plant)
    opened.high[row] = max(opened.high[row], plant)
    return 1


@inner_loop
def _refill(
    travel: TravelTable,
    opened: _Open,
    plants: tuple[NDArray[np.bool_], NDArray[np.int64]],
    limits: tuple[int, int],
) -> int:
    """Open the suspicious plants not yet inspected today, `room` at most; return how many.

    Called when none is open.
    """
    inspected, chance_bits = plants
    room, steps = limits
    most = np.int64(0)
    for plant in range(inspected.size):
        bits = np.int64(0) if inspected[plant] else chance_bits[plant]
        most = bits if bits > most else most  # noqa: FURB136 - max is slower
    top = most >> _LEVEL_BITS
    n = 0
    for plant in range(inspected.size):
        # written either way: to foresee which ones come into question is what costs
        opened.asked[n] = plant
        n += (top - (chance_bits[plant] >> _LEVEL_BITS) <= steps) & (not inspected[plant])
    least, even = steps + 1, 0
    if n > room:
        least, even = _least_of(opened, chance_bits, (n, room), (top, steps))
    joined, row, in_row = 0, 0, 0
    for plant in opened.asked[:n]:
        below = top - (chance_bits[plant] >> _LEVEL_BITS)
        if below >= least:
            if below > least or even == 0:
                continue
            even -= 1
        if in_row == 0 or travel.row[plant] != row:
            row, in_row = 0 + travel.row[plant], 0
            opened.low[row] = plant
        in_row += 1
        opened.flag[plant] = True
        opened.n_open[row], opened.high[row] = in_row, plant
        joined += 1
    return joined


@inner_loop
def _least_of(
    opened: _Open,
    chance_bits: NDArray[np.int64],
    asked: tuple[int, int],
    levels: tuple[np.int64, int],
) -> tuple[int, int]:
    """Return the lowest level of which some have room, and how many of that one."""
    n, room = asked
    top, steps = levels
    opened.tally[:] = 0
    for plant in opened.asked[:n]:
        below = top - (chance_bits[plant] >> _LEVEL_BITS)
        if below < steps:
            opened.tally[below] += 1
    most_below = min(steps, int(top))
    least, above = 0, 0
    while least < most_below and above + opened.tally[least] < room:
        above += opened.tally[least]
        least += 1
    return least, room - above


@inner_inlined
def _nearest(
    travel: TravelTable, clock: Clock, opened: _Open, onward_m: NDArray[np.float32], at: int
) -> tuple[int, float]:
    """Return the open plant that is reached first from `at` (a plant or the gate), and the seconds.

    Rows are looked at outward from the robot's own, until driving out of its aisle and to the next
    one or any beyond it would already take longer than to the best plant so far.
    """
    best, best_s = -1, np.inf
    own, out_m = 0, 0.0
    if at >= 0:
        own = travel.row[at]
        low_m, high_m = travel.end_x_m[own, 0], travel.end_x_m[own, 1]
        out_m = min(abs(travel.x_m[at] - low_m), abs(high_m - travel.x_m[at]))
    for step in (1, -1):
        row = own if step == 1 else own - 1
        while 0 <= row < opened.n_open.size:
            if at >= 0 and row != own:
                least_m = (onward_m[own, row] + out_m) * _NEARLY
                if least_m / clock.speed_m_s + clock.row_change_s > best_s:
                    break
            if opened.n_open[row] > 0:
                plant, plant_s = _nearest_in(travel, clock, opened, at, row)
                if plant_s < best_s:
                    best, best_s = plant, plant_s
            row += step
    return best, best_s


@inner_inlined
def _nearest_in(
    travel: TravelTable, clock: Clock, opened: _Open, at: int, row: int
) -> tuple[int, float]:
    """Return the open plant of a row that is reached first, and the seconds."""
    if at >= 0 and travel.corridor[row] == travel.corridor[travel.row[at]]:
        return _nearest_along(travel, clock, opened, at, row)
    return _nearest_end(travel, clock, opened, at, row)


@inner_inlined
def _nearest_end(
    travel: TravelTable, clock: Clock, opened: _Open, at: int, row: int
) -> tuple[int, float]:
    """Return the outermost open plant of another row that is reached first, and the seconds.

    Such a row is entered by one of its ends, so no plant between the two outermost is nearer.
    """
    while not opened.flag[opened.low[row]]:
        opened.low[row] += 1
    while not opened.flag[opened.high[row]]:
        opened.high[row] -= 1
    low, high = opened.low[row], opened.high[row]
    low_s = travel_s(travel, clock, at, low)
    if low == high:
        return low, low_s
    high_s = travel_s(travel, clock, at, high)
    return (low, low_s) if low_s <= high_s else (high, high_s)


@inner_inlined
def _nearest_along(
    travel: TravelTable, clock: Clock, opened: _Open, at: int, row: int
) -> tuple[int, float]:
    """Return the open plant of a row in the same aisle that is reached first, and the seconds."""
    best, best_s = -1, np.inf
    start, end = travel.row_start[row], travel.row_start[row + 1]
    middle = at
    if row != travel.row[at]:
        middle = start + np.searchsorted(travel.x_m[start:end], travel.x_m[at])
    plant = max(middle, opened.low[row])
    while plant <= opened.high[row] and not opened.flag[plant]:
        plant += 1
    if plant <= opened.high[row]:
        best, best_s = plant, travel_s(travel, clock, at, plant)
    else:
        # none from here on up: not to be looked through again
        opened.high[row] = min(opened.high[row], middle - 1)
    plant = min(middle - 1, opened.high[row])
    while plant >= opened.low[row]:
        if (travel.x_m[at] - travel.x_m[plant]) / clock.speed_m_s >= best_s:
            return best, best_s
        if opened.flag[plant]:
            plant_s = travel_s(travel, clock, at, plant)
            return (plant, plant_s) if plant_s < best_s else (best, best_s)
        plant -= 1
    opened.low[row] = max(opened.low[row], middle)
    return best, best_s
