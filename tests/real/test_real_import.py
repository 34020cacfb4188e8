"""Real files come in where they are: coordinates and areas against what is known of them."""

import json
from pathlib import Path

import numpy as np
import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.geodata.findings import Severity
from fieldmon.geodata.geometry import area_m2
from fieldmon.geodata.options import PlotOptions, ReadOptions, RecordOptions
from fieldmon.geodata.reading import read_lines, read_plants, read_plots, read_records

ACRE_M2 = 4046.8564224


def attributes(path: Path, column: str) -> list:
    import pyogrio

    return list(pyogrio.read_dataframe(path, columns=[column], read_geometry=False)[column])


def test_riseholme_vines_stand_where_they_were_surveyed(shared):
    plants = read_plants(shared / "riseholme_vines/riseholme_vineyard_lat_long_vines.csv").value
    assert len(plants) == 120
    np.testing.assert_allclose(plants.lonlat[0], (-0.52427621, 53.26818125), atol=1e-9)
    assert (plants.row[0], plants.plant[0]) == ("row_1", "ROW01VINE01")
    assert len(set(plants.row)) == 10


def test_riseholme_poles_and_paths_are_points_and_lines(shared):
    poles = read_plants(shared / "riseholme_vines/riseholme_rtk_gps_poles.geojson").value
    assert len(poles) == 40
    np.testing.assert_allclose(poles.lonlat[1], (-0.52426541, 53.26813837), atol=1e-9)
    paths = read_lines(shared / "riseholme_vines/topological_map.geojson")
    assert len(paths.value.geoms) == 106 - 18  # a node's link to itself has no length
    np.testing.assert_allclose(paths.value.geoms[0].coords[0], (-0.524551, 53.26801), atol=1e-9)
    said = " ".join(f.sentence for f in paths.findings)
    assert "81 feature(s) that are no lines" in said
    assert "18 line(s) that do not lead anywhere" in said


def test_the_banana_field_has_its_four_corners(shared):
    path = shared / "banana_fusarium/FusariumBanana.csv"
    with pytest.raises(ChoiceNeeded) as asked:
        read_plots(path)
    assert (asked.value.option, "marker=polygon" in asked.value.choices) == ("where", True)
    (field,) = read_plots(path, PlotOptions(where="marker=polygon")).value
    corners = {(round(x, 6), round(y, 6)) for x, y in field.boundary.geoms[0].exterior.coords}
    assert corners == {
        (-50.832455, -20.462361),
        (-50.832468, -20.460924),
        (-50.834468, -20.460958),
        (-50.833915, -20.46241),
    }
    found = read_records(path, RecordOptions(where="marker=plantas"), near=field).value
    assert len(found) == 159
    np.testing.assert_allclose(found.lonlat[0], (-50.833389, -20.460995), atol=1e-9)


@pytest.mark.parametrize("ending", ["shp", "geojson"])
def test_rlp_vineyards_keep_names_parts_and_corners(shared, ending):
    imported = read_plots(shared / f"parcels_rlp_vineyards/vineyards.{ending}")
    fields = {field.name: field for field in imported.value}
    assert len(fields) == 10
    assert "Höll" in fields
    kupp = np.array(fields["Kupp"].boundary.geoms[0].exterior.coords)
    assert np.abs(kupp - (6.6155138, 49.569263)).max(axis=1).min() < 1e-7
    raw = json.loads((shared / "parcels_rlp_vineyards/vineyards.geojson").read_text("utf-8"))
    parts = {f["properties"]["name"]: len(f["geometry"]["coordinates"]) for f in raw["features"]}
    slivers = [f.feature for f in imported.of(Severity.DROPPED)]
    assert slivers == ["Steingebiß"]
    for name, field in fields.items():
        assert len(field.boundary.geoms) == parts[name] - (name in slivers)


@pytest.mark.parametrize(
    ("file", "column", "to_m2", "tolerance"),
    [
        ("france_vignes_epsg2154.gpkg", "surf_parc", 1e4, 0.02),
        ("lleida_apricot_orchards_epsg25831.gpkg", "ha", 1e4, 0.02),
        ("aveiro_vinha_olival_epsg3763.gpkg", "Shape_Area", 1.0, 0.002),
        ("california_tuolumne_vineyard_apple_epsg4269_Z.gpkg", "ACRES", ACRE_M2, 0.02),
    ],
)
def test_parcels_have_the_area_that_their_register_states(shared, file, column, to_m2, tolerance):
    path = shared / "parcels_orchards_vineyards" / file
    fields = read_plots(path).value
    stated = np.array(attributes(path, column), dtype=float) * to_m2
    measured = np.array([area_m2(field.boundary) for field in fields])
    np.testing.assert_allclose(measured, stated, rtol=tolerance, atol=60.0)


def test_an_aphid_field_lies_in_arlington(shared):
    (field,) = read_plots(
        shared / "arlington_aphids/Arlington.geojson", PlotOptions(feature="110")
    ).value
    first = field.boundary.geoms[0].exterior.coords[:]
    assert min(abs(x + 89.382865297) + abs(y - 43.300891262) for x, y in first) < 1e-8


def test_pistachio_traps_hang_at_their_points_not_where_one_looks_from(shared):
    path = shared / "pistachio_traps/mwoolf-farmsense-expt-2020-07-01.kml"
    traps = read_plants(path, ReadOptions()).value
    assert len(traps) == 42
    text = path.read_text("utf-8")
    point = text.split("<Point>")[1].split("<coordinates>")[1].split("<")[0]
    lon, lat, _ = (float(v) for v in point.split(","))
    np.testing.assert_allclose(traps.lonlat[0], (lon, lat), atol=1e-12)


def test_trees_of_a_projected_geojson_land_in_california(shared):
    trees = read_plants(shared / "naip_trees/chico_2020_70.geojson").value
    # the tile's north-west corner is 39.7222, -121.8119 (UTM 601845.6, 4397523.0)
    assert np.abs(trees.lonlat - (-121.8110, 39.7215)).max() < 0.002


def test_eight_soil_samples_lie_outside_their_field_but_none_far(shared):
    folder = shared / "field_sensor_samples"
    (field,) = read_plots(folder / "sensor_farm_boundary.geojson").value
    samples = read_records(folder / "sensor_samples.geojson", near=field)
    assert len(samples.value) == 104
