"""What each further robot saves, in sentences and as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import counted
from fieldmon.simulation.season import visits_in
from fieldmon.simulation.statistics import summary_statistics
from fieldmon.simulation.team_worth import MarginalGain, marginal_gains, worth_sentence

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.simulation.statistics import SummaryStatistics
    from fieldmon.studies.teams.seasons import TeamOutcome


class TeamRow(NamedTuple):
    """What teams of one size came to in a scenario.

    Parameters
    ----------
    scenario, who, robots
        Where, how, and how many.
    loss, worked_h
        Infested plant-days, and hours worked of a season.
    d80
        Days to 80 % of the seasons that reach it, ``(k,)``.
    n_days, visits
        How many days a season has, and on how many of them they work.
    hectares, spread
        How large the plot is, and the chance a night; NaN where a pest has nights of its own.
    gain
        What they save beyond the next lesser team, on the seeds that both met; None for the least.
    """

    scenario: str
    who: str
    robots: int
    loss: SummaryStatistics
    d80: NDArray[np.float64]
    n_days: int
    visits: int
    worked_h: SummaryStatistics
    hectares: float
    spread: float
    gain: MarginalGain | None

    @property
    def nights(self) -> str:
        """Return how the insects spread, in words."""
        return "as the pest spreads" if np.isnan(self.spread) else f"{self.spread:.0%} a night"

    def __repr__(self) -> str:
        return f"<TeamRow: {self.scenario}, {self.robots} robots>"


def rows(outcomes: Sequence[TeamOutcome], n_days: int, visit_every: int = 1) -> list[TeamRow]:
    """Return a row for each scenario, way to work and number of robots, in their order.

    Seasons are of `n_days` days, with a visit every so many.
    One robot alone is the first of every way to work: there is nobody to share with.
    """
    made = []
    for scenario in dict.fromkeys(one.scenario for one in outcomes):
        here = [one for one in outcomes if one.scenario == scenario]
        ways = dict.fromkeys(one.who for one in here if one.robots > 1) or {"": None}
        for way in ways:
            sampler = way.partition(",")[0]
            alone = [o for o in here if o.robots == 1 and (not way or o.who in (sampler, way))]
            made += _of_way(
                [*alone, *(o for o in here if o.who == way and o.robots > 1)],
                way,
                (n_days, visits_in(n_days, visit_every)),
            )
    return made


def _of_way(
    outcomes: Sequence[TeamOutcome], way: str, days_and_visits: tuple[int, int]
) -> list[TeamRow]:
    sizes = sorted({one.robots for one in outcomes})
    seeds = set.intersection(*({o.seed for o in outcomes if o.robots == k} for k in sizes))
    by = {
        k: sorted((o for o in outcomes if o.robots == k and o.seed in seeds), key=lambda o: o.seed)
        for k in sizes
    }
    losses = {k: np.array([o.infested_plant_days for o in by[k]]) for k in sizes}
    gains = {gain.robots: gain for gain in marginal_gains(losses)}
    return [
        TeamRow(
            by[k][0].scenario, way or by[k][0].who, k,
            summary_statistics(losses[k]),
            np.array([o.d80 for o in by[k] if o.d80 <= days_and_visits[0]]),
            *days_and_visits,
            summary_statistics(np.array([o.worked_h for o in by[k]])),
            by[k][0].hectares, by[k][0].spread,
            gains.get(k),
        )
        for k in sizes if by[k]
    ]  # fmt: skip


def sentences(made: Sequence[TeamRow]) -> list[str]:
    """Return for each scenario and way to work what each further robot would save."""
    said = []
    for scenario, who in dict.fromkeys((row.scenario, row.who) for row in made):
        gains = [r.gain for r in made if (r.scenario, r.who) == (scenario, who) and r.gain]
        if gains:
            said.append(f"{short(scenario)} ({who}): {worth_sentence(gains)}")
    return said


def short(scenario: str) -> str:
    """Return a scenario's name without what tells it from others of the same name."""
    return scenario.rpartition(" ")[0]


HEADS = (
    *("scenario", "who", "robots", "infested plant-days", "saved by the last"),
    *("days to 80 %", "hours worked"),
)


def cells(row: TeamRow) -> tuple[str, ...]:
    """Return a row as texts, in the order of `HEADS`."""
    daily = row.visits == row.n_days
    return (
        short(row.scenario),
        row.who,
        str(row.robots),
        _interval(row.loss),
        "" if row.gain is None else _interval(row.gain.saved),
        _days_to_80(row),
        f"{row.worked_h.mean:.0f}" + ("" if daily else f" in {counted(row.visits, 'visit')}"),
    )


def table(made: Sequence[TeamRow]) -> str:
    """Return the rows as a table in Markdown."""
    lines = [HEADS, ("---",) * len(HEADS), *map(cells, made)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _days_to_80(row: TeamRow) -> str:
    """Return when seasons reach 80 %, and how many do where not all do."""
    reached, seasons = len(row.d80), row.loss.replicates
    if not reached:
        return f"not in {row.n_days}"
    mean = f"{row.d80.mean():.1f}"
    return mean if reached == seasons else f"{mean} in {reached} of {seasons} seasons"


def _interval(of: SummaryStatistics) -> str:
    if np.isnan(of.low):
        return f"{of.mean:.0f}"
    return f"{of.mean:.0f} ({of.low:.0f} to {of.high:.0f})"
