"""Treatment maps: every format holds the zones and their rate, and 0 elsewhere."""

import io
import zipfile

import geopandas as gpd
import pyogrio
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.writers.treatment_map import TreatmentMap, write_treatment_map

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
