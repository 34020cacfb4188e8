"""Looks until a verdict: W walk, Wald's test alone, Adaptive and Decide on the same insects."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from scipy.special import ndtri

from fieldmon.compute.digest import digest
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.decisions.map_plan import MapPlan
from fieldmon.decisions.map_verdict import verdict_of
from fieldmon.decisions.sequential import INSPECT_MORE, LEAVE, TREAT, IwaoPlan, Verdict, WaldPlan
from fieldmon.decisions.stopping import decided
from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.planning.workday import work_day
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.samplers.decide import Decide
from fieldmon.simulation.experiment import Experiment
from fieldmon.studies.outcome_table import finite
from fieldmon.studies.samplers.mapped_plots import DatedMap, plots_in
from fieldmon.studies.samplers.scenarios import (
    Scenario,
    infested_at_start,
    known_chance,
    of_pest,
)
from fieldmon.studies.verdicts.walks import random_walk, w_walk

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Sampler

    Looks = tuple[NDArray[np.int32], NDArray[np.bool_]]

#: treat from this share of the plants on, and how sure verdicts are to be
LEVEL, WRONG = 0.05, 0.1
#: mistakes are tolerated only outside of this: half and twice the threshold
APART = 2.0
#: who has no verdict after so many looks has none
MOST = 400
# the truth is drawn evenly, as a logarithm, from a quarter of the threshold to four times it
_WIDEST = 4.0
_SIDE = 64
_DIGITS = 6
_LOOKS_A_CHECK = 10
W_FIXED, W_WALD, W_IWAO = "W walk, all of it", "W walk, Wald", "W walk, Iwao"
RANDOM_WALD, ADAPTIVE = "anywhere, Wald", "adaptive, Wald on the map"
DECIDE, DECIDE_MAP = "decide, Wald on the map", "decide, the map's verdict"
CONTENDERS = (W_FIXED, W_WALD, RANDOM_WALD, ADAPTIVE, DECIDE, W_IWAO, DECIDE_MAP)
"""The first five tolerate `WRONG` outside of `APART`; the last two up to the threshold itself."""


@dataclass(frozen=True)
class Question:
    """A plot of which is asked whether to treat it.

    Parameters
    ----------
    start
        Where the infested plants stand, see `Scenario`; or the name of a real map.
    prior
        What is known of where they stand, see `Scenario`. Of how many nothing is known: they are
        believed to be as many as the threshold has it.
    real
        The real map; None: drawn.
    pest_in_weather
        The pest, which is detected as its file says; None: as the thesis's table has it.
    """

    start: str
    prior: str = "none"
    real: DatedMap | None = None
    pest_in_weather: PestInWeather | None = None

    @property
    def name(self) -> str:
        """Return it in words, unique."""
        words = f"{self.start}, prior {self.prior}"
        if self.real is not None:
            # whose file says something else by now is another question
            grid = self.real.aisles.grid
            words = f"{self.start}, {digest(self.real.infested, grid.xy_m, length=_DIGITS)}"
        if self.pest_in_weather is None:
            return words
        return f"{words}, {self.pest_in_weather.pest.name}, {of_pest(self.pest_in_weather)}"


@dataclass(frozen=True)
class VerdictOutcome:
    """How a contender answered, after how many looks, and whether that was right.

    `share` is the truth in thresholds: from 1 on treating pays.
    """

    question: str
    seed: int
    contender: str
    looks: float
    verdict: str
    right: float
    share: float

    columns: ClassVar[tuple[str, ...]] = (
        "question", "seed", "contender", "looks", "verdict", "right", "share"
    )  # fmt: skip
    kinds: ClassVar[tuple[Callable[[str], Any], ...]] = (str, int, str, finite, str, finite, finite)

    @property
    def key(self) -> tuple[str, int]:
        """Return the chunk that it is of."""
        return self.question, self.seed


def usual_questions() -> list[Question]:
    """Return the simulated questions: clusters, edge, scattered, and with what may be known."""
    return [
        Question("clusters"), Question("edge"), Question("scattered"),
        Question("edge", "edge"), Question("clusters", "records 5 %"), Question("edge", "wrong"),
    ]  # fmt: skip


def real_questions(folder: Path) -> tuple[list[Question], list[str]]:
    """Return the questions of the maps in a folder, and the names of those that are left out.

    Whether to treat is only asked where between 0.5 % and half of the plants are infested.
    """
    maps = plots_in(folder)
    asked = [0.005 < each.infested.mean() < 0.5 for each in maps]
    return (
        [Question(each.name, real=each) for each, of in zip(maps, asked, strict=True) if of],
        [each.name for each, of in zip(maps, asked, strict=True) if not of],
    )


def study_of_verdicts(
    questions: Sequence[Question], seeds: range
) -> Experiment[Question, list[VerdictOutcome]]:
    """Return the study of some questions: all contenders meet the same insects."""
    return Experiment(
        settings=questions,
        seeds=seeds,
        simulate=lambda question, seeds: answers(question, seeds.start),
        chunk_size=lambda _: 1,
        key=lambda question, seeds: (question.name, seeds.start),
        seed_by_seed=True,
    )


@dataclass(frozen=True, eq=False)
class _Plot:
    """A plot as drawn: level, truth, what a look would find, and what is believed of it."""

    aisles: Aisles
    level: float
    infested: NDArray[np.bool_]
    shows: NDArray[np.bool_]
    morning: NDArray[np.float64]
    robot: Robot


def answers(question: Question, seed: int) -> list[VerdictOutcome]:
    """Return what every contender answers to a question, with one seed."""
    streams = RandomStreams(seed)
    plot = _drawn(question, streams)
    made = []
    for name, contender in _ANSWERS.items():
        verdict, looks = contender(plot, streams.of(f"looks of {name}"))
        share = float(plot.infested.mean()) / plot.level
        right = verdict == (TREAT if share >= 1.0 else LEAVE)
        made.append(
            VerdictOutcome(question.name, seed, name, float(looks), verdict, float(right), share)
        )
    return made


@lru_cache(maxsize=1)
def _usual_plot() -> Aisles:
    return Aisles.of(rectangle(_SIDE, _SIDE))


def _drawn(question: Question, streams: RandomStreams) -> _Plot:
    rng = streams.of("truth")
    apart = float(_WIDEST ** rng.uniform(-1.0, 1.0))
    if question.real is None:
        aisles, level = _usual_plot(), LEVEL
        infested = infested_at_start(aisles.grid, question.start, level * apart, rng)
    else:
        aisles, infested = question.real.aisles, question.real.infested
        level = float(np.clip(infested.mean() / apart, 0.002, 0.45))
    known = Scenario(prior=question.prior, pest_in_weather=question.pest_in_weather)
    robot = replace(known.believed_robot, returns=False, hours=24.0).with_times("thesis")
    shows = infested & (rng.random(len(infested)) < robot.detects)
    morning = known_chance(aisles.grid, known, infested, streams.of("records"), level)
    return _Plot(aisles, level, infested, shows, morning, robot)


def _wald(plot: _Plot) -> WaldPlan:
    """Return Wald's plan for what is seen: of infested plants some are overlooked."""
    detects, whole = plot.robot.detects, MapPlan.about(plot.level, APART, WRONG)
    return WaldPlan(
        whole.low * detects, whole.high * detects, treats_wrongly=WRONG, leaves_wrongly=WRONG
    )


