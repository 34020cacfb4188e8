"""What Adaptive believes and plans during a day, as arrays for compiled loops."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from fieldmon.samplers.base import InspectionTimes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.pairs.clustering import ClusterEstimate
    from fieldmon.infestation.pairs.pairs import Neighbourhood
    from fieldmon.infestation.tracing.tracing import Raised, Traces

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

#: a row is left for one of the next six in line: on plots with holes the next is not the nearest
REACH = 6
#: ways of driving a row: 0 from the low end through, 1 from the high end, 2 and 3 in and out again
N_WAYS = 4
#: plants in line that are judged together: do any of them pay?
BLOCK = 32
NOWHERE = -1
LEAST = 1e-6
#: a bound stays one however its sum is rounded
NEARLY = 1.0 - 1e-9


class BeliefArrays(NamedTuple):
    """What is believed of n plants and e pairs of neighbours during the day.

    Parameters
    ----------
    chance, pair_chance
        ``(n,)`` and ``(e,)`` as believed now.
    worth
        ``(n,)`` of a find at each plant, in finds; 0 once it is inspected.
    near
        Room for the neighbourhood of a plant.
    pair_before
        ``(n,)`` where in `pair_chance` each plant stands with the one before it in its row, -1 if
        there is none.
    morning_chance, morning_pair_chance
        As believed before the first inspection.
    clusters
        What the inspections since say of how much infested plants stand together.
    scale
        ``(5,)`` what was made of that: how much closer they stand than was believed, the chance
        that insects jump beyond the plants next to them, and how much they lean along the row; the
        power of chances by which plans are made, and the share believed infested.
    level
        ``(3,)`` finds of the day, finds that were expected of it, and how many times as likely as
        in the morning plants are taken to be infested because of that.
    traces, raised
        What a find says of plants farther away, and room for those.
    """

    chance: Float
    pair_chance: Float
    worth: Float
    near: Neighbourhood
    pair_before: Int
    morning_chance: Float
    morning_pair_chance: Float
    clusters: ClusterEstimate
    scale: Float
    level: Float
    traces: Traces
    raised: Raised


class ToursBefore(NamedTuple):
    """What `RowTours` held at the price before this one: a price often goes up and down again.

    Parameters
    ----------
    price
        ``(1,)`` that price; NaN if nothing is kept.
    net, seconds, last, stale
        As in `RowTours`.
    plans
        ``(2,)`` the numbers of this price and of the one before, counted from 0.
    """

    price: Float
    net: Float
    seconds: Float
    last: Int
    stale: NDArray[np.bool_]
    plans: Int

    @classmethod
    def none(cls, n_rows: int) -> ToursBefore:
        """Return room."""
        ways = n_rows, N_WAYS
        stale = np.ones(n_rows, np.bool_)
        tours = np.zeros(ways), np.zeros(ways), np.full(ways, NOWHERE), stale
        return cls(np.full(1, np.nan), *tours, np.zeros(2, np.int64))


class RowTours(NamedTuple):
    """What each of the four ways of driving each of r rows comes to, at a price of a second.

    Parameters
    ----------
    net, seconds
        ``(r, 4)`` what the tour gains beyond what its driving costs, and how long it takes.
    last
        ``(r, 4)`` the last plant inspected on it, -1 where none pays.
    stale
        ``(r,)`` whether the row must be valued again.
    n_pays, pays
        The plants that are worth their stop: ``n_pays (r,)`` of them in each row, from where the
        row starts in ``pays (n,)``.
    gain, stop_s
        ``(n,)`` beside `pays`: what each gains beyond what its stop costs, and how long that is.
    most
        ``(n // BLOCK + 1,)`` the most that a find in each block of plants in line is expected to
        be worth, -1 where that has changed.
    value
        ``(n,)`` what a find at each plant is expected to be worth, as plans are made by it; as old
        as `most`.
    after_clean
        ``(n, k)`` the same once the plant before it in the row was inspected, for each of k times,
        and seemed clean; -1 until somebody asks.
    pays_of
        ``(r,)`` the number of the price at which `pays` of each row were worked out.
    before
        What is kept of the price before.
    """

    net: Float
    seconds: Float
    last: Int
    stale: NDArray[np.bool_]
    n_pays: Int
    pays: NDArray[np.int32]
    gain: Float
    stop_s: Float
    most: Float
    value: Float
    after_clean: Float
    pays_of: Int
    before: ToursBefore

    @classmethod
    def of(cls, n: int, n_rows: int, n_times: int) -> RowTours:
        """Return room for so many plants, rows and inspection times."""
        ways = n_rows, N_WAYS
        last, stale = np.full(ways, NOWHERE), np.ones(n_rows, np.bool_)
        n_pays, pays = np.zeros(n_rows, np.int64), np.empty(n, np.int32)
        most = np.full(n // BLOCK + 1, -1.0)
        room = np.empty(n), np.empty(n)
        values = np.empty(n), np.empty((n, n_times))
        tours = np.zeros(ways), np.zeros(ways), last
        before = np.zeros(n_rows, np.int64), ToursBefore.none(n_rows)
        return cls(*tours, stale, n_pays, pays, *room, most, *values, *before)


class BestTours(NamedTuple):
    """The best rest of the day from each lane end, going up (0) or down (1) the plot.

    Parameters
    ----------
    net, seconds
        ``(2, r, 2)`` by direction, row and end: what the rest of the day gains beyond what its
        driving costs, and how long it takes.
    way
        ``(2, r, 2)`` how the row is driven, -1 where it is passed by.
    left_net, left_seconds
        ``(2, r, 2)`` the same once the row is done.
    to
        ``(2, r, 2)`` the lane end (2 row + end) after that, -1 for home.
    next_s
        ``(2, r, 2, 6, 2)`` seconds to the two ends of each of the next lanes in line.
    home_s
        ``(r, 2)`` seconds to the gate.
    """

    net: Float
    seconds: Float
    way: Int
    left_net: Float
    left_seconds: Float
    to: Int
    next_s: Float
    home_s: Float

    @classmethod
    def of(cls, n_rows: int) -> BestTours:
        """Return room for so many rows."""
        net, seconds, left_net, left_seconds = np.zeros((4, 2, n_rows, 2))
        way, to = np.full((2, 2, n_rows, 2), NOWHERE)
        next_s, home_s = np.empty((2, n_rows, 2, REACH, 2)), np.empty((n_rows, 2))
        return cls(net, seconds, way, left_net, left_seconds, to, next_s, home_s)


class OwnRow(NamedTuple):
    """What either direction along the robot's own row comes to, ``(2,)`` each: low end, high end.

    Parameters
    ----------
    ahead, ahead_s
        Net and seconds of driving out by that end, with all plants on the way that pay.
    fetch, fetch_s
        Net and seconds of driving there and back, as far as it pays.
    last, turn
        The last plant on the way out, and the one at which to turn back; -1 if there is none.
    """

    ahead: Float
    ahead_s: Float
    fetch: Float
    fetch_s: Float
    last: Int
    turn: Int

    @classmethod
    def blank(cls) -> OwnRow:
        """Return room."""
        none = np.full(2, NOWHERE)
        return cls(np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2), none, none.copy())


class Stretch(NamedTuple):
    """Where a plan begins: plants of one row, from one end up to `last`.

    Parameters
    ----------
    row
        -1 where nothing pays.
    first_end
        0 if the plants are driven to with x rising, 1 if with x falling.
    last
        The last plant of the row to be inspected.
    seconds
        How long the whole plan takes.
    """

    row: int
    first_end: int
    last: int
    seconds: float


#: what planning works in
Workspace: TypeAlias = tuple[BeliefArrays, RowTours, BestTours, InspectionTimes, OwnRow]
