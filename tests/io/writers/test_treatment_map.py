"""Treatment maps: every format holds the zones and their rate, and 0 elsewhere."""

import io
import re
import sqlite3
import zipfile

import geopandas as gpd
import numpy as np
import pyogrio
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.writers import zone_cells
from fieldmon.io.writers.treatment_map import TreatmentMap, said_of_cells, write_treatment_map
from fieldmon.plot.projection import Frame

PLOT = MultiPolygon([shapely.box(35.15, 30.36, 35.152, 30.362)])
ZONES = [
    MultiPolygon([shapely.box(35.15, 30.36, 35.1505, 30.3605)]),
    MultiPolygon([shapely.box(35.151, 30.361, 35.1512, 30.3613)]),
]
MAP = TreatmentMap("Gate", PLOT, ZONES, 300.0, "soap")


@pytest.mark.parametrize("name", ["t.gpkg", "t.shp.zip", "t.geojson", "t.KML"])
def test_the_rates_are_read_back_where_they_are(tmp_path, name):
    path = write_treatment_map(MAP, tmp_path / name)
    read = gpd.read_file(path)
    assert str(read.crs) == "EPSG:4326"
    by_zone = dict(zip(read["ZONE"].astype(int), read.geometry, strict=True))
    rates = dict(zip(read["ZONE"].astype(int), read["RATE"].astype(float), strict=True))
    assert rates == {1: 300.0, 2: 300.0, 0: 0.0}
    assert set(read["UNIT"]) == {"l/ha"}
    for k, zone in enumerate(ZONES, 1):
        assert by_zone[k].symmetric_difference(zone).area < 1e-9 * zone.area
    assert shapely.union_all(list(by_zone.values())).area == pytest.approx(PLOT.area)
    assert by_zone[0].intersection(shapely.union_all(ZONES)).area < 1e-15


def frayed(rng):
    """Return a map of measured plants: a square a plant, some centimetres off its place."""
    frame = Frame(8.0, 49.5)
    x, y = np.meshgrid(np.arange(12) * 1.4, np.arange(8) * 2.5)
    x, y = (of.ravel() + rng.normal(0.0, 0.03, x.size) for of in (x, y))
    cells = shapely.box(x - 0.7007, y - 1.25125, x + 0.7007, y + 1.25125)
    zones = [shapely.union_all(cells[:40]), shapely.union_all(cells[40:70])]
    parts = [frame.geometry_lonlat(MultiPolygon(shapely.get_parts(one).tolist())) for one in zones]
    plot = frame.geometry_lonlat(MultiPolygon([shapely.box(-0.7, -1.25, 16.1, 18.75)]))
    return TreatmentMap("Gate", plot, parts, 300.0)


@pytest.mark.parametrize("name", ["t.gpkg", "t.shp.zip", "t.geojson", "t.kml"])
def test_measured_plants_leave_no_slivers_and_nothing_but_polygons(tmp_path, name):
    for seed in range(5):
        made = frayed(np.random.default_rng(seed))
        read = gpd.read_file(write_treatment_map(made, tmp_path / name))
        assert set(read.geom_type) <= {"Polygon", "MultiPolygon"}
        assert read.geometry.is_valid.all()
        in_m = read.to_crs(25832).geometry
        parts = shapely.get_parts(in_m.to_numpy())
        holes = [shapely.Polygon(hole) for part in parts for hole in part.interiors]
        assert min(one.area for one in [*parts, *holes]) > 1.0
        own = gpd.GeoSeries(made.zones, crs=4326).to_crs(25832).area.tolist()
        assert in_m.area[read["ZONE"].astype(int) > 0].tolist() == pytest.approx(own, rel=0.02)
        assert in_m[0].intersection(in_m[1]).area < 0.01


def test_terminals_get_no_rings_of_some_square_centimetres(tmp_path):
    path = write_treatment_map(frayed(np.random.default_rng(0)), tmp_path / "t.xml.zip")
    with zipfile.ZipFile(path) as archive:
        task = archive.read("TASKDATA/TASKDATA.XML").decode()
    corners = [re.findall(r'C="([^"]+)" D="([^"]+)"', ring) for ring in task.split("<LSG ")[1:]]
    rings = [shapely.Polygon([(float(y) * 111e3, float(x) * 72e3) for y, x in ring])
             for ring in corners]  # fmt: skip
    assert len(rings) >= 2
    assert min(ring.area for ring in rings) > 1.0


