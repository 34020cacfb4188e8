"""What no other route of a day's hours can expect to find."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.planning.bound_wording import sound_bound
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.workday import Workday
    from fieldmon.samplers.base import Scene

#: seconds after which the best bound so far is taken; on a plot of a million plants it takes one
WITHIN_S = 10.0


def with_bound(day: DayPlan, within_s: float = WITHIN_S) -> DayPlan:
    """Return a planned day whose route says what no other can expect to find, if that is known."""
    return replace(day, route=replace(day.route, found_bound=found_bound(day, within_s)))


def found_bound(day: DayPlan, within_s: float = WITHIN_S) -> float | None:
    """Return the most finds that any route of a day's hours can expect.

    A route is fixed in the morning: whoever plans again after each find can expect more. None
    where no bound is known: on the way, away from the gate, where a sampler chooses at each
    plant how long to inspect it, and where plants stand in no rows.
    """
    # late: a day without a bound needs none of these loops
    from fieldmon.planning.routes import bound  # noqa: PLC0415

    scene = day.scene
    if scene.at != GATE or scene.seconds_left <= 0 or not scene.grid.in_rows:
        return None
    if _chooses_time(scene, day.work):
        return None
    finds = np.where(scene.last_inspected == scene.day, 0.0, scene.chance * scene.robot.detects)
    most = bound(scene.aisles, finds, scene.robot, scene.seconds_left, within_s)
    most = sound_bound(day.route.expected_finds, most)
    return most if np.isfinite(most) else None


def _chooses_time(scene: Scene, work: Workday) -> bool:
    return bool((work.stop_s != scene.robot.visit_s).any())
