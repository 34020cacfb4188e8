"""From records, edges, paths and rasters to a chance of infestation for every plant.

A plant can be infested in several ways that are taken as independent: from anywhere (background),
from the plot's edge, from a path, for a reason that a raster shows. Those make the *base*. Dated
records then move each plant away from its base, oldest first, and the base takes it back with a
half-life. So newer evidence outweighs older evidence of the same place, and of records of one day
the order does not matter.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, NamedTuple

import numba as nb
import numpy as np
import shapely
from scipy.optimize import brentq
from scipy.special import expit, logit

from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.observations import PRESENT, UNKNOWN

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.observations import Observations
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# edges, paths and records are followed no farther than they change a chance by this
_LEAST_SAY = 1e-4
# nobody is infested for certain: a clean look must be able to undo it
_MOST = 1.0 - 1e-6
# records farther from the plot are not even brought into its plane of metres
_FAR_M = 100_000.0
_EARTH_M = 6_371_000.0


@dataclass(frozen=True)
class PriorSettings:
    """How records, edges and paths become a chance of infestation.

    Where no source is named the value is our choice, for the reason given.

    Parameters
    ----------
    background_chance
        Chance of a plant of which nothing is known, far from edges and paths. Small, not zero:
        mites drift on the wind, so no plant is beyond suspicion.
    edge_chance, edge_depth_m
        Chance added at the plot's boundary (its holes' too: weeds around a pond or a house are a
        margin like any other), and the depth over which it falls to 1/e. That insects enter
        there is Shmuel (2018), through Yehoshua's thesis (2023), which gives no numbers.
    path_chance, path_depth_m
        The same for paths and roads (same sources): people, vehicles and dust carry mites.
    at_record
        Chance that a plant recorded as infested today is infested: short of 1 for the wrong
        plant, the wrong species, a slip of the pen.
    beside_one, beside_many, half_count
        Chance that plants beside a record are infested because of it: where few pests were
        counted, where very many were, and the count that lies half-way (and stands in where
        presence alone was noted). In mapped plots with 13-20 % of the plants infested, 0.21-0.56
        of the neighbours of an infested plant were so too (citrus tristeza 1991, bell pepper
        Phytophthora: the public maps of the R packages epiphy and agridat).
    reach_m
        How far a record speaks for the plants about it: the standard deviation of a round bell.
        Mites crawl from plant to plant where leaves touch: a few plants along, a row or two across.
    accuracy_m
        Position accuracy (1 sigma) of records that do not state theirs. A phone in the open is
        within 4.9 m (GPS.gov).
    half_life_days
        After this time a record counts half. *Tetranychus urticae* grows from egg to adult in
        7-14 days (UMass Extension): by then another generation sits on the plants.
    undated_days
        Age at which records without a date are taken. One half-life: they count half.
    detection
        Chance that a look finds what is there, where the leaves sampled are not stated: the
        quickest look of the thesis's robot (20 s, 50 %).
    leaf_detection
        Chance that one leaf of an infested plant shows it; k leaves miss it by (1 - chance)^k.
        Young infestations sit on few leaves.
    """

    background_chance: float = 0.01
    edge_chance: float = 0.05
    edge_depth_m: float = 10.0
    path_chance: float = 0.05
    path_depth_m: float = 10.0
    at_record: float = 0.95
    beside_one: float = 0.2
    beside_many: float = 0.6
    half_count: float = 10.0
    reach_m: float = 5.0
    accuracy_m: float = 5.0
    half_life_days: float = 14.0
    undated_days: float = 14.0
    detection: float = 0.5
    leaf_detection: float = 0.1

    def __post_init__(self) -> None:
        above_0 = {"edge_depth_m", "path_depth_m", "half_count", "reach_m", "half_life_days"}
        from_0 = {"accuracy_m", "undated_days"}
        for name in (each.name for each in fields(self)):
            value = getattr(self, name)
            if name in above_0 and not 0.0 < value < np.inf:
                raise SettingError(f"The prior's {name} must be above 0, but it is {value}.")
            if name in from_0 and not 0.0 <= value < np.inf:
                raise SettingError(f"The prior's {name} must be 0 or more, but it is {value}.")
            if name not in above_0 | from_0 and not 0.0 <= value <= 1.0:
                raise SettingError(
                    f"The prior's {name} must be a chance in 0..1, but it is {value}."
                )
        if self.beside_many < self.beside_one:
            raise SettingError(
                "Many pests must not say less than one: the prior's beside_many must be at least "
                f"beside_one ({self.beside_one}), but it is {self.beside_many}."
            )


@dataclass(frozen=True, eq=False)
class Usable:
    """The records that speak on a day, and how many others there were.

    Parameters
    ----------
    observations
        Records that say infested or clean, not later than the day; undated ones included.
    undecided, future, undated
        How many were left out because they say neither, because they are of a later day; and how
        many of those kept have no date.
    """

    observations: Observations
    undecided: int
    future: int
    undated: int

    def remarks(self) -> tuple[str, ...]:
        """Return a sentence for each thing that a person should know about the records."""
        said = (
            (self.undecided, "say neither infested nor clean and are left out"),
            (self.future, "are of a later day than the one planned and are left out"),
            (self.undated, "have no date and count as old ones"),
        )
        return tuple(f"{count} of the records {what}." for count, what in said if count)


def usable(observations: Observations, on_day: np.datetime64) -> Usable:
    """Return the records that speak on a day; the caller tells of the others."""
    undecided = observations.present == UNKNOWN
    future = ~undecided & (observations.day > on_day.astype("datetime64[D]"))
    kept = observations.take(~undecided & ~future)
    return Usable(
        observations=kept,
        undecided=int(np.count_nonzero(undecided)),
        future=int(np.count_nonzero(future)),
        undated=int(np.count_nonzero(np.isnat(kept.day))),
    )


def prior_chance(
    grid: PlantGrid,
    field: Field,
    observations: Observations,
    on_day: np.datetime64,
    settings: PriorSettings,
    risk: Floats | None = None,
) -> Floats:
    """Return the chance of infestation of every plant on a morning, ``(n,)`` in [0, 1].

    Only the :func:`usable` records are heard. `risk` is one more way of being infested, ``(n,)``
    in [0, 1], from a raster for instance; NaN where it says nothing.

    Raises
    ------
    ObservationError
        If there are records and none is near enough to say anything about a plant, or if `risk`
        does not fit the plants.
    """
    ways = [
        np.full(len(grid), settings.background_chance),
        edge_chance(grid, settings),
        path_chance(grid, field, settings),
    ]
    if risk is not None:
        ways.append(_checked_risk(grid, risk))
    clean = np.prod([1.0 - way for way in ways], axis=0)
    heard = usable(observations, on_day).observations
    return record_chance(grid, np.minimum(1.0 - clean, _MOST), heard, on_day, settings)


def edge_chance(grid: PlantGrid, settings: PriorSettings) -> Floats:
    """Return the chance that a plant was infested from the plot's edge, ``(n,)``."""
    edges = shapely.boundary(grid.drivable_m)
    return _entering(grid, edges, settings.edge_chance, settings.edge_depth_m)


