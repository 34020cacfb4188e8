"""Awkward files, each made here, with what its import has to say.

A case is a function that makes the file in an empty folder; its decorator says through which door
it comes in, and what must come out: findings (``"repaired: part of the sentence [option=value]"``),
positions, a question or a refusal. Dropped or doubtful findings that are not named fail the test.
"""

import io
import json
import struct
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import geopandas as gpd
import numpy as np
import pandas as pd
import pyogrio
import shapely
from shapely import LineString, MultiPolygon, Point, Polygon, box

from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions, Upload
from fieldmon.io.readers.places import NamedPlaces, Plants
from fieldmon.plot.field import Field

PARAN = (35.15, 30.36)
SQUARE = box(35.15, 30.36, 35.152, 30.362)
SECOND = box(35.154, 30.36, 35.156, 30.362)
CORNERS = ((35.15, 30.36), (35.152, 30.362))
HOME = Field("home", MultiPolygon([SQUARE]))
HEBREW = "חלקה א"


@dataclass(frozen=True)
class Case:
    """A file, its door, and what has to come out."""

    make: Callable[..., Any]
    door: str
    options: ReadOptions
    says: tuple[str, ...] = ()
    at: tuple[tuple[float, float], ...] = ()
    asks: tuple[str, ...] = ()
    refuses: str | None = None
    near: Field | None = None
    places: NamedPlaces | None = None
    check: Callable[[Any], object] | None = None

    @property
    def name(self) -> str:
        return self.make.__name__

    def source(self, folder):
        """Make the file, in the folder if it needs one."""
        return self.make(folder) if self.make.__code__.co_argcount else self.make()


CASES: list[Case] = []
_OPTIONS = {"plots": PlotOptions, "records": RecordOptions}


def case(door: str, **expected: Any):
    """Note the decorated function as a case; ``says`` and ``asks`` may be one text or several."""
    for key in ("says", "asks"):
        if isinstance(expected.get(key), str):
            expected[key] = (expected[key],)
    expected.setdefault("options", _OPTIONS.get(door, ReadOptions)())

    def note(make):
        CASES.append(Case(make, door, **expected))
        return make

    return note


# --- how files are made ------------------------------------------------------------------------


def frame(*shapes, crs=4326, **columns):
    shapes = shapes or (SQUARE,)
    columns = columns or {"name": [f"plot {i + 1}" for i in range(len(shapes))]}
    return gpd.GeoDataFrame(columns, geometry=list(shapes), crs=crs)


def shapefile(folder, rows=None, stem="plots", encoding="utf-8"):
    folder.mkdir(exist_ok=True, parents=True)
    rows = frame() if rows is None else rows
    rows.to_file(folder / f"{stem}.shp", engine="pyogrio", encoding=encoding)
    return folder / f"{stem}.shp"


def geojson(*shapes, crs=None):
    features = [
        {
            "type": "Feature",
            "properties": {"name": f"plot {i + 1}"},
            "geometry": stated(s),
        }
        for i, s in enumerate(shapes or (SQUARE,))
    ]
    root: dict[str, Any] = {"type": "FeatureCollection", "features": features}
    if crs is not None:
        root["crs"] = {"type": "name", "properties": {"name": crs}}
    return Upload("plots.geojson", json.dumps(root, ensure_ascii=False).encode())


def stated(shape):
    if shape is None or isinstance(shape, dict):
        return shape
    return json.loads(shapely.to_geojson(shape))


def polygon(*rings):
    return {"type": "Polygon", "coordinates": [[list(p) for p in ring] for ring in rings]}


def ring_of(area):
    return list(area.exterior.coords)


def zipped(parts, name="estate.zip"):
    """Return a zip of ``{name: bytes}``, or of a folder."""
    if not isinstance(parts, dict):
        parts = {p.relative_to(parts).as_posix(): p.read_bytes() for p in files(parts)}
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for part, content in parts.items():
            archive.writestr(part, content)
    return Upload(name, data.getvalue())


def files(folder):
    return sorted(p for p in folder.rglob("*") if p.is_file())


def table(content, encoding="utf-8"):
    return Upload("mites.csv", content.encode(encoding))


def workbook(folder, rows):
    pd.DataFrame(rows).to_excel(folder / "mites.xlsx", header=False, index=False)
    return folder / "mites.xlsx"


def moved(area, epsg):
    """Return an area in another system, by way of geopandas."""
    return gpd.GeoSeries([area], crs=4326).to_crs(epsg)[0]


def without(path, ending):
    path.with_suffix(ending).unlink()
    return path


# --- containers --------------------------------------------------------------------------------


@case("plots", at=CORNERS)
def a_zip_with_folders_in_folders(folder):
    shapefile(folder / "s/estate 2026/גבולות")
    return zipped(folder / "s")


@case("plots", at=CORNERS)
def a_zip_from_a_mac_with_decoys(folder):
    shapefile(folder / "s")
    parts = {p.name: p.read_bytes() for p in files(folder / "s")}
    decoys = {f"__MACOSX/._{name}": b"\x00\x05\x16\x07" + b"\x00" * 80 for name in parts}
    return zipped(parts | decoys | {".DS_Store": b"\x00\x00\x00\x01Bud1", "Thumbs.db": b"\x00"})


@case("plots", at=CORNERS)
def a_zip_without_its_ending(folder):
    shapefile(folder / "s")
    return Upload("download", zipped(folder / "s").data)


@case("plots", asks=("member", "a/plots.shp", "b/plots.shp"), refuses="holds 2 files")
def two_shapefiles_in_one_zip(folder):
    shapefile(folder / "s/a")
    shapefile(folder / "s/b", frame(SECOND))
    return zipped(folder / "s")


@case("plots", options=PlotOptions(member="b/plots.shp"), at=((35.154, 30.36),))
def two_shapefiles_in_one_zip_and_the_second_chosen(folder):
    return two_shapefiles_in_one_zip(folder)


@case("plots", at=CORNERS)
def a_zip_in_a_zip(folder):
    shapefile(folder / "s")
    return zipped({"outer/plots.zip": zipped(folder / "s").data})


@case("plots", at=CORNERS)
def a_zipped_geopackage(folder):
    frame().to_file(folder / "plots.gpkg")
    return zipped({"plots.gpkg": (folder / "plots.gpkg").read_bytes()})


