import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyproj import Transformer

from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.rasters.values import Raster, RasterOptions, map_xy, pixel_xy
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting

UTM = "EPSG:32636"
TO_UTM = Transformer.from_crs("OGC:CRS84", UTM, always_xy=True)
GRID = rectangle(12, 20, Planting(row_bearing_deg=63.0, row_spacing_m=3.0, plant_spacing_m=1.5))


def plane(pixel_m=0.25, turn_deg=0.0, *, flip=False):
    """Return a raster about GRID whose value is 3 x + 2 y in metres from its corner."""
    east, north = TO_UTM.transform(*GRID.lonlat().T)
    cos, sin = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    side_m = 1.5 * np.hypot(np.ptp(east), np.ptp(north))
    n = int(side_m / pixel_m)
    middle = np.array([east.mean(), north.mean()])
    a, d = pixel_m * cos, pixel_m * sin
    b, e = (pixel_m * sin, -pixel_m * cos) if not flip else (-pixel_m * sin, pixel_m * cos)
    corner = middle - np.array([[a, b], [d, e]]) @ [n / 2, n / 2]
    to_map = (a, b, float(corner[0]), d, e, float(corner[1]))
    places = np.stack(np.meshgrid(np.arange(n) + 0.5, np.arange(n) + 0.5), axis=-1).reshape(-1, 2)
    x, y = (map_xy(to_map, places) - middle).T
    return Raster((3 * x + 2 * y).reshape(n, n), to_map, UTM), middle


def truth(middle):
    east, north = TO_UTM.transform(*GRID.lonlat().T)
    return 3 * (east - middle[0]) + 2 * (north - middle[1])


@pytest.mark.parametrize("turn_deg", [0.0, 30.0, -135.0])
@pytest.mark.parametrize("flip", [False, True])
def test_every_way_of_sampling_finds_a_tilted_plane_however_the_raster_lies(turn_deg, flip):
    raster, middle = plane(turn_deg=turn_deg, flip=flip)
    wanted = truth(middle)
    np.testing.assert_allclose(raster.of_plants(GRID, "bilinear"), wanted, atol=1e-6)
    # a pixel's middle is at most half a diagonal away, and the plane rises 3.6 a metre
    np.testing.assert_allclose(
        raster.of_plants(GRID, "nearest"), wanted, atol=3.61 * 0.25 * 0.5**0.5
    )
    np.testing.assert_allclose(raster.of_plants(GRID, "mean"), wanted, atol=0.35)
    # half a plant spacing along and half a row spacing across, seen at points 0.25 m apart
    rise = raster.of_plants(GRID, "highest") - wanted
    assert (rise > 0.5).all()
    assert (rise < 3.61 * (0.84 + 0.25)).all()


def test_the_mean_takes_in_the_plants_own_ground_and_nothing_beyond():
    raster, _ = plane(pixel_m=0.1)
    east, north = TO_UTM.transform(*GRID.lonlat().T)
    values = np.zeros(raster.values.shape)
    plant = 115
    places = pixel_xy(raster.to_map, np.stack([east, north], axis=1))
    rows, columns = np.indices(values.shape)
    away_m = 0.1 * np.hypot(columns + 0.5 - places[plant, 0], rows + 0.5 - places[plant, 1])
    values[away_m < 0.9] = 1.0  # the corners of its footprint are 0.84 m away
    crown = Raster(values, raster.to_map, UTM)
    mean = crown.of_plants(GRID, "mean")
    assert mean[plant] == 1.0
    others = np.hypot(east - east[plant], north - north[plant]) > 0.9 + 0.84 + 0.15
    assert others.sum() > len(GRID) - 12
    assert (mean[others] == 0.0).all()


def test_no_value_stays_apart_from_zero():
    values = np.array([[0.0, np.nan], [5.0, np.nan]])
    raster = Raster(values, (1e-3, 0.0, 35.0, 0.0, -1e-3, 30.002), "EPSG:4326")
    places = np.array([[35.0005, 30.0015], [35.0015, 30.0015], [35.1, 30.0015], [np.nan, 30.0]])
    for how in ("nearest", "bilinear"):
        np.testing.assert_array_equal(raster.at(places, how), [0.0, np.nan, np.nan, np.nan])
    # half-way to the neighbour without a value, its weight goes to the others
    between = np.array([[35.00099, 30.0015]])
    assert raster.at(between, "bilinear")[0] == pytest.approx(0.0)


def test_pixels_reach_from_edge_to_edge_and_no_further():
    raster = Raster(np.arange(4.0).reshape(2, 2), (1.0, 0, 10.0, 0, -1.0, 22.0), "EPSG:4326")
    inside = np.array([[10.0, 22.0], [11.999, 20.001], [10.5, 20.5]])
    np.testing.assert_array_equal(raster.at(inside), [0.0, 3.0, 2.0])
    outside = np.array([[9.999, 21.0], [12.001, 21.0], [11.0, 22.001], [11.0, 19.999]])
    assert np.isnan(raster.at(outside)).all()
    assert np.isnan(raster.at(outside, "bilinear")).all()


def test_classes_are_not_averaged():
    raster = Raster(np.ones((2, 2)), (1.0, 0, 35.0, 0, -1.0, 31.0), "EPSG:4326", is_classes=True)
    assert raster.of_plants(GRID, "nearest")[0] == 1.0
    with pytest.raises(FileProblem, match="classes"):
        raster.of_plants(GRID, "mean")


def test_an_unknown_way_of_sampling_is_refused():
    raster = Raster(np.ones((2, 2)), (1.0, 0, 35.0, 0, -1.0, 31.0), "EPSG:4326")
    with pytest.raises(SettingError, match="nearest, bilinear, mean, highest"):
        raster.of_plants(GRID, "cubic")
    with pytest.raises(SettingError, match="footprint"):
        raster.at(GRID.lonlat(), "mean")


def test_options_are_checked_and_chosen_by_name():
    assert RasterOptions().choose("nodata", "none").nodata == "none"
    assert RasterOptions().choose("band", "4").band == "4"
    with pytest.raises(SettingError, match="nope"):
        RasterOptions(nodata="nope")
    with pytest.raises(SettingError, match="no swap_axes"):
        RasterOptions().choose("swap_axes", "yes")


@given(
    turn=st.floats(-np.pi, np.pi),
    skew=st.floats(-1.2, 1.2),
    sides=st.tuples(st.floats(0.01, 100), st.floats(0.01, 100)),
)
def test_pixels_and_map_lead_back_to_each_other(turn, skew, sides):
    a, d = sides[0] * np.cos(turn), sides[0] * np.sin(turn)
    b, e = sides[1] * np.sin(turn + skew), -sides[1] * np.cos(turn + skew)
    to_map = (a, b, 4e5, d, e, 3e6)
    places = np.array([[0.0, 0.0], [10.5, 3.25], [1000.0, 2000.0]])
    np.testing.assert_allclose(pixel_xy(to_map, map_xy(to_map, places)), places, atol=1e-4)
