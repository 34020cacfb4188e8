"""Beliefs side by side: whether what they say happens as often as they say it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.ensemble import Ensemble
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.plot_estimate import PlotEstimate, estimate_of, estimate_plot
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.io.html import page
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Experiment, Memory, run
from fieldmon.simulation.season import simulated_days
from fieldmon.studies.charts import Line, line_chart

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief, Learning
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.samplers.base import Sampler
    from fieldmon.studies.samplers.scenarios import Scenario

    Believe = Callable[[PlantGrid, NDArray[np.float64]], Belief]

BELIEFS: dict[str, Believe] = {
    "independent plants": IndependentPlants,
    "traced pairs": TracedPairs.of,
    "traced pairs, no ancestry": partial(TracedPairs.of, by_ancestry=False),
    "pairs": PairApproximation.of,
    "pairs, clustering known": partial(PairApproximation.of, clustering=0.65),
    "ensemble": Ensemble.of,
}
# the one belief that follows a pest's kernel, warmth and stages
BELIEFS_OF_PESTS = {"traced pairs": BELIEFS["traced pairs"]}
EDGES = (0.0, 0.001, 0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0)
CLEAN_EDGES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
# the thesis knows only suspicious plants and others: this from a chance map, in chances
_SUSPICIOUS = 0.5
_LEAST = 1e-6
_FEW = 50
# of fewer seasons than these it is not sure how often intervals hold (our choice)
_ROUGH = 20


@dataclass(frozen=True, eq=False)
class Calibration:
    """How a belief's chances compare with what was so.

    Parameters
    ----------
    said, was, count
        Reliability: mean chance, share infested and number of plant-mornings between `EDGES`.
    brier, log_score
        Mean squared error, and mean of minus the logarithm of the chance given to what was so.
    suspicious_log_score
        The same for the map reduced to suspicious or not: each class at its share infested.
    skill
        How much less the logarithmic score is than that of one rate for all plants, told the share
        infested of each morning, of what that leaves (1: nothing is left to know).
    covered, half_covered
        Share of mornings with infested plants on which the interval of 90 % held their number, and
        that of 50 %; NaN where there was none. First mornings do not count: their number was told.
    clean_said, clean_was, clean_count
        Reliability of the chance that the plot is clean, between `CLEAN_EDGES`.
    seconds_a_day
        Time to learn a day's findings and pass a night.
    mornings
        Of how many mornings `covered` and `half_covered` are the shares.
    """

    said: NDArray[np.float64]
    was: NDArray[np.float64]
    count: NDArray[np.int64]
    brier: float
    log_score: float
    suspicious_log_score: float
    skill: float
    covered: float
    half_covered: float
    clean_said: NDArray[np.float64]
    clean_was: NDArray[np.float64]
    clean_count: NDArray[np.int64]
    seconds_a_day: float
    mornings: int


class _Watched:
    """A belief that notes every morning, and the time it takes."""

    def __init__(self, belief: Belief, mornings: list[Belief], seconds: list[float]) -> None:
        self._belief, self._mornings, self._seconds = belief, mornings, seconds
        self.chance, self.pair_chance = belief.chance, belief.pair_chance
        self.traces, self.doubt, self.pest = belief.traces, belief.doubt, belief.pest
        self.doubt_of_rates, self.since_inspected = belief.doubt_of_rates, belief.since_inspected

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> _Watched:
        """Learn, and note the time."""
        began = time.thread_time()
        after = self._belief.learn(plants, found, learning)
        self._seconds.append(time.thread_time() - began)
        return _Watched(after, self._mornings, self._seconds)

    def overnight(self, spread: Spread) -> _Watched:
        """Pass a night, and note the morning and the time."""
        began = time.thread_time()
        after = self._belief.overnight(spread)
        self._seconds.append(time.thread_time() - began)
        self._mornings.append(after)
        return _Watched(after, self._mornings, self._seconds)

    def treated(self, left: NDArray[np.float64]) -> _Watched:
        """Hear of a treatment."""
        return _Watched(self._belief.treated(left), self._mornings, self._seconds)


class _Mornings(NamedTuple):
    """What was believed on the mornings of seasons, and what was so.

    Parameters
    ----------
    chances, truths
        A map a morning, ``(n,)`` each: chance of infestation, and which plants were infested.
    ahead, half_ahead
        What was believed of the whole plot, with intervals of 90 % and of 50 %.
    told
        Whether it was a season's first morning.
    seconds
        Spent by the belief.
    """

    chances: list[NDArray[np.float64]]
    truths: list[NDArray[np.bool_]]
    ahead: list[PlotEstimate]
    half_ahead: list[PlotEstimate]
    told: list[bool]
    seconds: list[float]


def calibration(
    scenarios: Sequence[Scenario],
    sampler: Sampler,
    believe: Believe,
    seeds: int,
    n_days: int = 12,
) -> Calibration:
    """Return how well a belief is calibrated over the mornings of the seasons of some scenarios."""

    def simulate(scenario: Scenario, seeds: range) -> _Mornings:
        return _mornings(scenario, sampler, believe, seeds.start, n_days)

    experiment = Experiment(scenarios, range(seeds), simulate, lambda _: 1)
    made: Memory[_Mornings] = Memory()
    with executor.threads() as workers:
        run(experiment, workers, made)
    parts = [made[chunk.key] for chunk in experiment.chunks()]
    return _compared(_Mornings(*(list(chain(*each)) for each in zip(*parts, strict=True))))


def _mornings(
    scenario: Scenario, sampler: Sampler, believe: Believe, seed: int, n_days: int
) -> _Mornings:
    """Return the mornings of one season."""
    believed: list[Belief] = []
    seconds: list[float] = []

    def watched(grid: PlantGrid, chance: NDArray[np.float64]) -> Belief:
        first = believe(grid, chance)
        if scenario.pest_in_weather is not None and isinstance(first, TracedPairs):
            first = first.of_pest(scenario.pest_in_weather.pest)
        believed.append(first)
        return _Watched(first, believed, seconds)

    settings = replace(scenario.settings, n_days=n_days, believe=watched)
    start, streams = scenario.draw_start(RandomStreams(seed)), RandomStreams(seed)
    aisles = scenario.aisles
    season = list(simulated_days(aisles, scenario.robot, sampler, start, settings, streams))
    # a blind sampler has not asked: all mornings are worked out now, for the last one
    season[-1].belief  # noqa: B018
    return _Mornings(
        [belief.chance for belief in believed],
        [day.infested for day in season],
        [_estimate(belief, aisles.grid, 0.9) for belief in believed],
        [_estimate(belief, aisles.grid, 0.5) for belief in believed],
        [day.number == 0 for day in season],
        seconds,
    )


def _estimate(belief: Belief, grid: PlantGrid, sure: float) -> PlotEstimate:
    if isinstance(belief, Ensemble):
        return belief.estimate(sure)
    if belief.pair_chance is not None:
        return estimate_of(grid, belief, sure)
    start, other = grid.adjacent
    alone = np.repeat(belief.chance, np.diff(start)) * belief.chance[other]
    return estimate_plot(grid, belief.chance, alone, sure)


def _compared(mornings: _Mornings) -> Calibration:
    chances, truths, ahead, half_ahead, told, seconds = mornings
    counts = np.array([np.count_nonzero(truth) for truth in truths])
    p = np.clip(np.concatenate(chances), _LEAST, 1.0 - _LEAST)
    y = np.concatenate(truths)
    suspicious = np.concatenate([c >= _SUSPICIOUS * c.max() for c in chances])
    classes = np.where(suspicious, _share(y[suspicious]), _share(y[~suspicious]))
    clean = np.array([each.chance_clean for each in ahead])
    rate = np.concatenate([np.full(len(truth), truth.mean()) for truth in truths])
    flat = _log_score(np.clip(rate, _LEAST, 1.0 - _LEAST), y)
    return Calibration(
        *_reliability(p, y, EDGES),
        float(np.mean((p - y) ** 2)),
        _log_score(p, y),
        _log_score(np.clip(classes, _LEAST, 1.0 - _LEAST), y),
        1.0 - _log_score(p, y) / flat,
        _held(ahead, counts * ~np.array(told)),
        _held(half_ahead, counts * ~np.array(told)),
        *_reliability(clean, counts == 0, CLEAN_EDGES),
        sum(seconds) / len(counts),
        int(np.count_nonzero(counts * ~np.array(told))),
    )


def _held(ahead: list[PlotEstimate], counts: NDArray[np.intp]) -> float:
    """Return how often an interval held the number of infested plants where there were any."""
    inside = [o.low <= n <= o.high for o, n in zip(ahead, counts, strict=True) if n]
    return float(np.mean(inside)) if inside else float("nan")


def _share(y: NDArray[np.bool_]) -> float:
    return float(y.mean()) if len(y) else 0.0


def _log_score(p: NDArray[np.float64], y: NDArray[np.bool_]) -> float:
    return float(-np.mean(np.log(np.where(y, p, 1.0 - p))))


def _reliability(
    p: NDArray[np.float64], y: NDArray[np.bool_], edges: Sequence[float]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Return mean chance, share that was so, and number between each two edges."""
    group = np.digitize(p, edges[1:-1])
    count = np.bincount(group, minlength=len(edges) - 1)
    some = np.maximum(count, 1)
    said = np.bincount(group, p, len(edges) - 1) / some
    return said, np.bincount(group, y, len(edges) - 1) / some, count


