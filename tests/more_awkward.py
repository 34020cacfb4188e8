"""More awkward files: what went wrong when sixty real ones were tried that nobody had seen."""

import shapely

from fieldmon.io.options import Upload
from tests.awkward import (
    CORNERS,
    SECOND,
    SQUARE,
    case,
    frame,
    ring_of,
    shapefile,
    zipped,
)


def named(*names):
    def check(fields):
        assert [field.name for field in fields] == list(names)

    return check


# --- rings that nobody closed ------------------------------------------------------------------

OPEN = "repaired: 2 feature(s) did not end where it began; it was closed by a straight line"
_KML = """<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Schema name="s" id="s">
<SimpleField name="f_name" type="string"/></Schema>{body}</Document></kml>"""
_PLACE = """<Placemark><name></name><ExtendedData><SchemaData schemaUrl="#s">
<SimpleData name="f_name">{name}</SimpleData></SchemaData></ExtendedData><Polygon><outerBoundaryIs>
<LinearRing><coordinates>{ring}</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>"""
_GML = """<?xml version="1.0" encoding="utf-8"?>
<wfs:FeatureCollection xmlns:wfs="http://www.opengis.net/wfs/2.0"
 xmlns:gml="http://www.opengis.net/gml/3.2" xmlns:app="http://example.org/app">{body}
</wfs:FeatureCollection>"""
_MEMBER = """<wfs:member><app:field gml:id="{id}">{names}<app:geom>
<gml:Polygon gml:id="p{id}" srsName="urn:ogc:def:crs:EPSG::4326"><gml:exterior><gml:LinearRing>
<gml:posList>{ring}</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></app:geom>
</app:field></wfs:member>"""


def open_ring(area, mark, order=1):
    """Return the corners of an area but the last, which is the first again, as text."""
    corners = [corner[::order] for corner in ring_of(area)[:-1]]
    return " ".join(mark.join(f"{v:.6f}" for v in corner) for corner in corners)


def kml_of(*areas):
    return "".join(
        _PLACE.format(name=f"field {i}", ring=open_ring(area, ","))
        for i, area in enumerate(areas, 1)
    )


def gml_of(*areas, names="<gml:name>North</gml:name><gml:name>Nord</gml:name>"):
    return "".join(
        _MEMBER.format(id=f"f{i}", names=names, ring=open_ring(area, " ", -1))
        for i, area in enumerate(areas, 1)
    )


# names: KML's own Name is empty, another column has them; GML's are lists
@case(
    "plots",
    says=(OPEN, "seen: Plots are named by column 'f_name'"),
    at=CORNERS,
    check=named("field 1", "field 2"),
)
def rings_of_kml_that_are_not_closed():
    return Upload("fields.kml", _KML.format(body=kml_of(SQUARE, SECOND)).encode())


@case("plots", says=OPEN, at=CORNERS, check=named("North, Nord (1)", "North, Nord (2)"))
def rings_of_gml_that_are_not_closed_and_lists_of_names():
    return Upload("fields.gml", _GML.format(body=gml_of(SQUARE, SECOND)).encode())


@case("plots", says=OPEN.replace("2", "1"), at=CORNERS)
def a_ring_of_geoparquet_that_is_not_closed(folder):
    import pyarrow as pa
    import pyarrow.parquet as pq

    frame().to_parquet(folder / "plots.parquet")
    table = pq.read_table(folder / "plots.parquet")
    whole = shapely.to_wkb(SQUARE)
    cut = whole[:9] + (4).to_bytes(4, "little") + whole[13:-16]
    at = table.column_names.index("geometry")
    changed = table.set_column(at, table.field(at), pa.array([cut], pa.binary()))
    pq.write_table(changed, folder / "plots.parquet")
    return folder / "plots.parquet"


@case(
    "plots",
    says=(
        "repaired: did not end where it began",
        "dropped: The shape of 1 feature(s) cannot be understood",
        "dropped: 1 feature(s) without a geometry",
    ),
    at=CORNERS,
)
def a_ring_of_one_corner_among_good_ones():
    one = _PLACE.format(name="dot", ring="35.15,30.36")
    return Upload("f.kml", _KML.format(body=kml_of(SQUARE) + one).encode())


# --- what ArcGIS leaves beside a shapefile ----------------------------------------------------

_SBN = b"\x00\x00\x27\x0a\xff\xff\xfe\x70" + b"\x00" * 92


def with_indexes(folder):
    path = shapefile(folder / "s")
    for ending in ("sbn", "sbx"):
        path.with_suffix(f".{ending}").write_bytes(_SBN)
    path.with_suffix(".shp.xml").write_text("<metadata xml:lang='en'/>")
    path.with_suffix(".qix").write_bytes(b"SQT\x01\x01\x00\x00\x00" + b"\x00" * 40)
    return path


@case("plots", at=CORNERS)
def a_zip_of_arcgis_with_its_indexes(folder):
    with_indexes(folder)
    return zipped(folder / "s")


@case("plots", at=CORNERS)
def a_folder_of_arcgis_with_its_indexes(folder):
    return with_indexes(folder).parent


@case("plots", refuses="only an index of a shapefile")
def an_index_of_arcgis_alone():
    return Upload("plots.sbn", _SBN)


@case("plots", refuses="only an index of a shapefile")
def an_index_alone(folder):
    return Upload("plots.shx", shapefile(folder / "s").with_suffix(".shx").read_bytes())
