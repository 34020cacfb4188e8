"""One season of chapter 5 under its open choices, as columns a day."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.belief import Learning, learn, overnight
from fieldmon.samplers import GATE, NEVER, Scene, sampler
from fieldmon.spread import night
from fieldmon.thesis.with_prior.choices import N_DAYS, OpenChoices
from fieldmon.thesis.with_prior.sites import first_morning
from fieldmon.workday import outcomes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.chance import Chance
    from fieldmon.robot import Robot
    from fieldmon.season import Start
    from fieldmon.thesis.with_prior.sites import Site

    Floats = NDArray[np.float64]
    Flags = NDArray[np.bool_]

COLUMNS = ("visited", "found", "infested", "new", "ever", "ever_found")
VISITED, FOUND, INFESTED, NEW, EVER, EVER_FOUND = range(len(COLUMNS))
"""Columns of a season, one row a day: plants inspected and found; infested that morning; new since
the evening before (day 1: at the start); plants infested, and found, at least once by then."""

# who does not look at the chance map needs none
_BLIND = frozenset({"naive", "bouncy"})
_MOST = 1.0 - 1e-6


@dataclass(frozen=True)
class Trial:
    """One configuration of chapter 5.

    Parameters
    ----------
    sampler
        Its name.
    choices
        What the thesis leaves open.
    hectares
        Size of the square plot; None: played on a site that is handed in.
    look_s
        Seconds of looking.
    detection
        Chance of detection; None: by the viewpoint table.
    """

    sampler: str
    choices: OpenChoices
    hectares: float | None = None
    look_s: float = 40.0
    detection: float | None = None

    @property
    def robot(self) -> Robot:
        """Return who inspects."""
        return self.choices.robot(self.look_s, self.detection)


@dataclass(frozen=True, eq=False)
class Luck:
    """The keys of all coins of one seed, drawn once for all samplers."""

    chance: Chance
    inspect: NDArray[np.uint64]
    spread: NDArray[np.uint64]

    @classmethod
    def of(cls, chance: Chance, n_days: int = N_DAYS) -> Luck:
        """Return the keys of ``inspect/day`` and ``spread/day``."""
        keys = (
            np.array([chance.key(name, day) for day in range(n_days)], np.uint64)
            for name in ("inspect", "spread")
        )
        return cls(chance, *keys)


def play(site: Site, trial: Trial, luck: Luck) -> Floats:
    """Return a season as ``(days, 6)``, see `COLUMNS`; visited is NaN after the end of work."""
    start = first_morning(site, trial.choices.start, luck.chance)
    return play_from(site, trial, start, luck)


def play_from(site: Site, trial: Trial, start: Start, luck: Luck) -> Floats:
    """Return a season as :func:`play` does, from a given first morning."""
    choices, day_s = trial.choices, trial.robot.day_s
    table = np.zeros((len(luck.inspect), len(COLUMNS)))
    infested, belief = start.infested.copy(), start.chance.copy()
    ever, ever_found = infested.copy(), np.zeros(len(infested), np.bool_)
    last = np.full(len(infested), NEVER, np.int32)
    trail = np.empty(0, np.int32)
    new = np.count_nonzero(infested)
    for day in range(len(table)):
        here = np.count_nonzero(infested)
        if here == 0 and choices.ends == "find":
            table[day:, VISITED] = np.nan
            table[day:, EVER], table[day:, EVER_FOUND] = ever.sum(), ever_found.sum()
            break
        scene = Scene(site.aisles, trial.robot, belief, last, day, GATE, day_s, trail)
        plants, found = _inspect(trial, scene, infested, luck.inspect[day])
        finds = plants[found]
        missed = np.zeros(len(infested), np.bool_)
        missed[plants] = infested[plants]
        missed[finds] = False
        infested[finds] = False
        last[plants] = day
        ever_found[finds] = True
        table[day] = len(plants), len(finds), here, new, ever.sum(), ever_found.sum()
        if trial.sampler not in _BLIND:
            belief = _morning(site, trial, belief, (plants, found, missed))
        after = _night(site, choices, infested, missed, luck.spread[day])
        new = np.count_nonzero(after) - np.count_nonzero(infested)
        infested = after
        ever |= infested
        trail = plants if len(plants) else trail
    return table


def _inspect(
    trial: Trial, scene: Scene, infested: Flags, key: np.uint64
) -> tuple[NDArray[np.int32], Flags]:
    """Return the plants inspected on a day and which of them were found infested."""
    would_find = outcomes(infested, scene.robot.detects, key)
    plants = sampler(trial.sampler).walk(scene, would_find).plant
    if trial.sampler == "bouncy" and trial.choices.bouncy_rests:
        plants = plants[: (len(infested) + 1) // 2]
    found = would_find[plants]
    finds = np.flatnonzero(found)
    if trial.choices.ends == "find" and len(finds) == np.count_nonzero(infested) > 0:
        plants, found = plants[: finds[-1] + 1], found[: finds[-1] + 1]
    return plants, found


def _night(
    site: Site, choices: OpenChoices, infested: Flags, missed: Flags, key: np.uint64
) -> Flags:
    if choices.sources == "left":
        return night(site.grid, infested, choices.spread, key)
    after: Flags = infested | night(site.grid, missed, choices.spread, key)
    return after


def _morning(
    site: Site,
    trial: Trial,
    belief: Floats,
    work: tuple[NDArray[np.int32], Flags, Flags],
) -> Floats:
    """Return the chance map of the next morning."""
    plants, found, missed = work
    choices = trial.choices
    evening = learn(belief, site.grid, plants, found, Learning(detection=trial.robot.detects))
    if choices.missed_known:
        evening[missed] = _MOST
    if not choices.map_follows:
        return evening
    if choices.sources == "left":
        return overnight(evening, site.grid, choices.spread)
    # only who was inspected and missed can spread
    source = np.zeros(len(evening))
    source[plants] = evening[plants]
    source[plants[found]] = 0.0
    spared = (1.0 - overnight(source, site.grid, choices.spread)) / (1.0 - source)
    return np.clip(1.0 - (1.0 - evening) * spared, 1e-6, _MOST)


def detection_pct(table: Floats, choices: OpenChoices) -> Floats:
    """Return all finds so far in percent of all ever infested, ``(..., days)``; 100 if none."""
    if choices.counts == "plants":
        part, whole = table[..., EVER_FOUND], table[..., EVER]
    else:
        part = np.cumsum(table[..., FOUND], axis=-1)
        whole = np.cumsum(table[..., NEW], axis=-1)
    return 100.0 * np.divide(part, whole, out=np.ones_like(part), where=whole > 0)
