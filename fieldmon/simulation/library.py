"""A season simulated in one call, for the public library."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.array_arguments import chances_of
from fieldmon.compute.kinds import checked, must_be_of
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.pest_in_weather import seen_in_weather
from fieldmon.plot.plot import must_be_plot
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler_or_name
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.season import SimulationSettings, check_start, simulated_days
from fieldmon.simulation.start import Start, season_start

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.compute.array_arguments import Column
    from fieldmon.plot.plot import Plot
    from fieldmon.samplers.base import Sampler
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.season import SimulatedDay


def draw_start(plot: Plot, chance: Column, share: float = 0.02, *, seed: int = 1) -> Start:
    """Draw which plants are infested on a simulated season's first morning.

    Parameters
    ----------
    plot
        Plants and the ways between them.
    chance
        ``(n,)`` chance of infestation as believed, in 0..1, for instance `DayPlan.chance`.
    share
        Share of all plants infested on average, above 0 and below 1.
    seed
        The same seed infests the same plants.

    Returns
    -------
    Start
        Who is infested, and what is believed of it: `simulate` begins with it.

    Raises
    ------
    SettingError
        If `share` is not above 0 and below 1.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance, share=0.05)
    >>> bool(100 < start.infested.sum() < 300)
    True
    """
    must_be_plot(plot)
    chance = chances_of(chance, plot.n_plants)
    must_be_of("The share infested at the start", "float", share)
    return season_start(plot.grid, chance, share, RandomStreams(seed))


@checked
def simulate(
    plot: Plot,
    start: Start,
    sampler: str | Sampler = "adaptive",
    *,
    robot: Robot | None = None,
    settings: SimulationSettings | None = None,
    seed: int = 1,
) -> SeasonMetrics:
    """Simulate a season: insects spread at night, a sampler looks for them by day.

    Samplers that are given the same start and seed meet the same insects.

    Parameters
    ----------
    plot
        Plants and the ways between them.
    start
        Which plants are infested on the first morning, and what is believed; see `draw_start`.
    sampler
        Name of a sampler, or one of your own.
    robot
        Who inspects; None: the usual `Robot`, which sees the pest of `settings` as its file says.
    settings
        Days, visits, and what insects do at night; None: a visit on each of 25 days, see
        `SimulationSettings`.
    seed
        Of nights and of what inspections find.

    Returns
    -------
    SeasonMetrics
        Columns ``(d,)`` a day: finds, plants still infested, shares inspected and detected. Each
        plant's are in `simulate_days`.

    Raises
    ------
    SettingError
        If there is no such sampler, or one of your own names no plant on the first day.
    PlotError
        If the start is of another plot.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance)
    >>> season = fm.simulate(plot, start, "naive", settings=fm.SimulationSettings(n_days=3))
    >>> season.left.shape
    (3,)
    >>> weekly = fm.SimulationSettings(n_days=8, visit_every=7)
    >>> season = fm.simulate(plot, start, "naive", settings=weekly)
    >>> season.visits, (season.worked_h > 0).nonzero()[0].tolist()
    (2, [0, 7])
    """
    return season_metrics(
        simulate_days(plot, start, sampler, robot=robot, settings=settings, seed=seed)
    )


@checked
def simulate_days(
    plot: Plot,
    start: Start,
    sampler: str | Sampler = "adaptive",
    *,
    robot: Robot | None = None,
    settings: SimulationSettings | None = None,
    seed: int = 1,
) -> Iterator[SimulatedDay]:
    """Simulate a season as `simulate` does, day by day: which plants are infested and inspected.

    Parameters
    ----------
    plot, start, sampler, robot, settings, seed
        As `simulate` takes them.

    Returns
    -------
    Iterator of SimulatedDay
        Each day as it happens.

    Raises
    ------
    SettingError
        If there is no such sampler.
    PlotError
        If the start is of another plot.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance)
    >>> days = [*fm.simulate_days(plot, start, "naive", settings=fm.SimulationSettings(n_days=3))]
    >>> np.array([day.infested for day in days]).shape
    (3, 3825)
    >>> [int(day.work.found.sum()) == day.found for day in days]
    [True, True, True]
    """
    check_start(plot.aisles, start)
    decides, chosen = sampler_or_name(sampler), settings or SimulationSettings()
    worker = robot or _usual_robot(chosen)
    return simulated_days(plot.aisles, worker, decides, start, chosen, RandomStreams(seed))


def _usual_robot(settings: SimulationSettings | None) -> Robot:
    return seen_in_weather(Robot(), None if settings is None else settings.pest)
