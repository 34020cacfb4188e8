"""A treatment lowers chances where it was, and is undone like findings."""

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.errors import SettingError
from tests.monitoring.seasons import (
    BEGINS,
    some_results,
)


def test_a_spraying_lowers_the_chance_where_it_was(season):
    season.record(some_results(season, found=[0]), "x")
    before = season.evening(BEGINS)
    west = MultiPolygon([box(35.14, 30.35, 35.15041, 30.37)])
    season.treat(BEGINS, 0.8, west, "soap")
    after = season.evening(BEGINS)
    inside = season.plot.grid.lonlat()[:, 0] < 35.15041
    assert after[inside] == pytest.approx(np.maximum(before[inside] * 0.2, 1e-6))
    assert np.array_equal(after[~inside], before[~inside])
    assert season.treat(BEGINS, 0.8, west, "soap").new == 0
    season.undo()
    assert np.array_equal(season.evening(BEGINS), before)


@pytest.mark.parametrize(
    ("area", "efficacy", "says"),
    [(box(35.2, 30.3, 35.3, 30.4), 0.5, "holds none"), (box(35, 30, 36, 31), 1.5, "efficacy")],
)
def test_an_impossible_spraying_is_a_sentence(season, area, efficacy, says):
    with pytest.raises(SettingError, match=says):
        season.treat(BEGINS, efficacy, MultiPolygon([area]))
    assert season.batches() == ()


def test_a_treatment_is_undone(season):
    before = season.evening(BEGINS)
    season.treat(BEGINS, 0.5)
    assert season.evening(BEGINS) == pytest.approx(before / 2)
    season.undo()
    assert np.array_equal(season.evening(BEGINS), before)
    assert [(batch.kind, batch.undone) for batch in season.batches()] == [("treatment", True)]


def test_numbers_of_plants_are_not_taken_for_which_were_treated(season):
    n = len(season.plot.grid)
    for plants in (np.arange(n), np.ones(n)):
        with pytest.raises(SettingError, match="of each plant as True or False"):
            season.treat(BEGINS, 0.5, plants=plants)
    assert season.treatments() == ()
    season.treat(BEGINS, 0.5, plants=np.isin(np.arange(n), [1, 2, 3]))
    (treated,) = season.treatments()
    assert np.flatnonzero(treated.place.plants).tolist() == [1, 2, 3]