@case("plots", at=CORNERS)
def a_zipped_gml(folder):
    frame().to_file(folder / "plots.gml", driver="GML")
    return zipped({"x/plots.gml": (folder / "plots.gml").read_bytes()})


KML = """<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Folder><name>estate</name>{body}
</Folder></Document></kml>"""
KML_PLOT = """<Placemark><name>חלקה א</name><Polygon><outerBoundaryIs><LinearRing><coordinates>
35.15,30.36,0 35.152,30.36,0 35.152,30.362,0 35.15,30.362,0 35.15,30.36,0
</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>"""


def is_called_in_hebrew(fields):
    assert fields[0].name == HEBREW


@case("plots", at=CORNERS, check=is_called_in_hebrew)
def a_zipped_kml():
    return zipped({"plots.kml": KML.format(body=KML_PLOT).encode()})


@case("plots", at=CORNERS, check=is_called_in_hebrew)
def a_kmz():
    parts = {"doc.kml": KML.format(body=KML_PLOT).encode(), "images/icon.png": b"\x89PNG\r\n"}
    return zipped(parts, "plots.kmz")


@case("plots", at=CORNERS)
def a_file_geodatabase_in_a_zip(folder):
    (folder / "g").mkdir()
    frame().to_file(folder / "g/plots.gdb", driver="OpenFileGDB", layer="parcels")
    return zipped(folder / "g")


@case("plots", at=CORNERS)
def a_file_geodatabase_in_a_folder(folder):
    frame().to_file(folder / "plots.gdb", driver="OpenFileGDB", layer="parcels")
    return folder / "plots.gdb"


@case("plots", at=CORNERS)
def geoparquet_in_metres(folder):
    frame().to_crs(2039).to_parquet(folder / "plots.parquet")
    return folder / "plots.parquet"


@case("plots", at=CORNERS)
def flatgeobuf_uploaded(folder):
    frame().to_file(folder / "plots.fgb", driver="FlatGeobuf", SPATIAL_INDEX="NO")
    return Upload("plots.fgb", (folder / "plots.fgb").read_bytes())


@case("plots", asks="crs", refuses="around 35.15")
def a_shp_alone_uploaded(folder):
    return Upload("plots.shp", shapefile(folder).read_bytes())


@case(
    "plots",
    options=PlotOptions(crs="EPSG:4326"),
    says=("repaired: index (.shx) was missing", "seen: table (.dbf) is missing"),
    at=CORNERS,
)
def a_shp_alone_with_its_system_named(folder):
    return a_shp_alone_uploaded(folder)


@case("plots", says="repaired: index (.shx) was missing", at=CORNERS)
def a_shapefile_without_its_index(folder):
    return without(shapefile(folder), ".shx")


@case("plots", refuses="only the table of a shapefile")
def a_dbf_alone(folder):
    return Upload("plots.dbf", shapefile(folder).with_suffix(".dbf").read_bytes())


@case("plots", asks=("layer", "peppers", "vines"), refuses="Choose one of: peppers, vines")
def two_layers_with_plots(folder):
    for layer in ("peppers", "vines"):
        frame().to_file(folder / "e.gpkg", layer=layer)
    return folder / "e.gpkg"


def nothing_yet():
    return frame().iloc[:0]


@case("plots", says="seen: Layer vines was read; 1 other holds nothing", at=CORNERS)
def an_empty_layer_beside_the_full_one(folder):
    nothing_yet().to_file(folder / "e.gpkg", layer="drafts", geometry_type="Polygon")
    frame().to_file(folder / "e.gpkg", layer="vines")
    return folder / "e.gpkg"


@case("plots", at=CORNERS)
def a_plain_table_beside_the_layer(folder):
    frame().to_file(folder / "e.gpkg", layer="vines")
    plain = pd.DataFrame({"variety": ["Merlot"], "planted": [1998]})
    pyogrio.write_dataframe(plain, folder / "e.gpkg", layer="varieties")
    return folder / "e.gpkg"


@case("plots", refuses="at least one layer with something in it")
def only_empty_layers(folder):
    for layer in ("a", "b"):
        nothing_yet().to_file(folder / "e.gpkg", layer=layer, geometry_type="Polygon")
    return folder / "e.gpkg"


