"""Awkward files as people have them: what went wrong when sixty real ones were tried."""

import io
import re
import zipfile

import geopandas as gpd
import numpy as np
import pyproj
import shapely
from shapely import LineString, MultiPolygon, Point, box

from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions, Upload
from tests.awkward import (
    CORNERS,
    DAY,
    HERE,
    HOME,
    SECOND,
    SQUARE,
    case,
    counts,
    days,
    frame,
    geojson,
    moved,
    plants_on_top_of_each_other,
    ring_of,
    shapefile,
    states,
    table,
    without,
    workbook,
    zipped,
)
from tests.old_workbook import xls


def both(*checks):
    return lambda value: [check(value) for check in checks]


def named(*names):
    def check(fields):
        assert [field.name for field in fields] == list(names)

    return check


# --- rings that nobody closed ------------------------------------------------------------------

OPEN = "repaired: 2 features did not end where it began; it was closed by a straight line"
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


@case("plots", says=OPEN.replace("2 features", "1 feature"), at=CORNERS)
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
        "dropped: The shape of 1 feature cannot be understood",
        "dropped: 1 feature without a geometry",
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


# --- workbooks ---------------------------------------------------------------------------------

CELLS = [["lon", "lat", "date", "count"], *[[*place, DAY, 7] for place in HERE]]


@case("records", at=HERE, check=counts(7))
def a_workbook_that_says_it_has_one_cell(folder):
    path = workbook(folder, CELLS)
    with zipfile.ZipFile(path) as book:
        parts = {name: book.read(name) for name in book.namelist()}
    sheet = "xl/worksheets/sheet1.xml"
    parts[sheet] = re.sub(rb'<dimension ref="[^"]*"', b'<dimension ref="A1"', parts[sheet])
    return zipped(parts, "mites.xlsx")


@case("records", at=HERE, check=counts(7))
def an_old_workbook():
    return Upload("mites.xls", xls(CELLS))


@case("records", refuses="must be a workbook of Excel or LibreOffice, but it cannot be read")
def a_letter_of_old_word():
    return Upload(
        "letter.doc", xls(CELLS).replace("Workbook".encode("utf-16-le"), b"W\0o\0r\0d\0" * 2)
    )


_ODS = """<?xml version="1.0" encoding="UTF-8"?><office:document-content
 xmlns:office="urn:oasis:names:tc:opendocument:xmlns:office:1.0"
 xmlns:table="urn:oasis:names:tc:opendocument:xmlns:table:1.0"
 xmlns:text="urn:oasis:names:tc:opendocument:xmlns:text:1.0"><office:body><office:spreadsheet>
<table:table table:name="Sheet1">{rows}</table:table></office:spreadsheet></office:body>
</office:document-content>"""


def ods(rows, more=""):
    """Return a spreadsheet of LibreOffice; dates are dates, as it keeps them."""

    def cell(value):
        kind = "float" if isinstance(value, int | float) else "string"
        if value == DAY:
            return f'<table:table-cell office:value-type="date" office:date-value="{value}"/>'
        number = f' office:value="{value}"' if kind == "float" else ""
        text = f"<text:p>{value}</text:p>"
        return f'<table:table-cell office:value-type="{kind}"{number}>{text}</table:table-cell>'

    body = "".join(f"<table:table-row>{''.join(map(cell, row))}</table:table-row>" for row in rows)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as book:
        book.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        book.writestr("content.xml", _ODS.format(rows=body + more))
        book.writestr("META-INF/manifest.xml", "<manifest/>")
    return packed.getvalue()


@case("records", at=HERE, check=both(counts(7), days(DAY)))
def a_spreadsheet_of_libreoffice():
    return Upload("mites.ods", ods(CELLS))


@case("records", at=HERE, check=counts(7))
def a_spreadsheet_of_libreoffice_in_a_zip():
    return zipped({"books/mites.ods": ods(CELLS)})


# --- tables with a column for each day, and without a line of names ----------------------------

TWO = (HERE[0], (35.15023, 30.36023))


@case(
    "records",
    says=(
        "seen: 3 columns are called by dates, 2026-03-01 to 2026-03-15: each cell is one record",
        "seen: 1 cell is not filled in",
        "seen: these were passed over: Total",
    ),
    check=both(counts(0, 3, 7, 0, 12), days(DAY, "2026-03-08", "2026-03-15", DAY, "2026-03-15")),
    at=(TWO[0], TWO[0], TWO[0], TWO[1], TWO[1]),
)
def a_column_for_each_day():
    head = "lon,lat,2026-03-01,2026-03-08,2026-03-15,Total\n"
    rows = f"{TWO[0][0]},{TWO[0][1]},0,3,7,10\n{TWO[1][0]},{TWO[1][1]},0,,12,12\n"
    return table(head + rows)


