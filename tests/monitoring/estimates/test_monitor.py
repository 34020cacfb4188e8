"""Ask and tell: the same day as the compiled one, plant by plant."""

from dataclasses import astuple
from datetime import date

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring.estimates.monitor import Monitor
from fieldmon.monitoring.season.season_file import Season
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.pests.weather import DAY_S, weather_of
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import Sampler, Stops
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start

SEED = 5
SPREAD = Spread(rate_per_day=0.2, arrivals_per_day=0.001)


@pytest.fixture(scope="module")
def plot():
    grid = rectangle(12, 20, Planting())
    return Plot(Field("square", grid.frame.geometry_lonlat(grid.drivable_m)), Aisles.of(grid))


@pytest.fixture(scope="module")
def start(plot):
    rng = np.random.default_rng(1)
    chance = rng.uniform(0.005, 0.3, len(plot.grid))
    return Start(rng.random(len(chance)) < chance, chance)


def compiled(plot, name, robot, start):
    settings = SimulationSettings(n_days=2, spread=SPREAD, learning=None)
    return list(
        simulated_days(plot.aisles, robot, sampler(name), start, settings, RandomStreams(SEED))
    )


# each returns to the gate or stays out, and two of them do both
@pytest.mark.parametrize(
    ("name", "returns"),
    [
        *((name, k % 2 == 0) for k, name in enumerate(SAMPLERS)),
        ("naive", False),
        ("dynamic", False),
    ],
)
def test_a_season_asked_and_told_is_the_compiled_one_stop_for_stop(plot, start, name, returns):
    robot = Robot(hours=0.4, returns=returns)
    monitor = Monitor(plot, name, robot, start.chance, BeliefSettings(spread=SPREAD), SEED)
    some_found = 0
    for simulated in compiled(plot, name, robot, start):
        assert np.array_equal(monitor.chance, simulated.chance)
        truth = dict(zip(simulated.work.plant.tolist(), simulated.work.found.tolist(), strict=True))
        asked = []
        with monitor.day() as day:
            while (stop := day.ask()) is not None:
                asked.append(stop)
                day.tell(found=truth[stop.plant])
        assert [stop.plant for stop in asked] == simulated.work.plant.tolist()
        assert [stop.arrive_s for stop in asked] == simulated.work.arrive_s.tolist()
        assert [stop.inspect_s for stop in asked] == simulated.work.stop_s.tolist()
        assert np.array_equal(day.found, simulated.work.found)
        some_found += int(day.found.sum())
        monitor.night()
    assert some_found > 0


def test_a_plant_that_cannot_be_inspected_stays_unknown_and_is_not_asked_for_again(plot):
    monitor = Monitor(plot, robot=Robot(hours=1))
    before = monitor.chance.copy()
    with monitor.day() as day:
        skipped = day.ask().plant
        day.tell(found=None)
        rest = []
        while (stop := day.ask()) is not None:
            rest.append(stop.plant)
            day.tell(found=False)
    assert skipped not in rest
    assert skipped not in day.plants
    assert monitor.last_inspected[skipped] == -1
    assert monitor.last_inspected[rest].tolist() == [0] * len(rest)
    assert monitor.chance[rest].max() < before[rest].max()


@pytest.mark.parametrize("name", ["adaptive", "dynamic", "naive", "decide"])
def test_plants_that_are_gone_are_asked_for_again_ever_more_seldom(plot, name):
    robot = Robot(hours=0.25)
    monitor = Monitor(plot, name, robot)
    gone = np.zeros(plot.n_plants, np.bool_)
    gone[Monitor(plot, name, robot).plan().route.plant[::3]] = True
    asked = {plant: [] for plant in np.flatnonzero(gone).tolist()}
    for number in range(12):
        left_out = monitor.left_out
        with monitor.day() as day:
            while (stop := day.ask()) is not None:
                assert not left_out[stop.plant]
                day.tell(None if gone[stop.plant] else False)
                if gone[stop.plant]:
                    asked[stop.plant].append(number)
        assert monitor.left_out[day.skipped].all()
        assert not monitor.left_out[~gone].any()
        monitor.night()
        assert monitor.left_out[day.skipped].all()
    assert max(map(len, asked.values())) >= 1
    for days in asked.values():
        assert all(gap > 2**k for k, gap in enumerate(np.diff(days).tolist()))


def test_a_robot_that_is_slower_than_charged_visits_fewer_plants_and_never_ends_late(plot):
    robot = Robot(hours=1)
    whole = len(Monitor(plot, "naive", robot).plan().route)
    clock = 0.0
    with Monitor(plot, "naive", robot).day() as day:
        while (stop := day.ask()) is not None:
            assert stop.arrive_s >= clock
            clock = stop.arrive_s + stop.inspect_s + 30.0
            day.tell(found=False, at_s=clock)
    assert 0 < len(day.plants) < whole
    assert clock <= robot.day_s + 30.0


def test_what_was_told_before_an_error_is_learnt(plot):
    monitor = Monitor(plot, robot=Robot(hours=1))
    day = monitor.day()
    plant = day.ask().plant
    day.tell(found=True)
    with pytest.raises(ZeroDivisionError), day:
        assert 1 / 0
    assert monitor.last_inspected[plant] == 0