@case("plots", refuses="damaged")
def a_zip_that_breaks_off():
    whole = zipped({"plots.geojson": geojson().data})
    return Upload("plots.zip", whole.data[: len(whole.data) // 2])


@case("plots", refuses="nothing of the kind")
def a_zip_with_photographs_only():
    return zipped({"a.jpg": b"\xff\xd8\xff\xe0", "b.jpg": b"\xff\xd8\xff\xe0"})


@case("plots", refuses="is a raster")
def an_orthophoto_where_plots_are_asked_for():
    return Upload("ortho.tif", b"II*\x00" + b"\x00" * 100)


# --- coordinate systems ------------------------------------------------------------------------


@case(
    "plots",
    options=PlotOptions(country="Israel"),
    asks=("crs", "EPSG:2039"),
    refuses="would put it at 35.15",
)
def no_prj_in_the_new_israeli_grid(folder):
    return without(shapefile(folder, frame().to_crs(2039)), ".prj")


@case("plots", options=PlotOptions(near=PARAN), asks=("crs", "EPSG:28193"), refuses="km from")
def no_prj_in_the_old_israeli_grid(folder):
    return without(shapefile(folder, frame().to_crs(28193)), ".prj")


@case("plots", options=PlotOptions(crs="2039"), at=CORNERS)
def no_prj_and_the_system_named_by_its_number(folder):
    return no_prj_in_the_new_israeli_grid(folder)


@case("plots", options=PlotOptions(crs="EPSG:nowhere"), asks="crs", refuses="'EPSG:nowhere'")
def no_prj_and_a_system_that_does_not_exist(folder):
    return no_prj_in_the_new_israeli_grid(folder)


@case(
    "plots",
    options=PlotOptions(near=PARAN),
    asks=("crs", "EPSG:2039"),
    refuses="coordinates are no degrees",
)
def geojson_in_metres_that_says_nothing():
    return geojson(moved(SQUARE, 2039))


@case("plots", at=CORNERS, says="seen: EPSG:2039")
def geojson_in_metres_that_says_so():
    return geojson(moved(SQUARE, 2039), crs="urn:ogc:def:crs:EPSG::2039")


GERMAN = box(8.0, 49.0, 8.002, 49.002)
IN_GERMANY = ((8.0, 49.0), (8.002, 49.002))


def with_zone_32_in_front():
    return shapely.transform(moved(GERMAN, 25832), lambda xy: xy + np.array([32e6, 0.0]))


@case("plots", at=IN_GERMANY, says="repaired: zone number 32 in front of the eastings")
def eastings_with_the_zone_in_front():
    return geojson(with_zone_32_in_front(), crs="EPSG:25832")


@case("plots", at=IN_GERMANY)
def a_system_that_counts_the_zone_in():
    return geojson(moved(GERMAN, 4647), crs="EPSG:4647")


@case("plots", options=PlotOptions(country="Germany"), asks="crs", refuses="would put it at 8.00")
def eastings_with_the_zone_in_front_and_no_system(folder):
    return without(shapefile(folder, frame(with_zone_32_in_front(), crs=25832)), ".prj")


# the published shifts of ED50 in Spain (about -87, -98, -121 m), applied by hand
ED50, AS_WGS84 = (-3.0, 40.0), (-3.00129, 39.99884)


def lies_a_hundred_metres_off(fields):
    corner = np.array(fields[0].boundary.bounds[:2])
    assert np.abs(corner - AS_WGS84).max() < 2e-4  # published shifts differ by ten metres
    assert np.abs(corner - ED50).min() > 1e-3


@case(
    "plots",
    says="doubtful: ED50 (EPSG:4230); PROJ states 1.5 m for this. A better",
    check=lies_a_hundred_metres_off,
)
def degrees_that_are_not_wgs84():
    return geojson(box(*ED50, -2.998, 40.002), crs="EPSG:4230")


def lies_where_the_ordnance_survey_says(fields):
    # the Ordnance Survey's worked example: TG 51409 13177, and what it is in ETRS89
    corners = shapely.get_coordinates(fields[0].boundary)
    assert np.abs(corners - (1.716073973, 52.658007833)).max(axis=1).min() < 7e-5


@case(
    "plots",
    says="doubtful: needs the grid file uk_os_OSTN15",
    check=lies_where_the_ordnance_survey_says,
)
def the_british_grid_without_its_grid_file():
    return geojson(box(651409.804, 313177.450, 651509.804, 313277.450), crs="EPSG:27700")


@case(
    "plots",
    options=PlotOptions(crs="EPSG:2039"),
    at=CORNERS,
    says="seen: coordinate system named by hand",
)
def a_prj_that_lies_and_the_right_system_named(folder):
    lying = frame().to_crs(2039).set_crs(28193, allow_override=True)
    return shapefile(folder, lying)


@case("plots", refuses="lie where", options=PlotOptions(crs="EPSG:2039"))
def numbers_in_the_millions_of_millions():
    return geojson(box(1e12, 1e12, 1e12 + 100, 1e12 + 100), crs="EPSG:2039")


@case("plots", asks="crs", refuses="leaves its coordinate system to another file")
def geojson_whose_system_is_an_address():
    root = json.loads(geojson().data)
    root["crs"] = {"type": "link", "properties": {"href": "http://example.org/crs", "type": "wkt"}}
    return Upload("plots.geojson", json.dumps(root).encode())


# --- order of axes -----------------------------------------------------------------------------


def swapped(area):
    return shapely.transform(area, lambda xy: xy[:, ::-1])


AUSTRALIA = box(140.0, -35.0, 140.002, -34.998)


@case("plots", asks=("swap_axes", "yes"), refuses="Latitudes must lie in -90..90")
def latitude_first_outside_the_range():
    return geojson(swapped(AUSTRALIA))


@case("plots", options=PlotOptions(swap_axes=True), at=((140.0, -35.0),))
def latitude_first_exchanged_as_offered():
    return geojson(swapped(AUSTRALIA))


@case(
    "plots",
    options=PlotOptions(near=PARAN),
    says="doubtful: longitude and latitude exchanged [swap_axes=yes]",
    at=((30.36, 35.15),),
)
def latitude_first_within_the_range_near_a_place():
    return geojson(swapped(SQUARE))


def on_a_day(lon, lat, count):
    return f"{lon},{lat},2026-03-01,{count}\n"


@case("records", near=HOME, asks=("swap_axes", "yes"), refuses="exchanged they would be 0 m away")
def records_swapped_far_from_the_plot():
    return table(f"longitude,latitude,date,count\n{on_a_day(30.361, 35.151, 1)}")


@case(
    "records",
    near=HOME,
    says=(
        "dropped: 1 of 3 records lies outside home",
        "doubtful: 1 record would lie on the plot with longitude and latitude exchanged",
    ),
    at=((35.15101, 30.36101), (35.1512, 30.3612)),
)
def one_record_swapped_among_good_ones():
    rows = [(35.15101, 30.36101, 1), (35.1512, 30.3612, 0), (30.3613, 35.1513, 2)]
    return table("longitude,latitude,date,count\n" + "".join(on_a_day(*row) for row in rows))


@case("records", says="repaired: stood in the column of latitudes", at=((35.15101, 30.36101),))
def letters_that_say_the_columns_are_crossed():
    return table("lat,lon,date,count\n35.15101 E,30.36101 N,2026-03-01,1\n")


# --- geometry ----------------------------------------------------------------------------------

TIE = polygon([(35.15, 30.36), (35.152, 30.362), (35.152, 30.36), (35.15, 30.362), (35.15, 30.36)])


def is_a_tie(fields):
    assert len(fields[0].boundary.geoms) == 2
    half = shapely.area(SQUARE) / 2
    np.testing.assert_allclose(shapely.area(fields[0].boundary), half, rtol=1e-6)


@case(
    "plots",
    says="doubtful: wrong order: the outline crosses itself at 35.151000",
    at=CORNERS,
    check=is_a_tie,
)
def a_bow_tie():
    return geojson(TIE)


@case("plots", says="doubtful: 2.13", at=CORNERS)
def a_bow_tie_says_its_new_area():
    return geojson(TIE)


@case("plots", says="dropped: 2 features without a geometry", at=CORNERS)
def features_without_geometry():
    return geojson(SQUARE, None, {"type": "Polygon", "coordinates": []})


@case("plots", says="seen: Heights and measures", at=CORNERS)
def heights_and_measures(folder):
    flat = shapely.get_coordinates(SQUARE)
    frame(Polygon(np.column_stack([flat, np.full(len(flat), 310.0)]))).to_file(folder / "p.gpkg")
    return folder / "p.gpkg"


def has_two_parts(fields):
    assert len(fields) == 1
    assert len(fields[0].boundary.geoms) == 2


@case("plots", says="seen: several parts, which were kept", check=has_two_parts, at=CORNERS)
def a_plot_of_two_parts():
    return geojson(MultiPolygon([SQUARE, SECOND]))


HOLE = box(35.1505, 30.3605, 35.151, 30.361)


def keeps_its_hole(fields):
    (part,) = fields[0].boundary.geoms
    np.testing.assert_allclose(part.interiors[0].bounds, HOLE.bounds, atol=1e-9)


@case("plots", says="seen: has holes", check=keeps_its_hole)
def a_plot_with_a_pond():
    return geojson(SQUARE.difference(HOLE))


@case("plots", says=("repaired: was not valid", "seen: has holes"), check=keeps_its_hole)
def the_same_hole_twice():
    return geojson(polygon(ring_of(SQUARE), ring_of(HOLE), ring_of(HOLE)))


@case("plots", says="repaired: was not valid", at=CORNERS)
def a_hole_outside():
    return geojson(polygon(ring_of(SQUARE), ring_of(SECOND)))


@case("plots", says="repaired: was not valid", at=CORNERS)
def the_same_part_twice():
    ring = ring_of(SQUARE)
    return geojson({"type": "MultiPolygon", "coordinates": [[ring], [ring]]})


@case("plots", says="doubtful: same outline as plot 1", at=CORNERS)
def the_same_plot_twice():
    return geojson(SQUARE, SQUARE)


@case("plots", says="dropped: 1 part too small or narrow", at=CORNERS)
def a_sliver_beside_the_plot():
    sliver = box(35.1530, 30.36, 35.1530002, 30.362)
    return geojson(MultiPolygon([SQUARE, sliver]))


@case("plots", says="doubtful: but this one has 4.2")
def a_plot_of_four_square_metres():
    return geojson(box(35.15, 30.36, 35.15002, 30.36002))


@case("plots", says="doubtful: Check the coordinate system and the choice of feature")
def a_plot_as_large_as_a_district():
    return geojson(box(35.0, 30.0, 35.5, 30.5))


@case("plots", refuses="none has")
def a_plot_without_any_width():
    return geojson(polygon([(35.15, 30.36), (35.152, 30.36), (35.151, 30.36), (35.15, 30.36)]))


@case("plots", says="repaired: 1 feature did not end where it began", at=CORNERS)
def a_ring_that_is_not_closed():
    return geojson(polygon(ring_of(SQUARE)[:-1]))


@case("plots", says="guessed: closed line was taken as the outlines", at=CORNERS)
def outlines_drawn_as_lines():
    return geojson(SQUARE.exterior)


LINE = LineString([(35.15, 30.36), (35.152, 30.361)])


@case("plots", asks=("kind", "lines"), refuses="rows or paths")
def lines_where_plots_are_asked_for():
    return geojson(LINE)


@case("plots", asks=("kind", "plants"), refuses="plants or records")
def points_where_plots_are_asked_for():
    return geojson(Point(PARAN), Point(35.151, 30.36))


@case(
    "plots",
    says=("dropped: 1 line was left out", "dropped: 1 point was left out"),
    at=CORNERS,
)
def areas_lines_and_points_in_one_file():
    return geojson(SQUARE, LINE, Point(PARAN))


@case("lines", says="dropped: 2 features that are no lines")
def lines_among_other_things():
    return areas_lines_and_points_in_one_file()


@case("plants", asks=("doubles", "one"), refuses="1 of 3 are within 5 cm of an earlier one")
def plants_on_top_of_each_other():
    return geojson(Point(35.15001, 30.36001), Point(35.15002, 30.36), Point(35.15002, 30.36))


@case(
    "plots",
    says=("dropped: cannot be understood", "dropped: 1 feature without"),
    at=CORNERS,
)
def one_broken_feature_among_good_ones():
    return geojson(SQUARE, {"type": "Polygon", "coordinates": [["a", "b"]]})


@case("plots", says=("dropped: no numbers", "dropped: 1 feature without"), at=CORNERS)
def coordinates_that_are_no_numbers():
    broken = polygon([(35.15, 30.36), (float("nan"), 30.36), (35.152, 30.362), (35.15, 30.36)])
    return geojson(SQUARE, broken)


# --- text --------------------------------------------------------------------------------------


def hebrew_shapefile(folder, encoding, cpg, name=HEBREW):
    """Return a shapefile whose table does not say its code page, and its .cpg whatever is told."""
    path = shapefile(folder, frame(name=[name], note=["גבול דרום"]), encoding=encoding)
    path.with_suffix(".cpg").unlink(missing_ok=True)
    if cpg is not None:
        path.with_suffix(".cpg").write_text(cpg)
    data = bytearray(path.with_suffix(".dbf").read_bytes())
    data[29] = 0
    path.with_suffix(".dbf").write_bytes(bytes(data))
    return path


@case("plots", check=is_called_in_hebrew, at=CORNERS)
def hebrew_in_utf8_without_a_cpg(folder):
    return hebrew_shapefile(folder, "utf-8", None)


@case("plots", check=is_called_in_hebrew, says="guessed: read as cp1255 [encoding=cp862]")
def hebrew_of_windows_without_a_cpg(folder):
    return hebrew_shapefile(folder, "cp1255", None)


@case("plots", check=is_called_in_hebrew, says="guessed: read as cp862 [encoding=cp1255]")
def hebrew_of_dos_without_a_cpg(folder):
    return hebrew_shapefile(folder, "cp862", None)


@case("plots", check=is_called_in_hebrew, says="repaired: the text is UTF-8")
def a_cpg_that_lies_about_utf8(folder):
    return hebrew_shapefile(folder, "utf-8", "1252")


@case("plots", check=is_called_in_hebrew, says="guessed: The .cpg file says utf-8")
def a_cpg_that_says_utf8_of_windows_hebrew(folder):
    return hebrew_shapefile(folder, "cp1255", "UTF-8")


@case("plots", check=is_called_in_hebrew, options=PlotOptions(encoding="cp1255"))
def hebrew_read_as_told(folder):
    return hebrew_shapefile(folder, "cp1255", "1252")


@case("plots", asks=("encoding", "cp1255"), options=PlotOptions(encoding="utf-8"), refuses="utf-8")
def hebrew_read_as_told_wrongly(folder):
    return hebrew_shapefile(folder, "cp1255", None)


def is_called_hoell(fields):
    assert fields[0].name == "Höll"


@case("plots", check=is_called_hoell, says="guessed: read as cp1252")
def umlauts_of_windows_without_a_cpg(folder):
    path = shapefile(folder, frame(name=["Höll"]), encoding="cp1252")
    return without(path, ".cpg")


def has_count_and_accuracy(records):
    assert records.count.tolist() == [4.0]
    assert records.accuracy_m.tolist() == [3.0]


@case("records", check=has_count_and_accuracy, at=((35.15101, 30.36101),))
def column_names_cut_to_ten_letters(folder):
    columns = {"individualCount": [4], "coordinateUncertaintyInMeters": [3.0], "date": ["2026"]}
    cut = {name[:10]: values for name, values in columns.items()} | {"date": ["2026-03-01"]}
    return shapefile(folder, frame(Point(35.15101, 30.36101), **cut), stem="mites")


# --- tables ------------------------------------------------------------------------------------


def counts(*expected):
    return lambda records: np.testing.assert_array_equal(records.count, expected)


def days(*expected):
    def check(records):
        assert records.day.astype(str).tolist() == list(expected)

    return check


def states(*expected):
    def check(records):
        assert records.present.tolist() == list(expected)

    return check


HERE = ((35.15013, 30.36013),)
DAY = "2026-03-01"


@case("records", at=HERE, check=counts(1234.5))
def semicolons_decimal_commas_and_thousands():
    head = "Länge;Breite;Datum;Anzahl\n"
    return table(f"{head}35,15013;30,36013;01.03.2026;1.234,5\n", encoding="cp1252")


@case("records", at=HERE, check=counts(1234.0))
def a_byte_order_mark_and_a_sep_line():
    return table(f"\ufeffsep=;\nlon;lat;date;count\n35.15013;30.36013;{DAY};1 234\n")


@case("records", at=HERE, check=counts(7))
def utf16_from_excel_with_tabs():
    head = "lon\tlat\tdate\tcount\n"
    return table(f"{head}35.15013\t30.36013\t{DAY}\t7\n", encoding="utf-16")


@case("records", at=HERE, check=counts(7), says="guessed: read as cp1255 [encoding=cp862]")
def hebrew_columns_in_cp1255():
    head = "קו אורך,קו רוחב,תאריך,כמות\n"
    return table(f"{head}35.15013,30.36013,{DAY},7\n", encoding="cp1255")


@case("records", at=HERE, check=counts(7))
def a_line_break_inside_quotes():
    head = "lon,lat,date,remarks,count\n"
    return table(f'{head}35.15013,30.36013,{DAY},"near the gate,\nunder the vine",7\n')


RECORD = [35.15013, 30.36013, DAY, 7]


@case("records", at=HERE, check=counts(7), says="seen: 3 lines above the column names")
def excel_with_lines_of_title(folder):
    rows = [
        ["Monitoring 2026", *[None] * 3],
        ["Block 7", *[None] * 3],
        [None] * 4,
        ["lon", "lat", "date", "count"],
        RECORD,
    ]
    return workbook(folder, rows)


@case("records", at=HERE, check=counts(7), says="seen: 2 lines above the column names")
def a_csv_with_lines_of_title():
    head = "Monitoring 2026;;;\nBlock 7;;;\nlon;lat;date;count\n"
    return table(f"{head}35,15013;30,36013;{DAY};7\n")


@case("records", asks=("layer", "spring", "autumn"), refuses="spring")
def a_workbook_with_two_full_sheets(folder):
    with pd.ExcelWriter(folder / "m.xlsx") as book:
        for sheet in ("spring", "autumn"):
            one = pd.DataFrame([RECORD], columns=["lon", "lat", "date", "count"])
            one.to_excel(book, sheet_name=sheet, index=False)
    return folder / "m.xlsx"


@case("records", asks=("columns", "lon=a", "lat=b"), refuses="column of longitudes")
def columns_that_nobody_knows():
    return table("a,b,c\n35.15013,30.36013,7\n")


@case("records", says="dropped: 1 line has more cells than there are columns")
def a_line_with_too_many_cells():
    rows = f"35.15013,30.36013,{DAY},7\n35.15023,30.36023,{DAY},8,oops\n"
    return table(f"lon,lat,date,count\n{rows}")


# --- positions in tables -----------------------------------------------------------------------


def placed(cells, head="lat,lon"):
    return table(f"{head},date,count\n{cells},{DAY},7\n")


SECONDS = ((35 + 9 / 60 + 0.377 / 3600, 30 + 21 / 60 + 36.367 / 3600),)


@case("records", at=SECONDS)
def degrees_minutes_seconds():
    return placed('"30°21\'36.367""N","35°09\'00.377""E"')


@case("records", at=((35.15013, -30.36013),))
def letters_before_the_numbers():
    return placed("S 30.36013,E 35.15013")


@case("records", at=((-(35 + 9.0123 / 60), 30 + 21.6123 / 60),))
def degrees_and_minutes_in_the_west():
    return placed("30 21.6123 N,35 09.0123 W")


@case("records", at=HERE, says="guessed: read as latitude, longitude [swap_axes=yes]")
def both_coordinates_in_one_cell():
    return placed('"30.36013, 35.15013"', "gps")


@case("records", at=HERE)
def well_known_text_in_a_cell():
    return placed("POINT (35.15013 30.36013)", "location")


@case(
    "records",
    at=(HERE[0], (35.15013, 30.36023)),
    says="dropped: 1 record without a usable position was left out, for instance "
    "'35.15023 / 07.16.5046' in record 3. 1 of them have two points [degrees=dms]",
)
def impossible_minutes_are_not_guessed():
    good = f"30.36013,35.15013,{DAY},7\n30.36023,35.15013,{DAY},8"
    return placed(f"{good}\n07.16.5046,35.15023")


@case("records", refuses="not one record has any")
def minutes_beyond_sixty():
    return placed("30 75 10,35 75 10")


@case("records", options=RecordOptions(near=PARAN), asks=("crs", "EPSG:2039"), refuses="km from")
def projected_columns_without_a_system():
    point = moved(Point(HERE[0]), 2039)
    return placed(f"{point.x},{point.y}", "easting,northing")


@case("records", at=HERE, says="seen: Column 'epsg' names the coordinate system")
def projected_columns_with_a_column_that_names_their_system():
    point = moved(Point(HERE[0]), 2039)
    return placed(f"{point.x},{point.y},2039", "easting,northing,epsg")


@case("records", asks=("where", "datum=WGS84"), refuses="one coordinate system")
def two_systems_in_one_table():
    return table("lon,lat,datum,count\n35.15,30.36,WGS84,1\n35.151,30.36,EPSG:4230,1\n")


def is_as_rough_as_it_was_rounded(records):
    np.testing.assert_allclose(records.accuracy_m, 111.32 / np.sqrt(6), rtol=1e-3)


@case(
    "records",
    at=((35.15, 30.36), (35.151, 30.361)),
    says="doubtful: rounded to about 111 m: too coarse to name a plant",
    check=is_as_rough_as_it_was_rounded,
)
def coordinates_rounded_too_coarsely():
    return table(f"lon,lat,date,count\n35.150,30.360,{DAY},1\n35.151,30.361,{DAY},0\n")


ROWS = Plants(
    np.array([(35.1501, 30.3601), (35.1502, 30.3601), (35.1501, 30.3602)]),
    np.array(["1", "1", "2"]),
    np.array(["1", "2", "1"]),
)


@case(
    "records",
    places=NamedPlaces(plants=ROWS),
    at=((35.1501, 30.3602), (35.1502, 30.3601)),
    says="dropped: 1 record names 1 plant not known: 7/7",
)
def rows_and_plants_by_number():
    return table(f"row,plant,date,count\n2,1,{DAY},4\n1,2,{DAY},0\n7,7,{DAY},1\n")


@case("records", asks="plants", refuses="name plants instead of positions")
def rows_and_plants_without_any_plants():
    return rows_and_plants_by_number()


@case(
    "records",
    places=NamedPlaces(plots=(Field("North 1", MultiPolygon([SQUARE])),)),
    at=((35.151, 30.361),),
    says=(
        "guessed: without capitals, spaces and marks",
        "seen: somewhere on it",
        "dropped: 2 records name 1 plot not known: South",
        "dropped: 2 records name no plot at all",
    ),
)
def plots_by_name_with_some_unknown():
    rows = [("north-1", 4), ("South", 0), ("South", 2), ("", 1), ("NA", 0)]
    return table("field,date,count\n" + "".join(f"{name},{DAY},{n}\n" for name, n in rows))


@case("records", asks="plots", refuses="name plots instead of positions")
def plots_by_name_without_any_plots():
    return plots_by_name_with_some_unknown()


# --- dates -------------------------------------------------------------------------------------


def dated(*cells):
    rows = (f"{35.15013 + i / 10_000:.5f},30.36013,{cell},1" for i, cell in enumerate(cells))
    return table("lon,lat,date,count\n" + "\n".join(rows))


@case("records", check=days("2026-03-13", "2026-04-03"))
def dates_that_can_only_be_day_first():
    return dated("13/03/2026", "03/04/2026")


@case("records", check=days("2026-03-13", "2026-03-04"))
def dates_that_can_only_be_month_first():
    return dated("03/13/2026", "03/04/2026")


@case("records", check=days("2026-04-03"), says="guessed: read day first [date_order=mdy]")
def dates_that_could_be_both():
    return dated("03/04/2026")


@case("records", check=days("2026-03-04"), options=RecordOptions(date_order="mdy"))
def dates_that_could_be_both_and_were_told():
    return dated("03/04/2026")


@case("records", asks=("date_order", "dmy", "mdy"), refuses="must stand in one order")
def dates_in_both_orders():
    return dated("13/03/2026", "03/13/2026")


@case(
    "records",
    check=days("2026-03-13", "NaT"),
    options=RecordOptions(date_order="dmy"),
    says="doubtful: 1 record has a date that is none (record 2: '03/13/2026')",
)
def dates_in_both_orders_that_were_told():
    return dated("13/03/2026", "03/13/2026")


@case("records", check=days(*["2026-03-01"] * 4))
def dates_in_words_and_iso():
    return dated("2026-03-01T08:15:00+02:00", "1 March 2026", "20260301", "1. März 2026")


@case("records", check=days("2026-03-01"))
def dates_in_three_columns():
    return table("lon,lat,year,month,day,count\n35.15013,30.36013,2026,3,1,4\n")


@case("records", check=days("2026-03-01"), says="guessed: days counted by Excel")
def dates_as_serial_numbers():
    return dated("46082")


@case("records", check=days("2026-03-01"), at=HERE)
def dates_of_a_workbook(folder):
    record = [35.15013, 30.36013, pd.Timestamp(2026, 3, 1), 4]
    return workbook(folder, [["lon", "lat", "date", "count"], record])


@case("records", says="doubtful: 1 record lies in the future, the last on 2126-03-01")
def dates_in_the_future():
    return dated("2026-03-01", "2126-03-01")


@case(
    "records",
    check=days("2026-03-01", "NaT"),
    says="doubtful: date that is none (record 2: 'soon')",
)
def dates_that_are_none():
    return dated("2026-03-01", "soon")


@case("records", says="doubtful: No column was recognised as the date", at=HERE)
def no_dates_at_all():
    return table("lon,lat,count\n35.15013,30.36013,1\n")


# --- counts ------------------------------------------------------------------------------------


def counted(*cells):
    rows = (f"{35.15013 + i / 10_000:.5f},30.36013,{DAY},{cell}" for i, cell in enumerate(cells))
    return table("lon,lat,date,count\n" + "\n".join(rows))


@case("records", check=states(1, 0, -1, 1, 0), says="seen: 1 record has no count")
def zero_apart_from_missing():
    return counted(3, 0, "NA", "present", "none")


@case(
    "records",
    check=states(1, -1, 1, 1, 1),
    says=(
        "doubtful: 4 counts are no plain number ('<5', '~20', '10-20'); read roughly",
        "doubtful: 1 count says neither how many nor whether any ('<1')",
    ),
)
def counts_as_text():
    return counted("<5", "<1", "~20", "10-20", ">100")


@case("records", check=counts(np.nan, 3), says="doubtful: 1 count says neither how many")
def a_count_below_zero():
    return counted(-4, 3)


@case(
    "records",
    asks=("columns", "present="),
    refuses="must have a column that says what was found (count, found, result), but none",
)
def records_without_any_count():
    return table(f"lon,lat,date\n35.15013,30.36013,{DAY}\n35.15023,30.36013,{DAY}\n")


@case(
    "records",
    check=states(0, 1),
    says="doubtful: 1 record contradicts its own count",
)
def counts_and_presence_at_odds():
    rows = f"35.15013,30.36013,{DAY},3,absent\n35.15023,30.36013,{DAY},3,present\n"
    return table("lon,lat,date,count,status\n" + rows)


@case("records", says="dropped: 1 record repeats another in every column", at=HERE)
def the_same_record_twice():
    return table("lon,lat,date,count\n" + f"35.15013,30.36013,{DAY},3\n" * 2)


@case("records", says="doubtful: another count for a place and day")
def two_counts_of_one_plant_and_day():
    rows = f"35.15013,30.36013,{DAY},3\n35.15013,30.36013,{DAY},0\n"
    return table("lon,lat,date,count\n" + rows)


@case("records", asks=("where", "species=T. urticae"), refuses="must be of one pest")
def two_species_in_one_file():
    rows = f"35.15013,30.36013,{DAY},3,T. urticae\n35.15023,30.36013,{DAY},3,B. tabaci\n"
    return table("lon,lat,date,count,species\n" + rows)


@case(
    "records",
    near=HOME,
    at=((35.15101, 30.36101),),
    says="dropped: 2 of 3 records lie outside home and were kept apart: 961 m to 28.84 km",
)
def records_elsewhere():
    rows = [(35.15101, 30.36101, 3), (35.162, 30.36101, 1), (35.452, 30.36101, 1)]
    return table("lon,lat,date,count\n" + "".join(on_a_day(*row) for row in rows))


@case("records", near=HOME, at=((35.15351, 30.36101),))
def a_rough_position_that_may_be_on_the_plot():
    return table(f"lon,lat,date,count,accuracy\n35.15351,30.36101,{DAY},3,120\n")


# --- hostile files -----------------------------------------------------------------------------


def forged(name, data, mode=0):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        info = zipfile.ZipInfo(name)
        info.compress_type = zipfile.ZIP_DEFLATED
        info.external_attr = mode << 16
        archive.writestr(info, data)
    return Upload("estate.zip", packed.getvalue())


@case("plots", refuses="points outside")
def a_name_that_climbs_out():
    return forged("../../plots.geojson", geojson().data)


@case("plots", refuses="points outside")
def a_name_that_climbs_out_with_backslashes():
    return forged("..\\..\\plots.geojson", geojson().data)


@case("plots", at=CORNERS)
def a_name_from_the_root_is_only_a_name():
    return forged("/etc/plots.geojson", geojson().data)


@case("plots", refuses="link to another file")
def a_link_to_another_file():
    return forged("plots.geojson", b"/etc/passwd", mode=0o120777)


@case("plots", refuses="100 times its size at most")
def a_bomb_of_blanks():
    return forged("plots.geojson", b" " * 150_000_000)


@case("plots", refuses="2 deep inside each other at most")
def archives_in_archives_in_archives():
    data, name = geojson().data, "plots.geojson"
    for depth in range(4):
        data, name = zipped({name: data}).data, f"{depth}.zip"
    return Upload("plots.zip", data)


@case("plots", refuses="2000 files at most")
def an_archive_of_thousands():
    return zipped({f"{i}.txt": b"x" for i in range(2001)})


def lying_about_its_size(n_bytes):
    data = bytearray(zipped({"plots.geojson": geojson().data}).data)
    at = data.index(b"PK\x01\x02") + 24
    data[at : at + 4] = struct.pack("<I", n_bytes)
    return Upload("plots.zip", bytes(data))


@case("plots", refuses="1 GB at most")
def a_directory_that_promises_terabytes():
    return lying_about_its_size(0xFFFFFFF0)


@case("plots", refuses="is damaged")
def an_entry_that_is_longer_than_it_says():
    return lying_about_its_size(80)


@case("plots", refuses="locked with a password")
def a_locked_archive():
    data = bytearray(zipped({"plots.geojson": geojson().data}).data)
    data[data.index(b"PK\x01\x02") + 8] |= 1
    data[6] |= 1
    return Upload("plots.zip", bytes(data))


VRT = (
    '<OGRVRTDataSource><OGRVRTLayer name="x"><SrcDataSource>{}</SrcDataSource></OGRVRTLayer>'
    "</OGRVRTDataSource>"
)


@case("plots", refuses="only points at other files")
def a_vrt():
    return Upload("plots.vrt", VRT.format("/etc/passwd").encode())


@case("plots", refuses="only points at other files")
def a_vrt_called_kml():
    return Upload("plots.kml", VRT.format("/vsicurl/http://127.0.0.1/x").encode())


@case("plots", refuses="only points at other files")
def a_vrt_in_a_zip():
    return zipped({"plots.vrt": VRT.format("/etc/passwd").encode()})


@case("plots", refuses="XML entities")
def entities_that_read_files():
    head = '<?xml version="1.0"?><!DOCTYPE kml [<!ENTITY x SYSTEM "file:///etc/passwd">]>'
    return Upload("p.kml", (head + KML.format(body="&x;")).encode())


@case("plots", refuses="begins with something else")
def entities_behind_a_long_comment():
    bombs = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 12))
    head = f'<?xml version="1.0"?><!--{"-x" * 4000}--><!DOCTYPE kml [<!ENTITY e0 "lol">{bombs}]>'
    body = KML.format(body=f"<name>&e11;</name>{KML_PLOT}").partition("?>")[2]
    return Upload("p.kml", (head + body).encode())


