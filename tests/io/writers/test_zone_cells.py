"""Zones as cells: every zone shows, areas add up, and a GIS reads the rates where they are."""

import geopandas as gpd
import numpy as np
import pytest
import rasterio
import shapely
import shapely.affinity
from pyproj import Geod
from rasterio.io import MemoryFile
from shapely import MultiPolygon

from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.writers.zone_cells import (
    MOST_CELLS,
    NODATA,
    beside_and_missed,
    cell_for,
    narrowest_m,
    rates_geotiff,
    zone_cells,
)
from fieldmon.plot.projection import Frame
from tests.thorough import seeds

PLOT = MultiPolygon([shapely.box(35.15, 30.36, 35.152, 30.362)])
ZONES = [
    MultiPolygon([shapely.box(35.15, 30.36, 35.1505, 30.36005)]),
    MultiPolygon([shapely.box(35.151, 30.361, 35.1512, 30.3613)]),
]


def test_half_of_the_narrowest_zone_shows_all_of_them_at_their_size():
    cell_m = narrowest_m(ZONES)
    assert cell_m == pytest.approx(5e-5 * 111_320 / 2, rel=0.01)
    cells = zone_cells(PLOT, ZONES, cell_m)
    area = np.count_nonzero(cells.sprayed) * cells.north_size * cells.east_size
    assert area == pytest.approx(sum(zone.area for zone in ZONES), rel=0.1)
    assert cells.within.all() or cells.within.sum() > 0.9 * cells.within.size
    middle = ZONES[1].centroid
    row = int((middle.y - cells.south) / cells.north_size)
    column = int((middle.x - cells.west) / cells.east_size)
    assert cells.sprayed[row, column]


def test_a_gis_reads_the_rates_where_they_are():
    cells = zone_cells(PLOT, ZONES, 2.0)
    with MemoryFile(rates_geotiff(cells, 250.5)) as memory, memory.open() as tif:
        assert tif.crs == rasterio.CRS.from_epsg(4326)
        places = [(35.1511, 30.36115), (35.1518, 30.3618), (35.15025, 30.360025)]
        assert [float(v[0]) for v in tif.sample(places)] == [250.5, 0.0, 250.5]
        assert tif.nodata == NODATA
        assert tif.descriptions == ("l/ha",)


def test_cells_that_cannot_be_are_refused():
    with pytest.raises(SettingError, match="size above 0"):
        zone_cells(PLOT, ZONES, 0.0)
    with pytest.raises(FileProblem, match="rates"):
        zone_cells(PLOT, ZONES, 1e-4)
    with pytest.raises(SettingError, match="kind 1 or 2"):
        zone_cells(PLOT, ZONES, 5.0, kind=3)


@pytest.mark.parametrize(("long_m", "wide_m"), [(4.0, 4.0), (30.0, 1.5), (12.0, 3.0)])
@pytest.mark.parametrize("turned_deg", [0.0, 30.0])
def test_the_narrowest_of_a_rectangle_is_half_its_shorter_side_however_it_lies(
    long_m, wide_m, turned_deg
):
    flat = shapely.affinity.rotate(shapely.box(0.0, 0.0, long_m, wide_m), turned_deg)
    degrees = 111_320.0 * np.array([np.cos(np.radians(30.36)), 1.0])
    zone = shapely.transform(flat, lambda xy: xy / degrees + [35.15, 30.36])
    wider = shapely.box(35.16, 30.36, 35.161, 30.361)
    assert narrowest_m([MultiPolygon([zone, wider])]) == pytest.approx(wide_m / 2, rel=0.02)


def test_a_cell_larger_than_the_plot_is_the_only_one():
    assert zone_cells(PLOT, ZONES, 10_000.0).sprayed.shape == (1, 1)


def scattered(seed):
    """Return a plot of two pieces, and zones in it and beyond its rim."""
    rng = np.random.default_rng(seed)
    at = rng.uniform([-60.0, -60.0], [60.0, 60.0])
    lon, lat = rng.uniform(-179, 179), rng.uniform(-65, 65)
    degrees = 111_320.0 * np.array([np.cos(np.radians(lat)), 1.0])

    def there(*boxes):
        turned = [shapely.affinity.rotate(shapely.box(*one), rng.uniform(0, 90)) for one in boxes]
        return MultiPolygon([*shapely.transform(turned, lambda xy: xy / degrees + [lon, lat])])

    plot = there((-70, -40, -20, 30), (10, -30, 60, 30))
    zones = [there((at[0], at[1], at[0] + 25, at[1] + 9)), there((40, 35, 90, 45))]
    return plot, zones