def fixed_inspections(plan: WaldPlan) -> int:
    """Return how many looks tell the two levels of a plan apart if all are made (normal law).

    Examples
    --------
    >>> fixed_inspections(WaldPlan(0.025, 0.1))
    61
    """
    low, high = plan.low, plan.high
    off = -ndtri(plan.treats_wrongly) * np.sqrt(low * (1 - low))
    off -= ndtri(plan.leaves_wrongly) * np.sqrt(high * (1 - high))
    return int(np.ceil((off / (high - low)) ** 2))


def _w_all(plot: _Plot, _: np.random.Generator) -> tuple[Verdict, int]:
    """Walk one W with as many looks as the two levels need, and count."""
    plan = _wald(plot)
    looks = min(fixed_inspections(plan), MOST, len(plot.shows))
    seen = plot.shows[w_walk(plot.aisles.grid, looks, looks)]
    # half way between the levels, as far as their spreads go
    spreads = [np.sqrt(level * (1 - level)) for level in (plan.low, plan.high)]
    middle = (plan.low * spreads[1] + plan.high * spreads[0]) / sum(spreads)
    return ("treat" if seen.mean() >= middle else "do not treat"), looks


def _w_wald(plot: _Plot, _: np.random.Generator) -> tuple[Verdict, int]:
    plan = _wald(plot)
    walk = w_walk(plot.aisles.grid, fixed_inspections(plan), MOST)
    return decided(plan, plot.shows[walk])


def _w_iwao(plot: _Plot, _: np.random.Generator) -> tuple[Verdict, int]:
    # one side is wrong in a tenth
    plan = IwaoPlan(plot.level * plot.robot.detects, z=float(-ndtri(WRONG)))
    walk = w_walk(plot.aisles.grid, fixed_inspections(_wald(plot)), MOST)
    return decided(plan, plot.shows[walk])