def path_chance(grid: PlantGrid, field: Field, settings: PriorSettings) -> Floats:
    """Return the chance that a plant was infested from a path or road, ``(n,)``."""
    lon, lat = grid.frame.lon, grid.frame.lat
    # the roads of a whole country may come along: those within a day's drive do
    paths = shapely.clip_by_rect(field.paths, lon - 0.7, lat - 0.7, lon + 0.7, lat + 0.7)
    paths_m = grid.frame.geometry_m(paths)
    return _entering(grid, paths_m, settings.path_chance, settings.path_depth_m)


def record_chance(
    grid: PlantGrid,
    base: Floats,
    observations: Observations,
    on_day: np.datetime64,
    settings: PriorSettings,
) -> Floats:
    """Return the chance of infestation ``(n,)`` after hearing records about plants at `base`.

    A record speaks in full of the plant it stands at, as sharply as its position is known, and
    more softly of the plants about it. A find is one more way of being infested,
    1 - (1 - p)(1 - s) with s what it says here; a clean look is Bayes' rule, p (1 - s) / (1 - p s).
    All records must be :func:`usable` ones; raise `ObservationError` if all are out of reach.
    """
    if not len(observations):
        return base.copy()
    speech = _speech(grid, observations, settings)
    near = _within_reach(grid, observations, speech.radius_m)
    heard = observations.take(near)
    xy_m = grid.frame.xy_m(heard.lonlat)
    age_days = _age_days(heard, on_day, settings)
    find = heard.present == PRESENT
    spoken = _RecordKernel(*(column[near] for column in speech))
    # oldest first, a day's finds before its clean looks; the rest only settles the last digit
    order = np.lexsort((*spoken, *xy_m.T, ~find, -age_days))
    records = _Records(xy_m[order, 0].copy(), xy_m[order, 1].copy(), age_days[order], find[order])
    chance = base.copy()
    _apply_records(
        chance,
        _rows(grid),
        records,
        _RecordKernel(*(column[order] for column in spoken)),
        1.0 / settings.half_life_days,
    )
    return chance


