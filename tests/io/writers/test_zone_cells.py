"""Zones as cells: every zone shows, areas add up, and a GIS reads the rates where they are."""

import numpy as np
import pytest
import rasterio
import shapely
import shapely.affinity
from rasterio.io import MemoryFile
from shapely import MultiPolygon

from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.writers.zone_cells import NODATA, narrowest_m, rates_geotiff, zone_cells

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
