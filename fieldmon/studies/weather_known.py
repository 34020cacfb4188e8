"""What knowing the weather brings: Adaptive that knows it beside one that believes averages.

Both meet the same insects, which live in the weather of the season. One chance map is told of each
day's temperature and wind, the other has the averages of the place, and no wind.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import date
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.colonies import Colonies
from fieldmon.infestation.insects.pest_in_weather import PestInWeather, Spell, seen_in_weather
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.pests.pest import Increase, Movement, Pest, Stage
from fieldmon.pests.weather import DAY_S, weather_of
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.simulation import executor
from fieldmon.simulation.experiment import Experiment, Memory, run
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from fieldmon.simulation.statistics import summary_statistics

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.simulation.statistics import SummaryStatistics

    Floats = NDArray[np.float64]

#: a mite that multiplies as published (Bounfour & Tanigoshi 2001) and is carried by the wind; how
#: often and how far is our choice
CARRIED = Pest(
    "carried by the wind",
    stages=(
        Stage("egg", 12.5, 63.0, visible=False, mobile=False),
        Stage("young", 12.5, 83.0, mobile=False),
    ),
    increase=Increase((12.5, 15.0, 30.0), (0.0, 0.08, 0.321)),
    movement=Movement("exponential", 0.3, reach_m=6.0, wind="with", hours=(9.0, 18.0), at_c=21.0),
)
# the place: mean low and high, how much a day differs from the one before, and how much of that
# stays for the next (our choice)
_LOW_C, _HIGH_C, _DIFFERS_C, _STAYS = 14.0, 28.0, 2.0, 0.6
_WEEK = slice(4, 11)
_WARMER_C, _WIND_M_S = 9.0, 5.0
_BEGINS = date(2026, 6, 1)
# plants a side; the share infested at first, and how many came from one plant (our choice)
_SIDE, _SHARE, _TOGETHER = 64, 0.015, 8
_GROWS = 0.25
_MOST_GROWN = 200


class Shape(NamedTuple):
    """How the weather of a season differs from the usual.

    Parameters
    ----------
    warmer_c
        For a week, from the fifth day on.
    wind_m_s
        All season, from the west.
    """

    warmer_c: float = 0.0
    wind_m_s: float = 0.0


SHAPES = {
    "as usual": Shape(),
    "heat wave": Shape(warmer_c=_WARMER_C),
    "cold week": Shape(warmer_c=-_WARMER_C),
    "steady wind": Shape(wind_m_s=_WIND_M_S),
    "heat wave in the wind": Shape(_WARMER_C, _WIND_M_S),
}
"""By name."""


class KnownOrNot(NamedTuple):
    """A season of each on the same insects.

    Parameters
    ----------
    knows, averages
        Infested plant-days.
    held, held_by_averages
        ``(d,)`` whether the interval of 90 % held the number infested on each morning.
    """

    knows: int
    averages: int
    held: NDArray[np.bool_]
    held_by_averages: NDArray[np.bool_]


@dataclass(frozen=True)
class WorthOfWeather:
    """What knowing the weather brings under one shape of it.

    Parameters
    ----------
    shape
        Its name.
    knows, averages
        Mean infested plant-days of each.
    ratio
        Those of the one that knows over those of the other, season by season.
    held, held_by_averages
        Share of mornings on which the interval of 90 % held the number infested.
    """

    shape: str
    knows: float
    averages: float
    ratio: SummaryStatistics
    held: float
    held_by_averages: float

    def sentence(self) -> str:
        """Return it in words."""
        return (
            f"{self.shape:22} {self.knows:7.0f} infested plant-days knowing it, "
            f"{self.averages:7.0f} by averages: season by season x {self.ratio.mean:.2f} "
            f"({self.ratio.low:.2f} to {self.ratio.high:.2f}, 95 %); the interval of 90 % holds on "
            f"{100 * self.held:.0f} and {100 * self.held_by_averages:.0f} % of mornings"
        )


def worth_of_weather(
    seeds: range,
    shapes: Sequence[str] = tuple(SHAPES),
    pest: Pest = CARRIED,
    n_days: int = 20,
    progress: Callable[[int, int], None] | None = None,
) -> list[WorthOfWeather]:
    """Return what knowing the weather brings, by shape of it, on paired seeds."""
    must_be_shapes(shapes, n_days)

    def simulate(shape: str, seeds: range) -> KnownOrNot:
        return paired_seasons(pest, SHAPES[shape], seeds.start, n_days)

    experiment = Experiment(shapes, seeds, simulate, lambda _: 1)
    made: Memory[KnownOrNot] = Memory()
    with executor.threads() as workers:
        run(experiment, workers, made, progress)
    return [_worth(name, [made[name, seed] for seed in seeds]) for name in shapes]


def must_be_shapes(shapes: Sequence[str], n_days: int) -> None:
    """Raise `SettingError` unless there are such shapes, and they show in so many days."""
    unknown = [name for name in shapes if name not in SHAPES]
    if unknown:
        raise SettingError(
            f"A shape of weather must be one of {', '.join(SHAPES)}, but it is {unknown[0]!r}."
        )
    weeks = [name for name in shapes if SHAPES[name].warmer_c]
    least = _WEEK.start + 2
    if weeks and n_days < least:
        raise SettingError(
            f"A season with a {weeks[0]} must have {least} days or more, for it begins on day "
            f"{least - 1} and a night shows on the next, but it has {n_days}. Give more days, or "
            "another shape: as usual, steady wind."
        )


def changes_nothing(pest: Pest) -> tuple[str, ...]:
    """Return what of the weather changes nothing of a pest, in sentences."""
    moves, said = pest.movement, []
    if not pest.stages and (pest.increase is None or moves.at_c is None):
        said.append(
            "Warmth changes nothing of this pest: its file has no stages, and no increase or no "
            "at_c of movement."
        )
    if moves.wind == "none" or moves.kernel == "adjacent":
        said.append("Wind changes nothing of this pest: it does not go with it.")
    return tuple(said)


def paired_seasons(pest: Pest, shape: Shape, seed: int, n_days: int) -> KnownOrNot:
    """Return what a season comes to for one that knows the weather and for one that does not."""
    streams = RandomStreams(seed)
    pest_in_weather = PestInWeather(pest, season_weather(shape, streams, n_days + 1), _BEGINS)
    averages = PestInWeather(pest, usual_weather(), _BEGINS)
    start = _grown(pest, streams)
    columns = []
    for believed in (pest_in_weather, averages):
        settings = SimulationSettings(n_days=n_days, pest=pest_in_weather, believed_pest=believed)
        columns.append(_season(start, settings, streams))
    (knows, held), (other, held_by_averages) = columns
    return KnownOrNot(knows, other, held, held_by_averages)


def season_weather(shape: Shape, streams: RandomStreams, n_days: int) -> Weather:
    """Return the daily weather of a season of some shape, drawn from the stream ``weather``."""
    draws = streams.of("weather").normal(0.0, _DIFFERS_C, n_days)
    off = np.zeros(n_days)
    for day in range(n_days):
        off[day] = draws[day] + (_STAYS * off[day - 1] if day else 0.0)
    off[_WEEK] += shape.warmer_c
    return _daily(off, shape.wind_m_s)


def usual_weather() -> Weather:
    """Return the averages of the place, and no wind."""
    return _daily(np.zeros(1), 0.0)


def _daily(off_c: Floats, wind_m_s: float) -> Weather:
    days = np.datetime64(_BEGINS, "D") + np.arange(len(off_c))
    return weather_of(
        days.astype("datetime64[s]"),
        DAY_S,
        low_c=_LOW_C + off_c,
        high_c=_HIGH_C + off_c,
        wind_speed_m_s=np.full(len(off_c), wind_m_s),
        wind_from_deg=np.full(len(off_c), 270.0),
    )


@cache
def _aisles() -> Aisles:
    return Aisles.of(rectangle(_SIDE, _SIDE))


def _grown(pest: Pest, streams: RandomStreams) -> Start:
    """Draw a first morning: groups that came from one plant each, as the pest moves."""
    grid, draws = _aisles().grid, streams.of("start")
    wanted = round(_SHARE * len(grid))
    infested = np.zeros(len(grid), np.bool_)
    infested[draws.choice(len(grid), max(1, wanted // _TOGETHER), replace=False)] = True
    for turn in range(_MOST_GROWN):
        if np.count_nonzero(infested) >= wanted:
            break
        colonies = Colonies.grown(grid, replace(pest, stages=()), infested)
        infested = colonies.after(Spell(0.0, (), _GROWS), streams.key("grown", turn)).infested
    return Start(infested, np.full(len(grid), infested.mean()))


def _season(
    start: Start, settings: SimulationSettings, streams: RandomStreams
) -> tuple[int, NDArray[np.bool_]]:
    """Return a season's infested plant-days, and on which mornings the interval held."""
    aisles, lost, held = _aisles(), 0, []
    robot = seen_in_weather(Robot(hours=6.0).with_times("thesis"), settings.pest)
    season = simulated_days(aisles, robot, sampler("adaptive"), start, settings, streams)
    for day in season:
        lost += day.left
        held.append(_holds(aisles.grid, day.belief, int(np.count_nonzero(day.infested))))
    return lost, np.array(held)


def _holds(grid: PlantGrid, belief: Belief, number: int) -> bool:
    made = estimate_of(grid, belief)
    return made.low <= number <= made.high


def _worth(name: str, seasons: Sequence[KnownOrNot]) -> WorthOfWeather:
    knows = np.array([each.knows for each in seasons], float)
    averages = np.array([each.averages for each in seasons], float)
    return WorthOfWeather(
        name,
        float(knows.mean()),
        float(averages.mean()),
        summary_statistics(knows / np.maximum(averages, 1.0)),
        float(np.concatenate([each.held for each in seasons]).mean()),
        float(np.concatenate([each.held_by_averages for each in seasons]).mean()),
    )