def test_days_and_nights_take_turns(plot):
    monitor = Monitor(plot)
    with monitor.day():
        with pytest.raises(SettingError, match="before the night"):
            monitor.night()
        with pytest.raises(SettingError, match="night"):
            monitor.day()
    monitor.night()
    assert monitor.day_number == 1
    assert "day 2" in repr(monitor)


class Nobody(Sampler):
    """It goes nowhere."""

    def walk(self, scene, would_find):  # noqa: ARG002 - the protocol's
        return Stops(np.empty(0, np.int32), np.empty(0))


def test_a_sampler_that_names_no_plant_on_the_first_day_is_refused_as_in_a_plan(plot):
    day = Monitor(plot, Nobody(), Robot(hours=1)).day()
    with pytest.raises(SettingError, match="Nobody must name plants to inspect"):
        day.ask()
    later = Monitor(plot, "naive", Robot(hours=1))
    with later.day() as day:
        day.ask()
        day.tell(found=False)
    later.night()
    scene = later.day()._scene
    assert Monitor(plot, Nobody()).day_in(scene).ask() is None


def test_nothing_is_told_after_the_day_for_nobody_would_learn_it(plot):
    monitor = Monitor(plot, robot=Robot(hours=1))
    with monitor.day() as day:
        asked = day.ask()
    with pytest.raises(ObservationError, match="told of before its day ends"):
        day.tell(found=True)
    assert not len(day.plants)
    assert monitor.last_inspected[asked.plant] == -1


def test_what_is_believed_is_read_and_not_written_to(plot):
    monitor = Monitor(plot, robot=Robot(hours=1))
    for held in (monitor.chance, monitor.last_inspected):
        with pytest.raises(ValueError, match="read-only"):
            held[0] = 1
    assert monitor.chance[0] < 1


@pytest.mark.parametrize("chance", [np.zeros(3), np.full(240, 2.0)])
def test_a_chance_map_that_does_not_fit_is_refused(plot, chance):
    with pytest.raises(SettingError, match="240"):
        Monitor(plot, chance=chance)


def test_a_robot_that_can_find_nothing_is_refused_as_in_a_plan(plot):
    said = "An inspection must be able to find something, but 5 s at a plant find 0 %"
    with pytest.raises(SettingError, match=said):
        Monitor(plot, robot=Robot(look_s=5))


def test_finds_that_are_only_flagged_stay_infested(plot):
    monitor = Monitor(plot, robot=Robot(hours=1), belief_settings=BeliefSettings(treated=False))
    with monitor.day() as day:
        plant = day.ask().plant
        day.tell(found=True)
    assert monitor.chance[plant] > 0.99
    assert Learning().treated
    assert monitor.estimate().chance_clean == 0.0
    assert monitor.estimate().sentence().endswith("only flagged; the chance that the plot is "
                                                  "clean is 0 %.")  # fmt: skip


@pytest.mark.parametrize(
    ("name", "treated"),
    [("adaptive", True), *((name, False) for name in ("adaptive", "dynamic", "naive", "decide"))],
)
def test_a_plant_known_to_be_infested_is_not_asked_for_again(plot, name, treated):
    """It was for ever, and took a third of the day's inspections."""
    settings = BeliefSettings(treated=treated)
    monitor = Monitor(plot, name, Robot(hours=0.3), belief_settings=settings)
    found = np.zeros(len(plot.grid), np.bool_)
    for _ in range(3):
        assert (monitor.left_out == (found & (not treated))).all()
        with monitor.day() as day:
            while (stop := day.ask()) is not None:
                day.tell(found=stop.plant % 3 == 0)
        assert len(day.plants) > 10
        assert treated or not found[day.plants].any()
        found[day.plants[day.found]] = True
        monitor.night()


def test_the_robot_stands_at_the_last_plant_that_was_told_of(plot):
    with Monitor(plot, robot=Robot(hours=1)).day() as day:
        assert day.at == GATE
        for found in (False, None, True):
            plant = day.ask().plant
            day.tell(found=found)
            assert day.at == plant


@pytest.mark.parametrize("name", SAMPLERS)
def test_the_plants_ahead_are_those_asked_for_while_nothing_is_found(plot, start, name):
    with Monitor(plot, name, Robot(hours=0.25), start.chance).day() as day:
        assert day.ahead(3) == []  # nothing was asked for yet
        first = day.ask()
        some, rest = day.ahead(3), day.ahead(10**6)
        assert some == rest[:3]
        assert len(rest) > 3
        asked = [first.plant]
        day.tell(found=False)
        assert day.ahead(3) == []
        while (stop := day.ask()) is not None:
            assert day.ahead(10**6) == rest[len(asked) :]
            asked.append(stop.plant)
            day.tell(found=False)
        assert asked == [first.plant, *rest]


