"""The situations in which samplers are compared."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.pests.pest import Pest
from fieldmon.plot.robot import Robot
from fieldmon.studies.samplers.scenarios import (
    PRIORS,
    SIDES,
    STARTS,
    Scenario,
    all_scenarios,
    in_worlds,
    usual_scenarios,
    with_pest,
)


@pytest.mark.parametrize("start", STARTS)
def test_a_season_starts_with_the_share_of_infested_plants_that_it_says(start):
    starts = [Scenario("B", start=start).draw_start(RandomStreams(s)) for s in range(20)]
    assert np.mean([s.infested.mean() for s in starts]) == pytest.approx(0.015, rel=0.15)


@pytest.mark.parametrize("prior", PRIORS)
def test_a_prior_expects_about_as_many_as_there_are(prior):
    start = Scenario("B", prior=prior).draw_start(RandomStreams(3))
    assert start.chance.mean() == pytest.approx(0.015, rel=0.5)
    assert ((start.chance > 0) & (start.chance < 1)).all()


def test_what_is_known_does_not_change_where_the_insects_are():
    first = Scenario("B").draw_start(RandomStreams(5)).infested
    for prior in PRIORS:
        assert (Scenario("B", prior=prior).draw_start(RandomStreams(5)).infested == first).all()


def test_clusters_hang_together_and_scattered_plants_do_not():
    grid = Scenario("B").aisles.grid
    row = np.repeat(np.arange(len(grid)), np.diff(grid.adjacent.start))

    def size(start):
        infested = Scenario("B", start=start).draw_start(RandomStreams(1)).infested
        both = infested[row] & infested[grid.adjacent.plant]
        links = coo_matrix(
            (np.ones(both.sum()), (row[both], grid.adjacent.plant[both])), shape=[len(grid)] * 2
        )
        return infested.sum() / (connected_components(links)[0] - (~infested).sum())

    assert size("clusters") > 5
    assert size("scattered") < 1.5


def test_records_point_to_infested_plants_and_a_wrong_prior_to_a_quarter():
    told = Scenario("B", prior="records 5 %")
    chances = [told.draw_start(RandomStreams(s)) for s in range(10)]
    known = np.mean([s.chance[s.infested].mean() / s.chance.mean() for s in chances])
    assert known > 2
    wrong = Scenario("B", prior="wrong").draw_start(RandomStreams(1)).chance
    assert (wrong > 5 * wrong.min()).mean() == pytest.approx(0.25, abs=0.02)


def test_scenarios_have_names_of_their_own_and_cover_every_level():
    everything, usual = all_scenarios(), usual_scenarios()
    assert len({each.name for each in everything}) == len(everything) > len(usual)
    assert {each.prior for each in usual} == set(PRIORS)
    assert {each.start for each in usual} == set(STARTS)
    assert {each.plot for each in usual} == set(SIDES)
    assert len(everything) == 3 * 3 * len(STARTS) * len(PRIORS) + 7


def test_a_flaw_is_in_what_is_believed_and_not_in_what_is():
    spread = Scenario(flaw="spread")
    assert spread.settings.spread == Spread(0.3, "one")
    assert spread.settings.believed_spread == Spread(0.8, "one")
    detection = Scenario(flaw="detection")
    assert detection.robot.detects == 0.5
    assert detection.settings.learning.detection == Robot().detects
    assert Scenario().settings.believed_spread is None


@pytest.mark.parametrize("levels", [{"plot": "D"}, {"start": "x"}, {"prior": "x"}, {"flaw": "x"}])
def test_an_unknown_level_is_refused(levels):
    (name,) = levels
    with pytest.raises(SettingError, match=f"The {name} must be one of"):
        Scenario(**levels)


def test_every_world_is_there_on_two_plots_with_long_and_short_days_and_none_is_usual():
    worlds = in_worlds()
    assert len({each.name for each in (*worlds, *all_scenarios())}) == 40 + len(all_scenarios())
    assert "world, B, 12 h, Cauchy" in {each.name for each in worlds}
    assert {each.robot.hours for each in worlds} == {4.0, 12.0}
    assert {each.settings.hidden_nights for each in worlds} == {0, 4}


@pytest.mark.parametrize("world", ["wind", "edges and road all season"])
def test_a_season_in_a_world_starts_with_the_same_share_in_groups_that_came_about_there(world):
    start = Scenario(world=world).draw_start(RandomStreams(2))
    assert start.infested.mean() == pytest.approx(0.015, rel=0.02)
    assert (start.chance == 0.015).all()


def test_what_is_believed_in_a_world_is_what_is_believed_elsewhere():
    world, usual = Scenario(world="Cauchy").settings, Scenario().settings
    assert (world.spread, world.learning) == (usual.spread, usual.learning)
    assert world.own_night is not None


def test_a_pest_takes_the_place_of_each_rate_and_keeps_the_rest():
    pest_in_weather = PestInWeather(Pest("mite", detection=0.5))
    made = with_pest([*all_scenarios(), *in_worlds()], pest_in_weather)
    names = [each.name for each in made]
    assert len(set(names)) == len(names) == 3 * len(STARTS) * len(PRIORS) + 2
    assert all(each.pest_in_weather is pest_in_weather and not each.world for each in made)
    assert {each.robot.detects for each in made} == {0.5}
    assert all(each.settings.pest is pest_in_weather for each in made)
    assert Scenario(pest_in_weather=PestInWeather(Pest("mite"))).name not in names
    with pytest.raises(SettingError, match="goes without a world"):
        Scenario(flaw="spread", pest_in_weather=pest_in_weather)
