"""From a plot and its records to today's route: the chain behind the commands and the app."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.pairs import pair_chances
from fieldmon.infestation.prior import PriorSettings, prior_chance
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_day
from fieldmon.plot.robot import Robot
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Sampler, Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.observations import Observations
    from fieldmon.planning.route import Route
    from fieldmon.planning.workday import Workday
    from fieldmon.plot.plot import Plot


@dataclass(frozen=True)
class PlanSettings:
    """How a day is planned.

    Parameters
    ----------
    robot
        Who inspects.
    sampler
        Who decides which plants come next.
    prior
        How records, edges and paths become a chance of infestation.
    """

    robot: Robot = field(default_factory=Robot)
    sampler: Sampler = field(default_factory=Adaptive)
    prior: PriorSettings = field(default_factory=PriorSettings)


@dataclass(frozen=True, eq=False)
class DayPlan:
    """A planned day: what is believed, where to go, and the scene it was planned in."""

    scene: Scene
    work: Workday
    route: Route

    @property
    def chance(self) -> NDArray[np.float64]:
        """Return the believed chance of infestation of every plant, ``(n,)``."""
        return self.scene.chance


def first_day(
    plot: Plot,
    observations: Observations,
    on_day: np.datetime64,
    plans: PlanSettings,
    risk: NDArray[np.float64] | None = None,
) -> DayPlan:
    """Plan a day on a plot of which nothing but records is known, and perhaps a risk ``(n,)``."""
    chance = prior_chance(plot.grid, plot.field, observations, on_day, plans.prior, risk)
    return plan_from(plot, chance, plans)


def plan_from(plot: Plot, chance: NDArray[np.float64], plans: PlanSettings) -> DayPlan:
    """Plan a first day from a chance map ``(n,)``."""
    scene = Scene(
        aisles=plot.aisles,
        robot=plans.robot,
        chance=chance,
        last_inspected=np.full(len(plot.grid), NEVER, np.int32),
        seconds_left=plans.robot.day_s,
        # as a season believes: it goes the same way on its first day
        pair_chance=pair_chances(chance, plot.grid),
    )
    work = plan_day(scene, plans.sampler)
    return DayPlan(scene, work, route_of(scene, work))
