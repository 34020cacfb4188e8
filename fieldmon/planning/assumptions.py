"""What the figures of a planned day rest on though nobody said it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.clearance import USUAL_HALF_CANOPY_M, robot_on
from fieldmon.plot.robot import USUAL_TIMES, Robot, scout

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fieldmon.planning.members import TeamMember
    from fieldmon.plot.grid import PlantGrid


def assumed_by(
    planting: Iterable[Assumed], prior: PriorSettings, robot: Robot, grid: PlantGrid | None = None
) -> tuple[Assumed, ...]:
    """Return everything assumed of a day: of the planting, and what still is as it came.

    How far plants reach to each side counts only for a robot whose width is known.

    Examples
    --------
    >>> from fieldmon.infestation.prior.prior import PriorSettings
    >>> from fieldmon.plot.robot import Robot
    >>> for each in assumed_by((), PriorSettings(background_chance=0.03), Robot(speed_m_s=0.5)):
    ...     print(each)
    guessed: time added for a row change, as in simulated drives: 9 s
    guessed: time added for a stop, as in simulated drives: 1.13 s
    guessed: chance to find what is there 84 %
    """
    made = [*planting]
    if prior.background_chance == PriorSettings().background_chance:
        made.append(Assumed("background_chance", prior.background_chance))
    usual = (Robot(), scout())
    if robot.speed_m_s in {one.speed_m_s for one in usual}:
        made.append(Assumed("speed_m_s", robot.speed_m_s))
    if robot.times == USUAL_TIMES:
        charged = robot if grid is None else robot_on(grid, robot)
        if grid is None or grid.in_rows:
            made.append(Assumed("row_change_s", charged.row_change_s))
        made.append(Assumed("stop_s", charged.stop_s))
    if robot.detection is None and robot.viewpoints == Robot().viewpoints:
        made.append(Assumed("detects", robot.detects))
    if robot.width_m is not None and (grid is None or grid.half_canopy_m is None):
        made.append(Assumed("half_canopy_m", USUAL_HALF_CANOPY_M))
    return tuple(made)


def assumed_by_team(
    planting: Iterable[Assumed],
    prior: PriorSettings,
    team: Sequence[TeamMember],
    grid: PlantGrid | None = None,
) -> tuple[Assumed, ...]:
    """Return everything assumed of a day of a team: what is not of all, with the names of whom."""
    laid = tuple(planting)
    names: dict[Assumed, list[str]] = {}
    for member in team:
        for one in assumed_by(laid, prior, member.robot, grid):
            names.setdefault(one, []).append(member.name)
    order = [*dict.fromkeys(one.setting for one in names)]
    return tuple(
        one if len(whose) == len(team) else replace(one, of=", ".join(whose))
        for one, whose in sorted(names.items(), key=lambda item: order.index(item[0].setting))
    )
