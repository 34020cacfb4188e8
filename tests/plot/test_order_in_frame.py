"""Columns of a frame reach the plants they were written of, whatever the frame's order."""

from contextlib import nullcontext

import geopandas
import numpy as np
import pytest

from fieldmon.errors import ImportDoubt, PlotError
from fieldmon.plot.field import Field
from fieldmon.plot.frames import plant_frame
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot

SHUFFLED = np.random.default_rng(3).permutation(24)


def points(planting=None, order=SHUFFLED):
    """Return the plants of three rows of eight in another order, as somebody's own table."""
    plants = plant_frame(rectangle(3, 8, planting or Planting()))
    mixed = plants.iloc[order].reset_index(drop=True)
    mixed["risk"] = mixed["row"] + mixed["number"] / 10
    return mixed


def risk_of(plot):
    rows = plot.to_geopandas()
    return (rows["row"] + rows["number"] / 10).to_numpy()


@pytest.mark.parametrize("made_of", ["gdf", "plants", "trees", "field"])
def test_plants_that_are_numbered_otherwise_than_given_are_said_and_found_again(made_of):
    frame = points()
    lonlat = np.c_[frame.geometry.x, frame.geometry.y]
    boundary = rectangle(3, 8).frame.geometry_lonlat(rectangle(3, 8).drivable_m)
    make, given = {
        "gdf": (lambda: Plot.from_geopandas(frame), frame),
        "plants": (lambda: Plot.around("p", lonlat), lonlat),
        "trees": (lambda: Plot.among("p", lonlat), frame),
        "field": (lambda: Plot.of(Field("p", boundary, plants=lonlat)), lonlat),
    }[made_of]
    # of a field, which comes from a file, nobody has the points at hand
    said = pytest.warns(ImportDoubt, match=r"not as they were given.*plot\.order_in\(")
    with nullcontext() if made_of == "field" else said:
        plot = make()
    order = plot.order_in(given)
    np.testing.assert_allclose(lonlat[order], plot.grid.lonlat(), atol=1e-8)


@pytest.mark.filterwarnings("error:Plants were numbered along rows")
def test_plants_in_their_own_order_are_no_doubt():
    frame = points(order=np.arange(24))
    plot = Plot.from_geopandas(frame[["geometry"]])  # warnings are errors in tests
    assert plot.order_in(frame).tolist() == list(range(24))


def test_a_column_is_brought_over_past_an_area_and_lines_that_have_no_place():
    frame = points()
    frame.loc[5, "geometry"] = None
    with pytest.warns(ImportDoubt, match="without a place"):
        plot = Plot.from_geopandas(frame)
    risk = frame["risk"].to_numpy()[plot.order_in(frame.to_crs(32636))]
    np.testing.assert_allclose(risk, risk_of(plot))


def test_each_face_gets_its_own_line_and_one_line_is_of_both_faces():
    planting = Planting(faces=2)
    n = len(rectangle(3, 8, planting))
    frame = points(planting, np.random.default_rng(4).permutation(n))
    plot = Plot.from_geopandas(frame)
    order = plot.order_in(frame)
    assert sorted(order) == list(range(n))
    assert frame["face"].to_numpy()[order].tolist() == plot.to_geopandas()["face"].tolist()
    once = frame.drop_duplicates("geometry")
    np.testing.assert_allclose(once["risk"].to_numpy()[plot.order_in(once)], risk_of(plot))


def test_a_frame_of_other_plants_is_refused():
    plot = Plot.from_geopandas(points(order=np.arange(24))[["geometry"]])
    with pytest.raises(PlotError, match=r"1 of 24 have none within 0\.5 m: plant 1 of row 1 is"):
        plot.order_in(points(order=np.arange(1, 24)))
    with pytest.raises(PlotError, match="must be points, but it holds none"):
        plot.order_in(geopandas.GeoSeries([points().union_all().convex_hull], crs=4326))
    close = rectangle(3, 8, Planting(plant_spacing_m=0.4))
    dense = Plot.around("p", close.lonlat())
    with pytest.raises(PlotError, match="a line of its own"):
        dense.order_in(close.lonlat()[1:])


def test_a_plant_that_has_two_lines_is_refused_as_a_column_may_say_two_things_of_it():
    frame = points(order=np.arange(24))
    plot = Plot.from_geopandas(frame[["geometry"]])
    twice = frame.iloc[[*range(24), 4]].reset_index(drop=True)
    with pytest.raises(PlotError, match=r"plant 5 of row 1 has two, 4 and 24 from 0\. Leave"):
        plot.order_in(twice)