@pytest.mark.parametrize("grid", ["", ".grid1", ".grid2"])
@pytest.mark.parametrize(("name", "version"), [("t", b'"4"'), ("t.v3", b'"3"')])
def test_terminals_get_the_version_and_the_grid_that_the_name_says(tmp_path, name, version, grid):
    path = write_treatment_map(MAP, tmp_path / f"{name}{grid}.xml.zip")
    with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as archive:
        task = archive.read("TASKDATA/TASKDATA.XML")
        assert b"VersionMajor=" + version in task
        assert (b"<GRD " in task) == bool(grid)
        if grid:
            assert b'I="%c"' % grid[-1].encode() in task
            assert "TASKDATA/GRD00001.bin" in archive.namelist()


@pytest.mark.parametrize("name", ["t.grid1.xml.zip", "t.v3.grid2.xml.zip", "t.tif"])
def test_it_is_said_what_cells_spray_beside_the_zones_and_miss(name, monkeypatch):
    said = said_of_cells(MAP, name)
    assert re.fullmatch(
        r"Cells of 1\.00 m spray \d+\.\d m² beside the zones and miss \d+\.\d m² of their "
        r"0\.33 ha\.", said,
    )  # fmt: skip
    monkeypatch.setattr(zone_cells, "MOST_CELLS", 2_000)
    assert re.search(
        r"Cells of 4\.\d+ m .* coarser than 1\.00 m, since .* take a file of areas",
        said_of_cells(MAP, name),
    )
    assert said_of_cells(MAP, "t.xml.zip") == said_of_cells(MAP, "t.geojson") == ""


def test_zones_of_a_plot_across_longitude_180_lie_in_its_one_piece(tmp_path):
    plot = MultiPolygon([shapely.box(179.9996, -16.8005, 180.0008, -16.8)])
    east = MultiPolygon([shapely.box(-179.9998, -16.8005, -179.9995, -16.8003)])
    of = TreatmentMap("Taveuni", plot, [east], 300.0)
    path = write_treatment_map(of, tmp_path / "t.gpkg")
    read = gpd.read_file(path)
    assert read.total_bounds[[0, 2]].tolist() == pytest.approx([179.9996, 180.0008])
    assert read.geometry[0].bounds[0] == pytest.approx(180.0002)
    with sqlite3.connect(path) as db:
        assert db.execute("pragma user_version").fetchone() == (10300,)  # QGIS 3.22 warns of 1.4
    assert said_of_cells(of, "t.tif").startswith("Cells of 1.00 m")


def test_a_plot_that_is_all_zone_has_no_rest(tmp_path):
    path = write_treatment_map(TreatmentMap("a", PLOT, [PLOT], 1.0), tmp_path / "t.gpkg")
    assert gpd.read_file(path)["ZONE"].tolist() == [1]


def test_what_cannot_be_written_is_refused(tmp_path, monkeypatch):
    with pytest.raises(SettingError, match=r"must be called \*\.v3\.grid1\.xml\.zip"):
        write_treatment_map(MAP, tmp_path / "t.pdf")
    with pytest.raises(SettingError, match="pays nowhere"):
        TreatmentMap("a", PLOT, [], 1.0)
    with pytest.raises(SettingError, match="litres a hectare, but it is 0"):
        TreatmentMap("a", PLOT, ZONES, 0.0)
    with pytest.raises(FileProblem, match="must exist"):
        write_treatment_map(MAP, tmp_path / "none" / "t.gpkg")

    def full(*_, **__):
        raise pyogrio.errors.DataSourceError("sqlite3_exec(COMMIT) failed")

    monkeypatch.setattr(pyogrio, "write_dataframe", full)
    with pytest.raises(FileProblem, match=r"\(no room, or no leave to write\)\. Make room"):
        write_treatment_map(MAP, tmp_path / "t.gpkg")
