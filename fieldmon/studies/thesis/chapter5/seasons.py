"""One season of chapter 5 under its open choices, as columns a day."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.dispersal import dispersal_of
from fieldmon.infestation.insects.pest_in_weather import PestInWeather, kernel_of
from fieldmon.infestation.insects.spread import night
from fieldmon.infestation.pairs.independent_plants import learn, overnight
from fieldmon.planning.workday import draw_detections
from fieldmon.plot.travel import GATE
from fieldmon.samplers import kind_of, sampler
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.simulation.insects import PestInsects
from fieldmon.studies.thesis.chapter5.open_choices import N_DAYS, OpenChoices
from fieldmon.studies.thesis.chapter5.sites import first_morning

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.plot.robot import Robot
    from fieldmon.simulation.start import Start
    from fieldmon.studies.thesis.chapter5.sites import Site

    Floats = NDArray[np.float64]
    Flags = NDArray[np.bool_]

LEVELS_PCT = (50.0, 80.0, 100.0)
VISITED, FOUND, INFESTED, NEW, EVER, EVER_FOUND, AT_LEVEL = range(7)
N_COLUMNS = AT_LEVEL + len(LEVELS_PCT)
"""Columns of a season, one row a day: plants inspected and found; infested that morning; new since
the evening before (day 1: at the start); plants infested, and found, at least once by then; and
at which part of the working day detection came to each of `LEVELS_PCT` (NaN: not on that day)."""

_MOST = 1.0 - 1e-6


@dataclass(frozen=True)
class PriorTrial:
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
class SeedKeys:
    """The keys of all coins of one seed, drawn once for all samplers.

    Parameters
    ----------
    streams
        All random streams of the seed.
    inspect, spread
        ``(days,)`` the key of each day's inspections, and of its night.
    """

    streams: RandomStreams
    inspect: NDArray[np.uint64]
    spread: NDArray[np.uint64]

    @classmethod
    def of(cls, streams: RandomStreams, n_days: int = N_DAYS) -> SeedKeys:
        """Return the keys of ``inspect/day`` and ``spread/day``."""
        keys = (
            np.array([streams.key(name, day) for day in range(n_days)], np.uint64)
            for name in ("inspect", "spread")
        )
        return cls(streams, *keys)


def play(site: Site, trial: PriorTrial, keys: SeedKeys) -> Floats:
    """Return a season as ``(days, 9)``, see `N_COLUMNS`; visited is NaN after the end of work."""
    start = first_morning(site, trial.choices.start, keys.streams)
    return play_from(site, trial, start, keys)


def play_from(site: Site, trial: PriorTrial, start: Start, keys: SeedKeys) -> Floats:
    """Return a season as :func:`play` does, from a given first morning."""
    choices, robot, count = trial.choices, trial.robot, np.count_nonzero
    table = np.zeros((len(keys.inspect), N_COLUMNS))
    table[:, AT_LEVEL:] = np.nan
    infested, belief = start.infested.copy(), start.chance.copy()
    ever, ever_found = infested.copy(), np.zeros(len(infested), np.bool_)
    last = np.full(len(infested), NEVER, np.int32)
    trail = np.empty(0, np.int32)
    new = count(infested)
    insects = None if choices.pest is None else PestInsects(site.grid, infested, choices.pest)
    for day in range(len(table)):
        here = count(infested)
        if here == 0 and choices.ends == "find":
            table[day:, VISITED] = np.nan
            table[day:, EVER], table[day:, EVER_FOUND] = count(ever), count(ever_found)
            break
        scene = Scene(site.aisles, robot, belief, last, day, GATE, robot.day_s, trail)
        showing = infested if insects is None else insects.showing(day)
        plants, found, at_s = _inspect(trial, scene, showing, keys.inspect[day])
        finds = plants[found]
        again = ever_found[finds]
        missed = np.zeros(len(infested), np.bool_)
        missed[plants] = infested[plants]
        missed[finds] = False
        infested[finds] = False
        last[plants] = day
        ever_found[finds] = True
        row = table[day]
        row[:AT_LEVEL] = len(plants), len(finds), here, new, count(ever), count(ever_found)
        row[AT_LEVEL:] = _levels(table[: day + 1], choices, again, at_s[found] / robot.day_s)
        if kind_of(trial.sampler).reads_chance:
            evening = learn(belief, site.grid, plants, found, Learning(detection=robot.detects))
            if choices.pest is None:
                belief = _morning(site, choices, evening, (plants, found, missed))
            else:
                belief = _morning_of_pest(site, choices.pest, evening, day)
        if insects is None:
            after = _night(site, choices, infested, missed, keys.spread[day])
        else:
            insects.pass_night(finds, day, keys.spread[day])
            after = insects.infested.copy()
        new = count(after & ~infested)
        infested = after
        ever |= infested
        trail = plants if len(plants) else trail
    return table


def _inspect(
    trial: PriorTrial, scene: Scene, infested: Flags, key: np.uint64
) -> tuple[NDArray[np.int32], Flags, Floats]:
    """Return the plants inspected on a day, which were found infested, and when it was done."""
    would_find = draw_detections(infested, np.array([scene.robot.detects]), key) > 0
    plants, arrive_s, _ = sampler(trial.sampler).walk(scene, would_find)
    end = len(plants)
    if trial.sampler == "bouncy" and trial.choices.bouncy_rests:
        end = min(end, (len(infested) + 1) // 2)
    found = would_find[plants[:end]]
    finds = np.flatnonzero(found)
    if trial.choices.ends == "find" and len(finds) == np.count_nonzero(infested) > 0:
        end = finds[-1] + 1
    return plants[:end], found[:end], arrive_s[:end] + scene.robot.visit_s


def _levels(table: Floats, choices: OpenChoices, again: Flags, when: Floats) -> list[float]:
    """Return when today, the last row, detection came to each level; NaN where it did not.

    `again` tells of today's finds which plants were found before, `when` the part of the day.
    """
    today = table[-1]
    if choices.counts == "plants":
        fresh, so_far, whole = ~again, today[EVER_FOUND], today[EVER]
    else:
        fresh, so_far, whole = np.ones_like(again), table[:, FOUND].sum(), table[:, NEW].sum()
    gained = np.cumsum(fresh)
    before = so_far - (gained[-1] if len(gained) else 0)
    reached = []
    for level in LEVELS_PCT:
        wanted = level / 100.0 * whole - before - 1e-9
        k = int(np.searchsorted(gained, wanted))
        reached.append(float(when[k]) if wanted > 0 and k < len(gained) else np.nan)
    return reached


def _night(
    site: Site, choices: OpenChoices, infested: Flags, missed: Flags, key: np.uint64
) -> Flags:
    if choices.sources == "left":
        return night(site.grid, infested, choices.spread, key)
    after: Flags = infested | night(site.grid, missed, choices.spread, key)
    return after


def _morning(
    site: Site,
    choices: OpenChoices,
    evening: Floats,
    work: tuple[NDArray[np.int32], Flags, Flags],
) -> Floats:
    """Return the chance map of the next morning; that of the evening may be changed."""
    plants, found, missed = work
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


def _morning_of_pest(
    site: Site, pest_in_weather: PestInWeather, evening: Floats, day: int
) -> Floats:
    """Return the chance map of the next morning, plants taken as independent, as the thesis does.

    By the pest's kernel, warmth and wind; nothing is known of what comes over the edge, nor of
    what cannot be seen yet.
    """
    frame, movement = site.grid.frame, pest_in_weather.pest.movement
    spread = pest_in_weather.spread(day, frame)
    if movement.kernel == "adjacent":
        return overnight(evening, site.grid, spread)
    kernel = dispersal_of(site.grid, kernel_of(movement), spread.wind_m_s)
    stays = np.exp(-kernel.landed(evening * spread.sends)) * (1.0 - spread.arrivals_per_day)
    return np.clip(1.0 - (1.0 - evening) * stays, 1e-6, _MOST)


def detection_pct(table: Floats, choices: OpenChoices) -> Floats:
    """Return all finds so far in percent of all ever infested, ``(..., days)``; 100 if none."""
    if choices.counts == "plants":
        part, whole = table[..., EVER_FOUND], table[..., EVER]
    else:
        part = np.cumsum(table[..., FOUND], axis=-1)
        whole = np.cumsum(table[..., NEW], axis=-1)
    return 100.0 * np.divide(part, whole, out=np.ones_like(part), where=whole > 0)