@case("plots", refuses="at least one layer")
def a_kml_that_only_links_to_the_network():
    link = "<NetworkLink><Link><href>http://127.0.0.1:9/x.kml</href></Link></NetworkLink>"
    return Upload("p.kml", KML.format(body=link).encode())


@case("plots", refuses="beyond reason")
def geojson_nested_a_hundred_thousand_deep():
    return Upload("p.geojson", b'{"type":' + b"[" * 100_000)


@case("plots", refuses="5000000 vertices at most")
def more_vertices_than_any_plot_has(folder):
    t = np.linspace(0, 2 * np.pi, 1_000_001)
    ring = Polygon(np.column_stack([35.15 + np.cos(t) / 1000, 30.36 + np.sin(t) / 1000]))
    frame(*[ring] * 6).to_file(folder / "p.gpkg")
    return folder / "p.gpkg"


@case("plots", refuses="1000000 features at most")
def more_features_than_any_estate_has(folder):
    many = gpd.GeoDataFrame(geometry=gpd.GeoSeries([None] * 1_000_001, crs=4326))
    many.to_parquet(folder / "p.parquet")
    return folder / "p.parquet"


@case("records", refuses="1000 columns at most")
def more_columns_than_any_table_has():
    names = ["lon", "lat", "count", *(f"c{i}" for i in range(1500))]
    return table(",".join(names) + "\n" + ",".join(["35"] * len(names)))


