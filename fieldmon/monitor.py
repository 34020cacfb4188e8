"""From a plot and its records to today's route: the chain that the command line and the app share."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.aisles import Aisles
from fieldmon.field import Observations
from fieldmon.planting import Planting, lay
from fieldmon.prior import PriorSettings, prior_chance
from fieldmon.robot import Robot
from fieldmon.route import route_of
from fieldmon.samplers import NEVER, Dynamic, Sampler, Scene
from fieldmon.workday import plan_day

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.field import Field
    from fieldmon.grid import PlantGrid
    from fieldmon.route import Route
    from fieldmon.workday import Workday


@dataclass(frozen=True, eq=False)
class Plot:
    """A field with its plants and the ways between them."""

    field: Field
    aisles: Aisles

    @property
    def grid(self) -> PlantGrid:
        """Return the plants."""
        return self.aisles.grid

    @classmethod
    def of(cls, field: Field, planting: Planting | None = None) -> Plot:
        """Lay the plants of a field, or take its measured ones, and find the ways between them."""
        grid = lay(field, planting or Planting())
        gate = None if field.gate is None else tuple(grid.frame.xy_m([field.gate])[0].tolist())
        return cls(field, Aisles.of(grid, gate))


@dataclass(frozen=True)
class Plans:
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
    sampler: Sampler = field(default_factory=Dynamic)
    prior: PriorSettings = field(default_factory=PriorSettings)


@dataclass(frozen=True, eq=False)
class Today:
    """A planned day: what is believed, where to go, and the scene it was planned in."""

    scene: Scene
    work: Workday
    route: Route

    @property
    def chance(self) -> NDArray[np.float64]:
        """Return the believed chance of infestation of every plant, ``(n,)``."""
        return self.scene.chance


def first_day(
    plot: Plot, observations: Observations, on_day: np.datetime64, plans: Plans
) -> Today:
    """Plan a day on a plot of which nothing but records is known."""
    chance = prior_chance(plot.grid, plot.field, observations, on_day, plans.prior)
    return plan_from(plot, chance, plans)


def plan_from(plot: Plot, chance: NDArray[np.float64], plans: Plans) -> Today:
    """Plan a first day from a chance map ``(n,)``."""
    scene = Scene(
        aisles=plot.aisles,
        robot=plans.robot,
        chance=chance,
        last_inspected=np.full(len(plot.grid), NEVER, np.int32),
        seconds_left=plans.robot.day_s,
    )
    work = plan_day(scene, plans.sampler)
    return Today(scene, work, route_of(scene, work))
