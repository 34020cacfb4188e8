"""Seasons of all samplers on the same insects, two at a time, and what came of each."""

from __future__ import annotations

from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.independent import IndependentPlants
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.spread import night
from fieldmon.plot.robot import Robot
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import Sampler
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.sweeps import Bouncy, Naive
from fieldmon.simulation.metrics import SeasonFigures, figures
from fieldmon.simulation.season import days

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.samplers.base import Scene, Stops, WouldFind
    from fieldmon.simulation.season import Day, Start
    from fieldmon.studies.samplers.scenarios import Cell

ADAPTIVE, WORDED, TUNED = "adaptive", "dynamic, as worded", "dynamic, tuned"
NO_TRAVEL, CLAIRVOYANT = "no travel", "clairvoyant"
SOME = 10
_FAST = 1e6


@dataclass(frozen=True)
class Contender:
    """Who takes part: a sampler with the belief it is given.

    Parameters
    ----------
    name
        What it is called.
    sampler
        Who decides.
    believe
        How plot and chance map become a belief.
    drives
        False for the bound: driving and changing rows take no time.
    every
        Takes part in every so many-th season: who is there for orientation need not be in all.
    """

    name: str
    sampler: Sampler
    believe: Callable[[PlantGrid, NDArray[np.float64]], Belief] = PairApproximation.of
    drives: bool = True
    every: int = 1


# what `tuning.losses` came to; the map of pairs is the better one for Dynamic too
RIVALS = (
    Contender(ADAPTIVE, Adaptive()),
    Contender(WORDED, Dynamic()),
    Contender(TUNED, Dynamic(suspicious=0.06)),
    Contender("dynamic, independent plants", Dynamic(), IndependentPlants, every=SOME),
    Contender("adaptive, independent plants", Adaptive(), IndependentPlants, every=SOME),
    Contender("naive", Naive(), IndependentPlants),
    Contender("bouncy", Bouncy(), IndependentPlants),
    Contender(NO_TRAVEL, Adaptive(), drives=False, every=SOME),
)
NAMES = (*(rival.name for rival in RIVALS), CLAIRVOYANT)


@dataclass(frozen=True)
class Outcome:
    """What a season came to; a level never reached counts as one day more than the season has."""

    cell: str
    seed: int
    who: str
    infested_plant_days: float
    d50: float
    d80: float
    inspected: float
    found: float
    visited_pct: float


MEASURES = ("infested_plant_days", "d50", "d80", "inspected", "found", "visited_pct")


class _Oracle(Sampler):
    """The clairvoyant: drives as Adaptive does, on the truth instead of a chance map."""

    def __init__(self, truth: NDArray[np.bool_]) -> None:
        self.truth = truth

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day, at infested plants first."""
        chance = np.where(self.truth, 1.0 - 1e-6, 1e-6)
        start, other = scene.grid.adjacent
        pair_chance = np.repeat(chance, np.diff(start)) * chance[other]
        return Adaptive().walk(replace(scene, chance=chance, pair_chance=pair_chance), would_find)


class _Misinformed(Sampler):
    """A sampler that takes the robot to detect what the thesis's does."""

    def __init__(self, sampler: Sampler) -> None:
        self.sampler = sampler

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day."""
        robot = replace(scene.robot, detection=Robot().detects)
        return self.sampler.walk(replace(scene, robot=robot), would_find)


def run(
    cells: Sequence[Cell],
    seeds: Sequence[int],
    done: frozenset[tuple[str, int]] = frozenset(),
    at_once: int = 2,
) -> Iterator[list[Outcome]]:
    """Yield the outcomes of one cell and seed after the other, as they are ready.

    `done` ``(cell name, seed)`` are left out: a study that was stopped goes on.
    """
    jobs = ((cell, seed) for seed in seeds for cell in cells if (cell.name, seed) not in done)
    with ThreadPoolExecutor(at_once) as pool:
        running = {pool.submit(outcomes, *job) for job in islice(jobs, at_once)}
        while running:
            ready, running = wait(running, return_when=FIRST_COMPLETED)
            running |= {pool.submit(outcomes, *job) for job in islice(jobs, len(ready))}
            for job in ready:
                yield job.result()


def outcomes(cell: Cell, seed: int) -> list[Outcome]:
    """Return what the season of one cell and seed comes to for every rival and the clairvoyant."""
    chance = RandomStreams(seed)
    start = cell.begin(chance)
    made = [
        _outcome(cell, seed, rival.name, figures(season(cell, rival, start, chance)))
        for rival in RIVALS
        if seed % rival.every == 0
    ]
    if seed % SOME:
        return made
    seen = figures(_clairvoyant(cell, start, chance))
    return [*made, _outcome(cell, seed, CLAIRVOYANT, seen)]


def season(cell: Cell, rival: Contender, start: Start, chance: RandomStreams) -> Iterator[Day]:
    """Return the days of a rival's season."""
    robot = cell.robot
    if not rival.drives:
        robot = replace(robot, speed_m_s=_FAST, row_change_s=0.0)
    sampler = _Misinformed(rival.sampler) if cell.flaw == "detection" else rival.sampler
    settings = replace(cell.settings, believe=rival.believe)
    return days(cell.aisles, robot, sampler, start, settings, chance)


def _clairvoyant(cell: Cell, start: Start, chance: RandomStreams) -> Iterator[Day]:
    seer = _Oracle(start.infested)
    for day in days(cell.aisles, cell.robot, seer, start, cell.settings, chance):
        yield day
        evening = day.infested.copy()
        evening[day.work.plant[day.work.found]] = False
        key = chance.key("spread", day.number)
        seer.truth = night(cell.aisles.grid, evening, cell.spread, key)


def _outcome(cell: Cell, seed: int, who: str, made: SeasonFigures) -> Outcome:
    never = len(made.found) + 1
    n = len(cell.aisles.grid)
    return Outcome(
        cell.name,
        seed,
        who,
        float(made.infested_plant_days),
        float(made.first_day(50.0) or never),
        float(made.first_day(80.0) or never),
        float(round(made.visited_pct.sum() * n / 100.0)),
        float(made.found.sum()),
        float(made.ever_visited_pct[-1]),
    )