def outside_m(grid: PlantGrid, lonlat: Floats) -> Floats:
    """Return how far positions ``(m, 2)`` lie outside the plot, ``(m,)`` metres; 0 inside.

    To the kilometre beyond 100 km; infinite where the numbers are no longitude and latitude.
    """
    on_earth = (np.abs(lonlat[:, 0]) <= 360.0) & (np.abs(lonlat[:, 1]) <= 90.0)
    lon, lat = (np.deg2rad(np.where(on_earth, degrees, 0.0)) for degrees in lonlat.T)
    lon_0, lat_0 = np.deg2rad([grid.frame.lon, grid.frame.lat])
    chord = np.sin((lat - lat_0) / 2) ** 2 + (
        np.cos(lat) * np.cos(lat_0) * np.sin((lon - lon_0) / 2) ** 2
    )
    off_m: Floats = 2.0 * _EARTH_M * np.arcsin(np.sqrt(np.clip(chord, 0.0, 1.0)))
    off_m[~on_earth] = np.inf
    near = off_m < _FAR_M
    xy_m = grid.frame.xy_m(lonlat[near])
    shapely.prepare(grid.drivable_m)
    # most are inside, and that is soon seen
    beyond = ~shapely.contains_xy(grid.drivable_m, xy_m)
    off_m[near] = 0.0
    outer = np.flatnonzero(near)[beyond]
    off_m[outer] = shapely.distance(grid.drivable_m, shapely.points(xy_m[beyond]))
    return off_m


def scaled(chance: Floats, expected_share: float) -> Floats:
    """Return the chances ``(n,)`` with the given mean, every plant's odds times the same number.

    Plants at exactly 0 or 1 stay there; raise `SettingError` where that leaves no room.
    """
    free = (chance > 0.0) & (chance < 1.0)
    certain = np.count_nonzero(chance >= 1.0)
    wanted = expected_share * len(chance) - certain
    if not (0.0 < wanted < np.count_nonzero(free)):
        raise SettingError(
            "The expected share of infested plants must lie strictly between "
            f"{certain / max(len(chance), 1):.6g} and "
            f"{(certain + np.count_nonzero(free)) / max(len(chance), 1):.6g} here "
            f"(plants at chance 0 or 1 stay there), but it is {expected_share}."
        )
    odds = logit(chance[free])
    share = wanted / len(odds)

    def excess(shift: float) -> float:
        return float(np.mean(expit(odds + shift))) - share

    least, most = logit(share) - odds.max(), logit(share) - odds.min()
    shift = brentq(excess, least - 1e-9, most + 1e-9, xtol=1e-13, rtol=1e-15)
    after = chance.copy()
    after[free] = expit(odds + shift)
    return after


def start_infested(
    chance: Floats, expected_share: float | None, rng: np.random.Generator
) -> NDArray[np.bool_]:
    """Draw who is infested on the first morning, ``(n,)``, each plant by its own chance.

    With `expected_share` the chances are :func:`scaled` to that mean first. The same generator
    state and more chance infest the same plants and others besides.
    """
    odds = chance if expected_share is None else scaled(chance, expected_share)
    drawn: NDArray[np.bool_] = rng.random(len(odds)) < odds
    return drawn


class _RecordKernel(NamedTuple):
    """What each record says, ``(m,)`` each: at its own plant and about it, and how far."""

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


class _Rows(NamedTuple):
    x_m: Floats  # (n,) ascending within each row
    y_m: Floats  # (n,)
    start: NDArray[np.int64]  # (r + 1,)
    low_m: Floats  # (r,) smallest y of the row
    high_m: Floats  # (r,)


