"""A chunk of a study is seasons of the simulator, and nothing else."""

from dataclasses import replace

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.prior.prior import prior_chance, start_infested
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import Records
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.pests.weather import DAY_S, weather_of
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from fieldmon.simulation.study_plot import Combination
from fieldmon.simulation.worker import LaidPlot, RefusedPlot, simulate_chunk, simulated_season
from tests.simulation.study_plots import DAY, plot
from tests.thorough import seeds

LEVELS = Combination("dynamic", 3.0, 40.0, 0.05, 0.1)


def laid():
    one = Plot.of(plot().field, Planting())
    chance = prior_chance(one.grid, one.field, Records.none(), DAY, PriorSettings())
    return LaidPlot(one, chance)


def test_a_season_of_a_study_is_that_of_the_simulator():
    (row,) = simulate_chunk((plot(), LEVELS), range(37, 38), 4)
    one, chance, _ = laid()
    start = Start(start_infested(chance, 0.05, RandomStreams(37).of("start")), chance)
    settings = SimulationSettings(n_days=4, spread=Spread(0.1))
    season = season_metrics(
        simulated_days(
            one.aisles, Robot(hours=3.0), sampler("dynamic"), start, settings, RandomStreams(37)
        )
    )
    assert row["found_by_day"] == season.found.tolist()
    assert row["left_by_day"] == season.left.tolist()
    assert row["detection_pct"] == season.detection_pct[-1]
    assert row["infested_plant_days"] == season.infested_plant_days
    assert row["infestations"] == season.new.sum()
    assert (row["plot"], row["sampler"], row["hours"], row["seed"]) == ("plot", "dynamic", 3.0, 37)
    assert (row["days"], row["plants"]) == (4, len(one.grid))


def test_a_chunk_has_a_row_a_seed_and_does_not_depend_on_its_neighbours():
    rows = simulate_chunk((plot(), LEVELS), range(5, 9), 3)
    assert [row["seed"] for row in rows] == [5, 6, 7, 8]
    assert simulate_chunk((plot(), LEVELS), range(7, 8), 3) == rows[2:3]


def test_all_combinations_of_a_seed_start_with_the_same_insects():
    first = {}
    for name in ("naive", "bouncy", "dynamic"):
        for hours in (1.0, 3.0):
            for row in simulate_chunk(
                (plot(), Combination(name, hours, 40.0, 0.05, 0.1)), range(8), 1
            ):
                before = row["found_by_day"][0] + row["left_by_day"][0]
                assert first.setdefault(row["seed"], before) == before
    assert len(set(first.values())) > 5


def test_what_is_not_varied_is_the_robots_own():
    slow, fast = Robot(speed_m_s=0.3), Robot(speed_m_s=3.0)
    few, many = (simulated_season(laid(), robot, LEVELS, 1, (3, 1)) for robot in (slow, fast))
    assert many.visited_pct.sum() > few.visited_pct.sum()
    long, short = (
        simulated_season(laid(), fast, Combination("naive", hours, 40.0, 0.05, 0.1), 1, (3, 1))
        for hours in (3.0, 1.0)
    )
    assert long.visited_pct.sum() > short.visited_pct.sum()


def test_a_plot_without_room_comes_back_with_a_sentence():
    made = simulate_chunk((plot(1.0, "tiny"), LEVELS), range(3), 1)
    assert isinstance(made, RefusedPlot)
    assert made.name == "tiny"
    assert made.why.endswith(".")


def test_records_raise_the_chance_where_they_are():
    one, chance, _ = laid()
    made = np.array(
        [
            simulated_season(LaidPlot(one, chance), Robot(), LEVELS, s, (1, 1)).new[0]
            for s in seeds(20, 60)
        ]
    )
    assert abs(made.mean() / len(one.grid) - 0.05) < 0.01


def test_a_plot_with_a_pest_meets_that_pest_and_is_another_to_the_study():
    """At 30 °C mites multiply four times as fast as at 15: more plants are infested."""
    days = DAY + np.arange(-30, 10)

    def at(temperature_c):
        warm = np.full(len(days), float(temperature_c))
        weather = weather_of(days.astype("datetime64[s]"), DAY_S, temperature_c=warm)
        pest_in_weather = PestInWeather(shipped_pest("spider-mite"), weather, DAY.astype(object))
        return replace(plot(), pest_in_weather=pest_in_weather)

    cold, hot = at(13), at(30)
    assert len({plot().digest, cold.digest, hot.digest}) == 3
    told = Combination("naive", 0.2, 40.0, 0.05, 0.1)
    few, many = (
        sum(row["infestations"] for row in simulate_chunk((one, told), range(4), 6))
        for one in (cold, hot)
    )
    assert many > 1.2 * few
