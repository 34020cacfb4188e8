"""What the outcomes say: means, paired ratios with intervals, and sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted
from fieldmon.simulation.statistics import paired_ratio, too_few_sentence
from fieldmon.studies.samplers.contenders import (
    ADAPTIVE,
    BOUNDS,
    NAIVE,
    NAMES,
    PAIRS,
    TUNED,
    WORDED,
)
from fieldmon.studies.samplers.seasons import MEASURES

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from fieldmon.simulation.statistics import Ratio
    from fieldmon.studies.samplers.seasons import SeasonOutcome

    MeasureTable = dict[str, dict[str, NDArray[np.float64]]]

#: whom Adaptive is held against
OTHERS = (PAIRS, WORDED, TUNED, NAIVE)
_NEVER_WORSE = 1.05


def names_in(outcomes: Sequence[SeasonOutcome]) -> tuple[str, ...]:
    """Return the names of contenders: the study's own, then those that were added."""
    return tuple(dict.fromkeys([*NAMES, *(outcome.contender for outcome in outcomes)]))


def others_in(outcomes: Sequence[SeasonOutcome]) -> tuple[str, ...]:
    """Return whom Adaptive is held against: `OTHERS`, and those that were added."""
    return *OTHERS, *(name for name in names_in(outcomes) if name not in NAMES)


def by_scenario(outcomes: Sequence[SeasonOutcome], measure: str) -> MeasureTable:
    """Return one measure by scenario and contender, ``(seeds,)`` each, seeds in order."""
    table: dict[str, dict[str, dict[int, float]]] = {}
    names = names_in(outcomes)
    for outcome in outcomes:
        contenders = table.setdefault(outcome.scenario, {name: {} for name in names})
        contenders[outcome.contender][outcome.seed] = getattr(outcome, measure)
    return {
        scenario: {name: np.array([v[seed] for seed in sorted(v)]) for name, v in values.items()}
        for scenario, values in table.items()
    }


def ratios(outcomes: Sequence[SeasonOutcome]) -> dict[str, dict[str, Ratio]]:
    """Return Adaptive's infested plant-days over each other's, by scenario and `others_in`."""
    loss, others = by_scenario(outcomes, "infested_plant_days"), others_in(outcomes)
    return {
        name: {
            other: paired_ratio(who[ADAPTIVE], who[other])
            for other in others
            if len(who[other]) == len(who[ADAPTIVE])
        }
        for name, who in loss.items()
    }


def ratio_lines(outcomes: Sequence[SeasonOutcome]) -> list[str]:
    """Return the ratios as lines of text, a scenario each, after a heading."""
    made, head = ratios(outcomes), "Infested plant-days of adaptive over those of"
    compared = others_in(outcomes)
    width = 2 + max(len(name) for name in (head, *made))
    lines = [f"{head:{width}}" + _columns(compared)]
    for name, others in made.items():
        lines.append(f"{name:{width}}" + _columns(str(others.get(one, "")) for one in compared))
    return lines


def _columns(values: Iterable[str]) -> str:
    return "  ".join(f"{value:>20}" for value in values)


def sentences(outcomes: Sequence[SeasonOutcome]) -> list[str]:
    """Return what the study found, with the numbers, whichever way they fall."""
    loss = by_scenario(outcomes, "infested_plant_days")
    said = verdict(outcomes)
    for other in (WORDED, TUNED, *(one for one in others_in(outcomes) if one not in OTHERS)):
        ratios = {name: paired_ratio(who[ADAPTIVE], who[other]).value for name, who in loss.items()}
        half = sum(value <= 0.5 for value in ratios.values())
        below = sum(value < 1.0 for value in ratios.values())
        worst = max(ratios, key=ratios.__getitem__)
        said.append(
            f"Infested plant-days against {other}: at most half in {half} of "
            f"{counted(len(ratios), 'scenario')}, fewer in {below}; "
            f"geometric mean {_mean(ratios):.2f} x, worst {ratios[worst]:.2f} x ({worst})."
        )
        worse = [name for name, value in ratios.items() if value > _NEVER_WORSE]
        if worse:
            said.append(f"More than 5 % worse than {other} in: {'; '.join(worse)}.")
    for measure, words in (("d50", "half"), ("d80", "80 %")):
        days = by_scenario(outcomes, measure)
        later = [
            name for name, who in days.items() if who[ADAPTIVE].mean() > who[TUNED].mean() + 1e-9
        ]
        said.append(
            f"Days until {words} of all infestations so far were found: no later than {TUNED} in "
            f"{len(days) - len(later)} of {counted(len(days), 'scenario')}{_but(later)}"
        )
    return [*said, _looks(outcomes)]