def _checked_risk(grid: PlantGrid, risk: Floats) -> Floats:
    if len(risk) != len(grid):
        raise ObservationError(
            f"A risk map must have one entry a plant ({len(grid)}), but it has {len(risk)}."
        )
    known = risk[~np.isnan(risk)]
    if known.size and (known.min() < 0.0 or known.max() > 1.0):
        raise ObservationError(
            "A risk map must hold chances in 0..1 (NaN where it says nothing), but it runs from "
            f"{known.min():.6g} to {known.max():.6g}. Scale the raster to chances first."
        )
    return np.where(np.isnan(risk), 0.0, risk)


def _entering(grid: PlantGrid, lines: shapely.Geometry, chance: float, depth_m: float) -> Floats:
    """Return a chance that falls by 1/e every `depth_m` away from lines (metres), ``(n,)``."""
    points, line = shapely.get_coordinates(shapely.get_parts(lines), return_index=True)
    ahead = np.flatnonzero(line[1:] == line[:-1])
    pieces = np.concatenate([points[ahead], points[ahead + 1]], axis=1)
    farthest_m = depth_m * np.log(max(chance / _LEAST_SAY, 1.0))
    return chance * np.exp(-_distance_m(_rows(grid), pieces, farthest_m) / depth_m)


def _speech(grid: PlantGrid, observations: Observations, settings: PriorSettings) -> _RecordKernel:
    find = observations.present == PRESENT
    accuracy_m = np.where(
        observations.accuracy_m >= 0.0, observations.accuracy_m, settings.accuracy_m
    )
    # A plant is a bell as heavy as its own ground, so that a record without error says all of it
    # to its own plant; an error of position widens both bells and lowers them, mass kept.
    plant_m2 = grid.row_spacing_m * grid.plant_spacing_m / (2.0 * np.pi)
    own_m2 = plant_m2 + accuracy_m**2
    near_m2 = settings.reach_m**2 + accuracy_m**2
    own = np.where(find, settings.at_record, 1.0) * plant_m2 / own_m2
    near = _beside(observations, settings) * settings.reach_m**2 / near_m2
    strength = np.where(find, 1.0, _detection(observations, settings))
    radius_m = np.maximum(_radius_m(own, own_m2), _radius_m(near, near_m2))
    return _RecordKernel(own, own_m2, near, near_m2, strength, radius_m)


def _beside(observations: Observations, settings: PriorSettings) -> Floats:
    """Return how much each record says of the plants about it: more, the more was counted."""
    count = np.where(np.isnan(observations.count), settings.half_count, observations.count)
    count = np.where(observations.present == PRESENT, np.maximum(count, 0.0), 0.0)
    full = np.where(np.isinf(count), 1.0, count / (np.minimum(count, 1e300) + settings.half_count))
    return settings.beside_one + (settings.beside_many - settings.beside_one) * full


def _detection(observations: Observations, settings: PriorSettings) -> Floats:
    leaves = observations.leaves_sampled
    found = 1.0 - (1.0 - settings.leaf_detection) ** np.where(leaves >= 0.0, leaves, 0.0)
    return np.minimum(np.where(leaves >= 0.0, found, settings.detection), _MOST)


def _radius_m(peak: Floats, variance_m2: Floats) -> Floats:
    return np.sqrt(2.0 * variance_m2 * np.log(np.maximum(peak / _LEAST_SAY, 1.0)))


def _age_days(observations: Observations, on_day: np.datetime64, settings: PriorSettings) -> Floats:
    age = (on_day.astype("datetime64[D]") - observations.day) / np.timedelta64(1, "D")
    return np.where(np.isnan(age), settings.undated_days, age)


def _within_reach(
    grid: PlantGrid, observations: Observations, radius_m: Floats
) -> NDArray[np.bool_]:
    off_m = outside_m(grid, observations.lonlat)
    near: NDArray[np.bool_] = off_m <= np.minimum(radius_m, _FAR_M)
    if near.any():
        return near
    turned_m = outside_m(grid, observations.lonlat[:, ::-1])
    turned = turned_m.min() <= radius_m.max()
    raise ObservationError(
        f"At least one record must lie on the plot or within {radius_m.max():.0f} m of it, but "
        f"of {len(observations)} the nearest is {_in_words(off_m.min())}. "
        + (
            "With longitude and latitude exchanged they would lie there: name the columns anew."
            if turned
            else "Check the coordinate system, the order of longitude and latitude, "
            "and whether the records belong to this plot."
        )
    )


