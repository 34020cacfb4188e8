"""The same day on many plots: what to plan on each, and how one of them is planned."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from datetime import time
from typing import TYPE_CHECKING, Any

from fieldmon.compute.digest import digest
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.pests.pest import seen_by_pest
from fieldmon.planning.day_bound import with_bound
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.robot import Robot, rover, scout
from fieldmon.samplers import USUAL_SAMPLER, sampler_with
from fieldmon.samplers.own import is_own, own_text

if TYPE_CHECKING:
    import numpy as np

    from fieldmon.infestation.records import Records
    from fieldmon.pests.pest import Pest
    from fieldmon.planning.plan import DayPlan
    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot


@dataclass(frozen=True)
class Orders:
    """What was ordered for all plots by hand.

    Parameters
    ----------
    day
        The day of the work.
    sampler
        Name of the sampler, or ``my_sampler.py:Mine``.
    every
        Its setting of that name, where it has one; None: its own.
    on_foot
        A scout on every plot instead of the robot.
    robot
        Settings of `Robot`; what is not here, the plot's own columns say.
    planting
        Settings of `Planting`, likewise.
    bound
        Whether each day says what no other route can expect to find.
    prior
        How records become chances.
    pest
        What is looked for; None: any.
    rover
        The small robot on every plot instead of the usual one.
    robot_times
        What robots are charged beside driving and looking, a name of `ROBOT_TIMES`; None: theirs.
        A scout has times of its own.
    at
        Local time at which the work starts.
    """

    day: np.datetime64
    sampler: str = USUAL_SAMPLER
    every: int | None = None
    on_foot: bool = False
    robot: dict[str, float] = field(default_factory=dict)
    planting: dict[str, float] = field(default_factory=dict)
    bound: bool = True
    prior: PriorSettings = field(default_factory=PriorSettings)
    pest: Pest | None = None
    rover: bool = False
    robot_times: str | None = None
    at: time = time(6)


@dataclass(frozen=True, eq=False)
class Task:
    """One plot to be planned.

    Parameters
    ----------
    plot
        The field.
    who
        ``"robot"``, ``"scout"`` or None, as its file says.
    stated
        Settings of `Robot` as its file says.
    orders
        What holds for all plots.
    wrong
        Of what its file says, what no robot can be set to: a sentence by its setting.
    left_aside
        Settings of `Robot` of which its file says no number, with what is wrong there, if anything.
    """

    plot: Field
    who: str | None
    stated: dict[str, float]
    orders: Orders
    wrong: dict[str, str] = field(default_factory=dict)
    left_aside: dict[str, str] = field(default_factory=dict)

    def assumed(self, robot: Robot) -> list[Assumed]:
        """Return what was taken of the robot where the file says no number."""
        return [
            Assumed(name, getattr(robot, name))
            for name in self.left_aside
            if name not in self.orders.robot
        ]

    def digest(self, records: Records) -> str:
        """Return what tells this task from any other, however alike."""
        ordered = dict(vars(self.orders))
        # folders of routes from before these could be ordered hold the tasks of today's usual
        later = ("prior", "pest", "rover", "robot_times", "at")
        usual = vars(Orders(self.orders.day))
        for name in later:
            if ordered[name] == usual[name]:
                del ordered[name]
        if is_own(self.orders.sampler):  # another text is another sampler
            ordered["own"] = own_text(self.orders.sampler)
        # what was left aside stands in the summary
        aside = [self.left_aside] * bool(self.left_aside)
        parts = (*self.plot.content, self.who, self.stated, *ordered.values(), *aside)
        return digest(*parts, *vars(records).values(), length=16)


def plan_task(task: Task, plot: Plot, records: Records) -> DayPlan:
    """Plan the day on a task's plot; raise a `FieldmonError` where it cannot be done."""
    orders = task.orders
    robot = _robot(task)
    decides = sampler_with(orders.sampler, orders.every)
    plans = PlanSettings(robot, decides, orders.prior)
    today = first_day(plot, records, orders.day, plans)
    if not len(today.route):
        raise SettingError(
            worded(
                "The working day must be long enough to reach a plant and come back, but "
                "{hours:g} h are not. Give more hours.",
                hours=robot.hours,
            )
        )
    return with_bound(today) if orders.bound else today


def _robot(task: Task) -> Robot:
    who = (task.who or "robot").casefold()
    if who not in {"robot", "scout"}:
        raise SettingError(
            worded(
                "A plot must be worked by 'robot' or 'scout', but it is {who!r}.",
                who=task.who,
            )
        )
    orders = task.orders
    on_foot = orders.on_foot or (who == "scout" and not orders.rover)
    base = scout() if on_foot else rover() if orders.rover else Robot()
    if orders.robot_times is not None and not on_foot:
        base = base.with_times(orders.robot_times)
    for name, said in task.wrong.items():
        if name not in orders.robot:
            raise SettingError(said)
    settings: dict[str, Any] = task.stated | orders.robot
    robot = replace(base, **settings)
    return seen_by_pest(robot, orders.pest)