@case("records", check=both(states(1, 0), days("2026-03-13", "2026-03-20")))
def a_column_for_each_day_with_words():
    return table(f"lon,lat,13.3.2026,20.3.2026\n{TWO[0][0]},{TWO[0][1]},infestado,sano\n")


@case(
    "records",
    says="guessed: above the columns could be day first or month first [date_order=mdy]",
    check=days("2026-04-03", "2026-04-10"),
)
def a_column_for_each_day_that_could_be_a_month():
    return table(f"lon,lat,03/04/2026,10/04/2026\n{TWO[0][0]},{TWO[0][1]},1,2\n")


@case("records", check=both(counts(3, 4), days("2026-03-01", "2026-03-08")))
def a_column_for_each_day_of_a_workbook(folder):
    import datetime as dt

    head = ["lon", "lat", dt.datetime(2026, 3, 1), dt.datetime(2026, 3, 8)]
    return workbook(folder, [head, [*TWO[0], 3, 4]])


@case(
    "records",
    says="doubtful: 2 columns are called by dates, but the dates were taken from this one",
    check=days(DAY),
)
def columns_called_by_dates_beside_a_date():
    head = "lon,lat,date,count,2026-03-01,2026-03-08\n"
    return table(f"{head}{TWO[0][0]},{TWO[0][1]},{DAY},4,1,2\n")


NAMELESS = "35.15013;30.36013;2026-03-01;7\n35.15023;30.36023;2026-03-01;0\n"


@case(
    "records",
    asks=("header", "no", "yes"),
    refuses="its first line looks like data (35.15013, 30.36013, 2026-03-01, 7)",
)
def a_table_without_column_names():
    return table(NAMELESS)


@case(
    "records",
    options=RecordOptions(header="no").naming(
        lon="column 1", lat="column 2", date="column 3", count="column 4"
    ),
    says="seen: its columns are called column 1 to 4",
    check=both(counts(7, 0), days(DAY, DAY)),
    at=TWO,
)
def a_table_without_column_names_and_told_so():
    return table(NAMELESS)


@case("records", asks=("header", "no"), refuses="looks like data")
def a_sheet_without_column_names(folder):
    return workbook(folder, CELLS[1:] * 2)


# --- shapes as text ----------------------------------------------------------------------------

QGIS = "seen: Shapes are in column 'WKT'"
GUESSED = "guessed: name no coordinate system and were read as longitude and latitude"


def wkt_of(*areas, before="", head="WKT,name"):
    rows = [f'"{before}{area.wkt}",plot {i}' for i, area in enumerate(areas, 1)]
    return "\n".join([head, *rows, ""]).encode()


@case("plots", says=(QGIS, GUESSED), at=CORNERS, check=named("plot 1", "plot 2"))
def plots_as_text_as_qgis_exports_them():
    return Upload("plots.csv", wkt_of(MultiPolygon([SQUARE]), SECOND))


@case("plots", says=QGIS, at=CORNERS)
def plots_as_text_with_the_system_beside_them(folder):
    (folder / "plots.csv").write_bytes(wkt_of(moved(SQUARE, 2039)))
    (folder / "plots.prj").write_text(pyproj.CRS("EPSG:2039").to_wkt("WKT1_ESRI"))
    (folder / "plots.csvt").write_text('"WKT","String"')
    return folder / "plots.csv"


@case("plots", says=QGIS, at=CORNERS)
def plots_as_text_that_name_their_system():
    return Upload("plots.csv", wkt_of(moved(SQUARE, 2039), before="SRID=2039;"))


@case("plots", asks=("crs", "EPSG:2039"), refuses="does not say in which coordinate system")
def plots_as_text_in_metres():
    return Upload("plots.csv", wkt_of(moved(SQUARE, 2039)))


@case(
    "plots",
    says=(
        "repaired: 1 feature did not end",
        "dropped: 1 shape cannot",
        "dropped: without a geometry",
    ),
    at=CORNERS,
)
def plots_as_text_some_of_them_broken():
    ring = ", ".join(f"{x} {y}" for x, y in ring_of(SQUARE)[:-1])
    rows = f'WKT,name\n"POLYGON (({ring}))",a\n"POLYGON ((1 2, 3))",b\n'
    return Upload("plots.csv", f"{rows}".encode())


