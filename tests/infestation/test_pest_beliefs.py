"""A chance map that knows the pest and the weather, beside what the simulator makes of them."""

from dataclasses import replace
from datetime import date

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.colonies import Colonies
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.pests.pest import Increase, Movement, Pest, Stage
from fieldmon.pests.weather import weather_of
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from tests.thorough import seeds

GRID = rectangle(24, 24)
N = len(GRID)
EGG = Stage("egg", 12.5, 40.0, visible=False, mobile=False)
RUNS = seeds(60, 150)


def pest(**movement):
    given = {"kernel": "exponential", "per_day": 0.6, "reach_m": 6.0, "at_c": 30.0, **movement}
    increase = Increase((12.5, 30.0), (0.0, 0.32))
    return Pest("mite", stages=(EGG,), increase=increase, movement=Movement(**given))


def weather(temperature=30.0, wind=0.0):
    days = np.arange("2026-06-01", "2026-06-21", dtype="datetime64[D]").astype("datetime64[s]")
    k = len(days)
    return weather_of(
        days, 86_400, temperature_c=np.full(k, temperature),
        wind_speed_m_s=np.full(k, wind), wind_from_deg=np.full(k, 270.0),
    )  # fmt: skip


def believed(pest_in_weather, infested, nights):
    belief = TracedPairs.of(GRID, np.where(infested, 0.98, 1e-6)).of_pest(pest_in_weather.pest)
    for number in range(nights):
        belief = belief.overnight(pest_in_weather.spread(number, GRID.frame))
    return belief


def simulated(pest_in_weather, infested, nights):
    total = np.zeros(N)
    for seed in RUNS:
        colonies = Colonies.grown(GRID, pest_in_weather.pest, infested)
        for number in range(nights):
            key = RandomStreams(seed).key("spread", number)
            colonies = colonies.after(pest_in_weather.night(number, GRID.frame), key)
        total += colonies.infested
    return total / len(RUNS)


def some():
    infested = np.zeros(N, bool)
    infested[[5 * 24 + 6, 12 * 24 + 12, 18 * 24 + 9]] = True
    return infested


@pytest.mark.parametrize(
    ("kernel", "eggs"),
    [("exponential", True), ("exponential", False), ("cauchy", True), ("adjacent", False)],
)
def test_the_chance_map_expects_as_many_as_are_simulated(kernel, eggs):
    pest_in_weather = PestInWeather(pest(kernel=kernel, per_day=0.3), None)
    if not eggs:
        pest_in_weather = replace(pest_in_weather, pest=replace(pest_in_weather.pest, stages=()))
    said, made = (
        believed(pest_in_weather, some(), 4).chance.sum(),
        simulated(pest_in_weather, some(), 4).sum(),
    )
    # arrivals, and the candidates beside the pest's own kernel, are the chance map's own
    assert said == pytest.approx(made, rel=0.15, abs=0.5)


def test_of_adjacent_plants_it_expects_a_quarter_too_many_while_there_are_eggs():
    """It takes them to send as much beside grown plants as elsewhere; see docs/pests."""
    pest_in_weather = PestInWeather(pest(kernel="adjacent", per_day=0.3), None)
    said, made = (
        believed(pest_in_weather, some(), 4).chance.sum(),
        simulated(pest_in_weather, some(), 4).sum(),
    )
    assert made < said < 1.3 * made


def test_eggs_send_nothing_out_in_the_chance_map_either():
    """Three nights of eggs grow by sums, not by powers; without stages all send at once."""
    pest_in_weather = PestInWeather(pest(), None)
    grown = PestInWeather(Pest("grown", movement=Movement("exponential", 0.6, reach_m=6.0)), None)
    slow, fast = (believed(each, some(), 3).chance.sum() for each in (pest_in_weather, grown))
    assert slow < 0.85 * fast
    assert slow == pytest.approx(simulated(pest_in_weather, some(), 3).sum(), rel=0.15, abs=0.5)


def test_what_predators_end_the_chance_map_ends_too():
    grown = replace(pest(), stages=(), mortality_per_day=0.2)
    pest_in_weather = PestInWeather(grown, None)
    said, made = (
        believed(pest_in_weather, some(), 3).chance.sum(),
        simulated(pest_in_weather, some(), 3).sum(),
    )
    assert said == pytest.approx(made, rel=0.15, abs=0.5)


def test_nights_are_as_warm_as_they_were():
    cold, hot = (
        believed(PestInWeather(pest(), weather(t), date(2026, 6, 1)), some(), 3).chance.sum()
        for t in (14.0, 30.0)
    )
    assert cold < 0.6 * hot


