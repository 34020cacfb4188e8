"""Seasons of several on the same insects: each of them meets every seed.

A seed's start, its nights and what its inspections detect are drawn from streams that know nothing
of who works. So differences and ratios are taken seed by seed (paired).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeVar

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.simulation.experiment import Experiment
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.start import season_start
from fieldmon.simulation.team_season import ONE

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Sampler
    from fieldmon.simulation.experiment import Memory
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.season import SimulationSettings
    from fieldmon.simulation.team_season import Team

Setting = TypeVar("Setting")
Result = TypeVar("Result")


class SameInsects(NamedTuple):
    """What all meet: a plot and its insects.

    Parameters
    ----------
    plot
        The plot.
    chance
        ``(n,)`` chance of infestation as believed on the first morning.
    share
        Share of plants infested on the first morning.
    settings
        Days, visits, and what the insects do at night.
    """

    plot: Plot
    chance: NDArray[np.float64]
    share: float
    settings: SimulationSettings

    def __repr__(self) -> str:
        return f"<SameInsects: {self.share:.1%} of {self.plot!r}>"

    def season(self, sampler: Sampler, robot: Robot, seed: int, team: Team = ONE) -> SeasonMetrics:
        """Return what one season comes to, for one robot or a team of such."""
        streams = RandomStreams(seed)
        start = season_start(self.plot.grid, self.chance, self.share, streams)
        days = team.days((self.plot, robot), sampler, start, self.settings, streams)
        return season_metrics(days)


def paired(
    settings: Sequence[Setting],
    seeds: range,
    of_seed: Callable[[Setting, int], Result],
    key: Callable[[Setting, range], Hashable] | None = None,
) -> Experiment[Setting, Result]:
    """Return the experiment in which all settings meet a seed before any meets the next."""
    return Experiment(
        settings=settings,
        seeds=seeds,
        simulate=lambda setting, seeds: of_seed(setting, seeds.start),
        chunk_size=lambda _: 1,
        key=key,
        seed_by_seed=True,
    )


def met_by_all(
    experiment: Experiment[Setting, Result], made: Memory[Result]
) -> dict[int, list[Result]]:
    """Return by seed what its seasons came to, for the seeds that every setting has been through.

    In the order of the settings. What is at work in several threads need not end in order.
    """
    by_seed: dict[int, list[Result]] = {}
    for chunk in experiment.chunks():
        if chunk.key in made:
            by_seed.setdefault(chunk.seeds.start, []).append(made[chunk.key])
    whole = len(experiment.settings)
    return {seed: results for seed, results in by_seed.items() if len(results) == whole}
