"""The best route for any reward per plant, and what no other route of these hours can exceed."""

from __future__ import annotations

from dataclasses import dataclass
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import counted
from fieldmon.errors import SettingError
from fieldmon.planning.bound_wording import FINDS, PROVED, share_above, told
from fieldmon.planning.routes.binned import proposals
from fieldmon.planning.routes.improve import Tour, fit, ruin
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.relaxation import ladder_below
from fieldmon.planning.routes.stops import stops_of
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles, driven_s, robot_clock
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    from fieldmon.planning.routes.priced import Drawn
    from fieldmon.planning.routes.relaxation import Ladder
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.travel import Clock

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

# a bound stays one however its sums are rounded
_ROUNDED = 1e-9
_LEG_M = 1e-6
_BISECTIONS = 40
_LEAST_PRICE = 1e-7
# plants worth less than this share of their stop at the price are not considered
_CONSIDERED = 0.5
# share of the hours that is left when the poorest stops are left out, before filling again
_RUINS = (0.97, 0.93, 0.9, 0.97, 0.85)


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
        return told(self.reward, self.bound, what)


class _Posed(NamedTuple):
    """A problem that makes sense: rewards that no day reaches are 0."""

    aisles: Aisles
    robot: Robot
    clock: Clock
    reward: Float


@dataclass(frozen=True)
class _Bound:
    """The least bound found, the price it was found at, and the drives met on the way."""

    value: float
    price: float
    drawn: tuple[tuple[Drawn, float], ...]


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
        Who drives; None: the thesis's robot.
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
    if not values.any():
        return BestRoute(np.empty(0, np.int32), 0.0, 0.0, 0.0, "nothing can be reached")
    time_s = clock.seconds_left
    ladder = ladder_below(aisles)
    priced = Priced(ladder, values, robot)
    found = upper_bound(priced, time_s)
    starts = [np.asarray(other, np.int64) for other in others]
    starts += list(_starts(priced, found, robot, time_s))
    starts.append(_walked(aisles, values, robot, time_s))
    stops = _best_of(aisles, clock, values, starts, _CONSIDERED * found.price * robot.visit_s)
    held = float(values[stops].sum())
    return BestRoute(
        stops.astype(np.int32),
        held,
        _seconds(aisles, clock, stops),
        max(found.value, held),
        _how(ladder),
    )


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
    priced = Priced(ladder_below(posed.aisles), posed.reward, posed.robot)
    return upper_bound(priced, posed.clock.seconds_left, within_s).value


def _posed(
    plot: Plot | Aisles, reward: ArrayLike, robot: Robot | None, seconds: float | None
) -> _Posed:
    """Check a problem, and leave out what no day reaches."""
    aisles = plot if isinstance(plot, Aisles) else plot.aisles
    robot = robot or Robot()
    time_s = robot.day_s if seconds is None else float(seconds)
    values = _checked(reward, len(aisles.grid), time_s)
    clock = robot_clock(robot, time_s)
    return _Posed(aisles, robot, clock, np.where(_reachable(aisles, clock), values, 0.0))


def upper_bound(priced: Priced, seconds: float, within_s: float = np.inf) -> _Bound:
    """Return the least bound of all prices of time, by bisection of what they fill."""
    began = monotonic()
    reward, stop_s = priced.reward, max(priced.costs.stop_s, 1e-9)
    high = float(reward.max()) / stop_s
    low = high * _LEAST_PRICE
    most_stops = int(seconds // stop_s) if priced.costs.stop_s > 0 else len(reward)
    value = float(np.sort(reward)[::-1][:most_stops].sum())
    # a leg on the ladder may be longer than the true one by less than a thousandth of a millimetre
    seconds += (min(most_stops, len(reward)) + 1) * _LEG_M * priced.costs.metre_s
    price, drawn = low, []
    for k in range(_BISECTIONS):
        middle = low if k == 0 else float(np.sqrt(low * high))
        one = priced.best(middle)
        here = priced.bound(one, middle, seconds)
        if here < value:
            value, price = here, middle
        drawn.append((one, middle))
        if monotonic() - began > within_s:
            break
        if priced.seconds(one, middle) > seconds:
            low = middle
        elif k == 0:
            break
        else:
            high = middle
    return _Bound(value * (1.0 + _ROUNDED), price, tuple(drawn[-2:]))


def _starts(priced: Priced, bound: _Bound, robot: Robot, seconds: float) -> Iterable[Int]:
    """Yield stops to begin with."""
    for drawn, price in bound.drawn:
        yield stops_of(priced, drawn, np.full(len(drawn.way), price), robot)
    for drawn, prices in proposals(priced, bound.price, seconds):
        yield stops_of(priced, drawn, prices, robot)


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
    return total <= clock.seconds_left


def _seconds(aisles: Aisles, clock: Clock, stops: Int) -> float:
    if not len(stops):
        return 0.0
    places = np.concatenate([[GATE], stops, [GATE] if clock.returns else []]).astype(np.int64)
    return float(driven_s(aisles.travel, clock, places)) + len(stops) * clock.visit_s


def _how(ladder: Ladder) -> str:
    if ladder.cross_links == 0:
        return "price of time on a ladder of aisles"
    return (
        f"price of time on a ladder with {ladder.cross_links} cross links, "
        "as the plot is no ladder itself"
    )


def _checked(reward: ArrayLike, n: int, seconds: float) -> Float:
    values = np.ascontiguousarray(reward, np.float64)
    if values.shape != (n,) or not (np.isfinite(values).all() and (values >= 0).all()):
        raise SettingError(
            f"Rewards must be {n} numbers of 0 or more, one a plant, but they are "
            f"{values.size} with a least value of {values.min() if values.size else 'none'}."
        )
    if not seconds > 0:
        raise SettingError(f"The time for a route must be above 0 s, but it is {seconds}.")
    return values
