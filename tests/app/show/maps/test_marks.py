"""Marks lie where the things are: hot spots, records, paths, places, drawings."""

import numpy as np
import pytest
import shapely

from app.show.maps import marks, plant_layers
from app.show.maps.colours import by_state
from fieldmon.infestation.hotspots import hot_spots
from tests.app.chosen import a_plot, records_at


@pytest.fixture(scope="module")
def plot():
    return a_plot(0.001)


@pytest.fixture(scope="module")
def spots(plot):
    """Return a cluster of finds in one corner, among clean plants all over."""
    away = np.hypot(*(plot.grid.xy_m - plot.grid.xy_m[40]).T)
    state = np.where(away < 12, 1, 0).astype(np.int8)
    found = hot_spots(plot.grid, state)
    assert len(found) == 1
    return found


def test_a_hot_spot_holds_its_plants_and_not_the_others_far_off(plot, spots):
    tint, edge = marks.hot(plot.grid, spots)
    (row,) = tint.data
    area = shapely.Polygon(row["p"])
    lonlat = plot.grid.lonlat()
    inside = shapely.contains_xy(area, lonlat)
    assert inside[spots.of_plant == 0].all()
    assert inside.sum() < 1.5 * (spots.of_plant == 0).sum()
    assert row["t"] == f"hot spot 1: {spots.found[0]} found of {spots.inspected[0]} inspected"
    assert edge.data == tint.data


def test_a_hot_spot_s_number_is_that_of_the_list_and_stands_in_it_or_on_its_edge(plot):
    away = [np.hypot(*(plot.grid.xy_m - plot.grid.xy_m[k]).T) < 9 for k in (40, -40)]
    two = hot_spots(plot.grid, np.logical_or(*away).astype(np.int8))
    assert len(two) == 2
    for k, row in enumerate(marks.hot(plot.grid, two)[0].data):
        assert row["number"]["t"] == str(k + 1)
        middle, *edge = shapely.points(row["number"]["at"])
        area = shapely.Polygon(row["p"])
        assert area.contains(middle)
        assert shapely.distance(edge, area.exterior) == pytest.approx(0.0, abs=1e-6)
        own = plot.grid.lonlat(np.flatnonzero(two.of_plant == k)).mean(axis=0)
        assert middle.distance(shapely.Point(own)) < 1e-4


def test_no_hot_spot_is_no_layer(plot):
    assert marks.hot(plot.grid, hot_spots(plot.grid, np.zeros(len(plot.grid), np.int8))) == []


def test_a_hot_spot_s_tint_lies_under_plants_that_can_be_tapped_its_edge_over_all(plot, spots):
    state = np.zeros(len(plot.grid), np.int8)
    plants = plant_layers.plants(plot.grid, by_state(state))
    paths = marks.paths(plot.field)
    made = marks.with_hot([*paths, plants], marks.hot(plot.grid, spots))
    assert [layer.id for layer in made] == ["paths", "hot", "plants", "hot-edge"]
    assert [layer.id for layer in marks.with_hot([plants], [])] == ["plants"]


def test_records_are_filled_where_pests_were_seen(plot):
    (layer,) = marks.records(records_at(plot, [3, 8, 9], [1, 0, -1]))
    seen, unseen, unknown = layer.data
    assert seen["l"] == unseen["l"] != unknown["l"], "unknown is not clean"
    assert unknown["t"] == "record of 2026-11-10: not known"
    assert seen["p"] == pytest.approx(plot.grid.lonlat()[3], abs=1e-6)
    assert (seen["c"][3] > 0, unseen["c"][3]) == (True, 0)
    assert seen["t"] == "record of 2026-11-10: found"
    assert unseen["t"] == "record of 2026-11-10: nothing"


def test_only_infested_plants_are_marked_as_such(plot):
    infested = np.zeros(len(plot.grid), bool)
    infested[[4, 9]] = True
    (layer,) = marks.truth(plot.grid, infested)
    assert np.array([row["p"] for row in layer.data]) == pytest.approx(
        plot.grid.lonlat()[[4, 9]], abs=1e-6
    )


def test_what_is_drawn_so_far_is_joined_from_the_second_point_on():
    one, several = (marks.drawing(points) for points in (((1.0, 2.0),), ((1.0, 2.0), (3.0, 4.0))))
    assert one[0].data == []
    assert several[0].data == [{"path": [[1.0, 2.0], [3.0, 4.0]]}]
    assert len(several[1].data) == 2