def _in_words(metres: float) -> str:
    if not np.isfinite(metres):
        return "nowhere on Earth (longitude and latitude must be in degrees)"
    return f"{metres:.0f} m away" if metres < 1000.0 else f"{metres / 1000.0:.0f} km away"


def _rows(grid: PlantGrid) -> _Rows:
    y_m = np.ascontiguousarray(grid.xy_m[:, 1])
    starts = grid.row_start[:-1]
    return _Rows(
        np.ascontiguousarray(grid.xy_m[:, 0]),
        y_m,
        grid.row_start,
        np.minimum.reduceat(y_m, starts),
        np.maximum.reduceat(y_m, starts),
    )


@nb.njit(cache=True, nogil=True)
def _distance_m(rows: _Rows, pieces: Floats, farthest_m: float) -> Floats:
    """Return metres from each plant to straight pieces ``(s, 4)``; infinite beyond `farthest_m`."""
    squares = np.full(rows.x_m.size, np.inf)
    for ax, ay, bx, by in pieces:
        length_m2 = max((bx - ax) ** 2 + (by - ay) ** 2, 1e-12)
        for row in range(rows.low_m.size):
            if rows.low_m[row] > max(ay, by) + farthest_m:
                continue
            if rows.high_m[row] < min(ay, by) - farthest_m:
                continue
            end = rows.start[row + 1]
            i = _first(rows.x_m, rows.start[row], end, min(ax, bx) - farthest_m)
            while i < end and rows.x_m[i] <= max(ax, bx) + farthest_m:
                x, y = rows.x_m[i] - ax, rows.y_m[i] - ay
                share = min(max((x * (bx - ax) + y * (by - ay)) / length_m2, 0.0), 1.0)
                square = (x - share * (bx - ax)) ** 2 + (y - share * (by - ay)) ** 2
                if square <= farthest_m * farthest_m:
                    squares[i] = min(squares[i], square)
                i += 1
    distance_m: Floats = np.sqrt(squares)
    return distance_m


@nb.njit(cache=True, nogil=True)
def _apply_records(
    chance: Floats, rows: _Rows, records: _Records, speech: _RecordKernel, fade_per_day: float
) -> None:
    """Let each record, in order, change the plants in its radius; then age them all to today."""
    base = chance.copy()
    age_days = np.zeros(chance.size)  # as old as the last record that spoke of the plant
    for r in range(records.x_m.size):
        x, y, radius = records.x_m[r], records.y_m[r], speech.radius_m[r]
        age = records.age_days[r]
        for row in range(rows.low_m.size):
            if rows.low_m[row] > y + radius or rows.high_m[row] < y - radius:
                continue
            end = rows.start[row + 1]
            i = _first(rows.x_m, rows.start[row], end, x - radius)
            while i < end and rows.x_m[i] <= x + radius:
                square = (rows.x_m[i] - x) ** 2 + (rows.y_m[i] - y) ** 2
                if square <= radius * radius:
                    own = speech.own[r] * np.exp(-0.5 * square / speech.own_m2[r])
                    near = speech.near[r] * np.exp(-0.5 * square / speech.near_m2[r])
                    says = speech.strength[r] * (1.0 - (1.0 - own) * (1.0 - near))
                    p = _aged(chance[i], base[i], (age_days[i] - age) * fade_per_day)
                    if records.find[r]:
                        p = min(1.0 - (1.0 - p) * (1.0 - says), _MOST)
                    else:
                        p = p * (1.0 - says) / (1.0 - p * says)
                    chance[i], age_days[i] = p, age
                i += 1
    for i in range(chance.size):
        chance[i] = _aged(chance[i], base[i], age_days[i] * fade_per_day)


@nb.njit(cache=True, inline="always")
def _aged(chance: float, base: float, half_lives: float) -> float:
    # a plant not spoken of yet sits at its base, whatever time has passed
    return chance if half_lives <= 0.0 else base + (chance - base) * 0.5**half_lives


@nb.njit(cache=True)
def _first(x_m: Floats, first: int, end: int, least_m: float) -> int:
    """Return the first index in ``first:end`` whose x is at least `least_m` (else `end`)."""
    while first < end:
        middle = (first + end) // 2
        if x_m[middle] < least_m:
            first = middle + 1
        else:
            end = middle
    return first