@pytest.mark.parametrize("over_s", [-30.0, 0.0, 5000.0])
def test_nothing_is_asked_for_once_the_hours_are_gone_by_the_robots_own_clock(plot, over_s):
    robot = Robot(hours=1.0)
    with Monitor(plot, sampler="naive", robot=robot).day() as day:
        day.ask()
        day.tell(found=False, at_s=robot.day_s + over_s)
        assert day.gone_s == robot.day_s + over_s
        assert day.ask() is None
        assert day.ahead(3) == []
        assert len(day.plants) == 1


def test_a_day_that_goes_on_anew_leaves_out_what_was_told_of_and_has_what_is_left(plot):
    monitor = Monitor(plot, sampler="naive", robot=Robot(hours=1.0))
    with monitor.day() as day:
        for k in range(6):
            stop = day.ask()
            assert stop is day.ask()
            day.tell(None if k == 2 else k == 4, at_s=stop.arrive_s + stop.inspect_s + 40.0)
            assert day.gone_s == stop.arrive_s + stop.inspect_s + 40.0
            follows = day.ask()
            assert follows.arrive_s >= day.gone_s
            assert follows.plant not in day.plants
            assert day.at == stop.plant
        assert len(set(day.plants.tolist())) == len(day.plants) == 5
        assert day.found.tolist() == [False, False, False, True, False]
        assert day.detects.tolist() == [monitor.robot.detects] * 5
        assert repr(day) == "<MonitorDay: 5 inspected, 1 found>"
    assert day.ask() is None
    with pytest.raises(ObservationError, match="before its day ends"):
        day.tell(found=True)  # it was asked for, and would be lost
    assert len(day.plants) == 5
    assert "day 1>" in repr(monitor)
    monitor.night()
    assert "day 2>" in repr(monitor)
    assert np.flatnonzero(monitor.last_inspected >= 0).tolist() == sorted(day.plants.tolist())
    assert set(monitor.last_inspected[day.plants].tolist()) == {0}


@pytest.mark.parametrize("treated", [True, False])
def test_it_tells_what_a_season_with_the_same_results_tells(tmp_path, plot, treated):
    """The map of the evening, how many there are, whether to treat, and what is ahead."""
    belief, robot, on = BeliefSettings(treated=treated), Robot(hours=1.0), date(2026, 4, 6)
    first = np.full(len(plot.grid), 0.02)
    monitor = Monitor(plot, "naive", robot, first, belief)
    season = Season.create(
        tmp_path / "s.gpkg", plot, risk=first, begins=on, robot=robot, belief=belief,
        sampler="naive", prior=PriorSettings(0.0, edge_chance=0.0, path_chance=0.0),
    )  # fmt: skip
    assert astuple(monitor.estimate()) == pytest.approx(astuple(season.status(on).estimate))
    assert monitor.verdict(0.9).verdict == season.verdict(on, 0.9).verdict == "inspect more"
    with monitor.day() as day:
        while (stop := day.ask()) is not None:
            day.tell(found=stop.plant % 9 == 0)
    season.record(
        Inspections.of(day.plants, day.found.astype(np.int8), np.datetime64(on, "D")), "x"
    )
    assert monitor.chance == pytest.approx(season.evening(on), abs=1e-9)
    assert astuple(monitor.estimate()) == pytest.approx(astuple(season.status(on).estimate))
    assert monitor.verdict(0.05).chance_above == season.verdict(on, 0.05).chance_above
    assert monitor.verdict(0.9).verdict == "do not treat"
    assert monitor.forecast().high.tolist() == season.forecast(on).high.tolist()
    assert monitor.estimate(0.5).high < monitor.estimate().high


def test_a_pest_in_its_weather_is_believed_as_a_season_believes_it(tmp_path, plot):
    robot, on = Robot(hours=1.0), date(2026, 4, 6)
    days = np.arange("2026-04-01", "2026-04-12", dtype="datetime64[D]").astype("datetime64[s]")
    weather = weather_of(days, DAY_S, temperature_c=np.full(len(days), 24.0))
    first, mite = np.full(len(plot.grid), 0.02), shipped_pest("spider-mite")
    monitor = Monitor(plot, "naive", robot, first, pest=PestInWeather(mite, weather, on))
    season = Season.create(
        tmp_path / "s.gpkg", plot, risk=first, begins=on, robot=robot, pest=mite, weather=weather,
        sampler="naive", prior=PriorSettings(0.0, edge_chance=0.0, path_chance=0.0),
    )  # fmt: skip
    with monitor.day() as day:
        while (stop := day.ask()) is not None:
            day.tell(found=stop.plant % 9 == 0)
    season.record(
        Inspections.of(day.plants, day.found.astype(np.int8), np.datetime64(on, "D")), "x"
    )
    assert monitor.forecast().high.tolist() == season.forecast(on).high.tolist()
    assert monitor.forecast().sentence() == season.forecast(on).sentence()
    monitor.night()
    assert monitor.chance == pytest.approx(season.evening(date(2026, 4, 7)), abs=1e-9)
    without = Monitor(plot, "naive", robot, first)
    assert not np.allclose(without.forecast().expected, monitor.forecast().expected)
    with pytest.raises(SettingError, match="A pest needs its finds traced"):
        Monitor(plot, belief_settings=BeliefSettings(traces=False), pest=PestInWeather(mite))