def test_the_wind_carries_the_chance_map_where_it_goes():
    pest_in_weather = PestInWeather(pest(wind="with"), weather(wind=4.0), date(2026, 6, 1))
    chance = believed(pest_in_weather, some(), 2).chance
    made = simulated(pest_in_weather, some(), 2)
    x = GRID.xy_m[:, 0]
    west, east = x < x[12 * 24 + 12], x > x[12 * 24 + 12]
    near = np.abs(GRID.xy_m - GRID.xy_m[12 * 24 + 12]).max(axis=1) < 13.0
    for values in (chance, made):
        assert values[east & near].sum() > 2.0 * values[west & near].sum()


def test_a_clean_look_says_less_of_what_cannot_be_seen_yet():
    pest_in_weather = PestInWeather(pest(), None)
    morning = believed(pest_in_weather, some(), 2)
    beside = np.array([12 * 24 + 13], np.int32)
    after = morning.learn(beside, np.array([False]), Learning(0.84))
    # all of it can be seen, whatever inspections may tell
    usual = replace(TracedPairs.of(GRID, np.where(some(), 0.98, 1e-6)), latency=None)
    for _ in range(2):
        usual = usual.overnight(Spread(0.15, "each"))
    seen = usual.learn(beside, np.array([False]), Learning(0.84))
    kept = after.chance[beside] / morning.chance[beside]
    assert kept > 3.0 * seen.chance[beside] / usual.chance[beside]


def test_finds_far_from_others_are_explained_by_the_pest_s_kernel():
    """A find raises plants within the kernel's reach, downwind more than upwind."""
    pest_in_weather = PestInWeather(
        pest(wind="with", reach_m=9.0), weather(wind=6.0), date(2026, 6, 1)
    )
    belief = TracedPairs.of(GRID, np.full(N, 0.01)).of_pest(pest_in_weather.pest)
    for number in range(2):
        belief = belief.overnight(pest_in_weather.spread(number, GRID.frame))
    find = 12 * 24 + 12
    after = belief.learn(np.array([find], np.int32), np.array([True]), Learning(0.84))
    gain = after.chance - belief.chance
    assert gain[find + 3] > 0.0
    assert gain[find + 3] + gain[find - 3] > 2.0 * abs(gain[find + 4 * 24])


def test_without_a_pest_nothing_is_different():
    belief = TracedPairs.of(GRID, np.full(N, 0.02))
    assert belief.cohorts is None
    assert belief.overnight(Spread(0.1)).wind_m_s == (0.0, 0.0)
    assert not belief.known_to_jump


def test_a_day_is_planned_by_what_can_be_seen():
    """Of the plants that the last nights infested, nothing shows yet; of the others all does."""
    pest_in_weather = PestInWeather(pest(), None)
    morning = believed(pest_in_weather, some(), 2)
    seen = morning.in_sight
    hidden = morning.cohorts.hidden
    assert seen.chance == pytest.approx(np.maximum(morning.chance * (1.0 - hidden), 1e-6))
    assert seen.chance[some()] == pytest.approx(morning.chance[some()], rel=1e-3)
    assert (seen.pair_chance <= morning.pair_chance + 1e-12).all()
    usual = TracedPairs.of(GRID, np.full(N, 0.02))
    assert usual.in_sight is usual


@pytest.mark.parametrize("stages", [(), (EGG,)])
def test_a_map_that_is_told_its_pest_holds_the_number_of_insects_that_do_as_told(stages):
    """Finds tell of their relatives: before, the map expected half of them, and was sure of it."""
    kind = replace(pest(kernel="exponential", per_day=0.25, reach_m=6.0), stages=stages)
    held, expected, true, robot = [], 0.0, 0, kind.seen_by(Robot(hours=4.0))
    settings = SimulationSettings(n_days=9, pest=PestInWeather(kind))
    for seed in range(4):
        infested = np.random.default_rng(seed).random(N) < 0.03
        start = Start(infested, np.full(N, 0.03))
        belief = TracedPairs.of(GRID, start.chance).of_pest(kind)
        for day in simulated_days(
            Aisles.of(GRID), robot, sampler("naive"), start, settings, RandomStreams(seed)
        ):
            there, said = int(day.infested.sum()), estimate_of(GRID, belief)
            if day.number:
                held.append(said.low <= there <= said.high)
                expected, true = expected + said.expected, true + there
            evening = belief.learn(day.work.plant, day.work.found, Learning(robot.detects))
            belief = evening.overnight(settings.pest.spread(day.number, GRID.frame))
    assert expected > 0.75 * true
    assert np.mean(held) > 0.8
