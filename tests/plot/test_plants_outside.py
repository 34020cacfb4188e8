"""Plants outside a plot by more than a phone errs are not of it."""

import numpy as np
import pytest
from shapely import MultiPolygon, box

from fieldmon.plot.field import Field
from fieldmon.plot.plants_outside import PlantsOutside, distance_m
from fieldmon.plot.projection import Frame

FRAME = Frame(8.0, 47.0)
FIELD = Field("a", FRAME.geometry_lonlat(MultiPolygon([box(-40, -40, 40, 40)])))
OFF_M = [0.0, 3.0, 6.0, 60_000.0]
PLANTS = FRAME.lonlat(np.array([[0.0, 0.0], [43.0, 0.0], [46.0, 0.0], [60_040.0, 0.0]]))


@pytest.mark.parametrize(
    ("far", "left_out"),
    [
        (None, [False, False, True, True]),
        ("keep", [False] * 4),
        ("drop", [False, True, True, True]),
    ],
)
def test_plants_outside_by_more_than_gps_errs_are_left_out_or_as_said(far, left_out):
    split = PlantsOutside.of(PLANTS, FIELD, far)
    assert split.left_out.tolist() == left_out
    assert bool(split.of_left_out()) == any(left_out)
    assert bool(split.of_beside()) == (far is None)
    assert split.away_m == pytest.approx(OFF_M, rel=2e-3, abs=1e-6)


def test_where_no_plant_is_near_the_plot_none_is_left_out():
    split = PlantsOutside.of(PLANTS[3:], FIELD)
    assert not split.left_out.any()
    assert split.of_beside() == ""
    assert split.away_m == pytest.approx(OFF_M[3:], rel=2e-3)


def test_a_place_on_the_plot_is_no_way_off_and_others_as_far_as_they_are():
    assert distance_m(PLANTS, FIELD) == pytest.approx(OFF_M, rel=2e-3, abs=1e-6)
