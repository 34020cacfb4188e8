"""The samplers on maps of plants whose truth is known."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import ObservationError, SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.robot import Robot
from fieldmon.studies.plant_maps import PlantMap
from fieldmon.studies.thesis.chapter5.mapped_plots import (
    SHARES_PCT,
    MapRules,
    inspect,
    run_maps,
)
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS

SURE = MapRules(Robot(detection=1.0), Spread(0.3, "one"))


def mapped(*infested, n_rows=10, n_plants=20):
    states = np.zeros((len(infested), n_rows * n_plants), bool)
    for day, plants in enumerate(infested):
        states[day, list(plants)] = True
    dates = tuple(str(k) for k in range(len(infested)))
    return PlantMap("made up", dates, states, np.ones_like(states), n_rows, n_plants, 4.0, 3.0)


@pytest.mark.parametrize("name", SAMPLERS)
def test_a_day_for_all_finds_all_when_looking_is_sure(name):
    plants = mapped([0, 50, 199])
    curve = inspect(plants, plants.aisles(), name, SURE, RandomStreams(1))[0]
    assert (curve[0], curve[-1]) == (0.0, 100.0)
    assert (np.diff(curve) >= 0).all()


def test_naive_finds_in_the_order_of_its_rows():
    plants = mapped([9, 10, 180])
    curve = inspect(plants, plants.aisles(), "naive", SURE, RandomStreams(1))[0]
    assert curve[SHARES_PCT == 5.0] == pytest.approx(100 / 3)
    assert curve[SHARES_PCT == 10.0] == pytest.approx(200 / 3)
    assert curve[SHARES_PCT == 95.0] == pytest.approx(200 / 3)


def test_dynamic_goes_to_the_records_first():
    plants = mapped([150, 151, 152, 170, 171])
    rules = replace(SURE, recorded_share=1.0)
    curve = inspect(plants, plants.aisles(), "dynamic", rules, RandomStreams(1))[0]
    assert curve[SHARES_PCT == 5.0] == 100.0


@pytest.mark.parametrize("name", SAMPLERS)
def test_what_is_found_is_gone_on_later_dates(name):
    plants = mapped([3, 4], [3, 4, 5])
    first, second = inspect(plants, plants.aisles(), name, SURE, RandomStreams(1))
    assert first[-1] == 100.0
    steps = np.unique(second)
    assert steps.tolist() == [0.0, 100.0]


def test_a_short_day_has_no_figure_beyond_its_end():
    plants = mapped([3])
    rules = replace(SURE, robot=Robot(hours=1.0))
    curve = inspect(plants, plants.aisles(), "naive", rules, RandomStreams(1))[0]
    assert np.isnan(curve[-1])
    assert not np.isnan(curve[1])


def test_rows_of_the_table_come_a_map_date_and_sampler():
    table = run_maps([mapped([3], [3, 4])], SURE, seeds=3)
    assert len(table) == 2 * len(SAMPLERS) * len(SHARES_PCT)
    assert {(row.date, row.infested) for row in table} == {("0", 1), ("1", 2)}


def test_where_no_plant_is_infested_no_share_is_found():
    rows = run_maps([mapped([3], [])], SURE, seeds=2)
    assert {row.seeds > 0 for row in rows if row.date == "0"} == {True}
    assert {(row.seeds, str(row.mean)) for row in rows if row.date == "1"} == {(0, "nan")}


def test_maps_and_rules_that_do_not_fit_are_refused():
    with pytest.raises(ObservationError, match="one entry a plant"):
        PlantMap("bad", ("1",), np.zeros((1, 3), bool), np.ones((1, 3), bool), 2, 2, 1.0, 1.0)
    with pytest.raises(SettingError, match="recorded_share"):
        replace(SURE, recorded_share=2.0)


def test_plants_of_unknown_state_are_not_visited_and_count_in_no_share():
    plants = mapped((5,), n_rows=2, n_plants=10)
    half = np.arange(20)[None] % 2 == 1
    plants = replace(plants, known=half)
    curve = inspect(plants, plants.aisles(), "naive", SURE, RandomStreams(1))[0]
    # plant 5 is the third of ten
    assert curve.tolist() == [0.0] * 6 + [100.0] * 15
