"""Real files come in where they are: coordinates and areas against what is known of them."""

import json
from pathlib import Path

import numpy as np
import pytest
from shapely import Point

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import Severity
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.read import read_lines, read_plants, read_plots, read_records
from fieldmon.io.readers.places import NamedPlaces, Plants
from fieldmon.plot.grid import plant_at
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plants_outside import distance_m

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
    said = " ".join(f.sentence for f in paths.messages)
    assert "81 features that are no lines" in said
    assert "18 lines that lead nowhere" in said


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
    options = RecordOptions(where="marker=plantas").naming(present="")
    found = read_records(path, options, near=field).value
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


# --- what else the files hold --------------------------------------------------------------------


def utm_lonlat(easting, northing, zone):
    """Return longitude and latitude of northern UTM coordinates: Krueger's series, to 0.1 mm."""
    a, f = 6378137.0, 1 / 298.257222101
    n = f / (2 - f)
    radius = a / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    beta = (n / 2 - 2 / 3 * n**2 + 37 / 96 * n**3, n**2 / 48 + n**3 / 15, 17 / 480 * n**3)
    delta = (2 * n - 2 / 3 * n**2 - 2 * n**3, 7 / 3 * n**2 - 8 / 5 * n**3, 56 / 15 * n**3)
    xi, eta = northing / (0.9996 * radius), (easting - 500_000) / (0.9996 * radius)
    rings = list(enumerate(beta, 1))
    x = xi - sum(b * np.sin(2 * j * xi) * np.cosh(2 * j * eta) for j, b in rings)
    y = eta - sum(b * np.cos(2 * j * xi) * np.sinh(2 * j * eta) for j, b in rings)
    chi = np.arcsin(np.sin(x) / np.cosh(y))
    lat = chi + sum(d * np.sin(2 * j * chi) for j, d in enumerate(delta, 1))
    return zone * 6 - 183 + np.rad2deg(np.arctan2(np.sinh(y), np.cos(x))), np.rad2deg(lat)


@pytest.mark.parametrize(("tile", "zone"), [("chico_2020_70", 10), ("claremont_2020_82", 11)])
def test_trees_of_a_projected_geojson_stand_where_utm_says(shared, tile, zone):
    path = shared / f"naip_trees/{tile}.geojson"
    features = json.loads(path.read_text("utf-8"))["features"]
    metres = np.array([feature["geometry"]["coordinates"] for feature in features])
    trees = read_plants(path).value
    wanted = np.stack(utm_lonlat(*metres.T, zone), axis=1)
    # NAD83 is WGS 84 to a metre or two, and PROJ says so
    np.testing.assert_allclose(trees.lonlat, wanted, atol=2e-5)


def test_positions_in_pixels_are_asked_about_and_not_put_on_the_map(shared):
    with pytest.raises(ChoiceNeeded) as asked:
        read_plants(shared / "naip_trees/chico_2020_70.csv")
    assert asked.value.option == "columns"


def test_an_orchard_near_lleida_has_its_corner_where_utm_says(shared):
    path = shared / "parcels_orchards_vineyards/lleida_apricot_orchards_epsg25831.gpkg"
    (first, *_) = read_plots(path).value
    corner = utm_lonlat(398830.1839, 4598402.7504, 31)
    np.testing.assert_allclose(first.boundary.geoms[0].exterior.coords[0], corner, atol=1e-8)


@pytest.mark.parametrize(
    ("file", "corner"),
    [  # in California as the file has it, else by the way that PROJ takes when nobody chooses
        ("aveiro_vinha_olival_epsg3763.gpkg", (-8.27748206, 40.90826184)),
        ("france_vignes_epsg2154.gpkg", (-1.28018862, 47.16778342)),
        ("california_tuolumne_vineyard_apple_epsg4269_Z.gpkg", (-120.325693962, 38.017025113)),
    ],
)
def test_parcels_have_their_first_corner_where_it_is(shared, file, corner):
    first = read_plots(shared / "parcels_orchards_vineyards" / file).value[0]
    np.testing.assert_allclose(first.boundary.geoms[0].exterior.coords[0], corner, atol=2e-5)


def test_aphid_counts_lie_on_the_fields_they_name_and_six_names_are_unknown(shared):
    folder = shared / "arlington_aphids"
    fields = read_plots(folder / "Arlington.geojson").value
    options = RecordOptions().naming(count="SweepsPeaAphids")
    path = folder / "parasitism-2011-2019.csv"
    read = read_records(path, options, places=NamedPlaces(fields))
    (unknown,) = [f.sentence for f in read.messages if "plots not known" in f.sentence]
    assert "6 plots" in unknown
    assert unknown.endswith(": 110/110, 2110, 349_Clover, 4110, 635S, N1902.")
    assert any("1 record names no plot" in f.sentence for f in read.messages)
    named = {field.name: field.boundary for field in fields}
    assert named["219"].contains(Point(read.value.lonlat[0]))
    assert read.value.count[:3].tolist() == [209, 430, 1005]
    assert read.value.day[:3].astype(str).tolist() == ["2011-10-12", "2011-09-01", "2011-09-08"]


