"""The scenarios in which samplers are compared: plot, insects, start, and what is known."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.errors import SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.pest_in_weather import seen_in_weather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.prior.prior import edge_chance, scaled, start_infested
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.simulation.season import SimulationSettings
from fieldmon.simulation.start import Start
from fieldmon.studies.samplers.worlds import WORLDS, World, near_edge

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.plot.grid import PlantGrid

# the thesis's plots, plants a side: 1, 5 and 10 ha
SIDES = {"A": 28, "B": 64, "C": 91}
STARTS = ("clusters", "edge", "scattered")
PRIORS = ("none", "edge", "records 1 %", "records 5 %", "wrong")
FLAWS = ("", "spread", "records", "detection")
# infested plants on the first morning, and how many stand together (our choice)
_SHARE, _TOGETHER = 0.015, 8
_GPS_M = 5.0
_TRIES = 200
_POOR_DETECTION = 0.5
_BELIEVED_RATE = {0.3: 0.8, 0.5: 0.1, 0.8: 0.3}
_DIGITS = 6


@dataclass(frozen=True)
class Scenario:
    """A plot, its insects, the start and what is known of it.

    Parameters
    ----------
    plot
        "A", "B" or "C": the thesis's plots of 28, 64 and 91 plants a side.
    spread
        What the insects do at night.
    start
        Where the 1.5 % infested plants of the first morning stand: in "clusters" of eight, along
        the "edge", or "scattered".
    prior
        What is known: "none" (the share alone), that insects come from the "edge", "records 1 %"
        or "records 5 %" of the plants looked at the evening before, or "wrong": a quarter of the
        plot is suspected ten times as much as the rest, for no reason.
    flaw
        What the belief has wrong: nothing, the "spread" (another rate), the place of the
        "records" (GPS error of 5 m, 1 sigma), the "detection" (0.84 believed, 0.5 true).
    world
        What the insects really do, a name of `fieldmon.studies.samplers.worlds.WORLDS`; then
        `spread` is what is believed, and clusters of the first morning came about as the world has
        it. Empty: they do as is believed.
    hours
        The working day.
    pest_in_weather
        The pest in its weather, which has nights of its own and is known to the belief; then
        `spread` is not read, and there is neither a world nor a wrong spread. None: as `spread` has
        it.
    visit_every
        Days from one visit to the next.
    """

    plot: str = "B"
    spread: Spread = field(default_factory=lambda: Spread(0.3, "one"))
    start: str = "clusters"
    prior: str = "none"
    flaw: str = ""
    world: str = ""
    hours: float = 12.0
    pest_in_weather: PestInWeather | None = None
    visit_every: int = 1

    def __post_init__(self) -> None:
        known: dict[str, Iterable[str]] = {
            "plot": SIDES, "start": STARTS, "prior": PRIORS, "flaw": FLAWS, "world": ("", *WORLDS)
        }  # fmt: skip
        for name, values in known.items():
            if getattr(self, name) not in values:
                raise SettingError(
                    f"The {name} must be one of {', '.join(map(repr, values))}, "
                    f"but it is {getattr(self, name)!r}."
                )
        if self.pest_in_weather is not None and (self.world or self.flaw == "spread"):
            raise SettingError("A pest has nights of its own: it goes without a world or spread.")

    @property
    def name(self) -> str:
        """Return the scenario in words, unique."""
        # unsaid, it leaves a scenario what it was before visits could be days apart
        visits = "" if self.visit_every == 1 else f", a visit every {self.visit_every} days"
        if self.world:
            return f"world, {self.plot}, {self.hours:g} h, {self.world}{visits}"
        nights = f"spread {self.spread.rate_per_day:.0%} to {self.spread.to}"
        if self.pest_in_weather is not None:
            nights = self.pest_in_weather.pest.name
        words = f"{self.plot}, {nights}, {self.start}, prior {self.prior}"
        words = (f"{words}, {self.flaw} wrong" if self.flaw else words) + visits
        # two files may give a pest the same name
        return (
            words if self.pest_in_weather is None else f"{words}, {of_pest(self.pest_in_weather)}"
        )

    @property
    def aisles(self) -> Aisles:
        """Return the plot."""
        return _aisles(SIDES[self.plot])

    @property
    def robot(self) -> Robot:
        """Return who inspects, as it is: charged the thesis's times."""
        robot = replace(self.believed_robot, hours=self.hours).with_times("thesis")
        return replace(robot, detection=_POOR_DETECTION) if self.flaw == "detection" else robot

    @property
    def believed_robot(self) -> Robot:
        """Return who inspects, with the chance of detection that is believed."""
        return seen_in_weather(Robot(), self.pest_in_weather)

    @property
    def settings(self) -> SimulationSettings:
        """Return what happens in the season, and what is believed of it."""
        believed = None
        if self.flaw == "spread":
            rate = _BELIEVED_RATE.get(self.spread.rate_per_day, 0.3)
            believed = Spread(rate, self.spread.to)
        learning = Learning(detection=self.believed_robot.detects)
        settings = SimulationSettings(
            spread=self.spread,
            believed_spread=believed,
            learning=learning,
            pest=self.pest_in_weather,
            visit_every=self.visit_every,
        )
        if not self.world:
            return settings
        world = WORLDS[self.world]
        return replace(settings, own_night=world.night, hidden_nights=world.hidden_nights)

    def draw_start(self, streams: RandomStreams) -> Start:
        """Draw the first morning and what is known of it."""
        grid = self.aisles.grid
        if self.world:
            infested = _grown(grid, WORLDS[self.world], streams.of("start"))
        else:
            infested = infested_at_start(grid, self.start, _SHARE, streams.of("start"))
        return Start(infested, known_chance(grid, self, infested, streams.of("records")))


