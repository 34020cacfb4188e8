"""A real season so far: what was inspected and treated, and what that says each morning."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.infestation.spread import Spread
from fieldmon.plot.travel import GATE, driven_s, robot_clock
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles


@dataclass(frozen=True)
class Beliefs:
    """How the chance map follows from what is done and found on a real plot.

    Parameters
    ----------
    spread
        What the insects are taken to do in a night. The default is our choice for a plot whose
        pest nobody measured: each infested plant infests each of its neighbours with 2 % a night
        (8 % a night altogether: doubling in nine days), and 1 plant in 5 000 is infested from
        outside. The thesis's 30 to 80 % are meant for its simulator.
    treated
        Whether plants found infested are treated at once (the thesis's rule), or only flagged.
    """

    spread: Spread = field(
        default_factory=lambda: Spread(rate_per_day=0.02, arrivals_per_day=0.0002)
    )
    treated: bool = True

    def learning(self, detection: float) -> Learning:
        """Return how findings of that detection rate change the chance map."""
        return Learning(detection, treated=self.treated)


@dataclass(frozen=True, eq=False)
class Treatment:
    """A spraying, or whatever else kills insects, on some plants on some day.

    Parameters
    ----------
    day
        Day of the season. It works after that day's inspections.
    plants
        ``(n,)`` whether each plant was treated.
    efficacy
        Chance that an infested plant is clean afterwards.
    """

    day: int
    plants: NDArray[np.bool_]
    efficacy: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.efficacy <= 1.0:
            raise SettingError(
                f"The efficacy of a treatment must be a chance in 0..1, but it is {self.efficacy}."
            )


@dataclass(frozen=True, eq=False)
class History:
    """All that happened on a plot since its season began.

    Parameters
    ----------
    grid
        The plants.
    prior
        What is believed on the first morning.
    inspections, treatments
        What was done.
    beliefs
        What is made of it.
    detection
        Chance that an inspection finds what is there.
    """

    grid: PlantGrid
    prior: Belief
    inspections: Inspections = field(default_factory=Inspections.none)
    treatments: tuple[Treatment, ...] = ()
    beliefs: Beliefs = field(default_factory=Beliefs)
    detection: float = 0.84

    def night_after(self, morning: Belief, day: int) -> Belief:
        """Return what is believed the next morning, from what was on the morning of a day."""
        return self.evening(morning, day).overnight(self.beliefs.spread)

    def evening(self, morning: Belief, day: int) -> Belief:
        """Return what is believed after what was found and treated on a day."""
        done = self.inspections.on(day).looked
        believed = morning
        if len(done):
            learning = self.beliefs.learning(self.detection)
            believed = believed.learn(done.plant, done.result == FOUND, learning)
        for treatment in self.treatments:
            if treatment.day == day:
                believed = believed.treated(np.where(treatment.plants, 1 - treatment.efficacy, 1.0))
        return believed

    def last_inspected(self, day: int) -> NDArray[np.int32]:
        """Return ``(n,)`` the day of each plant's last inspection up to `day`, or `NEVER`."""
        last = np.full(len(self.grid), NEVER, np.int32)
        done = self.inspections.before(day + 1).looked
        last[done.plant] = done.day
        return last

    def states(self, day: int) -> NDArray[np.int8]:
        """Return ``(n,)`` up to `day`: 1 found infested, 0 only looked clean, -1 never seen."""
        state = np.full(len(self.grid), -1, np.int8)
        done = self.inspections.before(day + 1).looked
        np.maximum.at(state, done.plant, done.result)
        return state

    def scene(self, crew: Crew, day: int, morning: Belief, now_s: float | None = None) -> Scene:
        """Return the scene of a day as it stands after what was recorded of it.

        Parameters
        ----------
        crew
            Who works, and where.
        day
            Number of the day.
        morning
            What was believed on its morning.
        now_s
            Seconds since midnight; None: when the last inspection recorded was done, by its own
            time or, where none was noted, by what driving and looking cost.
        """
        aisles, robot = crew.aisles, crew.robot
        today, believed = self.inspections.on(day), self.evening(morning, day)
        last = self.last_inspected(day)
        last[today.plant] = day  # nobody is sent to a plant twice a day, not even a closed one
        trail = self._trail(day)
        resting = GATE if robot.returns or not len(trail) else int(trail[-1])
        return Scene(
            aisles=aisles,
            robot=robot,
            chance=believed.chance,
            pair_chance=believed.pair_chance,
            last_inspected=last,
            day=day,
            at=int(today.plant[-1]) if len(today) else resting,
            seconds_left=max(0.0, robot.day_s - _gone_s(crew, today, resting, now_s)),
            trail=trail,
            key=crew.chance.key("sampler", day),
        )

    def _trail(self, day: int) -> NDArray[np.int32]:
        earlier = self.inspections.before(day).looked
        return earlier.on(int(earlier.day[-1])).plant if len(earlier) else earlier.plant


@dataclass(frozen=True, eq=False)
class Crew:
    """Who works on a plot, and when.

    Parameters
    ----------
    aisles
        The plot: plants and the ways between them.
    robot
        Who inspects.
    starts_s
        Seconds since midnight at which the work starts.
    chance
        For samplers that draw.
    """

    aisles: Aisles
    robot: Robot
    starts_s: float = 6 * 3600.0
    chance: RandomStreams = RandomStreams(1)  # noqa: RUF009 - a seed, not a call with effects


def _gone_s(crew: Crew, today: Inspections, resting: int, now_s: float | None) -> float:
    """Return the seconds of the working day that are gone."""
    if now_s is not None:
        return max(0.0, now_s - crew.starts_s)
    if not len(today):
        return 0.0
    if np.isfinite(today.second[-1]):
        return max(0.0, float(today.second[-1]) - crew.starts_s)
    robot = crew.robot
    clock = robot_clock(robot, robot.day_s)
    drive_s = driven_s(crew.aisles.travel, clock, np.append(np.int64(resting), today.plant))
    return drive_s + robot.visit_s * len(today)