def verdict(outcomes: Sequence[SeasonOutcome]) -> list[str]:
    """Return who loses fewest plant-days, and against whom that is sure, before all else."""
    loss = by_scenario(outcomes, "infested_plant_days")
    taking_part = {
        name: {who: values for who, values in each.items() if who not in BOUNDS and len(values)}
        for name, each in loss.items()
    }
    # as often: as they take part
    order = list(dict.fromkeys(who for each in taking_part.values() for who in each))
    least = [_with_least(each) for each in taking_part.values()]
    known = sorted({*least}, key=lambda who: (len(who) > 1, -least.count(who), order.index(who[0])))
    first = [f"{_together(who, order)} in {least.count(who)}" for who in known]
    scenarios = counted(len(loss), "scenario")
    said = [f"Fewest infested plant-days, of {scenarios}: {'; '.join(first)}."]
    made = ratios(outcomes)
    for other in others_in(outcomes):
        held = [each[other] for each in made.values() if other in each]
        if held:
            fewer = sum(one.high < 1.0 for one in held)
            more = sum(one.low > 1.0 for one in held)
            said.append(
                f"{ADAPTIVE} against {other}: surely fewer in {fewer}, surely more in {more}, not "
                f"sure in {len(held) - fewer - more} (95 % interval of the ratio)."
            )
    few = too_few_sentence(len({outcome.seed for outcome in outcomes}), "--seeds")
    return [*said, few] if few else said


def _with_least(loss: dict[str, NDArray[np.float64]]) -> tuple[str, ...]:
    """Return who has the smallest mean: several where they are alike."""
    means = {who: float(values.mean()) for who, values in loss.items()}
    return tuple(who for who, mean in means.items() if mean == min(means.values()))


def _together(who: tuple[str, ...], of: list[str]) -> str:
    if len(who) == 1:
        return who[0]
    return "all alike" if len(who) == len(of) else f"{' and '.join(who)} alike"


def _looks(outcomes: Sequence[SeasonOutcome]) -> str:
    inspected, found = by_scenario(outcomes, "inspected"), by_scenario(outcomes, "found")
    fewer = 0
    for scenario, who in inspected.items():
        own, other = (who[name].sum() / found[scenario][name].sum() for name in (ADAPTIVE, TUNED))
        fewer += own <= other
    return (
        f"Plants inspected per find over the whole season: no more than {TUNED} in {fewer} of "
        f"{counted(len(inspected), 'scenario')} (who stops the spread early has less left to find)."
    )


def _but(scenarios: Sequence[str]) -> str:
    return f"; later in {'; '.join(scenarios)}." if scenarios else "."


def _mean(ratios: dict[str, float]) -> float:
    return float(np.exp(np.mean(np.log(np.maximum(list(ratios.values()), 1e-9)))))


def means(outcomes: Sequence[SeasonOutcome]) -> dict[str, dict[str, dict[str, float]]]:
    """Return the mean of every measure by measure, scenario and contender."""
    return {
        measure: {
            name: {who: float(values.mean()) for who, values in contenders.items() if len(values)}
            for name, contenders in by_scenario(outcomes, measure).items()
        }
        for measure in MEASURES
    }