@cache
def _aisles(side: int) -> Aisles:
    return Aisles.of(rectangle(side, side))


def usual_scenarios() -> list[Scenario]:
    """Return the scenarios of the study: one thing changed at a time in B and C, and A."""
    made = [Scenario("A")]
    for plot in ("B", "C"):
        made += [Scenario(plot, Spread(rate, "one")) for rate in (0.3, 0.5, 0.8)]
        made += [Scenario(plot, Spread(rate, "each")) for rate in (0.3, 0.5)]
        made += [Scenario(plot, start=start) for start in STARTS[1:]]
        made += [Scenario(plot, start="edge", prior="edge")]
        made += [Scenario(plot, prior=prior) for prior in PRIORS[2:]]
    made += [Scenario(flaw="spread"), Scenario(flaw="detection")]
    return [*made, Scenario(prior="records 5 %", flaw="records")]


def in_worlds() -> list[Scenario]:
    """Return the scenarios of each world, on 5 and 10 ha, with 12 and with 4 hours a day."""
    return [
        Scenario(plot, world=world, hours=hours)
        for plot in ("B", "C")
        for hours in (12.0, 4.0)
        for world in WORLDS
    ]


def all_scenarios() -> list[Scenario]:
    """Return every combination of plot, spread, start and prior, and the flaws."""
    crossed = [
        Scenario(plot, Spread(rate, "one"), start, prior)
        for plot in SIDES
        for rate in (0.3, 0.5, 0.8)
        for start in STARTS
        for prior in PRIORS
    ]
    return list(dict.fromkeys([*usual_scenarios(), *crossed]))


def with_pest(scenarios: Iterable[Scenario], pest_in_weather: PestInWeather) -> list[Scenario]:
    """Return scenarios with a pest instead of a rate of spread, each once.

    Worlds and a wrong rate are left out: a pest has nights of its own.
    """
    return list(
        dict.fromkeys(
            replace(each, spread=Scenario().spread, pest_in_weather=pest_in_weather)
            for each in scenarios
            if not each.world and each.flaw != "spread"
        )
    )


