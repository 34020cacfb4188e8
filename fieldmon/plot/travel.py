"""Metres from any plant to any plant without crossing a row, and the line that is driven."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from numbers import Integral
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.arguments import shown
from fieldmon.compute.arrays import read_only
from fieldmon.compute.jit import inlined, inner_inlined, loop, routine
from fieldmon.compute.wording import counted, joined, worded
from fieldmon.errors import SettingError
from fieldmon.plot.clear_lanes import clear_lanes, hidden_plants
from fieldmon.plot.clearance import Clearance, hidden_sentence, narrow_sentence, robot_on
from fieldmon.plot.driven_line import Lanes, driven_line, shortest_nodes
from fieldmon.plot.ends_within import ROOM_M, opened
from fieldmon.plot.line_warnings import line_said
from fieldmon.plot.obstacles import off_limits
from fieldmon.plot.road_network import RoadNetwork, find_roads
from fieldmon.plot.travel_table import TravelTable
from fieldmon.plot.way_joining import CutOffError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from shapely import MultiPolygon

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]

GATE = -1
_BLOCK = 64
# what is kept half as exactly is no more than it was
_LESS = 1.0 - 1e-6


@dataclass(frozen=True, eq=False)
class Aisles:
    """The ways between the plants of a plot.

    A robot drives along the aisles and changes rows in the headlands; it crosses no row. Plants
    are given by number; -1 is the gate, where a working day starts and ends.

    Parameters
    ----------
    grid
        The plants.
    gate_xy_m, no_go_m
        Where the gate was said to be, and where nobody may drive.
    clearance
        How far ways keep off plants; None: as for a robot whose width nobody said.
    hidden
        ``(n,)`` plants of which no lane comes near for holes and no-go areas; None: as the grid
        has it.
    """

    grid: PlantGrid
    gate_xy_m: tuple[float, float] | None = None
    no_go_m: MultiPolygon | None = None
    clearance: Clearance | None = None
    hidden: NDArray[np.bool_] | None = None

    @classmethod
    def of(
        cls,
        grid: PlantGrid,
        gate_xy_m: tuple[float, float] | None = None,
        no_go_m: MultiPolygon | None = None,
        clearance: Clearance | None = None,
        hidden: NDArray[np.bool_] | None = None,
    ) -> Aisles:
        """Find the ways on a plot; raise `PlotError` where a row cannot be reached.

        Without a gate, work starts at the low-x lane end of the first row. `no_go_m` is what must
        not be crossed either where parts of a plot can only be joined outside the boundary.
        `clearance` is what a robot needs, `hidden` are plants ``(n,)`` that it cannot come near.
        """
        aisles = cls(grid, gate_xy_m, no_go_m, clearance, hidden)
        try:
            _ = aisles.travel
        except CutOffError:
            if not grid.in_rows:
                raise
            off_m, needs_m = (clearance.off_m, clearance.way_m) if clearance else (0.0, ROOM_M)
            wider = opened(grid, needs_m, off_limits(grid, no_go_m, off_m))
            if wider is grid:
                raise
            aisles = cls(wider, gate_xy_m, no_go_m, clearance, hidden)
            _ = aisles.travel  # or raise
        return aisles

    @cached_property
    def roads(self) -> RoadNetwork:
        """The network of ways between lane ends, found once it is asked for."""
        shut = np.logical_and.reduceat(self._hidden, self.grid.row_start[:-1])
        roads = find_roads(self.grid, self.gate_xy_m, self.no_go_m, self.clearance, shut)
        for values in roads:
            if isinstance(values, np.ndarray):
                read_only(values)
        return roads

    @cached_property
    def travel(self) -> TravelTable:
        """How far it is along the ways, for compiled loops: see `drive_m`."""
        grid, roads = self.grid, self.roads
        between_m = np.empty((2 * grid.n_rows + 1, 2 * grid.n_rows + 1))
        _reach(roads, np.append(roads.end.ravel(), roads.gate), between_m)
        travel = TravelTable(
            np.ascontiguousarray(grid.along_m),
            grid.row,
            grid.row_start,
            grid.lane_x_m,
            between_m,
            grid.stretches,
            grid.side,
        )
        for values in travel:
            read_only(values)
        return travel

    def for_robot(self, robot: Robot) -> Aisles:
        """Return the ways that a robot can drive: these, unless it is too wide for them.

        Raise `PlotError` if all aisles are too narrow for it, or rows cannot be reached.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> plot.aisles.for_robot(fm.Robot()) is plot.aisles
        True
        >>> plot.aisles.for_robot(fm.Robot(width_m=0.58)).clearance.way_m
        0.64
        """
        needs = Clearance.of(robot, self.grid)
        if needs == self.clearance:
            return self
        if needs not in self._others:
            self._others[needs] = self._for(needs)
        return self._others[needs]

    @cached_property
    def _others(self) -> dict[Clearance | None, Aisles]:
        return {}

    def _for(self, needs: Clearance | None) -> Aisles:
        if needs is None or not self.grid.in_rows:
            return Aisles.of(self.grid, self.gate_xy_m, self.no_go_m, needs)
        lanes = clear_lanes(self.grid, off_limits(self.grid, self.no_go_m, needs.off_m))
        hidden = lanes.hidden | self._hidden
        return Aisles.of(lanes.grid, self.gate_xy_m, self.no_go_m, needs, hidden)

    @cached_property
    def too_narrow(self) -> NDArray[np.bool_]:
        """Whether each plant ``(n,)`` cannot be come near: its aisle is too narrow, or is cut."""
        return read_only(self._narrow_rows[self.grid.row] | self._hidden)

    @cached_property
    def _narrow_rows(self) -> NDArray[np.bool_]:
        if self.clearance is None:
            return read_only(np.zeros(self.grid.n_rows, np.bool_))
        return read_only(self.clearance.too_narrow(self.grid))

    @cached_property
    def _hidden(self) -> NDArray[np.bool_]:
        if self.hidden is not None:
            return read_only(self.hidden)
        if shapely.is_empty(off_limits(self.grid, self.no_go_m, 0.0)) or not self.grid.in_rows:
            return read_only(np.zeros(len(self.grid), np.bool_))
        return read_only(hidden_plants(self.grid))

    def narrow_sentence(self) -> str:
        """Return for people which plants the robot cannot come near, in sentences; "" if none."""
        rows, said = self._narrow_rows, []
        if self.clearance is not None and rows.any():
            said.append(narrow_sentence(rows, self.grid, self.clearance))
        if n_hidden := int((self._hidden & ~rows[self.grid.row]).sum()):
            said.append(hidden_sentence(n_hidden, self.clearance))
        return joined(" ", said)

    def said_of(self, line_m: Float) -> tuple[str, ...]:
        """Return what people must know of a driven line ``(m, 2)``, and of the ways, in sentences.

        Which plants cannot be come near, how much of it lies outside the plot, and where a robot's
        body reaches over its boundary.
        """
        left = line_said(self.grid, (self.gate_m, self.no_go_m), self.clearance, line_m)
        return tuple(one for one in (self.narrow_sentence(), *left) if one)

    def __repr__(self) -> str:
        return f"<Aisles: {self.grid.counts}, {counted(len(self.roads.xy_m), 'node')}>"

    def worked_by(self, robot: Robot) -> Robot:
        """Return a robot as it is charged here, see `robot_on`.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
        >>> tractor = fm.Robot(width_m=1.1, length_m=1.6, turning_radius_m=1.5)
        >>> plot.aisles.worked_by(tractor).row_change_s
        9.9
        """
        return robot_on(self.grid, robot)

    @property
    def gate_m(self) -> Float:
        """Where a working day starts and ends, ``(2,)``."""
        here: Float = self.roads.xy_m[self.roads.gate]
        return here

    @cached_property
    def stop_m(self) -> Float:
        """Where the robot stands to inspect each plant, ``(n, 2)``."""
        return self.grid.stop_m

    def distance_m(self, i: ArrayLike, j: ArrayLike) -> Float:
        """Return the metres from plants i to plants j, -1 for the gate; shapes broadcast.

        Raise `SettingError` if one is neither.
        """
        here, there = self.places(i), self.places(j)
        shape = np.broadcast_shapes(here.shape, there.shape)
        a, b = (np.array(np.broadcast_to(k, shape)).ravel() for k in (here, there))
        metres = np.empty(a.size)
        _drive_all(self.travel, a, b, metres)
        return metres.reshape(shape)

    def path(self, i: int, j: int) -> Float:
        """Return the line ``(k, 2)`` driven from plant i to plant j, -1 for the gate.

        It is as long as `distance_m` says, and has two points or more.
        """
        return self.line(np.array([i, j]))[0]

    def line(self, places: NDArray[np.int64]) -> tuple[Float, NDArray[np.int64]]:
        """Return the line ``(m, 2)`` driven from place to place ``(k,)``, and where each leg ends.

        Legs are as `path` has them, one after the other; what is passed straight on is no corner.
        """
        return driven_line(self.travel, self.roads, self._lanes, self.places(places))

    def places(self, given: ArrayLike) -> NDArray[np.int64]:
        """Return numbers of plants, -1 for the gate; raise `SettingError` if one is neither.

        Loops look at no number: beyond the last plant they read what is not theirs.
        """
        numbers = np.asarray(given)
        if not numbers.size:
            return numbers.astype(np.int64)
        if numbers.dtype.kind not in "iu":
            raise self.no_place(given)
        wrong = (numbers < GATE) | (numbers >= len(self.grid))
        if wrong.any():
            raise self.no_place(numbers[wrong][0])
        return numbers.astype(np.int64)

    def no_place(self, *given: object) -> SettingError:
        """Return what is said of the first that is neither a plant nor the gate."""
        wrong = next(
            one
            for one in given
            if not isinstance(one, Integral)
            or isinstance(one, bool)
            or not GATE <= int(one) < len(self.grid)
        )
        return SettingError(
            worded(
                "Travel is between plants, 0 to {last}, and the gate, -1, but one is {wrong}. "
                "Count plants from 0.",
                last=len(self.grid) - 1,
                wrong=shown(wrong),
            )
        )

    @cached_property
    def onward_m(self) -> NDArray[np.float32]:
        """Least metres ``(r, r)`` from the lane ends of row i to those of row j or any beyond j.

        Below 0 where a row that is inspected from the same stretch of aisle is among these.
        """
        onward_m = np.zeros((self.grid.n_rows, self.grid.n_rows), np.float32)
        _onward(self.travel, onward_m)
        return read_only(onward_m)

    @cached_property
    def _lanes(self) -> Lanes:
        grid = self.grid
        end_node = np.append(self.roads.end.ravel(), self.roads.gate)
        stop_m = np.ascontiguousarray(self.stop_m)
        if grid.aisles_m is None or grid.aisle is None:
            nowhere = np.full(grid.n_rows, -1)
            nothing = np.zeros(1, np.int64), np.empty((0, 2)), np.empty(0)
            lanes = Lanes(stop_m, end_node, nowhere, *nothing)
        else:
            lanes = Lanes(stop_m, end_node, grid.aisle.astype(np.int64), *grid.aisles_m)
        for values in lanes:
            read_only(values)
        return lanes


def trace(aisles: Aisles, a: int, b: int) -> list[int]:
    """Return the nodes of the network on the way between two lane ends, as in `TravelTable`."""
    stops = np.append(aisles.roads.end.ravel(), aisles.roads.gate)
    nodes: list[int] = shortest_nodes(aisles.roads, stops[a], stops[b]).tolist()
    return nodes


@inner_inlined
def drive_m(travel: TravelTable, i: int, j: int) -> float:
    """Return the metres from plant i to plant j; -1 is the gate."""
    # written out: loops over the ends cost ten times as much
    x_m, end_m, between_m = travel.x_m, travel.end_x_m, travel.between_m
    gate = between_m.shape[0] - 1
    if i < 0:
        i, j = j, i
    if i < 0:
        return 0.0
    a = travel.row[i]
    low_m, high_m = abs(x_m[i] - end_m[a, 0]), abs(end_m[a, 1] - x_m[i])
    if j < 0:
        return float(min(low_m + between_m[2 * a, gate], high_m + between_m[2 * a + 1, gate]))
    b = travel.row[j]
    if travel.corridor[a] == travel.corridor[b]:
        return float(abs(x_m[i] - x_m[j]))
    to_low_m = min(low_m + between_m[2 * a, 2 * b], high_m + between_m[2 * a + 1, 2 * b])
    to_high_m = min(low_m + between_m[2 * a, 2 * b + 1], high_m + between_m[2 * a + 1, 2 * b + 1])
    to_low_m += abs(x_m[j] - end_m[b, 0])
    to_high_m += abs(end_m[b, 1] - x_m[j])
    return float(min(to_low_m, to_high_m))


@routine
def _drive_all(
    travel: TravelTable, i: NDArray[np.int64], j: NDArray[np.int64], metres: Float
) -> None:
    for k in range(i.size):
        metres[k] = drive_m(travel, i[k], j[k])


@routine
def _reach(roads: RoadNetwork, stops: NDArray[np.int64], between_m: Float) -> None:
    """Fill in the shortest ways ``(s, s)`` between the given nodes.

    Nodes are relaxed up and down the plot in turn, for some dozen sources side by side, until
    nothing gets shorter. As nodes are sorted by y, one sweep carries a way on until it turns back:
    on most plots a few sweeps do, far less work than a queue of nodes for each source.
    """
    n = roads.xy_m.shape[0]
    near = np.empty((n, _BLOCK))
    stale = np.empty(n, np.bool_)
    for first in range(0, stops.size, _BLOCK):
        width = min(_BLOCK, stops.size - first)
        near[:] = np.inf
        stale[:] = False
        for s in range(width):
            source = stops[first + s]
            near[source, s] = 0.0
            for e in range(roads.start[source], roads.start[source + 1]):
                stale[roads.to[e]] = True
        while stale.any():
            _sweep(roads, near, stale, (0, n, 1))
            _sweep(roads, near, stale, (n - 1, -1, -1))
        for s in range(width):
            # there and back are the same to the last bit
            for t in range(first + s + 1):
                between_m[first + s, t] = between_m[t, first + s] = near[stops[t], s]


@routine
def _onward(travel: TravelTable, onward_m: NDArray[np.float32]) -> None:
    for own in range(onward_m.shape[0]):
        for step in (1, -1):
            row, least = onward_m.shape[0] - 1 if step == 1 else 0, np.inf
            while row != own:
                for end in range(2):
                    ways_m = travel.between_m[2 * own + end]
                    least = min(least, ways_m[2 * row], ways_m[2 * row + 1])
                if travel.corridor[row] == travel.corridor[own]:
                    least = -np.inf
                onward_m[own, row] = np.float32(least * _LESS)
                row -= step


@routine
def _sweep(
    roads: RoadNetwork, near: Float, stale: NDArray[np.bool_], order: tuple[int, int, int]
) -> None:
    """Relax the stale nodes in order, for all columns of ``near`` (m, s)."""
    own = np.empty(_BLOCK)
    for node in range(order[0], order[1], order[2]):
        if not stale[node]:
            continue
        stale[node] = False
        # one by one, as `fill_coins` does
        for s in range(_BLOCK):
            own[s] = near[node, s]
        for e in range(roads.start[node], roads.start[node + 1]):
            other, length_m = np.uint64(roads.to[e]), roads.length_m[e]
            for s in range(_BLOCK):
                way_m = near[other, s] + length_m
                own[s] = way_m if way_m < own[s] else own[s]  # noqa: FURB136 - min is slower
        nearer = False
        for s in range(_BLOCK):
            nearer |= own[s] < near[node, s]
            near[node, s] = own[s]
        if nearer:
            for e in range(roads.start[node], roads.start[node + 1]):
                stale[roads.to[e]] = True


class Clock(NamedTuple):
    """A robot's numbers for compiled loops: what driving, turning and looking cost."""

    speed_m_s: float
    row_change_s: float
    turn_180_s: float
    visit_s: float
    seconds_left: float
    returns: bool


