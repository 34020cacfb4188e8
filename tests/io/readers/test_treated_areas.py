"""Where was treated, as files say: what has no rate was not."""

import geopandas as gpd
import pytest
from shapely import MultiPolygon, Point, box

from fieldmon.errors import FileProblem
from fieldmon.io.read import read_treated
from fieldmon.io.writers.treatment_map import TreatmentMap, write_treatment_map
from tests.paths import ROOT

PLOT = MultiPolygon([box(35.15, 30.36, 35.152, 30.362)])
ZONES = [
    MultiPolygon([box(35.1501, 30.3601, 35.1505, 30.3603)]),
    MultiPolygon([box(35.1510, 30.3601, 35.1512, 30.3605)]),
]
OF = TreatmentMap("Gate", PLOT, ZONES, 300.0, "soap")


@pytest.mark.parametrize("name", ["zones.gpkg", "zones.shp.zip", "zones.kml"])
def test_zones_of_a_decision_come_back_without_the_rest_of_the_plot(tmp_path, name):
    read = read_treated(write_treatment_map(OF, tmp_path / name))
    assert read.value.area == pytest.approx(sum(zone.area for zone in ZONES), rel=1e-6)
    assert read.value.symmetric_difference(MultiPolygon([z.geoms[0] for z in ZONES])).area < 1e-12
    assert any("rate 0 was not treated" in one.sentence for one in read.messages)


def test_areas_without_rates_were_treated_all(tmp_path):
    path = tmp_path / "corner.geojson"
    gpd.GeoDataFrame({"name": ["a", "b"]}, geometry=ZONES, crs=4326).to_file(path)
    assert read_treated(path).value.area == pytest.approx(sum(zone.area for zone in ZONES))


def test_task_data_says_the_plot_and_is_refused(tmp_path):
    with pytest.raises(FileProblem, match="task data for a terminal"):
        read_treated(write_treatment_map(OF, tmp_path / "zones.xml.zip"))


def test_where_every_rate_is_0_nothing_was_treated(tmp_path):
    path = tmp_path / "none.gpkg"
    gpd.GeoDataFrame({"RATE": [0.0, 0.0]}, geometry=ZONES, crs=4326).to_file(path)
    with pytest.raises(FileProblem, match="every RATE is 0"):
        read_treated(path)


def test_points_and_rasters_are_refused_with_what_can_be_read(tmp_path):
    path = tmp_path / "points.gpkg"
    gpd.GeoDataFrame(geometry=[Point(35.1501, 30.3601)], crs=4326).to_file(path)
    with pytest.raises(FileProblem, match="points must hold the areas that were treated"):
        read_treated(path)
    with pytest.raises(FileProblem, match=r"is a raster, .* Give a file that does, as .gpkg"):
        read_treated(ROOT / "sample_data" / "backdrop.tif")