@case("lines", says=QGIS)
def lines_as_text():
    return Upload("rows.csv", b'WKT;row\n"LINESTRING (35.15 30.36, 35.152 30.361)";1\n')


# --- other programs' files ---------------------------------------------------------------------


def written(folder, driver, name, *areas, crs=4326, **options):
    """Write areas by another driver; return the folder."""
    room = folder / "m"
    room.mkdir()
    frame(*areas).to_crs(crs).to_file(room / name, driver=driver, engine="pyogrio", **options)
    return room


@case("plots", at=CORNERS, check=named("plot 1", "plot 2"))
def a_mapinfo_table(folder):
    return written(folder, "MapInfo File", "plots.tab", SQUARE, SECOND) / "plots.tab"


@case("plots", at=CORNERS, check=named("plot 1"))
def a_zipped_mapinfo_table(folder):
    return zipped(written(folder, "MapInfo File", "plots.tab", SQUARE))


@case("plots", at=CORNERS, check=named("plot 1"))
def a_mapinfo_exchange_file(folder):
    return zipped(written(folder, "MapInfo File", "plots.mif", SQUARE))


@case("plots", refuses="only leads to other files")
def a_mapinfo_table_of_other_tables():
    said = '!table\n!version 300\n\nDefinition Table\n  Type NATIVE Charset "Neutral"\n  Fields 1\n'
    return Upload("all.tab", f'{said}begin_metadata\n"\\IsSeamless" = "TRUE"\n'.encode())


@case("plots", refuses="holds only the table of a MapInfo file")
def the_half_of_a_mapinfo_exchange_file():
    return Upload("plots.mid", b'"plot 1"\n')


@case("plots", at=CORNERS, check=named("plot 1", "plot 2"))
def a_spatialite_database(folder):
    room = written(
        folder, "SQLite", "plots.sqlite", SQUARE, SECOND, SPATIALITE="YES", INIT_WITH_EPSG="NO"
    )
    return room / "plots.sqlite"


@case(
    "plots",
    options=PlotOptions(crs="EPSG:2039"),
    says="guessed: 1 closed line was taken as the outlines",
    at=CORNERS,
)
def a_drawing(folder):
    room = folder / "m"
    room.mkdir()
    outline = gpd.GeoDataFrame(geometry=[moved(SQUARE, 2039).exterior], crs=2039)
    outline.to_file(room / "plots.dxf", driver="DXF", engine="pyogrio")
    return room / "plots.dxf"


@case("plots", asks=("crs", "EPSG:2039"), refuses="does not say in which coordinate system")
def a_drawing_without_a_system(folder):
    return a_drawing(folder)


# --- partfields of terminals -------------------------------------------------------------------

POND = box(35.1505, 30.3605, 35.151, 30.361)
_TASKS = """<?xml version="1.0" encoding="UTF-8"?>
<ISO11783_TaskData VersionMajor="4" VersionMinor="0" DataTransferOrigin="1">
<FRM A="FRM1" B="Paran"/>{body}</ISO11783_TaskData>"""


def pnt(lon, lat):
    return f'<PNT A="2" C="{lat:.9f}" D="{lon:.9f}"/>'


def lsg(kind, points):
    return f'<LSG A="{kind}">{"".join(pnt(*point) for point in points)}</LSG>'


def pln(kind, area, *holes):
    rings = [lsg(1, ring_of(area)[:-1]), *(lsg(2, ring_of(hole)) for hole in holes)]
    return f'<PLN A="{kind}" B="x">{"".join(rings)}</PLN>'


def pfd(number, name, *shapes):
    return f'<PFD A="PFD{number}" B="" C="{name}" D="42000">{"".join(shapes)}</PFD>'


GUIDE = ((35.15, 30.361), (35.152, 30.361))
FIELDS = (
    pfd(1, "North", pln(1, SQUARE, POND), pln(2, POND), lsg(5, GUIDE)),
    pfd(2, "צפון", pln(1, SECOND)),
)


def has_a_pond(fields):
    assert [field.name for field in fields] == ["North", "צפון"]
    assert len(fields[0].boundary.geoms[0].interiors) == 1


@case(
    "plots",
    says=("dropped: 1 line was left out", "seen: were passed over: treatment zone (1)"),
    at=CORNERS,
    check=has_a_pond,
)
def partfields_of_a_terminal():
    return zipped({"TASKDATA/TASKDATA.XML": _TASKS.format(body="".join(FIELDS)).encode()})


