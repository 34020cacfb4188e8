"""A few seconds of a study of one's own plots: the seasons of one chunk."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.errors import FieldmonError
from fieldmon.infestation.insects.pest_in_weather import seen_in_weather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.prior.pest_prior import prior_for
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.plot.plot import plot_of
from fieldmon.plot.robot import USUAL_TIMES, Robot
from fieldmon.samplers import sampler_or_name
from fieldmon.samplers.own import label_of
from fieldmon.simulation.metrics import DETECTION_LEVELS_PCT
from fieldmon.simulation.paired_seasons import SameInsects
from fieldmon.simulation.season import SimulationSettings
from fieldmon.simulation.team_season import ONE

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.plot.plot import Plot
    from fieldmon.simulation.metrics import SeasonMetrics
    from fieldmon.simulation.study_plot import Combination, StudyPlot
    from fieldmon.simulation.team_season import Team

    Setting = tuple[StudyPlot, Combination]

DETECTION_LEVELS = {f"d{level:g}": level for level in DETECTION_LEVELS_PCT}
# plots laid and kept by a process, for the next chunk
_KEPT = 4


class RefusedPlot(NamedTuple):
    """A plot that cannot carry plants, and the sentence that says why."""

    name: str
    why: str


class LaidPlot(NamedTuple):
    """A plot ready to be simulated on.

    Parameters
    ----------
    plot
        Its plants.
    chance
        ``(n,)`` of infestation on the first morning.
    pest_in_weather
        The pest in its weather; None: nights are as the levels have them.
    """

    plot: Plot
    chance: NDArray[np.float64]
    pest_in_weather: PestInWeather | None = None


ChunkSeasons = list[dict[str, Any]] | RefusedPlot
"""A row a season, see `results.SCHEMA`."""


def simulate_chunk(
    setting: Setting,
    seeds: range,
    n_days: int,
    robot_times: str = USUAL_TIMES,
    visit_every: int = 1,
) -> ChunkSeasons:
    """Simulate a combination on a plot; return a season's measures for each seed.

    It depends on its arguments alone: all samplers meet the same insects of a seed. A plot that
    cannot carry plants comes back as such, for thousands of others are none the worse for it.
    """
    of, levels = setting
    try:
        laid = _laid(of.digest, _Unhashed(of))
    except FieldmonError as error:
        return RefusedPlot(of.field.name, str(error))
    rows, plot, robot = [], laid.plot, Robot().with_times(robot_times)
    named = vars(replace(levels, sampler=label_of(levels.sampler)))
    if laid.pest_in_weather is not None:
        named = named | {"spread": None}  # the insects are that pest
    for seed in seeds:
        season = simulated_season(laid, robot, levels, seed, (n_days, visit_every))
        about = {"plot": plot.field.name, **named, "seed": seed, "days": n_days}
        rows.append(about | {"plants": len(plot.grid)} | _measures(season))
    return rows


def simulated_season(
    laid: LaidPlot,
    robot: Robot,
    levels: Combination,
    seed: int,
    days: tuple[int, int],
    team: Team = ONE,
) -> SeasonMetrics:
    """Return what one season comes to, on a plot with its chances of infestation.

    `days` are how many it has, and how many from one visit to the next.
    """
    (plot, chance, pest_in_weather), (n_days, visit_every) = laid, days
    spread = Spread(levels.spread)
    settings = SimulationSettings(n_days, spread, pest=pest_in_weather, visit_every=visit_every)
    robot = replace(robot, hours=levels.hours, look_s=levels.look_s)
    robot = seen_in_weather(robot, pest_in_weather)
    insects = SameInsects(plot, chance, levels.infested, settings)
    return insects.season(sampler_or_name(levels.sampler), robot, seed, team)


class _Unhashed:
    """Something beside the key of a cache: equal to anything of its kind."""

    def __init__(self, plot: StudyPlot) -> None:
        self.plot = plot

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Unhashed)

    def __hash__(self) -> int:
        return 0


@lru_cache(maxsize=_KEPT)
def _laid(digest: str, of: _Unhashed) -> LaidPlot:  # noqa: ARG001 - the key
    """Return a plot with its plants, and their chances of infestation."""
    plot = plot_of(of.plot.field, of.plot.planting)
    records, day, pest_in_weather = of.plot.records, of.plot.day, of.plot.pest_in_weather
    prior = PriorSettings()
    if pest_in_weather is not None:
        prior = prior_for(
            prior, pest_in_weather.pest, pest_in_weather.weather, pest_in_weather.begins
        )
    return LaidPlot(plot, prior_chance(plot.grid, plot.field, records, day, prior), pest_in_weather)


def _measures(season: SeasonMetrics) -> dict[str, Any]:
    return {
        "detection_pct": float(season.detection_pct[-1]),
        "visited_pct": float(season.visited_pct.mean()),
        "ever_visited_pct": float(season.ever_visited_pct[-1]),
        "infestations": int(season.new.sum()),
        "found": int(season.found.sum()),
        "left": int(season.left[-1]),
        "infested_plant_days": season.infested_plant_days,
        **{name: season.first_day(level) for name, level in DETECTION_LEVELS.items()},
        "found_by_day": season.found.tolist(),
        "left_by_day": season.left.tolist(),
    }
