"""Many working days while the insects spread."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import PlotError, SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers import SAMPLERS, sampler
from fieldmon.samplers.base import NEVER
from fieldmon.simulation.metrics import season_metrics
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from tests.thorough import seeds

AISLES = Aisles.of(rectangle(20, 20))
N = 400
NAMES = sorted(SAMPLERS)


def start(share=0.02, seed=3):
    infested = RandomStreams(seed).of("start").random(N) < share
    return Start(infested, np.full(N, share))


def season(name="naive", robot=None, settings=None, seed=3, first=None):
    robot = robot or Robot(hours=2.0)
    settings = settings or SimulationSettings(n_days=6, spread=Spread(0.2))
    return list(
        simulated_days(
            AISLES, robot, sampler(name), first or start(), settings, RandomStreams(seed)
        )
    )


@cache
def usual_season(name):
    """Return a season for tests that only look at it."""
    return season(name)


@pytest.mark.parametrize("name", NAMES)
def test_the_same_seed_gives_the_same_season(name):
    """A shorter season is the beginning of a longer one."""
    short = season(name, settings=SimulationSettings(n_days=3, spread=Spread(0.2)))
    for one, other in zip(usual_season(name)[:3], short, strict=True):
        assert (one.work.plant == other.work.plant).all()
        assert (one.infested == other.infested).all()
        assert (one.chance == other.chance).all()


def test_who_stays_where_a_day_ends_begins_the_first_at_the_gate():
    stays, comes_back = (
        season(robot=Robot(hours=2.0, returns=returns)) for returns in (False, True)
    )
    for first in (stays[0].work, comes_back[0].work):
        assert first.plant[0] == stays[0].work.plant[0]
        assert first.arrive_s[0] == comes_back[0].work.arrive_s[0]
    assert stays[1].work.arrive_s[0] < comes_back[1].work.arrive_s[0]


def test_another_seed_gives_another_season():
    assert any(
        (a.infested != b.infested).any()
        for a, b in zip(usual_season("naive"), season(seed=4), strict=True)
    )


def test_all_samplers_meet_the_same_insects():
    mornings = [usual_season(name)[0].infested for name in NAMES]
    assert all((mornings[0] == other).all() for other in mornings)
    blind = Robot(hours=2.0, detection=0.0)
    # who chooses how long to look needs a robot that says what looking longer brings
    settings = SimulationSettings(n_days=3, spread=Spread(0.2))
    ends = [
        season(name, blind, settings)[-1].infested for name in NAMES if name != "adaptive-looks"
    ]
    assert all((ends[0] == other).all() for other in ends)


@pytest.mark.parametrize("name", NAMES)
def test_only_infested_plants_are_found_and_found_insects_are_destroyed(name):
    for today, tomorrow in pairwise(usual_season(name)):
        finds = today.work.plant[today.work.found]
        assert today.infested[finds].all()
        cleared = np.zeros(N, bool)
        cleared[finds] = True
        stayed = today.infested & ~cleared
        assert tomorrow.infested[stayed].all()


@pytest.mark.parametrize("name", NAMES)
def test_the_figures_of_every_day_add_up(name):
    found, before = 0, None
    for day in usual_season(name):
        found += day.found
        assert day.ever_found == found
        assert day.ever_infested == found + day.left
        assert 0 <= day.detection_pct <= 100
        assert day.visited_pct == pytest.approx(100 * len(day.work) / N)
        assert day.ever_visited_pct >= (before.ever_visited_pct if before else 0)
        before = day


def test_perfect_looking_with_time_for_all_clears_a_field_at_once():
    robot = Robot(hours=24.0, detection=1.0)
    (first, second) = season(robot=robot, settings=SimulationSettings(n_days=2))
    assert (first.detection_pct, first.left) == (100.0, 0)
    assert not second.infested.any()


def test_missed_insects_are_found_at_the_stated_rate():
    robot = Robot(hours=24.0, detection=0.6)
    infested = Start(np.ones(N, bool), np.full(N, 0.5))
    found = [
        season(robot=robot, settings=SimulationSettings(n_days=1), seed=s, first=infested)[0].found
        for s in seeds(12, 40)
    ]
    assert np.mean(found) == pytest.approx(0.6 * N, rel=0.03)


def test_a_robot_that_stays_out_goes_on_where_it_stopped():
    robot = Robot(hours=1.0, returns=False)
    one, two = season(robot=robot)[:2]
    assert abs(int(two.work.plant[0]) - int(one.work.plant[-1])) in (1, 20)
    assert two.work.arrive_s[0] < 60


def test_a_season_can_be_left_half_way():
    settings = SimulationSettings(n_days=3650)
    walk = simulated_days(
        AISLES, Robot(hours=1.0), sampler("naive"), start(), settings, RandomStreams(1)
    )
    assert [next(walk).number for _ in range(3)] == [0, 1, 2]


def test_a_field_without_insects_is_fully_detected():
    nothing = Start(np.zeros(N, bool), np.full(N, 0.01))
    assert all(day.detection_pct == 100.0 for day in season(first=nothing))


def test_a_start_of_another_plot_is_refused():
    with pytest.raises(PlotError, match="one entry a plant"):
        season(first=Start(np.zeros(3, bool), np.zeros(3)))


def test_a_season_of_no_days_is_refused():
    with pytest.raises(SettingError, match="n_days must be 1 or more"):
        SimulationSettings(n_days=0)


def test_what_was_believed_on_a_morning_does_not_depend_on_when_one_asks():
    asked_daily = [day.chance for day in season("naive")]
    later = season("naive")
    for number in (3, 1, 5, 0):
        assert (later[number].chance == asked_daily[number]).all()
    assert any((one != other).any() for one, other in pairwise(asked_daily))


def test_a_new_infestation_that_hides_is_not_found_before_it_shows():
    everything = Robot(hours=24.0, detection=1.0)
    settings = SimulationSettings(n_days=7, spread=Spread(0.3), hidden_nights=3)
    days = season(robot=everything, settings=settings)
    assert days[0].found == days[0].infested.sum() > 0
    assert [day.found for day in days[1:]] == [0] * 6
    fresh = np.zeros(N, np.bool_)
    fresh[210] = True
    poor = season(robot=Robot(hours=24.0, detection=0.0), settings=settings,
                  first=Start(fresh, np.full(N, 0.02)))  # fmt: skip
    assert poor[-1].infested.sum() > 5


def test_pests_may_do_what_is_not_believed():
    def all_over(grid, infested, key):
        return infested | (np.arange(len(grid)) % 20 == key % np.uint64(20))

    days = season(settings=SimulationSettings(n_days=3, spread=Spread(0.0), own_night=all_over))
    assert days[2].infested.sum() >= 20


def test_unless_told_insects_show_at_once_and_the_map_knows_of_the_spread_that_is():
    told, plain = SimulationSettings(hidden_nights=0), SimulationSettings()
    assert plain == told
    spread, other = Spread(0.3), Spread(0.1)
    grid = AISLES.grid
    assert SimulationSettings(spread=spread).believed_night(grid)(0) is spread
    assert SimulationSettings(spread=spread, believed_spread=other).believed_night(grid)(0) is other


def test_a_level_that_is_reached_exactly_counts_as_reached():
    metrics = season_metrics(season(robot=Robot(hours=24.0, detection=1.0)))
    assert metrics.detection_pct[0] == 100.0
    assert metrics.first_day(100.0) == 1


def test_plants_visited_on_the_first_day_are_visited():
    days = usual_season("naive")
    seen = np.zeros(N, bool)
    for day in days:
        seen[day.work.plant] = True
        assert day.ever_visited_pct == pytest.approx(100 * seen.mean())
    assert days[0].ever_visited_pct == days[0].visited_pct > 0


class _Watched:
    """A sampler that notes the scene in which each day begins."""

    def __init__(self, name):
        self.own, self.scenes = sampler(name), []

    def __getattr__(self, name):
        return getattr(self.own, name)

    def walk(self, scene, would_find):
        self.scenes.append(scene)
        return self.own.walk(scene, would_find)


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize(("name", "hours"), [("naive", 1.0), ("dynamic", 1.0), ("naive", 0.004)])
def test_each_morning_begins_with_what_the_days_before_it_left(name, hours, returns):
    watched, robot = _Watched(name), Robot(hours=hours, returns=returns)
    settings = SimulationSettings(n_days=4, spread=Spread(0.2))
    days = list(simulated_days(AISLES, robot, watched, start(), settings, RandomStreams(3)))
    keys = RandomStreams(3).keys("sampler")
    trail, last = [], np.full(N, NEVER)
    for number, (scene, day, key) in enumerate(zip(watched.scenes, days, keys, strict=False)):
        assert (scene.day, day.number, scene.key) == (number, number, key)
        assert scene.trail.tolist() == trail
        assert scene.at == (trail[-1] if trail and not returns else GATE)
        assert scene.seconds_left == robot.day_s
        assert scene.last_inspected.tolist() == last.tolist()
        trail = day.work.plant.tolist() or trail
        last[day.work.plant] = number
        assert day.last_inspected.tolist() == last.tolist()
    assert len(watched.scenes) == len(days) == 4
    assert bool(trail) == (hours > 0.01)


@pytest.mark.parametrize("name", NAMES)
def test_between_visits_nobody_inspects_and_insects_go_on(name):
    weekly = season(name, settings=SimulationSettings(5, Spread(0.2), visit_every=4))
    assert [day.visit for day in weekly] == [0, None, None, None, 1]
    for day in weekly:
        assert (len(day.work) > 0) == (day.worked_s > 0) == (day.visit is not None)
    assert weekly[3].ever_infested > weekly[0].ever_infested
    assert weekly[3].left > weekly[0].left
    # the first visit is that of a season with one a day
    assert (usual_season(name)[0].work.plant == weekly[0].work.plant).all()


def test_all_samplers_meet_the_same_insects_on_the_same_visits():
    settings = SimulationSettings(5, Spread(0.2), visit_every=2)
    blind = Robot(hours=2.0, detection=0.0)
    # who finds nothing changes nothing: nights do not know of visits
    daily = season("naive", blind, replace(settings, visit_every=1))[-1].infested
    for name in ("naive", "dynamic", "adaptive"):
        assert (season(name, blind, settings)[-1].infested == daily).all()


def test_a_sweep_goes_on_where_the_last_visit_ended():
    one, _, two = season(settings=SimulationSettings(3, visit_every=2))
    assert not np.isin(two.work.plant, one.work.plant).any()
    daily = season(settings=SimulationSettings(2))
    assert two.work.plant.tolist() == daily[1].work.plant.tolist()


def test_what_is_believed_between_visits_is_what_nights_make_of_it():
    days = season("adaptive", settings=SimulationSettings(4, Spread(0.2), visit_every=3))
    assert days[2].chance.sum() > days[1].chance.sum()


def test_a_visit_every_no_days_is_refused():
    with pytest.raises(SettingError, match="visit_every must be 1 or more"):
        SimulationSettings(visit_every=0)


@pytest.mark.parametrize(
    ("name", "left", "found"),
    [("naive", [2, 1, 0, 0, 0, 0], [4, 3, 2, 0, 0, 0]),
     ("adaptive", [4, 3, 3, 2, 1, 0], [2, 4, 3, 3, 2, 1])],
)  # fmt: skip
def test_a_visit_a_day_is_what_it_was_before_visits_could_be_apart(name, left, found):
    days = usual_season(name)
    assert [day.left for day in days] == left
    assert [day.found for day in days] == found
    assert [day.visit for day in days] == [*range(6)]
