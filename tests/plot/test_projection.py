import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from pyproj import Geod

from fieldmon.errors import PlotError, SettingError
from fieldmon.plot.projection import Frame

GEOD = Geod(ellps="WGS84")
CM = 0.01

frames = st.builds(
    Frame,
    st.floats(-180, 180),
    st.floats(-80, 80),
    st.floats(-360, 720),
)
on_a_plot = st.lists(
    st.tuples(st.floats(-1000, 1000), st.floats(-1000, 1000)), min_size=2, max_size=8
).map(np.array)


def metres_apart(a, b):
    return np.array(GEOD.inv(a[:, 0], a[:, 1], b[:, 0], b[:, 1])[2])


@given(frames, on_a_plot)
def test_a_place_is_as_far_from_the_centre_and_in_the_direction_that_its_metres_say(frame, xy_m):
    distance_m = np.hypot(*xy_m.T)
    azimuth = frame.bearing_deg - np.rad2deg(np.arctan2(xy_m[:, 1], xy_m[:, 0]))
    n = len(xy_m)
    lon, lat, _ = GEOD.fwd(np.full(n, frame.lon), np.full(n, frame.lat), azimuth, distance_m)
    assert (metres_apart(frame.lonlat(xy_m), np.stack([lon, lat], axis=1)) < CM).all()


@given(frames, on_a_plot)
def test_places_are_as_far_from_each_other_as_their_metres_say(frame, xy_m):
    lonlat = frame.lonlat(xy_m)
    apart = metres_apart(lonlat[:-1], lonlat[1:])
    assert apart == pytest.approx(np.hypot(*np.diff(xy_m, axis=0).T), abs=CM)


@given(frames, on_a_plot)
def test_metres_come_back_from_degrees(frame, xy_m):
    # PROJ takes what is within 0.64 mm of the centre (1e-10 of the earth's radius) for the centre
    assert frame.xy_m(frame.lonlat(xy_m)) == pytest.approx(xy_m, abs=1e-3)


@given(frames, on_a_plot, st.floats(0, 360))
def test_turning_a_frame_moves_no_place(frame, xy_m, bearing_deg):
    lonlat = frame.lonlat(xy_m)
    turned = frame.turned(bearing_deg)
    assert (metres_apart(turned.lonlat(turned.xy_m(lonlat)), lonlat) < 1e-3).all()


@pytest.mark.parametrize(
    ("bearing_deg", "east", "north"), [(90, 1, 0), (0, 0, 1), (180, 0, -1), (270, -1, 0)]
)
def test_x_runs_along_the_bearing_and_y_to_its_left(bearing_deg, east, north):
    frame = Frame(35.0, 30.0, bearing_deg)
    (x_lon, x_lat), (y_lon, y_lat) = frame.lonlat([[100.0, 0.0], [0.0, 100.0]]) - [35.0, 30.0]
    assert np.sign(np.round([x_lon, x_lat], 5)).tolist() == [east, north]
    assert np.sign(np.round([y_lon, y_lat], 5)).tolist() == [-north, east]


def test_geometries_keep_their_kind_and_come_back():
    frame = Frame(35.0, 30.0, 33.0)
    ring = shapely.Polygon([(35, 30), (35.001, 30), (35.001, 30.001)])
    there = frame.geometry_m(ring)
    assert there.geom_type == "Polygon"
    assert there.area == pytest.approx(GEOD.geometry_area_perimeter(ring)[0], rel=1e-5)
    assert shapely.equals_exact(frame.geometry_lonlat(there), ring, 1e-9)


@pytest.mark.parametrize("where", [(32.0, 35.5), (np.nan, 30.0), (35.0, 95.0)])
def test_positions_far_from_the_plot_are_refused(where):
    with pytest.raises(PlotError, match="within 200 km"):
        Frame(35.0, 30.0).xy_m([where])


@pytest.mark.parametrize("centre", [(181.0, 0.0), (0.0, -91.0), (np.nan, 0.0), (601_954.6, 4.4e6)])
def test_a_centre_that_is_not_on_earth_is_refused(centre):
    with pytest.raises(SettingError, match="degrees"):
        Frame(*centre)


def test_a_bearing_must_be_a_number():
    with pytest.raises(SettingError, match="bearing"):
        Frame(35.0, 30.0, float("nan"))


def test_a_plot_on_both_sides_of_longitude_180_is_to_be_brought_as_two():
    both = np.array([[179.9995, -16.8], [-179.9995, -16.8], [-179.9995, -16.799]])
    with pytest.raises(PlotError, match="on one side of longitude 180"):
        Frame(0.0, -16.8).xy_m(both)
    # one side of it is as good as any
    assert np.abs(Frame(-179.9998, -16.8).xy_m(both[1:])).max() < 200.0


def test_what_is_drawn_across_longitude_180_does_not_jump_there():
    frame = Frame(-179.9999, -16.8)
    across = frame.geometry_lonlat(shapely.box(-30.0, 0.0, 30.0, 20.0))
    assert 179.999 < across.bounds[0] < 180.0 < across.bounds[2] < 180.001
    assert frame.geometry_m(across).area == pytest.approx(1200.0, rel=1e-6)
    beside = frame.geometry_lonlat(shapely.box(20.0, 0.0, 30.0, 20.0))
    assert beside.bounds[2] < -179.999
