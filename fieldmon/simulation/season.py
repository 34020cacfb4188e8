"""Many working days while the insects spread."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import PlotError, SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.spread import Spread, night
from fieldmon.planning.workday import draw_detections, work_day
from fieldmon.plot.travel import GATE
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.infestation.belief import Belief
    from fieldmon.planning.workday import Workday
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles
    from fieldmon.samplers.base import Sampler


@dataclass(frozen=True)
class SeasonSettings:
    """What happens in a simulated season, beside the plot, the robot and the sampler.

    Parameters
    ----------
    n_days
        Working days (thesis: 25).
    spread
        What the insects do at night.
    believed_spread
        What the chance map takes them to do; None: the same.
    learning
        How findings change the chance map; None: with the robot's own detection.
    believe
        How plot and first chance map become a belief.
    """

    n_days: int = 25
    spread: Spread = field(default_factory=Spread)
    believed_spread: Spread | None = None
    learning: Learning | None = None
    believe: Callable[[PlantGrid, NDArray[np.float64]], Belief] = PairApproximation.of

    def __post_init__(self) -> None:
        if self.n_days < 1:
            raise SettingError(f"A season must have 1 day or more, but n_days is {self.n_days}.")


@dataclass(frozen=True, eq=False)
class Start:
    """The first morning: who is infested, and what is believed about it.

    Parameters
    ----------
    infested
        ``(n,)`` the truth, which no sampler sees.
    chance
        ``(n,)`` chance of infestation as believed.
    """

    infested: NDArray[np.bool_]
    chance: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Day:
    """One day of a season.

    Parameters
    ----------
    number
        From 0.
    work
        What was inspected, when, with what result.
    infested
        ``(n,)`` the truth in the morning.
    mornings
        What was believed on the season's mornings.
    last_inspected
        ``(n,)`` day of each plant's last inspection after today's work; -1: never.
    ever_infested
        Infestations so far, this morning's included (a plant infested again counts again).
    ever_found
        Finds so far, today's included.
    """

    number: int
    work: Workday
    infested: NDArray[np.bool_]
    mornings: _Mornings
    last_inspected: NDArray[np.int32]
    ever_infested: int
    ever_found: int

    @property
    def belief(self) -> Belief:
        """Return what was believed in the morning; worked out now if the sampler did not ask."""
        return self.mornings.on(self.number)

    @property
    def chance(self) -> NDArray[np.float64]:
        """Return the chance of infestation as believed in the morning, ``(n,)``."""
        return self.belief.chance

    @property
    def found(self) -> int:
        """Return the number of plants found infested today."""
        return int(np.count_nonzero(self.work.found))

    @property
    def left(self) -> int:
        """Return the number of infested plants this evening, before the night."""
        return int(np.count_nonzero(self.infested)) - self.found

    @property
    def detection_pct(self) -> float:
        """Return all finds so far in percent of all infestations so far (100 if none)."""
        return 100.0 * self.ever_found / self.ever_infested if self.ever_infested else 100.0

    @property
    def visited_pct(self) -> float:
        """Return the plants inspected today in percent of all plants."""
        return 100.0 * len(self.work) / len(self.infested)

    @property
    def ever_visited_pct(self) -> float:
        """Return the plants inspected so far in percent of all plants."""
        return 100.0 * float(np.mean(self.last_inspected >= 0))


class _Mornings:
    """What is believed on every morning of a season, worked out when somebody asks.

    Most of a season's time goes into it, and half of the samplers do not read it.
    """

    def __init__(
        self, first: Callable[[], Belief], taught: Callable[[Workday], Learning], spread: Spread
    ) -> None:
        self._first, self._taught, self._spread = first, taught, spread
        self._works: list[Workday] = []
        self._last: tuple[int, Belief] | None = None

    def add(self, work: Workday) -> None:
        """Hear of the next day's work."""
        self._works.append(work)

    def on(self, number: int) -> Belief:
        """Return the belief of a morning, from the last one asked for if that was before."""
        day, belief = self._last or (0, self._first())
        if day > number:
            day, belief = 0, self._first()
        for work in self._works[day:number]:
            learnt = belief.learn(work.plant, work.found, self._taught(work))
            belief = learnt.overnight(self._spread)
        self._last = number, belief
        return belief


def days(
    aisles: Aisles,
    robot: Robot,
    sampler: Sampler,
    start: Start,
    settings: SeasonSettings,
    chance: RandomStreams,
) -> Iterator[Day]:
    """Yield the days of a season, one by one, as they happen.

    Found insects are destroyed at once; missed ones stay and spread at night. Chance streams:
    ``inspect/day``, ``spread/day`` and ``sampler/day``, so that every sampler meets the same
    insects and the same luck in looking.
    """
    _check(aisles, start)
    learning = settings.learning or Learning(detection=robot.detects)
    believed = settings.believed_spread or settings.spread
    times = sampler.inspection_times(robot)
    choosing = len(times.detects) > 1
    infested = start.infested.copy()

    def taught(work: Workday) -> Learning:
        return replace(learning, detection=work.detects) if choosing else learning

    mornings = _Mornings(lambda: settings.believe(aisles.grid, start.chance), taught, believed)
    last_inspected = np.full(len(infested), NEVER, np.int32)
    ever_infested, ever_found = int(np.count_nonzero(infested)), 0
    trail, at = np.empty(0, np.int32), GATE
    keys = zip(*(chance.keys(name) for name in ("sampler", "inspect", "spread")), strict=True)
    for number, (own_key, inspect_key, night_key) in zip(
        range(settings.n_days), keys, strict=False
    ):
        belief = mornings.on(number) if sampler.reads_chance else None
        scene = Scene(
            aisles=aisles,
            robot=robot,
            chance=start.chance if belief is None else belief.chance,
            pair_chance=None if belief is None else belief.pair_chance,
            last_inspected=last_inspected,
            day=number,
            at=at,
            seconds_left=robot.day_s,
            trail=trail,
            key=own_key,
        )
        work = work_day(scene, sampler, draw_detections(infested, times.detects, inspect_key))
        last_inspected = last_inspected.copy()
        last_inspected[work.plant] = number
        ever_found += int(np.count_nonzero(work.found))
        yield Day(number, work, infested, mornings, last_inspected, ever_infested, ever_found)
        mornings.add(work)
        evening = infested.copy()
        evening[work.plant[work.found]] = False
        infested = night(aisles.grid, evening, settings.spread, night_key)
        # nobody recovers at night
        ever_infested += int(np.count_nonzero(infested)) - int(np.count_nonzero(evening))
        trail = work.plant if len(work) else trail
        at = GATE if robot.returns or not len(trail) else int(trail[-1])


def _check(aisles: Aisles, start: Start) -> None:
    n = len(aisles.grid)
    for name, values in (("infested", start.infested), ("chance", start.chance)):
        if len(values) != n:
            raise PlotError(
                f"The start of a season must have one entry a plant ({n}), "
                f"but {name} has {len(values)}."
            )
