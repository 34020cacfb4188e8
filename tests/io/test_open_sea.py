"""A plot that lies where no plant grows."""

import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.io.guessed_bearing import doubts_of_bearing
from fieldmon.io.open_sea import said_of_place
from fieldmon.io.plot_request import PlantingChoices
from fieldmon.plot.field import Field


def plot_at(lon, lat):
    return Field("vines", MultiPolygon([shapely.box(lon, lat, lon + 0.001, lat + 0.001)]))


@pytest.mark.parametrize("place", [(35.14, 30.35), (-8.0, 41.5), (-157.9, 21.4), (174.8, -41.3)])
def test_nothing_is_said_of_a_plot_on_land(place):
    assert said_of_place(plot_at(*place)) == ()


def test_a_plot_in_the_sea_that_would_lie_on_land_may_have_its_axes_exchanged():
    (said,) = said_of_place(plot_at(30.35, 35.14))
    assert "open sea, at latitude 35.1405, longitude 30.3505. With those exchanged" in said.sentence
    assert (said.feature, said.remedy.setting) == ("vines", "swap_axes=yes")
    (said,) = said_of_place(plot_at(30.35, 35.14), exchanged=True)
    assert said.remedy.setting == "swap_axes=no"


@pytest.mark.parametrize("place", [(-30.0, -40.0), (-140.0, 20.0)])
def test_another_one_is_doubted_without_a_way_out(place):
    (said,) = said_of_place(plot_at(*place))
    assert "Check the coordinate system" in said.sentence
    assert said.remedy is None


def test_a_plot_cut_at_longitude_180_is_doubted_for_that_and_not_where_its_middle_lies():
    parts = shapely.box(179.9995, -16.801, 180, -16.8), shapely.box(-180, -16.801, -179.9995, -16.8)
    field = Field("Taveuni", MultiPolygon(parts))
    (said,) = said_of_place(field)
    assert not doubts_of_bearing(field, PlantingChoices())  # so that it is listed, and said once
    assert "on one side of longitude 180" in said.sentence
    assert "sea" not in said.sentence