def robot_clock(robot: Robot, seconds_left: float) -> Clock:
    """Return a robot's numbers for so much of a day."""
    return Clock(
        robot.speed_m_s,
        robot.row_change_s,
        robot.turn_180_s,
        robot.visit_s,
        float(seconds_left),
        robot.returns,
    )


@inlined
def travel_s(travel: TravelTable, clock: Clock, i: int, j: int) -> float:
    """Return the seconds from plant (or gate) i to plant (or gate) j, without the stop itself."""
    seconds = drive_m(travel, i, j) / clock.speed_m_s
    if i < 0 or j < 0:
        return seconds
    a, b = travel.row[i], travel.row[j]
    if travel.corridor[a] != travel.corridor[b]:
        return seconds + clock.row_change_s
    if travel.side[a] != travel.side[b]:
        return seconds + clock.turn_180_s
    return seconds


@loop
def driven_s(travel: TravelTable, clock: Clock, places: NDArray[np.int64]) -> float:
    """Return the seconds of driving from place to place ``(k,)``, plants or the gate."""
    seconds = 0.0
    for k in range(1, places.size):
        seconds += travel_s(travel, clock, places[k - 1], places[k])
    return seconds


@inlined
def in_time(travel: TravelTable, clock: Clock, plant: int, arrive_s: float) -> bool:
    """Tell whether a plant reached then fits into the day, way back to the gate included."""
    end_s = arrive_s + clock.visit_s
    if clock.returns:
        end_s += travel_s(travel, clock, plant, -1)
    return end_s <= clock.seconds_left
