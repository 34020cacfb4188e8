"""Small plots and scenes for tests of samplers, routes and seasons."""

import numpy as np

from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers.base import NEVER, Scene


def scene_on(grid, hours=3.0, seed=0, **changes):
    rng = np.random.default_rng(seed)
    chance = np.clip(rng.beta(0.3, 3.0, len(grid)), 1e-6, 1 - 1e-6)
    robot = Robot(hours=hours, returns=bool(seed % 2))
    return Scene(
        aisles=Aisles.of(grid),
        robot=robot,
        chance=chance,
        last_inspected=changes.pop("last_inspected", np.full(len(grid), NEVER, np.int32)),
        seconds_left=robot.day_s,
        key=np.uint64(seed),
        **changes,
    )


def grids():
    yield "one plant", rectangle(1, 1)
    yield "one row", rectangle(1, 30)
    yield "one plant a row", rectangle(12, 1)
    yield "rectangle", rectangle(11, 17)


GRIDS = dict(grids())


def charged_s(scene, i, j):
    """Return the seconds of one leg, from the driven line and the robot's stated numbers."""
    line = scene.aisles.path(i, j)
    seconds = np.hypot(*np.diff(line, axis=0).T).sum() / scene.robot.speed_m_s
    if GATE in (i, j):
        return seconds
    rows = scene.grid.row[[i, j]]
    if np.ptp(scene.grid.corridor[rows]):
        return seconds + scene.robot.row_change_s
    return seconds + scene.robot.turn_180_s * bool(np.ptp(scene.grid.side[rows]))