@case("plots", refuses="log-in page")
def a_web_page_instead_of_the_file():
    return Upload("plots.geojson", b"<!DOCTYPE html><html><body>Please log in</body></html>")


@case("plots", refuses="is empty")
def an_empty_file():
    return Upload("plots.geojson", b"")


@case("plots", refuses="cannot be read")
def a_geopackage_cut_in_half(folder):
    frame().to_file(folder / "p.gpkg")
    data = (folder / "p.gpkg").read_bytes()
    return Upload("p.gpkg", data[: len(data) // 3])


@case("plots", refuses="XML entities")
def a_document_type_of_its_own():
    head = f'<?xml version="1.0"?><!DOCTYPE kml [<!ELEMENT kml ANY><!--{"-x" * 4000}-->]>'
    body = KML.format(body=KML_PLOT).partition("?>")[2]
    return Upload("p.kml", (head + body).encode())


@case("records", at=(*HERE, (35.15023, 30.36023)), check=days("2026-03-13", "2026-03-14"))
def a_german_datum_is_a_day_and_no_system():
    rows = "35,15013;30,36013;13.03.2026;4\n35,15023;30,36023;14.03.2026;0\n"
    return table("Länge;Breite;Datum;Anzahl\n" + rows)


@case("records", at=HERE, check=counts(1234))
def thousands_in_quotes_beside_decimal_points():
    return table(f'lon,lat,date,count\n35.15013,30.36013,{DAY},"1,234"\n')


@case("records", at=HERE, check=counts(1234))
def thousands_with_points_beside_decimal_commas():
    return table(f"lon;lat;date;count\n35,15013;30,36013;{DAY};1.234\n")


@case(
    "records",
    places=NamedPlaces(plants=ROWS),
    check=counts(1234),
    says="guessed: Counts such as 1,234 were read as thousands [decimal=,]",
)
def thousands_beside_nothing_that_tells():
    return table(f"row;plant;date;count\n1;1;{DAY};1,234\n")


@case(
    "records",
    options=RecordOptions().naming(present=""),
    check=states(1, 1),
    says="seen: Every record was taken as a find, as told",
)
def records_without_any_count_that_are_all_finds():
    return records_without_any_count()


@case("records", asks=("columns", "count=eggs", "present="), refuses="says what was found")
def a_column_that_could_be_the_count_is_offered():
    return table(f"lon,lat,date,eggs,by\n35.15013,30.36013,{DAY},4,Noa\n")


@case("records", says="doubtful: No column was recognised as the date [columns=date=seen on]")
def a_column_that_could_be_the_date_is_offered():
    return table(f"lon,lat,seen on,count,by\n35.15013,30.36013,{DAY},4,Noa\n")


@case(
    "records",
    places=NamedPlaces(plants=ROWS),
    asks=("where", "block=A", "block=B"),
    refuses="rows and plants must be of one plot",
)
def rows_and_plants_of_several_plots():
    return table(f"block,row,plant,date,count\nA,1,1,{DAY},4\nB,1,1,{DAY},0\n")


@case(
    "records",
    places=NamedPlaces(plants=ROWS),
    options=RecordOptions(where="block=A"),
    at=((35.1501, 30.3601),),
)
def rows_and_plants_of_the_plot_that_was_chosen():
    return rows_and_plants_of_several_plots()


@case("plots", asks="crs", refuses="does not say in which coordinate system")
def a_prj_that_nobody_understands(folder):
    path = shapefile(folder, frame().to_crs(2039))
    path.with_suffix(".prj").write_bytes(b'PROJCS["Israel_TM_Grid",GEOGCS["GCS\x00')
    return path


@case("plots", options=PlotOptions(crs="EPSG:2039"), says="doubtful: (.prj) cannot", at=CORNERS)
def a_prj_that_nobody_understands_and_the_system_named(folder):
    return a_prj_that_nobody_understands(folder)


@case("records", near=HOME, asks=("crs", "EPSG:28193"), refuses="0.1 km from the plot or")
def eastings_without_a_system_beside_a_plot_that_tells():
    point = moved(Point(HERE[0]), 28193)
    return placed(f"{point.x},{point.y}", "easting,northing")


@case("plots", refuses="500 MB at most, but p.gpkg has 501 MB")
def a_file_of_half_a_gigabyte(folder):
    with (folder / "p.gpkg").open("wb") as file:
        file.truncate(501_000_000)
    return folder / "p.gpkg"


@case("records", refuses="field larger than field limit (1000000)")
def a_cell_of_a_million_letters():
    return placed(f"30.36013,35.15013,{'x' * 1_000_001}", "lat,lon,remarks")


@case("records", refuses="must be a workbook of Excel or LibreOffice, but it cannot be read")
def a_workbook_whose_sheet_breaks_off(folder):
    path = workbook(folder, [["lon", "lat", "date", "count"], RECORD])
    with zipfile.ZipFile(path) as book:
        parts = {name: book.read(name) for name in book.namelist()}
    sheet = "xl/worksheets/sheet1.xml"
    return zipped(parts | {sheet: parts[sheet][:300]}, "mites.xlsx")


from tests import awkward_real_files  # noqa: E402, F401 - it adds to the cases above