def _percent(value: float) -> str:
    """Return a share in percent with two digits that mean something."""
    if math.isnan(value):
        return "-"
    pct = 100.0 * value
    return f"{pct:.0f} %" if pct >= 10.0 or pct == 0.0 else f"{pct:.2g} %"


def _so(share: float, count: int) -> str:
    """Return the share that was so: of few plants how many, for a share of them is no more."""
    return _percent(share) if count >= _FEW else f"{round(share * count)} of {count}"


def report_html(made: dict[str, Calibration], about: str, seasons: int = _ROUGH) -> str:
    """Return the calibrations of some beliefs, of so many seasons, as one HTML document."""
    lines = [Line("as often as said", (0.0, 1.0), (0.0, 1.0))]
    clean = list(lines)
    for name, c in made.items():
        some, told = c.count >= _FEW, c.clean_count > 0
        lines.append(Line(name, c.said[some].tolist(), c.was[some].tolist()))
        clean.append(Line(name, c.clean_said[told].tolist(), c.clean_was[told].tolist()))
    axes = ("chance said", "share that was so")
    return page(
        "fieldmon/studies/samplers/calibration.html.j2",
        about=about,
        seasons=seasons,
        few=seasons < _ROUGH,
        share=_percent,
        so=_so,
        made=made,
        charts=[
            line_chart(f"Plants ({_FEW} mornings or more a dot)", lines, axes),
            line_chart("The plot is clean", clean, axes),
        ],
    )