def _random_wald(plot: _Plot, rng: np.random.Generator) -> tuple[Verdict, int]:
    return decided(_wald(plot), plot.shows[random_walk(len(plot.shows), MOST, rng)])


def _day(plot: _Plot, sampler: Sampler, rng: np.random.Generator) -> Looks:
    """Return the first looks of a day that a sampler drives, and what they found."""
    n = len(plot.shows)
    belief = TracedPairs.of(plot.aisles.grid, plot.morning)
    scene = Scene(
        plot.aisles, plot.robot, belief.chance, np.full(n, NEVER, np.int32), at=GATE,
        seconds_left=plot.robot.day_s, key=np.uint64(rng.integers(2**63)),
        pair_chance=belief.pair_chance, traces=belief.traces,
    )  # fmt: skip
    work = work_day(scene, sampler, plot.shows)
    return work.plant[:MOST], work.found[:MOST]


def _on_map(sampler: Sampler) -> Callable[[_Plot, np.random.Generator], tuple[Verdict, int]]:
    def answer(plot: _Plot, rng: np.random.Generator) -> tuple[Verdict, int]:
        plan, looks = MapPlan.about(plot.level, APART, WRONG), _day(plot, sampler, rng)
        detects = plot.robot.detects
        return plan.verdicts(plan.evidence(plot.aisles.grid, plot.morning, looks, detects))

    return answer


def _map_verdicts(plot: _Plot, rng: np.random.Generator) -> tuple[Verdict, int]:
    """Ask the chance map after every ten looks."""
    plants, found = _day(plot, Decide(), rng)
    grid, belief = plot.aisles.grid, TracedPairs.of(plot.aisles.grid, plot.morning)
    learning = Learning(detection=plot.robot.detects, treated=False)
    left = np.zeros(len(grid), np.bool_)
    for first in range(0, len(plants), _LOOKS_A_CHECK):
        now = slice(first, first + _LOOKS_A_CHECK)
        belief = belief.learn(plants[now], found[now], learning)
        left[plants[now][found[now]]] = True
        said = verdict_of(grid, belief, plot.level, 1 - WRONG, left)
        if said.verdict != INSPECT_MORE:
            return said.verdict, min(first + _LOOKS_A_CHECK, len(plants))
    return INSPECT_MORE, len(plants)


_ANSWERS: dict[str, Callable[[_Plot, np.random.Generator], tuple[Verdict, int]]] = {
    W_FIXED: _w_all,
    W_WALD: _w_wald,
    RANDOM_WALD: _random_wald,
    ADAPTIVE: _on_map(Adaptive()),
    DECIDE: _on_map(Decide()),
    W_IWAO: _w_iwao,
    DECIDE_MAP: _map_verdicts,
}


@dataclass(frozen=True)
class VerdictSummary:
    """What a contender came to in a question.

    Parameters
    ----------
    looks
        Mean looks until its verdict, `MOST` where it had none.
    right
        Share of right verdicts, and of those where the truth is outside of `APART`.
    right_apart
        See there.
    undecided
        Share of plots without a verdict.
    of_w
        Looks, over those of the whole W walk.
    """

    question: str
    contender: str
    looks: float
    right: float
    right_apart: float
    undecided: float
    of_w: float


def summaries(outcomes: Sequence[VerdictOutcome]) -> list[VerdictSummary]:
    """Return what each contender came to, question by question.

    Raises
    ------
    SettingError
        If there are no outcomes.
    """
    if not outcomes:
        raise SettingError("A summary of verdicts needs an outcome or more, but there is none.")
    made = []
    for question in dict.fromkeys(one.question for one in outcomes):
        whole = _mean(outcomes, question, W_FIXED)
        for name in CONTENDERS:
            mine = [one for one in outcomes if (one.question, one.contender) == (question, name)]
            apart = [one.right for one in mine if abs(np.log(one.share)) >= np.log(APART)]
            looks = float(np.mean([one.looks for one in mine]))
            none = [one.verdict not in {TREAT, LEAVE} for one in mine]
            made.append(
                VerdictSummary(
                    question, name, looks, float(np.mean([one.right for one in mine])),
                    float(np.mean(apart)) if apart else float("nan"),
                    float(np.mean(none)), looks / whole,
                )
            )  # fmt: skip
    return made


def _mean(outcomes: Sequence[VerdictOutcome], question: str, contender: str) -> float:
    of = [one.looks for one in outcomes if (one.question, one.contender) == (question, contender)]
    return float(np.mean(of))