@case("plots", says="dropped: 1 line was left out", at=CORNERS, check=has_a_pond)
def partfields_in_files_of_their_own(folder):
    room = folder / "TASKDATA"
    room.mkdir()
    led = '<XFR A="PFD00001" B="1"/>'
    (room / "TASKDATA.XML").write_text(_TASKS.format(body=led), encoding="utf-8")
    (room / "PFD00001.XML").write_text(f"<XFC>{''.join(FIELDS)}</XFC>", encoding="utf-8")
    (room / "TLG00001.BIN").write_bytes(b"\x00" * 64)
    return room / "TASKDATA.XML"


@case("lines", says="dropped: 2 features that are no lines")
def guidance_lines_of_a_terminal():
    return partfields_of_a_terminal()


@case("plots", refuses="must hold at least one partfield with an outline")
def an_isoxml_without_partfields():
    return Upload("TASKDATA.XML", _TASKS.format(body='<TSK A="TSK1" G="1"/>').encode())


@case("plots", refuses="must hold at least one partfield")
def an_isoxml_that_leads_to_a_file_that_is_not_there():
    return Upload("TASKDATA.XML", _TASKS.format(body='<XFR A="PFD00001" B="1"/>').encode())


@case("plots", says="dropped: North Its shape cannot be understood", check=named("South"))
def a_partfield_whose_corner_is_no_number():
    broken = FIELDS[0].replace('C="30.3', 'C="x30.3', 1)
    body = broken.replace(lsg(5, GUIDE), "").replace(pln(2, POND), "") + pfd(
        2, "South", pln(1, SECOND)
    )
    return Upload("TASKDATA.XML", _TASKS.format(body=body).encode())


@case("plots", refuses="must not define a document type")
def an_isoxml_that_leads_to_a_document_type(folder):
    room = partfields_in_files_of_their_own(folder).parent
    bomb = '<!DOCTYPE x [<!ENTITY a "b">]><XFC>&a;</XFC>'
    (room / "PFD00001.XML").write_text(bomb, encoding="utf-8")
    return room / "TASKDATA.XML"


@case("plots", refuses="is a 7z archive")
def a_7z_archive():
    return Upload("plots.7z", b"7z\xbc\xaf\x27\x1c" + b"\x00" * 40)


@case("plots", refuses="is a RAR archive")
def a_rar_archive():
    return Upload("plots.rar", b"Rar!\x1a\x07\x00" + b"\x00" * 40)


# --- what was found, in the words of many languages --------------------------------------------


def found(*words, head="found"):
    rows = "".join(f"35.1{i:05d},30.36013,{DAY},{word}\n" for i, word in enumerate(words))
    return table(f"lon,lat,date,{head}\n{rows}")


@case("records", check=states(1, 0, 1, 0, 1, 0, 1, 0, 1, 0))
def results_in_large_languages():
    spanish, french = ("positivo", "negativo"), ("positif", "négatif")
    return found(*spanish, *french, "infestado", "sano", "sì", "NEG", "есть", "нет")


@case("records", check=states(1, 0, 0))
def a_minus_beside_a_plus():
    return found("+", "-", "-")


@case(
    "records",
    check=states(1, -1, 0),
    says="doubtful: 1 record holds a minus alone: taken as not filled in [clean=-]",
)
def a_minus_beside_words():
    return found("positivo", "-", "negativo")


@case("records", options=RecordOptions(clean="-, ravi"), check=states(1, 0, 0))
def a_minus_and_a_word_that_are_told():
    return found("positivo", "-", "Ravi")


@case(
    "records", says="doubtful: neither yes nor no: 'krobbig' [found=krobbig]", check=states(-1, 0)
)
def a_word_that_nobody_knows():
    return found("krobbig", "sano")


@case("records", options=RecordOptions(found="krobbig"), check=states(1, 0))
def a_word_that_nobody_knows_and_told():
    return found("krobbig", "sano")


@case("records", asks=("columns", "count=eggs", "present="), refuses="says what was found")
def a_number_of_the_record_is_no_count():
    rows = "".join(f"35.1{i:05d},30.36013,{DAY},{i + 1},{i % 3}\n" for i in range(5))
    return table(f"lon,lat,date,trap_id,eggs\n{rows}")


@case("records", asks=("columns", "present=Ergebnisse"), refuses="says what was found")
def a_column_of_words_that_is_called_otherwise():
    return found("befallen", "befallsfrei", head="Ergebnisse")


# --- plants measured twice ---------------------------------------------------------------------


