"""The experiments of chapter 4, run again: its tables, and the questions they leave open."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError
from fieldmon.simulation.statistics import SummaryStatistics, summary_statistics
from fieldmon.studies.thesis.chapter4 import experiments, published, summaries
from fieldmon.studies.thesis.chapter4.measures import (
    NoPriorMeasure,
    field_name,
    rules_name,
)
from fieldmon.studies.thesis.chapter4.replicates import (
    NoPriorRuns,
    detection_curve,
    measures,
    run_trials,
)
from fieldmon.studies.thesis.chapter4.trial import NAMES as STRATEGY_NAMES
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, ThesisStrategy
from fieldmon.studies.thesis.chapter4.verdicts import judged_by_table_5, judged_by_tables_2_to_4
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.simulation.experiment import Progress

_DAY_MEASURES = ("PVV_ED1", "PCD_ED1", "PVV_ED2", "PCD_ED2", "PVV_ED3", "PCD_ED3")
_WHOLE = ("PCD_ALL", "visited_all", "MD_before", "MD_after", "clear_pct")
_TABLE = (*published.MEASURES, "PCD_ALL", "MD_before", "MD_after")
_THRESHOLDS = tuple(f"D{threshold}" for threshold in published.THRESHOLDS)

_COMPARED = ("2", "3", "4", "5", "severity")
"""Tables whose cells stand in the thesis or in the reference."""

Curve = tuple[str, "NDArray[np.float64]", "NDArray[np.float64]"]


@dataclass(frozen=True, eq=False)
class NoPriorTable:
    """One experiment made again.

    Parameters
    ----------
    name, title, about
        What was asked and how.
    cells
        The tidy table.
    summary
        What came out, in sentences with numbers.
    curves
        Detection curves: label, working hours and percent found.
    """

    name: str
    title: str
    about: str
    cells: tuple[NoPriorMeasure, ...]
    summary: tuple[str, ...]
    curves: tuple[Curve, ...] = ()


@dataclass(frozen=True, eq=False)
class NoPriorStudy:
    """Tables made in one go."""

    replicates: int
    seed: int
    tables: tuple[NoPriorTable, ...]

    @property
    def cells(self) -> list[NoPriorMeasure]:
        """All cells of all tables."""
        return [cell for table in self.tables for cell in table.cells]


@dataclass(frozen=True)
class _Plan:
    """How a table is made: its trials, what is measured, and what is said of it."""

    title: str
    about: str
    trials: Callable[[], list[NoPriorTrial]]
    measured: tuple[str, ...]
    summarise: Callable[[list[NoPriorMeasure]], tuple[str, ...]]
    curves: bool = False


def table_names() -> tuple[str, ...]:
    """Return the names that `run_no_prior` takes, beside "2-5" and "all"."""
    return tuple(_PLANS)


def run_no_prior(
    table: str, replicates: int = 400, seed: int = 1, progress: Progress | None = None
) -> NoPriorStudy:
    """Make tables of the thesis's chapter 4 again.

    Parameters
    ----------
    table
        One of `table_names`, "2-5" for the printed tables, or "all".
    replicates
        Runs of each configuration; every strategy meets the same insects in the same replicate.
    seed
        Names all random numbers.
    progress
        Called with the configurations done and their total.
    """
    chosen = {"2-5": ("2", "3", "4", "5"), "all": table_names()}.get(table, (table,))
    if not set(chosen) <= _PLANS.keys():
        raise SettingError(
            f"A table must be one of {', '.join(table_names())}, 2-5 or all, but it is {table!r}."
        )
    # a configuration that several tables show is run once
    wanted = dict.fromkeys(trial for name in chosen for trial in _PLANS[name].trials())
    results = run_trials(list(wanted), replicates, seed, progress)
    runs = dict(zip(wanted, results, strict=True))
    tables = tuple(_make(name, _PLANS[name], runs, seed) for name in chosen)
    return NoPriorStudy(replicates, seed, tables)


def _make(name: str, plan: _Plan, runs: dict[NoPriorTrial, NoPriorRuns], seed: int) -> NoPriorTable:
    trials = plan.trials()
    cells = [cell for trial in trials for cell in _cells(name, runs[trial], plan.measured)]
    if name == "equal":
        cells += _pairs(name, trials, runs)
    curves: tuple[Curve, ...] = ()
    if plan.curves:
        replicates = len(runs[trials[0]].days)
        curves = tuple(
            (_label(trial.strategy), *detection_curve(trial, min(replicates, 100), seed))
            for trial in trials
        )
    return NoPriorTable(name, plan.title, plan.about, tuple(cells), plan.summarise(cells), curves)


def _label(strategy: ThesisStrategy) -> str:
    return f"{strategy.algorithm} (N = {strategy.n})"


def _cells(table: str, runs: NoPriorRuns, measured: Iterable[str]) -> list[NoPriorMeasure]:
    values = measures(runs)
    return [_cell(table, runs, measure, values) for measure in measured]


def _cell(
    table: str, runs: NoPriorRuns, measure: str, values: dict[str, NDArray[np.float64]]
) -> NoPriorMeasure:
    """Return one measure of one configuration, beside what others have."""
    numbers = values[f"{measure}_true" if measure in _THRESHOLDS else measure]
    cell = _bare(table, runs, measure, summary_statistics(numbers))
    if table not in _COMPARED:
        return cell
    if measure in _THRESHOLDS:
        return judged_by_table_5(cell, numbers)
    return judged_by_tables_2_to_4(cell)


def _bare(table: str, runs: NoPriorRuns, measure: str, spread: SummaryStatistics) -> NoPriorMeasure:
    trial = runs.trial
    strategy = trial.strategy
    return NoPriorMeasure(
        table=table,
        field=field_name(trial),
        faces=trial.vineyard.faces,
        algorithm=strategy.algorithm,
        n=strategy.n,
        strategy=STRATEGY_NAMES[strategy.algorithm],
        severity=trial.severity,
        viewpoints=trial.viewpoints,
        rules=rules_name(trial),
        measure=measure,
        **vars(spread),
        aborted=float((runs.aborted > 0).mean()),
    )


def _pairs(
    table: str, trials: list[NoPriorTrial], runs: dict[NoPriorTrial, NoPriorRuns]
) -> list[NoPriorMeasure]:
    """Return snake minus neighbor on the same insects, measure by measure."""
    cells = []
    for snake in trials:
        if snake.strategy.neighbor:
            continue
        every = snake.strategy.every
        neighbor = replace(snake, strategy=experiments.neighbor_every(every))
        ours, theirs = measures(runs[snake]), measures(runs[neighbor])
        for measure in ("found_day1", "found_day2", "found_day3"):
            name = measure.replace("found", "curve_true")
            difference = ours[name] - theirs[name]
            cell = _bare(
                table, runs[snake], f"snake - neighbor, {measure}", summary_statistics(difference)
            )
            cells.append(replace(cell, strategy="snake - neighbor"))
    return cells


_AS_LISTED = (
    "The listings as published: snake strategies look from three viewpoints (23.74 s), neighbor "
    "strategies from one (4.34 s). The thesis prints one run a row; ours are means over many."
)

_PLANS: dict[str, _Plan] = {
    **{
        number: _Plan(
            f"Table {number}: scenario {letter}",
            _AS_LISTED,
            lambda letter=letter: experiments.table_trials(letter),  # type: ignore[misc]
            _TABLE,
            summaries.say_verdicts,
            curves=True,
        )
        for number, letter in (("2", "A"), ("3", "B"), ("4", "C"))
    },
    "5": _Plan(
        "Table 5: days to 30, 50, 80 and 100 % detected",
        "The first day at whose end detected / (infested at the start and in earlier nights) "
        "reaches the threshold; 4 is never. The verdict goes by the most likely day.",
        lambda: [trial for letter in SCENARIOS for trial in experiments.table_trials(letter)],
        _THRESHOLDS,
        summaries.say_verdicts,
    ),
    "severity": _Plan(
        "Severity 0.1, 0.3, 0.5 and 0.9 in scenario A",
        _AS_LISTED,
        lambda: [
            trial
            for severity in experiments.SEVERITIES
            for trial in experiments.table_trials("A", severity)
        ],
        _TABLE,
        summaries.say_verdicts,
    ),
    "bigger": _Plan(
        "The random strategies on bigger fields",
        f"Row lengths and areas as in the thesis; rows {experiments.BETWEEN_ROWS_M:g} m and vines "
        f"{experiments.BETWEEN_PLANTS_M:g} m apart are ours. Algorithm 7 has no listing: as "
        "described, at three viewpoints.",
        experiments.bigger_trials,
        (*_DAY_MEASURES, *_WHOLE),
        summaries.say_bigger,
    ),
    "trend": _Plan(
        "Trend over plots of rising size",
        "The listings as published on a grid of plots of ours (row length x area; the thesis's "
        f"table 1 is not in our source), rows {experiments.BETWEEN_ROWS_M:g} m and vines "
        f"{experiments.BETWEEN_PLANTS_M:g} m apart.",
        experiments.trend_trials,
        ("PCD_ALL", "visited_all", "clear_pct"),
        summaries.say_trend,
    ),
    "equal": _Plan(
        "Snake against neighbor at equal viewpoint time",
        "Both with one, two or three viewpoints, N = 1 to 4, scenarios A, B and C, by the "
        "listings, by the listings with the night corrected, and as the prose describes. "
        "found_day1, 2, 3: detected so far of those infested at the start and in earlier nights; "
        "differences are paired, on the same insects.",
        experiments.equal_trials,
        (*_DAY_MEASURES, "PCD_ALL", "MD_before"),
        summaries.say_pairs,
    ),
    "everywhere": _Plan(
        'Algorithm 6 "whatever the field"',
        "The thesis concludes that algorithm 6 reaches 100 % whatever the field. One viewpoint, as "
        "in its tables.",
        experiments.everywhere_trials,
        (*_DAY_MEASURES, *_WHOLE),
        summaries.say_everywhere,
    ),
    "slips": _Plan(
        "What each slip does, in scenario C",
        "The listings with one slip put right at a time, with the night corrected, and with all "
        "put right.",
        experiments.slip_trials,
        (*_DAY_MEASURES, *_WHOLE, "curve_listed_day3"),
        summaries.say_slips,
    ),
}
