"""What a robot's size means on a plot: how far ways keep off plants, and what is too narrow."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, floor
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.wording import counted, joined, worded
from fieldmon.errors import PlotError
from fieldmon.plot.clear_lanes import lane_lines
from fieldmon.plot.end_turns import TurningCircle, end_turns, lane_ends
from fieldmon.plot.robot import USUAL_TIMES
from fieldmon.plot.steered_way import STEERS_S

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]
    Mask = NDArray[np.bool_]

#: taken where nobody said how far plants reach to each side of their middle
USUAL_HALF_CANOPY_M = 0.25
#: how far a robot may stray from its line: simulated drives strayed 8 cm at most, see
#: docs/physical_simulation
STRAY_M = 0.1


class Clearance(NamedTuple):
    """How far a robot's way must keep off the middle of plants.

    Parameters
    ----------
    way_m
        Where it drives on.
    turn_m
        Where it turns on the spot, as at row ends.
    circle
        What it needs to turn if it cannot turn on the spot; None: it can.
    half_m
        Half of its width.
    """

    way_m: float
    turn_m: float
    circle: TurningCircle | None = None
    half_m: float = 0.0

    @property
    def off_m(self) -> float:
        """Return how far its way keeps off holes and no-go areas."""
        return self.half_m + STRAY_M if self.half_m else 0.0

    @classmethod
    def of(cls, robot: Robot, grid: PlantGrid) -> Clearance | None:
        """Return what a robot needs among these plants; None if its width is not known."""
        if robot.width_m is None or robot.turning_m is None:
            return None
        beside_m = half_canopy_m(grid) + STRAY_M
        half_m = robot.width_m / 2
        way_m = half_m + beside_m
        if robot.turning_radius_m is None:
            return cls(way_m, robot.turning_m / 2 + beside_m, None, half_m)
        size = robot.width_m, robot.length_m or robot.width_m
        circle = TurningCircle(robot.turning_radius_m, *size, beside_m)
        return cls(way_m, way_m, circle, half_m)

    def too_narrow(self, grid: PlantGrid) -> Mask:
        """Tell of each row ``(r,)`` whether it cannot be inspected: its aisle is too narrow.

        Or there is no room to turn at either end. Rows that are inspected from the same stretch
        of aisle are too narrow together. Raise `PlotError` if all are.
        """
        if not grid.in_rows:
            return np.zeros(grid.n_rows, np.bool_)
        room_m = lane_room_m(grid)
        stretches = np.zeros(int(grid.stretches.max()) + 1, np.bool_)
        tight = self.tight_ends(grid).all(axis=1) & ~grid.cut_ends.all(axis=1)
        stretches[grid.stretches[(room_m < self.way_m) | tight]] = True
        rows: Mask = stretches[grid.stretches]
        if rows.all() and (room_m >= self.way_m).any():
            if self.circle is not None:
                raise PlotError(
                    worded(
                        "A robot must have room to turn at the ends of rows, but with a turning "
                        "radius of {radius_m:g} m it has none at any row of this plot. Take a "
                        "robot that turns sharper or is smaller, or say how much headland there "
                        "is.",
                        radius_m=self.circle.radius_m,
                    )
                )
            raise PlotError(
                worded(
                    "A robot must have room to turn at the ends of rows: {need_m:.2f} m around it, "
                    "but no row of this plot has it. Take a shorter robot, or say how much "
                    "headland there is.",
                    need_m=self.turn_m,
                )
            )
        if rows.all():
            raise PlotError(
                worded(
                    "A robot's aisles must be as wide as it is, with plants' canopies and 0.1 m on "
                    "either side: {need_m:.2f} m between the middles of plants, but the widest "
                    "here is {room_m:.2f} m. Take a narrower robot, or say how far plants reach "
                    "to each side (half a canopy).",
                    need_m=2 * self.way_m,
                    room_m=2 * float(room_m.max()),
                )
            )
        return rows

    def tight_ends(self, grid: PlantGrid) -> Mask:
        """Tell of each lane end ``(r, 2)`` whether there is no room to turn."""
        tight: Mask = ~np.asarray(self.turn_room(grid).any(axis=2))
        return tight

    def turn_room(self, grid: PlantGrid) -> Mask:
        """Tell of each lane end whether there is room to turn right and left, ``(r, 2, 2)``.

        As the lane runs to its high end; on the spot it is as much to both sides. Nobody turns
        where a lane is cut.
        """
        if self.circle is not None:
            return end_turns(grid, self.circle).room & ~grid.cut_ends[..., None]
        roomy = (self.end_room_m(grid) >= self.turn_m) & ~grid.cut_ends
        room: Mask = np.repeat(roomy[..., None], 2, axis=2)
        return room

    @staticmethod
    def end_room_m(grid: PlantGrid) -> Float:
        """Return how near each lane end is to the middle of any plant, ``(r, 2)`` metres."""
        room: Float = grid.tree.query(lane_ends(grid)[0])[0]
        return room


def robot_on(grid: PlantGrid, robot: Robot) -> Robot:
    """Return a robot as it is charged on a plot.

    Where plants stand in no rows, it changes none. One that cannot turn on the spot is charged what
    a change to the next aisle takes it at the row ends of this plot, and that it steers before it
    sets out from a stop, unless other times than the usual were chosen for it.
    """
    if not grid.in_rows:
        return replace(robot, row_change_s=0.0) if robot.row_change_s else robot
    needs = Clearance.of(robot, grid)
    if needs is None or needs.circle is None or robot.times != USUAL_TIMES:
        return robot
    change_s = end_turns(grid, needs.circle).row_change_s(robot.speed_m_s)
    if change_s is None:
        return robot
    return replace(robot, row_change_s=round(change_s, 1), stop_s=robot.stop_s + STEERS_S)


def half_canopy_m(grid: PlantGrid) -> float:
    """Return how far plants reach to each side of their middle, as said or as usual."""
    return USUAL_HALF_CANOPY_M if grid.half_canopy_m is None else grid.half_canopy_m


def lane_room_m(grid: PlantGrid) -> Float:
    """Return how near the lane of each row comes to the middle of any plant, ``(r,)`` metres."""
    points: Any = shapely.points(grid.xy_m)
    plants = shapely.STRtree(points)
    near = plants.query_nearest(lane_lines(grid), all_matches=False, return_distance=True)
    room: Float = near[1]
    return room


def narrow_sentence(rows: Mask, grid: PlantGrid, needs: Clearance) -> str:
    """Return for people which rows ``(r,)`` a robot that needs so much cannot enter, and why."""
    room_m = lane_room_m(grid)
    ends_m = np.where(grid.cut_ends, 0.0, needs.end_room_m(grid)).max(axis=1)
    in_aisle = np.isin(grid.stretches, grid.stretches[room_m < needs.way_m])
    said = []
    if (narrow := rows & in_aisle).any():
        said.append(
            worded(
                "{rows} of {all} cannot be inspected: from the middle of the aisle, where it "
                "drives, the robot needs {need_m:.2f} m to the middle of any plant, but one "
                "stands {room_m:.2f} m from it. Their {plants} are not visited.",
                need_m=_up(needs.way_m),
                room_m=_down(float(room_m[narrow].min())),
                **_counted(narrow, grid),
            )
        )
    tight = rows & ~in_aisle
    if tight.any() and needs.circle is not None:
        said.append(
            worded(
                "{rows} of {all} cannot be inspected: with a turning radius of {radius_m:g} m the "
                "robot has no room to turn at either end of their aisles. Their {plants} are not "
                "visited.",
                radius_m=needs.circle.radius_m,
                **_counted(tight, grid),
            )
        )
    elif tight.any():
        said.append(
            worded(
                "{rows} of {all} cannot be inspected: to turn at an end of their aisles the robot "
                "needs {need_m:.2f} m from its middle to the middle of any plant, but at the "
                "better end one stands {room_m:.2f} m from it. Their {plants} are not visited.",
                need_m=_up(needs.turn_m),
                room_m=_down(float(ends_m[tight].min())),
                **_counted(tight, grid),
            )
        )
    return joined(" ", said)


def hidden_sentence(n: int, needs: Clearance | None) -> str:
    """Return for people that holes and no-go areas hide so many plants."""
    if needs is None:
        return worded(
            "{plants} cannot be inspected: a hole or a no-go area cuts their aisle.",
            plants=counted(n, "plant"),
        )
    return worded(
        "{plants} cannot be inspected: a hole or a no-go area, off which the robot keeps "
        "{off_m:.2f} m, cuts their aisle.",
        plants=counted(n, "plant"),
        off_m=_up(needs.off_m),
    )


def _counted(rows: Mask, grid: PlantGrid) -> dict[str, object]:
    """Return how many rows, as people count them, and plants these rows ``(r,)`` are."""
    return {
        "rows": counted(len(np.unique(grid.row_line[rows])), "row"),
        "all": grid.n_lines,
        "plants": counted(int(np.diff(grid.row_start)[rows].sum()), "plant"),
    }


def _up(metres: float) -> float:
    """Return a length in whole centimetres, never less: what is there must be seen to be less."""
    return ceil(round(100 * metres, 6)) / 100


def _down(metres: float) -> float:
    """Return a length in whole centimetres, never more."""
    return floor(round(100 * metres, 6)) / 100
