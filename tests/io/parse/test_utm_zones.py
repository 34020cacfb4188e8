"""UTM zones that a file names, or in which it seems to be written, are read, asked or doubted."""

import numpy as np
import pytest
from pyproj import Transformer
from shapely import Point

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.layer import Layer
from fieldmon.io.options import ReadOptions
from fieldmon.io.parse.positions import located
from fieldmon.io.parse.utm_zones import of_another_zone
from tests.io.tables_of_cells import column, sentences, table

ANY = ReadOptions()
LON = [35.150123, 35.151456]


def in_metres(lon, lat, crs):
    return Transformer.from_crs("OGC:CRS84", crs, always_xy=True).transform(lon, lat)


@pytest.mark.parametrize(
    ("zone", "lat", "code"),
    [("34H", -33.5, 32734), ("34S", -33.5, 32734), ("36 S", 32.5, 32636), ("36r", 30.4, 32636),
     ("36N", 30.4, 32636), ("03C", 30.4, None), ("3", 30.4, None),
     (36, 30.4, 32636), ("36", 30.4, 32636), ("36.5", 30.4, None)],
)  # fmt: skip
def test_a_column_of_utm_zones_is_read_unless_it_names_zones_of_something_else(zone, lat, code):
    crs = 32734 if lat < 0 else 32636
    lon = [21.0, 21.001] if lat < 0 else LON
    x, y = in_metres(lon, [lat, lat], crs)
    layer = table(zone=[zone] * 2, easting=list(x), northing=list(y))
    if code is None:
        with pytest.raises(ChoiceNeeded, match="does not say in which coordinate system"):
            located(layer, ANY)
        return
    found = located(layer, ANY)
    np.testing.assert_allclose(found.lonlat, np.stack([lon, [lat] * 2], axis=1), atol=1e-8)
    assert f"(EPSG:{code})" in next(one for one in sentences(found).split(". ") if "names" in one)


def test_records_of_two_utm_zones_are_asked_for_those_of_one():
    layer = table(zone=["34H", "35H"], easting=[3e5, 3e5], northing=[6.3e6, 6.3e6])
    for options in (ANY, ReadOptions(crs="EPSG:32734")):
        with pytest.raises(ChoiceNeeded, match=r"names 2: 34H, 35H[.] Bring all into one") as asked:
            located(layer, options)
        assert (asked.value.option, asked.value.choices) == ("where", ("zone=34H", "zone=35H"))
    assert len(located(layer, ReadOptions(crs="EPSG:2054")).lonlat) == 2
    bands = table(zone=["34H", "34J"], easting=[3e5, 3e5], northing=[6.4e6, 6.5e6])
    assert "names UTM zone 34H, 34J, which was read as" in sentences(located(bands, ANY))


def test_the_number_of_a_zone_is_one_of_utm_where_its_column_says_so_or_hardly_any_other():
    x, y = in_metres(*[[-176.9, -176.9], [-17.0, -17.0]], 32701)  # in the sea: Fiji's zone 1 is not
    easting, northing = in_metres([-157.9, -157.9], [21.4, 21.4], 32604)
    with pytest.raises(ChoiceNeeded, match="does not say in which coordinate system"):
        located(table(zone=[4, 4], easting=list(easting), northing=list(northing)), ANY)
    found = located(table(utm_zone=[4, 4], easting=list(easting), northing=list(northing)), ANY)
    np.testing.assert_allclose(found.lonlat, [[-157.9, 21.4]] * 2, atol=1e-8)
    with pytest.raises(ChoiceNeeded, match="does not say in which coordinate system"):
        located(table(utm_zone=[1, 1], easting=list(x), northing=list(y)), ANY)


def test_a_zone_that_may_be_north_or_south_of_the_equator_is_asked_about_unless_a_place_tells():
    x, y = in_metres([21.0, 21.001], [-33.5, -33.5], 32734)
    layer = table(zone=[34, 34], easting=list(x), northing=list(y))
    with pytest.raises(ChoiceNeeded, match=r"whether it is north or south .* EPSG:32734 ") as asked:
        located(layer, ANY)
    assert (asked.value.option, asked.value.choices) == ("crs", ("EPSG:32634", "EPSG:32734"))
    found = located(layer, ReadOptions(near=(21.0, -33.0)))
    np.testing.assert_allclose(found.lonlat[0], [21.0, -33.5], atol=1e-8)


def test_points_on_a_map_that_name_zones_in_which_they_do_not_lie_are_asked_about():
    xy = [*zip(*in_metres([35.9], [31.5], 32636), strict=True),
          *zip(*in_metres([36.1], [31.5], 32637), strict=True)]  # fmt: skip
    layer = Layer("p", {"zone": column([36, 37])}, column([*map(Point, xy)]), "EPSG:32636")
    with pytest.raises(ChoiceNeeded, match="names 2: 36, 37") as asked:
        located(layer, ANY)
    assert asked.value.choices == ("zone=36", "zone=37")
    both = [*zip(*in_metres([35.9, 36.1], [31.5, 31.5], 32636), strict=True)]
    right = Layer("p", {"zone": column([36, 37])}, column([*map(Point, both)]), "EPSG:32636")
    np.testing.assert_allclose(located(right, ANY).lonlat[:, 0], [35.9, 36.1], atol=1e-8)


@pytest.mark.parametrize("of_farm", [[1, 2], [11, 25], ["north", "south"]])
def test_zones_of_a_farm_are_none_of_utm(of_farm):
    x, y = in_metres(LON, [30.4, 30.4], 32636)
    layer = table(zone=of_farm, easting=list(x), northing=list(y))
    assert len(located(layer, ReadOptions(crs="EPSG:32636")).lonlat) == 2


def test_what_lies_a_zone_off_and_would_lie_beside_the_others_is_of_another_zone():
    here = np.array([[35.9, 31.5], [35.92, 31.51], [35.91, 31.49]])
    off = np.array([[30.1, 31.5]])  # 36.1 in zone 37, read in 36
    found = of_another_zone(np.concatenate([here, off]), 36)
    assert (found.which.tolist(), found.zone) == ([False, False, False, True], 37)
    assert found.near_km < 20
    assert found.away_km > 500
    east = of_another_zone(np.concatenate([off, here]), 37)
    assert (east.which.tolist(), east.zone) == ([True, False, False, False], 38)
    for far in ([[30.1, 33.5]], [[33.1, 31.5]], [[35.8, 31.5]], [[23.0, 31.5]]):
        assert of_another_zone(np.concatenate([here, far]), 36) is None
    assert of_another_zone(here[:1], 36) is None