@pytest.mark.parametrize("seed", seeds(2, 4))
def test_each_cell_is_sprayed_where_it_lies_in_the_plot_and_its_middle_in_a_zone(seed):
    plot, zones = scattered(seed)
    cells = zone_cells(plot, zones, 4.0)
    rows, columns = cells.sprayed.shape
    west, south, east, north = shapely.total_bounds([plot, *zones])
    assert (cells.west, cells.south) == (west, south)
    # as far as the last cell that holds anything
    assert 0.0 <= cells.west + columns * cells.east_size - east < cells.east_size
    assert 0.0 <= cells.south + rows * cells.north_size - north < cells.north_size
    everything = shapely.union_all([plot, *zones])
    earth = Geod(ellps="WGS84")
    wide_m, high_m = (
        earth.inv(west, south, west + step[0], south + step[1])[2]
        for step in ((cells.east_size, 0.0), (0.0, cells.north_size))
    )
    assert (wide_m, high_m) == pytest.approx((4.0, 4.0), rel=0.01)
    for r, c in np.ndindex(rows, columns):
        lon, lat = west + (c + 0.5) * cells.east_size, south + (r + 0.5) * cells.north_size
        middle = shapely.Point(lon, lat)
        in_zone = any(zone.contains(middle) for zone in zones)
        corner = west + c * cells.east_size, south + r * cells.north_size
        cell = shapely.box(*corner, corner[0] + cells.east_size, corner[1] + cells.north_size)
        assert cells.sprayed[r, c] == (in_zone and everything.covers(cell))
        assert cells.within[r, c] == (in_zone or plot.contains(middle))
    assert repr(cells) == f"<ZoneCells: {rows} x {columns}, {cells.sprayed.sum()} sprayed>"


SAMPLES = gpd.read_file("sample_data/paran_estate.geojson").set_index("name").geometry


# with a hole, in two parts, with a bent rim, and the smallest; others are larger ones of these
@pytest.mark.parametrize("name", ["Pond", "Two halves", "Bend", "Nursery"])
def test_a_plot_that_is_all_zone_is_sprayed_but_for_a_rim_and_nothing_outside_it(name):
    """Cells of up to 138 m missed a quarter of the zones, and sprayed a sixth outside the plots."""
    plot = MultiPolygon(shapely.get_parts(SAMPLES[name]).tolist())
    frame = Frame(plot.centroid.x, plot.centroid.y)
    plot_m = frame.geometry_m(plot)
    zone_m = plot_m.buffer(-1.5)
    zones = [frame.geometry_lonlat(MultiPolygon(shapely.get_parts(zone_m).tolist()))]
    should, cell_m = cell_for(plot, zones)
    assert (should, cell_m) == (1.0, 1.0)
    cells = zone_cells(plot, zones, cell_m)
    row, column = np.nonzero(cells.sprayed)
    south, west = cells.south + row * cells.north_size, cells.west + column * cells.east_size
    boxes = shapely.box(west, south, west + cells.east_size, south + cells.north_size)
    boxes = frame.geometry_m(boxes)
    shapely.prepare([plot_m, zone_m])
    outside, in_part = (boxes[~shapely.covers(area, boxes)] for area in (plot_m, zone_m))
    assert shapely.area(shapely.difference(outside, plot_m)).sum() < 0.1
    beside, missed = beside_and_missed(zones, cells)
    of_m2, beside_m2 = zone_m.area, shapely.area(shapely.difference(in_part, zone_m)).sum()
    assert beside * of_m2 == pytest.approx(beside_m2, rel=1e-3, abs=0.1)
    hit_m2 = shapely.area(boxes).sum() - beside_m2
    assert missed * of_m2 == pytest.approx(of_m2 - hit_m2, rel=1e-3, abs=0.1)
    # along the rim, at most a quarter of a cell on either side
    assert beside * of_m2 < 0.25 * zone_m.length
    assert missed * of_m2 < 0.25 * zone_m.length
    assert missed < (0.03 if name == "Nursery" else 0.01)


def test_cells_are_as_coarse_as_their_number_asks():
    wide = MultiPolygon([shapely.box(35.0, 30.0, 35.03, 30.02)])
    should, cell_m = cell_for(wide, [wide])
    assert should == 1.0
    assert 0.99 * MOST_CELLS < zone_cells(wide, [wide], cell_m).sprayed.size <= MOST_CELLS
    assert cell_for(PLOT, ZONES) == (1.0, 1.0)
    slim = MultiPolygon([shapely.box(35.15, 30.36, 35.1505, 30.36 + 0.5 / 111_320)])
    assert cell_for(PLOT, [slim]) == pytest.approx((0.25, 0.25), rel=0.01)


def test_each_pixel_of_the_picture_is_its_cell_north_up():
    plot, zones = scattered(1)
    cells = zone_cells(plot, zones, 6.0)
    with MemoryFile(rates_geotiff(cells, 90.0)) as memory, memory.open() as tif:
        picture, shape = tif.read(1), tif.shape
        assert (tif.dtypes, shape) == (("float32",), cells.sprayed.shape)
        for r, c in np.ndindex(shape):
            said = 90.0 if cells.sprayed[r, c] else 0.0 if cells.within[r, c] else NODATA
            lon = cells.west + (c + 0.5) * cells.east_size
            lat = cells.south + (r + 0.5) * cells.north_size
            assert tif.index(lon, lat) == (shape[0] - 1 - r, c)
            assert picture[shape[0] - 1 - r, c] == said
    assert {90.0, 0.0, NODATA} == set(np.unique(picture).tolist())
