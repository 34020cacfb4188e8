"""The experiments of chapter 5, run again: scenarios, sweeps, and any other plot."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError
from fieldmon.simulation.statistics import summary_statistics
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS, OpenChoices
from fieldmon.studies.thesis.chapter5.published import PARTS, cases_of
from fieldmon.studies.thesis.chapter5.replicates import run_trials, seed_keys
from fieldmon.studies.thesis.chapter5.seasons import PriorTrial
from fieldmon.studies.thesis.chapter5.verdicts import Compared, compare

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fieldmon.simulation.experiment import Progress
    from fieldmon.studies.thesis.chapter5.replicates import PriorRuns
    from fieldmon.studies.thesis.chapter5.sites import Site

TITLES = {
    "A": "Scenario A: 1 ha, 784 plants",
    "B": "Scenario B: 5 ha, 4 096 plants",
    "C": "Scenario C: 10 ha, 8 281 plants",
    "size": "Field size, 1 to 20 ha",
    "spread": "Spread, 30, 50 and 80 % a day (5 ha)",
    "time": "Inspection time, 20 to 40 s (6 ha)",
    "detection": "Detection rate, 40 to 90 % (5 ha)",
}
OWN = "plot"


@dataclass(frozen=True)
class PriorMeasure:
    """A row of the tidy table: one measure of one configuration, with its 95 % interval.

    `day` is NaN for measures of the whole season; `detection` and `rate` are what was in force.
    """

    part: str
    sampler: str
    plot: str
    plants: int
    look_s: float
    detection: float
    rate: float
    measure: str
    day: float
    mean: float
    low: float
    high: float
    sd: float
    seeds: int


@dataclass(frozen=True, eq=False)
class StudyPart:
    """One scenario or sweep made again.

    Parameters
    ----------
    name, title
        Which.
    runs
        Its seasons, in the order of its cases.
    compared
        Published figures beside ours.
    """

    name: str
    title: str
    runs: tuple[PriorRuns, ...]
    compared: tuple[Compared, ...] = ()


@dataclass(frozen=True, eq=False)
class PriorStudy:
    """Parts made in one go; `stopped` if somebody ended it, with what was done by then."""

    choices: OpenChoices
    seeds: int
    seed: int
    parts: tuple[StudyPart, ...]
    stopped: bool = False

    @property
    def compared(self) -> list[Compared]:
        """All published figures beside ours."""
        return [each for part in self.parts for each in part.compared]


def run_prior(
    parts: Sequence[str] = PARTS,
    seeds: int = 100,
    seed: int = 1,
    choices: OpenChoices = CALIBRATED,
    progress: Progress | None = None,
) -> PriorStudy:
    """Play scenarios and sweeps of chapter 5; all samplers meet the same insects.

    Parameters
    ----------
    parts
        Of ``A B C size spread time detection``; in the order of `PARTS`.
    seeds
        Seasons of each configuration (the thesis: 10).
    seed
        The first of them.
    choices
        What the thesis leaves open; the default is the best joint fit.
    progress
        Called with the configurations done and their total.
    """
    unknown = set(parts) - set(PARTS)
    if unknown or not parts:
        raise SettingError(
            f"A part of chapter 5 must be one of {', '.join(PARTS)}, but it is "
            f"{', '.join(sorted(unknown)) or 'none'}."
        )
    chosen = [part for part in PARTS if part in parts]
    trials = [case.trial(choices) for part in chosen for case in cases_of(part)]
    made = run_trials(trials, seed_keys(seeds, seed), progress)
    done = []
    for part in chosen:
        runs = [made.runs.get(case.trial(choices)) for case in cases_of(part)]
        ours = tuple(each for each in runs if each is not None)
        # what was published is of the thesis's rule
        compared = () if choices.pest else tuple(compare(made.runs, choices, [part]))
        if ours:
            done.append(StudyPart(part, TITLES[part], ours, compared))
    return PriorStudy(choices, seeds, seed, tuple(done), made.stopped)


def run_site(
    site: Site,
    seeds: int = 20,
    seed: int = 1,
    choices: OpenChoices = CALIBRATED,
    progress: Progress | None = None,
) -> PriorStudy:
    """Play the three samplers on any plot, from its own chance map if it has one."""
    trials = [PriorTrial(name, choices) for name in SAMPLERS]
    made = run_trials(trials, seed_keys(seeds, seed), progress, site)
    part = StudyPart(OWN, site.name, tuple(made.runs.values()))
    return PriorStudy(choices, seeds, seed, (part,) if made.runs else (), made.stopped)


def rows(study: PriorStudy) -> list[PriorMeasure]:
    """Return the tidy table: season measures first, then detection and visits day by day."""
    return [row for part in study.parts for runs in part.runs for row in _rows(part, runs)]


def _rows(part: StudyPart, runs: PriorRuns) -> Iterable[PriorMeasure]:
    for name, values in runs.measures().items():
        yield _row(part, runs, (name, math.nan), values)
    for name in ("detection_pct", "visited_pct"):
        for day, values in enumerate(getattr(runs, name).T, start=1):
            yield _row(part, runs, (name, float(day)), values)


def _row(part: StudyPart, runs: PriorRuns, what: tuple[str, float], values: object) -> PriorMeasure:
    trial = runs.trial
    ours = summary_statistics(values)  # type: ignore[arg-type]
    return PriorMeasure(
        part=part.name,
        sampler=trial.sampler,
        plot=part.title if trial.hectares is None else f"{trial.hectares:g} ha",
        plants=runs.n_plants,
        look_s=trial.look_s,
        detection=trial.robot.detects,
        rate=trial.choices.spread.rate_per_day,
        measure=what[0],
        day=what[1],
        mean=ours.mean,
        low=ours.low,
        high=ours.high,
        sd=ours.sd,
        seeds=ours.replicates,
    )


def label_of(part: str, trial: PriorTrial) -> str:
    """Return what tells a trial from the others of its part."""
    if part == "spread":
        return f"{trial.choices.spread.rate_per_day:.0%} a day"
    if part == "time":
        return f"{trial.look_s:g} s"
    if part == "detection":
        return f"{trial.robot.detects:.0%} detected"
    return trial.sampler.capitalize()
