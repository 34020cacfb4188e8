"""Real plots mapped at several dates: spread foretold from date to date, and what was seen."""

import pytest

from fieldmon.studies.map_spread import intervals_in, scores


@pytest.fixture(scope="module")
def told(shared):
    return {one.name.rpartition("/")[2]: one for one in map(scores, intervals_in(shared))}


def test_every_interval_with_enough_new_plants_is_scored(told):
    assert {name: (one.new, one.clean) for name, one in told.items()} == {
        "DidymellaWatermelon 55 to 60": (6, 186),
        "DidymellaWatermelon 60 to 65": (26, 180),
        "DidymellaWatermelon 65 to 74": (26, 156),
        "citrus_ctv_IVI3and4 1991 to 1992": (32, 172),
        "citrus_ctv_IVI3and4 1992 to 1993": (51, 140),
        "citrus_ctv_IVI3and4 1993 to 1994": (9, 89),
        "hop_viruses_HpLV 1996 to 1997": (302, 452),
    }


def test_a_kernel_foretells_every_interval_better_than_no_change_and_the_thesis_s_rule(told):
    for name, one in told.items():
        assert one.kernel < one.no_change, name
        assert one.kernel < one.thesis, name


def test_on_most_of_them_where_the_infested_stand_tells_hardly_more_than_how_many_come(told):
    """Honest: dates are months or years apart, and vectors come from beyond the plot."""
    gain = {name: one.evenly - one.kernel for name, one in told.items()}
    assert sum(each > 0.0 for each in gain.values()) == 3  # one of them by a hair
    assert min(gain.values()) > -0.1
