"""The first morning of a simulated season."""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import SettingError
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.simulation.start import Start, season_start

GRID = rectangle(40, 50)
CHANCE = np.linspace(0.001, 0.2, len(GRID))


def test_the_same_seed_infests_the_same_plants_and_another_others():
    one, same, other = (
        season_start(GRID, CHANCE, 0.05, RandomStreams(seed)).infested for seed in (7, 7, 8)
    )
    np.testing.assert_array_equal(one, same)
    assert (one != other).any()


def test_the_share_is_infested_on_average_more_where_the_chance_is_higher():
    starts = [season_start(GRID, CHANCE, 0.05, RandomStreams(s)).infested for s in range(50)]
    n = len(GRID)
    # 100 000 draws of a mean of 0.05: three standard errors are 0.002
    assert np.mean(starts) == pytest.approx(0.05, abs=0.002)
    assert np.mean(starts, axis=0)[n // 2 :].sum() > 2 * np.mean(starts, axis=0)[: n // 2].sum()


def test_what_is_believed_is_the_chance_map_itself():
    assert season_start(GRID, CHANCE, 0.05, RandomStreams(1)).chance is CHANCE


def test_both_faces_of_a_plant_are_infested_together():
    faces = rectangle(10, 20, Planting(faces=2))
    chance = np.full(len(faces), 0.3)
    infested = season_start(faces, chance, 0.3, RandomStreams(1)).infested
    both = faces.twin >= 0
    assert both.any()
    np.testing.assert_array_equal(infested[both], infested[faces.twin[both]])


@pytest.mark.parametrize("share", [0.0, 1.0, -0.1, float("nan")])
def test_a_share_of_none_or_all_is_refused(share):
    with pytest.raises(SettingError, match="above 0 and below 1"):
        season_start(GRID, CHANCE, share, RandomStreams(1))


@pytest.mark.parametrize("odd", [np.nan, 5.0, -0.1])
def test_what_is_believed_must_be_chances(odd):
    chance = np.full(4, 0.1)
    chance[2] = odd
    with pytest.raises(SettingError, match=r"must hold chances in 0\.\.1, but plant 2 of 4 has"):
        Start(np.zeros(4, bool), chance)
