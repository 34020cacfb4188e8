"""What people want of a day changes where it goes, and nothing that is believed."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.planning.plan import PlanSettings, plan_believed, plan_from
from fieldmon.planning.wishes import Wishes
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import SAMPLERS, sampler

HOUR = PlanSettings(Robot(hours=1))


@pytest.fixture(scope="module")
def plot():
    grid = rectangle(12, 40, Planting())
    return Plot(Field("Square", grid.frame.geometry_lonlat(grid.drivable_m)), Aisles.of(grid))


@pytest.fixture(scope="module")
def chance(plot):
    believed = np.full(len(plot.grid), 0.01)
    believed[:40] = 0.3  # the first row
    return believed


@pytest.fixture(scope="module")
def usual(plot, chance):
    return plan_from(plot, chance, HOUR)


@pytest.mark.parametrize("wishes", [Wishes((480,)), Wishes((), (-1,))])
def test_a_wish_for_a_plant_that_is_not_there_is_refused(plot, chance, wishes):
    with pytest.raises(SettingError, match="A plant must be 0 to 479, but it is"):
        wished(plot, chance, HOUR, wishes)


def wished(plot, chance, plans, wishes):
    return plan_believed(plot, (chance, TracedPairs.of(plot.grid, chance)), plans, wishes)


def test_wanted_plants_are_on_the_route_where_the_hours_reach_them(plot, chance, usual):
    elsewhere = np.setdiff1d(np.arange(len(plot.grid)), usual.route.plant)
    wanted = tuple(elsewhere[-3:].tolist())
    wishes = Wishes(wanted)
    route = wished(plot, chance, HOUR, wishes).route
    assert set(wanted) <= set(route.plant.tolist())
    assert not len(wishes.unmet(route))


@pytest.mark.parametrize("name", [*SAMPLERS])
def test_unwanted_plants_are_on_no_samplers_route(plot, chance, name):
    plans = PlanSettings(Robot(hours=1), sampler(name))
    gone_to = plan_from(plot, chance, plans).route.plant
    left_out = tuple(gone_to[::2].tolist())
    route = wished(plot, chance, plans, Wishes(unwanted=left_out)).route
    assert len(route)
    assert not set(left_out) & set(route.plant.tolist())


def test_what_is_believed_stays_as_it_is(plot, chance):
    day = wished(plot, chance, HOUR, Wishes((443,), (0,)))
    assert day.chance.tolist() == chance.tolist()
    assert day.route.chance.tolist() == chance[day.route.plant].tolist()


def test_what_cannot_be_reached_is_told(plot, chance):
    wishes = Wishes(tuple(range(len(plot.grid))))
    route = wished(plot, chance, HOUR, wishes).route
    unmet = wishes.unmet(route)
    assert len(unmet) == len(plot.grid) - len(route)
    assert not set(unmet.tolist()) & set(route.plant.tolist())


def test_pairs_beside_a_wanted_plant_are_as_likely_as_the_other_plant(usual):
    scene = usual.scene
    told = Wishes((100,)).applied_to(scene)
    start, second = scene.grid.adjacent
    own = slice(start[100], start[101])
    assert told.pair_chance[own] == pytest.approx(scene.chance[second[own]])
    others = np.setdiff1d(np.arange(len(second)), np.flatnonzero(second == 100))
    others = np.setdiff1d(others, np.arange(start[100], start[101]))
    assert (told.pair_chance[others] == scene.pair_chance[others]).all()


def test_no_wishes_change_nothing(plot, chance, usual):
    assert not Wishes()
    same = wished(plot, chance, HOUR, Wishes())
    assert same.route.plant.tolist() == usual.route.plant.tolist()


def test_the_last_word_on_a_plant_counts():
    wishes = Wishes().also((1, 2)).never((2, 3)).also((3,))
    assert wishes == Wishes((1, 3), (2,))