def of_pest(pest_in_weather: PestInWeather) -> str:
    """Return digits that tell a pest in its weather from any other."""
    return digest(*pest_in_weather.content, length=_DIGITS)


def infested_at_start(
    grid: PlantGrid, start: str, share: float, rng: np.random.Generator
) -> NDArray[np.bool_]:
    """Draw which plants are infested on a first morning, ``(n,)``: a share, see `Scenario`."""
    wanted = max(1, round(share * len(grid)))
    if start == "scattered":
        infested = np.zeros(len(grid), np.bool_)
        infested[rng.choice(len(grid), wanted, replace=False)] = True
        return infested
    if start == "edge":
        return start_infested(edge_chance(grid, PriorSettings()), share, rng)
    infested = np.zeros(len(grid), np.bool_)
    while np.count_nonzero(infested) < wanted:
        _grow(grid, infested, min(_TOGETHER, wanted - int(np.count_nonzero(infested))), rng)
    return infested


def _grown(grid: PlantGrid, world: World, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Infest the share of the first morning: groups of eight that came from one plant each."""
    n, wanted = len(grid), max(1, round(_SHARE * len(grid)))
    infested = np.zeros(n, np.bool_)
    if world.arrivals and world.at_edge:
        near = near_edge(grid)
        infested[rng.choice(n, wanted, replace=False, p=near / near.sum())] = True
        return infested
    while np.count_nonzero(infested) < wanted:
        members = [int(rng.choice(np.flatnonzero(~infested)))]
        size = min(_TOGETHER, wanted - int(np.count_nonzero(infested)))
        for _ in range(_TRIES):
            if len(members) >= size:
                break
            sender = members[int(rng.integers(len(members)))]
            reached = int(world.reached(grid, rng, np.array([sender]))[0])
            if reached >= 0 and reached not in members and not infested[reached]:
                members.append(reached)
        infested[members] = True
    return infested


def _grow(
    grid: PlantGrid, infested: NDArray[np.bool_], size: int, rng: np.random.Generator
) -> None:
    """Infest a cluster: a plant drawn evenly, then plants beside those it has already."""
    free = np.flatnonzero(~infested)
    members = [int(rng.choice(free))]
    infested[members] = True
    start, other = grid.adjacent
    while len(members) < size:
        beside = np.concatenate([other[start[i] : start[i + 1]] for i in members])
        beside = beside[~infested[beside]]
        if not beside.size:
            break
        members.append(int(rng.choice(beside)))
        infested[members[-1]] = True


def known_chance(
    grid: PlantGrid,
    scenario: Scenario,
    infested: NDArray[np.bool_],
    rng: np.random.Generator,
    share: float = _SHARE,
) -> NDArray[np.float64]:
    """Return the chance map of the first morning, ``(n,)``, where so much is thought infested."""
    flat = np.full(len(grid), share)
    if scenario.prior == "edge":
        return scaled(1.0 - (1.0 - 0.002) * (1.0 - edge_chance(grid, PriorSettings())), share)
    if scenario.prior == "wrong":
        x, y = grid.xy_m.T
        suspected = (x < np.median(x)) & (y < np.median(y))
        return scaled(np.where(suspected, 0.1, 0.01), share)
    if not scenario.prior.startswith("records"):
        return flat
    looked_at = 0.05 if scenario.prior == "records 5 %" else 0.01
    at = rng.choice(len(grid), round(looked_at * len(grid)), replace=False)
    detects = scenario.believed_robot.detects
    found = infested[at] & (rng.random(len(at)) < detects)
    if scenario.flaw == "records":
        away = grid.xy_m[at] + rng.normal(0.0, _GPS_M, (len(at), 2))
        at = np.array([int(np.argmin(((grid.xy_m - xy) ** 2).sum(axis=1))) for xy in away])
    plants = at.astype(np.int32)
    learning = Learning(detection=detects, treated=False)
    return PairApproximation.of(grid, flat).learn(plants, found, learning).chance
