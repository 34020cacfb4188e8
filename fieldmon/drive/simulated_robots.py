"""Robots of a simulation: who drives, and what they find, made up from what is believed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.insects import Insects
from fieldmon.drive.mujoco_robot import MujocoRobot
from fieldmon.errors import SettingError
from fieldmon.simulation.start import season_start

if TYPE_CHECKING:
    from fieldmon.drive.errand import DrivingRobot
    from fieldmon.drive.mujoco_robot import Physics
    from fieldmon.drive.recording import Recording
    from fieldmon.samplers.base import Sampler

CHARGED, MUJOCO = "charged", "mujoco"


class MadeUp(NamedTuple):
    """What of a simulated day is drawn.

    Parameters
    ----------
    infested
        Share of plants infested, 0 to 1.
    seed
        Of insects.
    """

    infested: float = 0.02
    seed: int = 1


def simulated_robot(
    kind: str,
    recording: Recording,
    sampler: Sampler,
    made_up: MadeUp,
    physics: Physics | None = None,
) -> DrivingRobot:
    """Return a simulated robot that notes its way in a recording.

    Parameters
    ----------
    kind
        ``charged`` or ``mujoco``.
    recording
        Of the ways, the robot's numbers and the morning's chances.
    sampler
        Who decides: says how long plants are inspected.
    made_up
        What is drawn.
    physics
        Of MuJoCo: what it is and meets.

    Raises
    ------
    SettingError
        If there is no such robot, or nothing is believed of the morning.
    """
    worker, chance = recording.robot, recording.chance
    if chance is None:
        raise SettingError("A simulated robot needs the morning's chances to draw its insects.")
    streams = RandomStreams(made_up.seed)
    grid = recording.aisles.grid
    start = season_start(grid, chance, made_up.infested, streams)
    detects = sampler.inspection_times(worker).detects
    look = Insects(grid, start, detects, streams=streams).look
    if kind == MUJOCO:
        return MujocoRobot(worker, look, physics, recording.track)
    if kind == CHARGED:
        return ChargedRobot(look)
    raise SettingError(f"A simulated robot is {CHARGED} or {MUJOCO}, but it is {kind!r}.")
