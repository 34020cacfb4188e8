"""The three samplers on real maps of plants."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.plot.robot import Robot
from fieldmon.simulation.statistics import summary_statistics
from fieldmon.studies.plant_maps import read_plant_maps
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.mapped_plots import SHARES_PCT, MapRules, inspect, run_maps
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS

QUARTER = int(np.flatnonzero(SHARES_PCT == 25.0)[0])
RULES = MapRules(Robot().with_times("thesis"), CALIBRATED.spread)


@pytest.fixture(scope="module")
def maps(shared):
    return {each.name.rpartition("/")[2]: each for each in read_plant_maps(shared)}


def test_every_map_is_read_as_its_papers_state_it(maps):
    citrus, hop = maps["citrus_ctv_IVI3and4"], maps["hop_viruses_HpLV"]
    assert (citrus.n_plants, citrus.n_rows) == (18, 12)
    assert citrus.dates == ("1991", "1992", "1993", "1994")
    assert citrus.infested.sum(1).tolist() == [44, 76, 127, 136]
    assert (hop.n_rows, hop.n_plants, hop.infested.sum(1).tolist()) == (25, 51, [823, 1125])
    pepper = [maps[f"gumpertz.pepper F{k}"] for k in (1, 2)]
    assert [int(each.infested.sum()) for each in pepper] == [54, 61]
    melon = maps["DidymellaWatermelon"]
    assert (melon.n_rows * melon.n_plants, len(melon.dates)) == (192, 7)
    assert melon.dates[0] == "50"
    webworms = maps["beall.webworms"]
    assert (webworms.n_rows, webworms.n_plants, int(webworms.infested.sum())) == (65, 20, 589)


def test_virus_never_leaves_a_tree_so_the_map_only_grows(maps):
    for name in ("citrus_ctv_IVI3and4", "hop_viruses_HpLV"):
        states = maps[name].infested
        assert (states[1:] >= states[:-1]).all(), name


def gap(plants, one, other, seeds=40):
    """Return found in the first quarter of the plants on the first date, one less other."""
    aisles = plants.aisles()
    found = [
        [
            inspect(plants, aisles, name, RULES, RandomStreams(seed))[0, QUARTER]
            for seed in range(seeds)
        ]
        for name in (one, other)
    ]
    return summary_statistics(np.subtract(*found))


@pytest.mark.parametrize(
    "name", ["citrus_ctv_IVI3and4", "gumpertz.pepper F1", "gumpertz.pepper F2"]
)
@pytest.mark.parametrize("other", ["naive", "bouncy"])
def test_where_few_are_infested_in_clusters_records_help_dynamic(maps, name, other):
    assert gap(maps[name], "dynamic", other).low > 0


@pytest.mark.parametrize("name", ["hop_viruses_HpLV", "beall.webworms"])
def test_where_half_or_more_are_infested_nobody_is_ten_points_ahead(maps, name):
    for other in ("naive", "bouncy"):
        ahead = gap(maps[name], "dynamic", other, seeds=10)
        assert -10 < ahead.low <= ahead.high < 10


def test_a_day_of_12_hours_finds_what_looking_can_on_the_small_maps(maps):
    small = [each for each in maps.values() if each.infested.shape[1] <= 400]
    ends = {
        (row.map, row.sampler): row.mean
        for row in run_maps(small, RULES, seeds=10)
        if row.visited_pct == 100.0 and row.date in ("", "1991")
    }
    assert len(ends) == 3 * len(SAMPLERS)
    for end in ends.values():
        assert end == pytest.approx(84, abs=6)