def has_two(plants):
    assert len(plants) == 2


@case(
    "plants",
    options=ReadOptions(doubles="one"),
    says="dropped: 1 of 3 plants stood within 5 cm of another one",
    check=has_two,
)
def plants_on_top_of_each_other_of_which_one_is_kept():
    return plants_on_top_of_each_other()


@case("plants", asks=("doubles", "one"), refuses="1 of 2 are within 5 cm of an earlier one")
def plants_four_centimetres_apart():
    return geojson(Point(35.15001, 30.36001), Point(35.15001, 30.36001036))


# --- degrees with two points -------------------------------------------------------------------

DOTTED = "30.21.36,35.09.33\n30.21.37,35.09.34\n30.36013,35.15013"
ASKED = "2 records give degrees with two points, for instance"
HERE_DOTTED = ((35 + 9 / 60 + 33 / 3600, 30 + 21 / 60 + 36 / 3600),)
HERE_MINUTES = ((35 + 9.33 / 60, 30 + 21.36 / 60),)


def with_two_points():
    rows = DOTTED.replace("\n", f",{DAY},7\n")
    return table(f"lat,lon,date,count\n{rows},{DAY},7\n")


@case("records", asks=("degrees", "dms", "dm"), refuses=ASKED)
def degrees_with_two_points():
    return with_two_points()


@case("records", options=RecordOptions(degrees="dms"), check=lambda r: is_at(r, HERE_DOTTED[0]))
def degrees_with_two_points_and_seconds():
    return with_two_points()


@case("records", options=RecordOptions(degrees="dm"), check=lambda r: is_at(r, HERE_MINUTES[0]))
def degrees_with_two_points_and_minutes():
    return with_two_points()


@case("records", asks=("degrees", "dms", "dm"), refuses="1 record gives degrees with two points")
def degrees_with_two_points_in_one_cell():
    return table(f'gps,date,count\n"30.21.36, 35.09.33",{DAY},7\n')


def is_at(records, place):
    np.testing.assert_allclose(records.lonlat[0], place, atol=1e-9)
    assert len(records) == 3


# --- on another part of the earth --------------------------------------------------------------

BRITISH = box(400_000, 300_000, 400_200, 300_200)


@case(
    "plots",
    options=PlotOptions(crs="EPSG:2039"),
    says="doubtful: km outside of where Israel 1993 / Israeli TM Grid is used, so the accuracy",
)
def a_british_plot_in_the_israeli_grid(folder):
    return without(shapefile(folder / "s", frame(BRITISH, crs=27700)), ".prj")


@case("plots", at=((36.5, 31.0),))
def a_plot_a_little_outside_of_its_utm_zone(folder):
    return shapefile(folder / "s", frame(box(36.5, 31, 36.502, 31.002)).to_crs(32637))


@case("plots", says="seen: PROJ states 1 m for this", at=((14.9, 55.1),))
def a_plot_of_bornholm_in_the_zone_of_all_denmark(folder):
    return shapefile(folder / "s", frame(box(14.9, 55.1, 14.902, 55.102)).to_crs(25832))


FAR = (-120.0, 38.0)


@case("lines", options=ReadOptions(near=FAR), asks=("crs", "OGC:CRS84"), refuses="keeps it there")
def paths_of_another_continent():
    return geojson(LineString([(35.15, 30.36), (35.152, 30.361)]))


@case(
    "lines",
    options=ReadOptions(near=FAR),
    asks=("crs", "EPSG:32009", "EPSG:2039"),
    refuses="keeps it there",
)
def paths_in_metres_of_another_continent(folder):
    path = LineString([moved(Point(35.15, 30.36), 2039), moved(Point(35.152, 30.361), 2039)])
    return shapefile(folder / "s", frame(path, crs=2039), "paths")


@case("lines", options=ReadOptions(near=FAR, crs="EPSG:4326"), says="doubtful: km from the plot")
def paths_of_another_continent_that_are_meant():
    return paths_of_another_continent()


@case("lines", options=ReadOptions(near=FAR), asks=("swap_axes", "yes"), refuses="Exchange")
def paths_whose_axes_are_exchanged():
    return geojson(LineString([FAR[::-1], (38.001, -120.001)]))


@case(
    "records",
    near=HOME,
    asks=("crs", "OGC:CRS84"),
    refuses="km from the plot or place nearby",
)
def records_of_another_continent():
    return table(f"lon,lat,date,count\n{FAR[0]},{FAR[1]},{DAY},7\n")
