"""Seasons of teams of several sizes on the same insects, and what came of each."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import Records
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler as sampler_of
from fieldmon.simulation.paired_seasons import SameInsects, paired
from fieldmon.simulation.season import SimulationSettings
from fieldmon.studies.outcome_table import finite

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.simulation.experiment import Experiment
    from fieldmon.simulation.team_season import Team

_DIGITS = 8


@dataclass(frozen=True, eq=False)
class TeamScenario:
    """A plot and its insects, on which teams of several sizes work.

    Parameters
    ----------
    plot
        The plot.
    chance
        ``(n,)`` chance of infestation as believed on the first morning.
    spread
        What the insects do at night, where no pest is named.
    robot
        Each of a team.
    infested
        Share of plants infested on the first morning.
    n_days
        Days.
    pest_in_weather
        The pest in its weather; None: nights are as `spread` says.
    visit_every
        Days from one visit to the next.
    """

    plot: Plot
    chance: NDArray[np.float64]
    spread: Spread = field(default_factory=Spread)
    robot: Robot = field(default_factory=Robot)
    infested: float = 0.02
    n_days: int = 25
    pest_in_weather: PestInWeather | None = None
    visit_every: int = 1

    @property
    def hectares(self) -> float:
        """Return how large the plot is."""
        grid = self.plot.grid
        return float(grid.frame.geometry_m(self.plot.field.boundary).area) / 1e4

    @cached_property
    def name(self) -> str:
        """Return the scenario in words; the same for the same plot and settings only."""
        settings = (self.robot, self.infested, self.n_days, self.spread)
        parts = (self.plot.grid.xy_m, self.chance, repr(settings).encode())
        # unsaid, it leaves a scenario what it was before pests could be named
        pest = () if self.pest_in_weather is None else self.pest_in_weather.content
        nights = f"spread {self.spread.rate_per_day:.0%} to {self.spread.to}"
        nights = nights if self.pest_in_weather is None else self.pest_in_weather.pest.name
        # and likewise before visits could be days apart: the name says it
        nights += "" if self.visit_every == 1 else f", a visit every {self.visit_every} days"
        return f"{self.plot.field.name} {nights} {digest(*parts, *pest, length=_DIGITS)}"

    @property
    def rate_per_day(self) -> float:
        """Return the chance a night to infest a neighbour; NaN where a pest has its own nights."""
        return self.spread.rate_per_day if self.pest_in_weather is None else np.nan


class TeamSetting(NamedTuple):
    """A team in a scenario."""

    scenario: TeamScenario
    sampler: str
    team: Team

    @property
    def who(self) -> str:
        """Return how they work, in words."""
        if self.team.robots == 1:
            return self.sampler
        work = self.team.teamwork
        room = f", {work.passing_m:g} m to pass" if work.passing_m else ""
        if not work.together:
            return f"{self.sampler}, sections{room}"
        contact = f"contact every {work.contact_s / 60:g} min" if work.contact_s else "at once"
        return f"{self.sampler}, together, {contact}{room}"


@dataclass(frozen=True)
class TeamOutcome:
    """What a season of a team came to; a level never reached counts as one day more than it has.

    `spread` is NaN where a pest has nights of its own.
    """

    scenario: str
    who: str
    robots: int
    seed: int
    hectares: float
    spread: float
    infested_plant_days: float
    d80: float
    worked_h: float
    found: float

    columns: ClassVar[tuple[str, ...]] = (
        *("scenario", "who", "robots", "seed", "hectares", "spread"),
        *("infested_plant_days", "d80", "worked_h", "found"),
    )
    kinds: ClassVar[tuple[Callable[[str], Any], ...]] = (
        *(str, str, int, int),
        finite,
        float,
        *(finite,) * 4,
    )

    @property
    def key(self) -> tuple[str, str, int, int]:
        """Return the chunk that it is of."""
        return self.scenario, self.who, self.robots, self.seed


def square_plot(hectares: float) -> Plot:
    """Return a square plot, rows 4 m and plants 3 m apart, its gate at a corner.

    Examples
    --------
    >>> square_plot(1.0).n_plants
    825
    """
    if not 0.0 < hectares <= 1000.0:
        raise SettingError(f"A plot must have above 0 and up to 1000 ha, but it has {hectares:g}.")
    side_m, planting = 100.0 * np.sqrt(hectares), Planting()
    rows = max(round(side_m / planting.row_spacing_m), 1)
    grid = rectangle(rows, max(round(side_m / planting.plant_spacing_m), 1), planting)
    boundary = grid.frame.geometry_lonlat(grid.drivable_m)
    return Plot(Field(f"{hectares:g} ha", boundary), Aisles.of(grid))


def unknown_chance(plot: Plot) -> NDArray[np.float64]:
    """Return what is believed where nothing is recorded ``(n,)``: more at the edge."""
    day = np.datetime64("2026-06-01", "D")  # no record is of any day
    return prior_chance(plot.grid, plot.field, Records.none(), day, PriorSettings())


def study_of(
    settings: Sequence[TeamSetting], seeds: range
) -> Experiment[TeamSetting, list[TeamOutcome]]:
    """Return the study of teams in scenarios: all of them meet a scenario's insects of a seed."""
    return paired(
        settings,
        seeds,
        lambda setting, seed: [outcome(setting, seed)],
        lambda one, seeds: (one.scenario.name, one.who, one.team.robots, seeds.start),
    )


def outcome(setting: TeamSetting, seed: int) -> TeamOutcome:
    """Return what a season of a team comes to."""
    scenario = setting.scenario
    season = SimulationSettings(
        n_days=scenario.n_days,
        spread=scenario.spread,
        pest=scenario.pest_in_weather,
        visit_every=scenario.visit_every,
    )
    insects = SameInsects(scenario.plot, scenario.chance, scenario.infested, season)
    made = insects.season(sampler_of(setting.sampler), scenario.robot, seed, setting.team)
    return TeamOutcome(
        scenario.name, setting.who, setting.team.robots, seed,
        round(scenario.hectares, 3), scenario.rate_per_day,
        float(made.infested_plant_days), float(made.first_day(80.0) or scenario.n_days + 1),
        round(float(made.worked_h.sum()), 3), float(made.found.sum()),
    )  # fmt: skip
