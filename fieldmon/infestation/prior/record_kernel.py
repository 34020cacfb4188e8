"""What records say about the plants near them: each at its own plant, and about it.

Records move each plant away from its base, oldest first, and the base takes it back with a
half-life. So newer evidence outweighs older evidence of the same place, and of records of one day
the order does not matter.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numba as nb
import numpy as np

from fieldmon.compute.jit import kept, routine
from fieldmon.errors import ObservationError
from fieldmon.infestation.chance_bounds import MOST_CHANCE
from fieldmon.infestation.nearby_plants import (
    FAR_M,
    PlantRows,
    SearchRows,
    first_from,
    outside_m,
)
from fieldmon.infestation.records import PRESENT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.infestation.records import Records
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# records are followed no farther than they change a chance by this
_LEAST_CHANGE = 1e-4


class _RecordKernel(NamedTuple):
    """How each record speaks of plants by their distance, ``(m,)`` each: two bells and a reach."""

    own: Floats  # peak at the plant itself
    own_m2: Floats  # variance of that bell
    near: Floats  # peak about it
    near_m2: Floats
    strength: Floats  # factor on both: a clean look's detection
    radius_m: Floats  # beyond it the record says nothing


class _Records(NamedTuple):
    x_m: Floats
    y_m: Floats
    age_days: Floats
    find: NDArray[np.bool_]


def record_chance(
    grid: PlantGrid,
    base: Floats,
    records: Records,
    on_day: np.datetime64,
    settings: PriorSettings,
) -> Floats:
    """Return the chance of infestation ``(n,)`` after taking in records about plants at `base`.

    A record speaks in full of the plant it stands at, as sharply as its position is known, and
    more softly of the plants about it. A find is one more way of being infested,
    1 - (1 - p)(1 - s) with s what it says here; a clean look is Bayes' rule, p (1 - s) / (1 - p s).
    All records must be `usable` ones; raise `ObservationError` if all lie elsewhere than on the
    plot or near it.
    """
    if not len(records):
        return base.copy()
    every = _kernel(grid, records, settings)
    near = _within_reach(grid, records, every.radius_m)
    if not near.any():
        return base.copy()
    nearby = records.take(near)
    xy_m = grid.frame.xy_m(nearby.lonlat)
    age_days = _age_days(nearby, on_day, settings)
    find = nearby.present == PRESENT
    kernel = _RecordKernel(*(column[near] for column in every))
    # oldest first, a day's finds before its clean looks; the rest only settles the last digit
    order = np.lexsort((*kernel, *xy_m.T, ~find, -age_days))
    in_order = _Records(xy_m[order, 0].copy(), xy_m[order, 1].copy(), age_days[order], find[order])
    search = SearchRows.of(grid)
    chance = search.sorted(base)
    _apply_records(
        chance,
        search.rows,
        in_order,
        _RecordKernel(*(column[order] for column in kernel)),
        1.0 / settings.half_life_days,
    )
    return search.numbered(chance)


def _kernel(grid: PlantGrid, records: Records, settings: PriorSettings) -> _RecordKernel:
    find = records.present == PRESENT
    accuracy_m = np.where(records.accuracy_m >= 0.0, records.accuracy_m, settings.accuracy_m)
    # A plant is a bell as heavy as its own ground, so that a record without error says all of it
    # to its own plant; an error of position widens both bells and lowers them, mass kept.
    plant_m2 = grid.row_spacing_m * grid.plant_spacing_m / (2.0 * np.pi)
    own_m2 = plant_m2 + accuracy_m**2
    near_m2 = settings.reach_m**2 + accuracy_m**2
    own = np.where(find, settings.at_record, 1.0) * plant_m2 / own_m2
    near = _about(records, settings) * settings.reach_m**2 / near_m2
    strength = np.where(find, 1.0, _detection(records, settings))
    radius_m = np.maximum(_radius_m(own, own_m2), _radius_m(near, near_m2))
    return _RecordKernel(own, own_m2, near, near_m2, strength, radius_m)


def _about(records: Records, settings: PriorSettings) -> Floats:
    """Return how much each record says of the plants about it: more, the more was counted."""
    count = np.where(np.isnan(records.count), settings.half_count, records.count)
    count = np.where(records.present == PRESENT, np.maximum(count, 0.0), 0.0)
    full = np.where(np.isinf(count), 1.0, count / (np.minimum(count, 1e300) + settings.half_count))
    return settings.beside_one + (settings.beside_many - settings.beside_one) * full


def _detection(records: Records, settings: PriorSettings) -> Floats:
    leaves = records.leaves_sampled
    found = 1.0 - (1.0 - settings.leaf_detection) ** np.where(leaves >= 0.0, leaves, 0.0)
    return np.minimum(np.where(leaves >= 0.0, found, settings.detection), MOST_CHANCE)


def _radius_m(peak: Floats, variance_m2: Floats) -> Floats:
    return np.sqrt(2.0 * variance_m2 * np.log(np.maximum(peak / _LEAST_CHANGE, 1.0)))


def _age_days(records: Records, on_day: np.datetime64, settings: PriorSettings) -> Floats:
    age = (on_day.astype("datetime64[D]") - records.day) / np.timedelta64(1, "D")
    return np.where(np.isnan(age), settings.undated_days, age)


def _within_reach(grid: PlantGrid, records: Records, radius_m: Floats) -> NDArray[np.bool_]:
    off_m = outside_m(grid, records.lonlat)
    near: NDArray[np.bool_] = off_m <= np.minimum(radius_m, FAR_M)
    # of a neighbour's records some are taken for this plot's own, and reach none of its plants
    if (near | (off_m <= records.reach_m())).any():
        return near
    turned_m = outside_m(grid, records.lonlat[:, ::-1])
    turned = turned_m.min() <= radius_m.max()
    raise ObservationError(
        f"At least one record must lie on the plot or within {radius_m.max():.0f} m of it, but "
        f"of {len(records)} the nearest is {_in_words(off_m.min())}. "
        + (
            "With longitude and latitude exchanged they would lie there: give longitude first."
            if turned
            else "Check the coordinate system, the order of longitude and latitude, "
            "and whether the records belong to this plot."
        )
    )


def _in_words(metres: float) -> str:
    if not np.isfinite(metres):
        return "nowhere on Earth (longitude and latitude must be in degrees)"
    return f"{metres:.0f} m away" if metres < 1000.0 else f"{metres / 1000.0:.0f} km away"


@routine
def _apply_records(
    chance: Floats, rows: PlantRows, records: _Records, kernel: _RecordKernel, fade_per_day: float
) -> None:
    """Let each record, in order, change the plants in its radius; then age them all to today."""
    base = chance.copy()
    age_days = np.zeros(chance.size)  # as old as the last record that spoke of the plant
    for r in range(records.x_m.size):
        x, y, radius = records.x_m[r], records.y_m[r], kernel.radius_m[r]
        age = records.age_days[r]
        for row in range(rows.low_m.size):
            if rows.low_m[row] > y + radius or rows.high_m[row] < y - radius:
                continue
            end = rows.start[row + 1]
            i = first_from(rows.x_m, rows.start[row], end, x - radius)
            while i < end and rows.x_m[i] <= x + radius:
                square = (rows.x_m[i] - x) ** 2 + (rows.y_m[i] - y) ** 2
                if square <= radius * radius:
                    own = kernel.own[r] * np.exp(-0.5 * square / kernel.own_m2[r])
                    near = kernel.near[r] * np.exp(-0.5 * square / kernel.near_m2[r])
                    says = kernel.strength[r] * (1.0 - (1.0 - own) * (1.0 - near))
                    p = _aged(chance[i], base[i], (age_days[i] - age) * fade_per_day)
                    if records.find[r]:
                        p = min(1.0 - (1.0 - p) * (1.0 - says), MOST_CHANCE)
                    else:
                        p = p * (1.0 - says) / (1.0 - p * says)
                    chance[i], age_days[i] = p, age
                i += 1
    for i in range(chance.size):
        chance[i] = _aged(chance[i], base[i], age_days[i] * fade_per_day)


@kept
@nb.njit(inline="always")
def _aged(chance: float, base: float, half_lives: float) -> float:
    # a plant not spoken of yet sits at its base, whatever time has passed
    return chance if half_lives <= 0.0 else base + (chance - base) * 0.5**half_lives
