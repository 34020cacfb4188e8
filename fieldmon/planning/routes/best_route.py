"""The best route for any reward per plant, and what no other route of these hours can exceed."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.compute.arguments import shown
from fieldmon.compute.array_arguments import array_of_plants
from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import counted
from fieldmon.errors import SettingError
from fieldmon.planning.bound_wording import (
    FINDS,
    PROVED,
    bound_sentence,
    share_above,
    sound_bound,
)
from fieldmon.planning.routes.binned import proposals
from fieldmon.planning.routes.blocks import Blocks, blockings
from fieldmon.planning.routes.improve import Tour, fit, ruin
from fieldmon.planning.routes.ladders import Ladders
from fieldmon.planning.routes.pendant_parts import ladder_with_parts
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.stops import stops_of
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import ArrayLike, NDArray

    from fieldmon.plot.plot import Plot
    from fieldmon.plot.travel import Clock

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# a bound stays one however its sums are rounded
_ROUNDED = 1e-9
_LEG_M = 1e-6
_PRICES = 40
# so many of them at once: a machine has as many cores
_AT_ONCE = 2
# bounds so near each other (as a share) are the same
_SAME = 1e-9
_LEAST_PRICE = 1e-7
# routes begin with the drives of so many of the least bounds
_STARTED_FROM = 3
_TOO_LONG = 1.5
# plants worth less than this share of their stop at the price are not considered
_CONSIDERED = 0.5
# share of the hours that is left when the poorest stops are left out, before filling again
_RUINS = (0.97, 0.93, 0.9, 0.97, 0.85)


@checked
@dataclass(frozen=True, eq=False)
class BestRoute:
    """A route, and a bound on every other.

    Parameters
    ----------
    plant
        ``(k,)`` int32 plants in order, from the gate.
    reward
        What they hold together.
    seconds
        What driving, turning and stopping take, the way back included if the robot returns.
    bound
        No route of these hours can hold more.
    how
        How the bound came about.
    """

    plant: NDArray[np.int32]
    reward: float
    seconds: float
    bound: float
    how: str

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A route's")

    def __repr__(self) -> str:
        held = f"{counted(len(self.plant), 'stop')}, {self.reward:.2f} of at most {self.bound:.2f}"
        return f"<BestRoute: {held}, {self.seconds / 3600:.2f} h>"

    @property
    def gap(self) -> float:
        """Return how much more than this route any other could hold at most, as a share."""
        return share_above(self.reward, self.bound)

    @property
    def proved(self) -> bool:
        """Tell whether it is proved that no other route holds more (by over a millionth)."""
        return self.gap <= PROVED

    def sentence(self, what: str = FINDS) -> str:
        """Return for people what the route holds and what no other can exceed."""
        return bound_sentence(self.reward, self.bound, what)


class _Posed(NamedTuple):
    """A problem that makes sense: rewards that no day reaches are 0."""

    aisles: Aisles
    robot: Robot
    clock: Clock
    reward: Float


@dataclass(frozen=True)
class PriceBound:
    """The least bound of a price of time, that price, what it is of, and drives about as long."""

    value: float
    price: float
    below: Priced | Blocks
    met: tuple[tuple[Any, float], ...]


@checked
def best(
    plot: Plot | Aisles,
    reward: ArrayLike,
    robot: Robot | None = None,
    seconds: float | None = None,
    others: Iterable[ArrayLike] = (),
) -> BestRoute:
    """Return a route from the gate that holds as much reward as can be found, and a bound.

    Only the bound is proved: no order of any plants that fits the time holds more. The route is
    a heuristic's, mended by the plot's own seconds.

    Parameters
    ----------
    plot
        The plot, or the ways between its plants.
    reward
        ``(n,)`` what a stop at each plant is worth, 0 or more: finds expected, or anything else.
    robot
        Who drives; None: the usual `Robot`.
    seconds
        The time; None: the robot's working day.
    others
        Routes known from elsewhere ``(k,)`` each: what comes out is at least as good as the best
        of those that fit.

    Raises
    ------
    SettingError
        If rewards are not one a plant and 0 or more, or there is no time.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> south = plot.grid.xy_m[:, 1] < 0
    >>> route = fm.routes.best(plot, 1.0 + south, fm.Robot(hours=2))
    >>> bool(route.seconds <= 7200 and route.reward <= route.bound)
    True
    >>> route.gap < 0.05
    True
    """
    posed = _posed(plot, reward, robot, seconds)
    aisles, robot, clock, values = posed
    starts = [_known(other, len(values)) for other in others]
    if not values.any():
        return BestRoute(np.empty(0, np.int32), 0.0, 0.0, 0.0, "nothing can be reached")
    bounds = sorted(_bounds(posed), key=lambda found: found.value)
    for found in bounds[:_STARTED_FROM]:
        starts += list(_starts(found, robot, clock.seconds_left))
    starts.append(_walked(aisles, values, robot, clock.seconds_left))
    least = _CONSIDERED * bounds[0].price * robot.visit_s
    stops = _best_of(aisles, clock, values, starts, least)
    held = float(values[stops].sum())
    return BestRoute(
        stops.astype(np.int32),
        held,
        _seconds(aisles, clock, stops),
        sound_bound(held, bounds[0].value),
        bounds[0].below.how,
    )


@checked
def bound(
    plot: Plot | Aisles,
    reward: ArrayLike,
    robot: Robot | None = None,
    seconds: float | None = None,
    within_s: float = np.inf,
) -> float:
    """Return what no route from the gate within the time can hold.

    It takes a hundredth of the time that `best` takes.

    Parameters
    ----------
    plot, reward, robot, seconds
        As `best` takes them.
    within_s
        Seconds of computing after which the best bound so far is returned.

    Raises
    ------
    SettingError
        If rewards are not one a plant and 0 or more, or there is no time.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> bound = fm.routes.bound(plot, [1.0] * len(plot.grid), fm.Robot(hours=2))
    >>> day = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=2), sampler="naive")
    >>> len(day.route) <= bound <= 7200 / 40
    True
    """
    posed = _posed(plot, reward, robot, seconds)
    if not posed.reward.any():
        return 0.0
    return min(found.value for found in _bounds(posed, within_s))


class Bounded(NamedTuple):
    """A bound, and how much of each plant ``(n,)`` the drives behind it visit, in 0..1."""

    value: float
    visits: Float


def bounded(plot: Plot | Aisles, reward: Float, robot: Robot) -> Bounded:
    """Return what no route of a robot's day can hold, and what the drives behind it visit.

    Two drives at about one price fill the hours, the one more, the other less: as much of each as
    fills them just.
    """
    posed, visits = _posed(plot, reward, robot, None), np.zeros(len(reward))
    if not posed.reward.any():
        return Bounded(0.0, visits)
    found = min(_bounds(posed), key=lambda each: each.value)
    took_s = np.array([found.below.seconds(*met) for met in found.met])
    share = np.ones(len(took_s))
    if len(took_s) == 2 and took_s[0] != took_s[1]:
        share[1] = (robot.day_s - took_s[0]) / (took_s[1] - took_s[0])
        share = np.clip([1.0 - share[1], share[1]], 0.0, 1.0)
    for met, of in zip(found.met, share, strict=True):
        if of > 0.0:
            visits[_stops_met(found.below, met, robot)] += of
    return Bounded(found.value, np.minimum(visits, 1.0))


def _stops_met(below: Priced | Blocks, met: tuple[Any, float], robot: Robot) -> Int:
    """Return the plants of a drive in the order of one way to drive it."""
    drawn, price = met
    if isinstance(below, Blocks):
        return below.stops(drawn, price)
    return stops_of(below, drawn, np.full(len(drawn.way), price), robot)


def _posed(
    plot: Plot | Aisles, reward: ArrayLike, robot: Robot | None, seconds: float | None
) -> _Posed:
    """Check a problem, and leave out what no day reaches."""
    ways = plot if isinstance(plot, Aisles) else plot.aisles
    aisles, robot = ways.for_robot(robot or Robot()), ways.worked_by(robot or Robot())
    time_s = robot.day_s if seconds is None else float(seconds)
    values = _checked(reward, len(aisles.grid), time_s)
    clock = robot_clock(robot, time_s)
    return _Posed(aisles, robot, clock, np.where(_reachable(aisles, clock), values, 0.0))


def _bounds(posed: _Posed, within_s: float = np.inf) -> list[PriceBound]:
    """Return the bounds of all ways of taking the plot for less than it is: each is one.

    The first is there however long it takes; compiled loops let others go on beside.
    """
    until = FIRST_USE.work_clock() + within_s

    def bounded_by(make: Callable[[], Priced | Blocks | None]) -> PriceBound | None:
        left_s = until - FIRST_USE.work_clock()
        below = make() if left_s > 0.0 or make is ways[0] else None
        return None if below is None else upper_bound(below, posed.clock.seconds_left, left_s)

    ways = list(_relaxations(posed))
    with ThreadPoolExecutor(_AT_ONCE) as threads:
        return [found for found in threads.map(bounded_by, ways) if found is not None]


def _relaxations(posed: _Posed) -> Iterator[Callable[[], Priced | Blocks | None]]:
    """Yield what makes what lies below the plot: a ladder, one with aisles hanging on it, several.

    Those of several parts stand beside each other, or hang on each other.
    """
    ladders, reward, robot = Ladders(posed.aisles), posed.reward, posed.robot

    def hanging() -> Priced | None:
        ladder = ladders.whole(hanging=True)
        return Priced(ladder, reward, robot) if ladder.hangs.any() else None

    yield lambda: Priced(ladders.whole(hanging=False), reward, robot)
    yield hanging
    for block in blockings(ladders.rungs):
        yield partial(Blocks, ladders, block, reward, robot)
        yield partial(ladder_with_parts, ladders, block, reward, robot)


def upper_bound(below: Priced | Blocks, seconds: float, within_s: float = np.inf) -> PriceBound:
    """Return the least bound of all prices of time.

    By prices the bound of each drive is a line, and that of all drives their highest, which has
    one lowest place. The next price tried is where the lines of the best drives known to either
    side of it cross, or between them where that comes nearer too slowly (Kelley's cutting planes).
    """
    began = FIRST_USE.work_clock()
    reward, costs = below.of_all, below.costs
    stop_s = max(costs.stop_s, 1e-9)
    high = float(reward.max()) / stop_s
    low = high * _LEAST_PRICE
    most_stops = int(seconds // stop_s) if costs.stop_s > 0 else len(reward)
    value = float(np.sort(reward)[::-1][:most_stops].sum())
    # a leg on the ladder may be longer than the true one by less than a thousandth of a millimetre
    seconds += (min(most_stops, len(reward)) + 1) * _LEG_M * costs.metre_s
    price = low
    met: dict[bool, tuple[Any, float]] = {}
    # what the best drive too long, and the best in time, holds, and the seconds that it leaves;
    # nothing pays at the highest price
    lines = {False: (0.0, seconds)}
    for k in range(_PRICES):
        middle, least = _between(lines, (low, high), halve=k % 5 == 4) if k else (low, -np.inf)
        one: Any = below.best(middle)
        here = below.bound(one, middle, seconds)
        if here < value:
            value, price = here, middle
        left_s = seconds - below.seconds(one, middle)
        met[left_s < 0.0] = one, middle
        lines[left_s < 0.0] = here - middle * left_s, left_s
        if FIRST_USE.work_clock() - began > within_s or here <= least * (1.0 + _SAME):
            break
        if left_s < 0.0:
            low = middle
        elif k == 0:
            break
        else:
            high = middle
    if FIRST_USE.work_clock() - began <= within_s:
        value = min(value, below.bound_by_kind(seconds, price, began + within_s))
    return PriceBound(value * (1.0 + _ROUNDED), price, below, tuple(met.values()))


def _between(
    lines: dict[bool, tuple[float, float]], prices: tuple[float, float], *, halve: bool
) -> tuple[float, float]:
    """Return a price between two, and what no bound in between can be less than."""
    low, high = prices
    middle = float(np.sqrt(low * high))
    (held, over_s), (held_in_time, spare_s) = lines[True], lines[False]
    crossing = (held - held_in_time) / (spare_s - over_s) if spare_s > over_s else middle
    least = held + crossing * over_s
    return (crossing if low < crossing < high and not halve else middle), least


def _starts(found: PriceBound, robot: Robot, seconds: float) -> Iterator[Int]:
    """Yield stops to begin with; drives that are far too long take long to be cut to the hours."""
    below = found.below
    fitting = [met for met in found.met if below.seconds(*met) <= _TOO_LONG * seconds]
    yield from (_stops_met(below, met, robot) for met in fitting)
    if isinstance(below, Blocks):
        yield from below.filling(found.price, seconds)
        return
    for drawn, prices in proposals(below, found.price, seconds):
        yield stops_of(below, drawn, prices, robot)


def _walked(aisles: Aisles, reward: Float, robot: Robot, seconds: float) -> Int:
    """Return the stops of Adaptive, to which holes and parts are nothing special."""
    n = len(aisles.grid)
    chance = 0.5 * reward / reward.max()
    near = aisles.grid.adjacent
    alone = np.repeat(chance, np.diff(near.start)) * chance[near.plant]
    never = np.full(n, NEVER, np.int32)
    scene = Scene(aisles, robot, chance, never, seconds_left=seconds, pair_chance=alone)
    stops = Adaptive(spares=0.0).walk(scene, np.zeros(n, np.bool_))
    return stops.plant[reward[stops.plant] > 0.0].astype(np.int64)


def _best_of(aisles: Aisles, clock: Clock, reward: Float, starts: list[Int], least: float) -> Int:
    """Return the best stops that come of any start, and of ruining and mending the best."""
    found, most = np.empty(0, np.int64), -1.0
    for stops in starts:
        tour = Tour.of(stops, len(reward))
        held = fit(aisles.travel, clock, tour, reward, least)
        if held > most:
            found, most = tour.stops, held
    for share in _RUINS:
        tour = Tour.of(found, len(reward))
        ruin(aisles.travel, clock, tour, reward, share * clock.seconds_left)
        held = fit(aisles.travel, clock, tour, reward, least)
        if held > most:
            found, most = tour.stops, held
    # whatever else fits
    tour = Tour.of(found, len(reward))
    fit(aisles.travel, clock, tour, reward, 0.0)
    return tour.stops if reward[tour.stops].sum() > most else found


def _reachable(aisles: Aisles, clock: Clock) -> NDArray[np.bool_]:
    """Tell of each plant ``(n,)`` whether a day for it alone is long enough."""
    way_s = aisles.distance_m(GATE, np.arange(len(aisles.grid))) / clock.speed_m_s
    total: Float = way_s * (2.0 if clock.returns else 1.0) + clock.visit_s
    return (total <= clock.seconds_left) & ~aisles.too_narrow


def _seconds(aisles: Aisles, clock: Clock, stops: Int) -> float:
    if not len(stops):
        return 0.0
    places = np.concatenate([[GATE], stops, [GATE] if clock.returns else []]).astype(np.int64)
    return float(driven_s(aisles.travel, clock, places)) + len(stops) * clock.visit_s


def _known(other: ArrayLike, n: int) -> Int:
    """Return a route from elsewhere; raise `SettingError` unless it is one of n plants."""
    try:
        plants = np.asarray(other)
    except ValueError:
        plants = np.empty((1, 1))
    if plants.size and not (
        plants.ndim == 1 and plants.dtype.kind in "iu" and 0 <= plants.min() <= plants.max() < n
    ):
        raise SettingError(
            f"Other routes must be numbers of plants from 0, below {n}, but one is {shown(other)}."
        )
    return plants.astype(np.int64)


def _checked(reward: ArrayLike, n: int, seconds: float) -> Float:
    values = array_of_plants(np.float64, "Rewards", reward)
    if values.shape != (n,):
        raise SettingError(
            f"Rewards must be {n} numbers in a row, one a plant, but they have the shape "
            f"{values.shape}."
        )
    if not (np.isfinite(values).all() and (values >= 0).all()):
        raise SettingError(
            f"Rewards must be numbers of 0 or more, but one is "
            f"{values[~(values >= 0) | np.isinf(values)][0]}."
        )
    if not 0 < seconds < np.inf:
        raise SettingError(
            f"The time for a route must be above 0 s, and end, but it is {seconds} s."
        )
    return values