def test_moth_counts_hang_in_the_traps_they_name(shared):
    folder = shared / "pistachio_traps"
    traps = read_plants(folder / "mwoolf-farmsense-expt-2020-07-01.kml").value
    read = read_records(
        folder / "y20_farmsense_wingtrap_counts.csv", places=NamedPlaces(plants=traps)
    )
    assert len(read.value) == 357
    assert any("by their digits alone" in f.sentence for f in read.messages)
    (third,) = traps.lonlat[traps.plant == "Block1-3"]
    np.testing.assert_array_equal(read.value.lonlat[0], third)  # PlotID 13: block 1, position 3
    assert (read.value.count[0], str(read.value.day[0])) == (15, "2020-07-02")


def test_mite_counts_sit_on_their_patches_with_the_day_first(shared):
    names = [f"{letter}{number}" for letter in "ABC" for number in (1, 2, 3)]
    lonlat = np.array([(3.7 + i // 3 * 1e-5, 51.0 + i % 3 * 1e-5) for i in range(9)])
    patches = Plants(lonlat, np.full(9, ""), np.array(names))
    options = RecordOptions(where="MP=Hom1").naming(plant="P", count="AvgFem")
    path = shared / "mite_patches/tetranychus_patches.csv"
    read = read_records(path, options, places=NamedPlaces(plants=patches)).value
    np.testing.assert_array_equal(read.lonlat[1], lonlat[names.index("A2")])
    assert read.count[1] == pytest.approx(5.666667)
    assert str(read.day[1]) == "2011-05-10"
    assert len(np.unique(read.day)) == 22
    assert (np.diff(np.unique(read.day)) == np.timedelta64(7, "D")).mean() > 0.9


@pytest.mark.parametrize(
    ("file", "size", "where", "roles", "record"),
    [  # record: its row, plant and count or presence, as one reads it in the file's line
        ("citrus_ctv_IVI3and4.csv", (18, 12), "t=1991", ("x", "y", "present=i"), (0, 1, 1, 1)),
        ("hop_viruses_HpLV.csv", (25, 51), "t=1996", ("x", "y", "present=i"), (2, 1, 3, 0)),
        ("beall.webworms.txt", (65, 20), None, ("row", "col", "count=y"), (3, 4, 1, 3)),
        ("gumpertz.pepper.txt", (20, 20), "field=F1", ("row", "quadrat", "present=disease"), None),
        ("aphids.csv", (7, 9), None, ("x", "y", "count=i"), (3, 4, 1, 7)),
    ],
)
def test_counts_by_row_and_plant_stand_on_the_plants_they_name(
    shared, file, size, where, roles, record
):
    grid = rectangle(*size)
    row, plant, role = roles
    options = (
        RecordOptions(where=where).naming(row=row, plant=plant, plot="").choose("columns", role)
    )
    read = read_records(
        shared / "plant_maps" / file, options, places=NamedPlaces.of((), grid)
    ).value
    spots = np.unique(np.round(read.lonlat, 9), axis=0)
    assert len(spots) == size[0] * size[1]
    i, line, number, value = record or (0, 1, 1, 0)
    spot = grid.lonlat(np.array([plant_at(grid, line, number)]))[0]
    np.testing.assert_allclose(read.lonlat[i], spot, atol=1e-12)
    assert (read.count[i] if role.startswith("count") else read.present[i]) == value


def test_severities_of_a_watermelon_field_stand_on_its_plants(shared):
    grid = rectangle(16, 12)
    path = shared / "banana_fusarium/DidymellaWatermelon.csv"
    options = RecordOptions(where="dap=50").naming(row="EW_row", plant="NS_col", count="severity")
    read = read_records(path, options, places=NamedPlaces.of((), grid)).value
    assert len(read) == 192
    np.testing.assert_allclose(
        read.lonlat[1], grid.lonlat(np.array([plant_at(grid, 2, 1)]))[0], atol=1e-12
    )


def test_eight_soil_samples_lie_outside_the_fence(shared):
    folder = shared / "field_sensor_samples"
    (field,) = read_plots(folder / "sensor_farm_boundary.geojson").value
    samples = read_records(
        folder / "sensor_samples.geojson", RecordOptions().naming(present=""), near=field
    ).value
    np.testing.assert_allclose(samples.lonlat[0], (-117.0464255, 47.03466384), atol=1e-12)
    assert (distance_m(samples.lonlat, field) > 0).sum() == 8
    assert area_m2(field.boundary) == pytest.approx(60_500, rel=2e-3)
