"""What kind of file it is, by its first bytes rather than by its name."""

from __future__ import annotations

import re
from enum import StrEnum
from pathlib import PurePosixPath

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem

#: pictures that browsers show, by their first bytes; a RIFF says further on of what it is
_PICTURES = {
    b"\xff\xd8\xff": "image/jpeg",
    b"\x89PNG\r\n\x1a\n": "image/png",
    b"RIFF": "image/webp",
}
#: how much of a file `kind_of` wants to see
HEAD_BYTES = 4096


class FileKind(StrEnum):
    """The kinds of files that can be read; the value is the ending a staged copy gets."""

    SHAPEFILE = ".shp"
    GEOPACKAGE = ".gpkg"
    GEODATABASE = ".gdb"
    GEOJSON = ".geojson"
    FLATGEOBUF = ".fgb"
    PARQUET = ".parquet"
    KML = ".kml"
    GML = ".gml"
    GPX = ".gpx"
    MAPINFO_TAB = ".tab"
    MAPINFO_MIF = ".mif"
    DXF = ".dxf"
    ISOXML = ".xml"
    WORKBOOK = ".xlsx"
    OLD_WORKBOOK = ".xls"
    OPEN_WORKBOOK = ".ods"
    TABLE = ".csv"
    RASTER = ".tif"
    ARCHIVE = ".zip"


WORKBOOKS = frozenset({FileKind.WORKBOOK, FileKind.OLD_WORKBOOK, FileKind.OPEN_WORKBOOK})
TABULAR = WORKBOOKS | {FileKind.TABLE}
VECTOR = frozenset(FileKind) - TABULAR - {FileKind.RASTER, FileKind.ARCHIVE}
#: what files are called that plots and records can be read from, in every language
CALLED = {
    FileKind.GEOPACKAGE: ("GeoPackage", "SpatiaLite"),
    FileKind.GEOJSON: ("GeoJSON",),
    FileKind.KML: ("KML", "KMZ"),
    FileKind.GML: ("GML",),
    FileKind.GPX: ("GPX",),
    FileKind.FLATGEOBUF: ("FlatGeobuf",),
    FileKind.PARQUET: ("GeoParquet",),
    FileKind.MAPINFO_TAB: ("MapInfo (.tab, .mif)",),
    FileKind.MAPINFO_MIF: ("MapInfo (.tab, .mif)",),
    FileKind.DXF: ("DXF",),
    FileKind.ISOXML: ("ISOXML (TASKDATA.XML)",),
}
READABLE = worded(
    "a shapefile (zipped or with its .dbf, .shx and .prj), {formats}, a zipped file geodatabase, "
    "CSV or a workbook (.xlsx, .xls, .ods)",
    formats=joined(", ", dict.fromkeys(name for names in CALLED.values() for name in names)),
)
#: what most people have, beside shapefiles, where there is no room for all
USUAL_FILES = tuple(
    CALLED[kind][0] for kind in (FileKind.GEOPACKAGE, FileKind.GEOJSON, FileKind.KML)
)

_SHAPEFILE = b"\x00\x00\x27\x0a"
_MAGIC = (
    (b"SQLite format 3\x00", FileKind.GEOPACKAGE),
    (b"PK\x03\x04", FileKind.ARCHIVE),
    (b"PK\x05\x06", FileKind.ARCHIVE),
    (b"fgb", FileKind.FLATGEOBUF),
    (b"PAR1", FileKind.PARQUET),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", FileKind.OLD_WORKBOOK),
    (_SHAPEFILE, FileKind.SHAPEFILE),
    (b"II*\x00", FileKind.RASTER),
    (b"MM\x00*", FileKind.RASTER),
    (b"II+\x00", FileKind.RASTER),
    (b"MM\x00+", FileKind.RASTER),
)
_INDEX = worded("is only an index of a shapefile. Choose the .shp with it, or all of them zipped")
_PICTURE = worded(
    "is a picture, and positions in photos are not read. Choose a GeoTIFF, a table of records with "
    "positions, or the plot as GeoPackage or shapefile"
)
_REFUSED_MAGIC = (
    (b"\x1f\x8b", worded("is packed with gzip. Unpack it and choose the file inside")),
    (b"7z\xbc\xaf", worded("is a 7z archive. Unpack it, or pack it as .zip")),
    (b"Rar!", worded("is a RAR archive. Unpack it, or pack it as .zip")),
    (
        b"%PDF",
        worded("is a PDF, which holds no positions. Ask for the map as GeoPackage or shapefile"),
    ),
    (b"\x89PNG", _PICTURE),
    (b"\xff\xd8\xff", _PICTURE),
    (b"\x00\x00\x27\x0a\xff\xff\xfe\x70", _INDEX),  # .sbn, .sbx of ArcGIS
    (b"AutoCAD Binary DXF", worded("is a binary CAD drawing. Save it as an ASCII DXF")),
    (b"AC10", worded("is a CAD drawing (DWG). Export it as GeoPackage, shapefile or GeoJSON")),
)
_BOMS = (b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff")
_TAG = re.compile(rb"<\s*(?:[\w.-]+:)?([A-Za-z][\w.-]*)")
_XML_ROOTS = {
    b"kml": FileKind.KML,
    b"gpx": FileKind.GPX,
    b"featurecollection": FileKind.GML,
    b"iso11783_taskdata": FileKind.ISOXML,
}
#: how text begins that is no table: MapInfo's tables and its exchange files, drawings
_TEXTS = (
    (re.compile(rb"\s*!table", re.IGNORECASE), FileKind.MAPINFO_TAB),
    (
        re.compile(
            rb"\s*version\s+\d+\s*[\r\n]+\s*(charset|delimiter|unique|index|coordsys|transform|"
            rb"columns)\b",
            re.IGNORECASE,
        ),
        FileKind.MAPINFO_MIF,
    ),
    (re.compile(rb"(\s*999\s*[\r\n]+[^\r\n]*[\r\n]+)*\s*0\s*[\r\n]+\s*SECTION\b"), FileKind.DXF),
)
_REFUSED_ROOTS = {
    b"ogrvrtdatasource": worded("only points at other files (VRT). Choose the files themselves"),
    b"vrtdataset": worded("only points at other files (VRT). Choose the files themselves"),
    b"html": worded(
        "is a web page, perhaps a log-in page saved instead of the file. Download it again"
    ),
    b"wfs_capabilities": worded("describes a web service. Download the data themselves"),
    b"ogcwfsdatasource": worded("only points at a web service. Download the data themselves"),
    b"xfc": worded(
        "is a part of an ISOXML. Choose the folder or zip that holds TASKDATA.XML with it"
    ),
    b"gdal_wms": worded("only points at a web service. Download the data themselves"),
    b"svg": worded(
        "is a drawing without positions on the earth. Export it as GeoPackage or GeoJSON"
    ),
}
_REFUSED_ENDINGS = {
    ".dbf": worded(
        "holds only the table of a shapefile. Choose the .shp with it, or all of them zipped"
    ),
    **dict.fromkeys((".shx", ".sbn", ".sbx", ".qix", ".fbn", ".fbx", ".ain", ".aih"), _INDEX),
    ".prj": worded(
        "holds only a coordinate system. Choose the .shp with it, or all of them zipped"
    ),
    ".vrt": worded("only points at other files (VRT). Choose the files themselves"),
    ".mid": worded(
        "holds only the table of a MapInfo file. Choose the .mif with it, or both zipped"
    ),
}


#: how the zip of an OpenDocument spreadsheet begins: its first file, stored as it is, says so
_OPEN_WORKBOOK = b"mimetypeapplication/vnd.oasis.opendocument.spreadsheet"


def workbook_kind(head: bytes) -> FileKind:
    """Return which workbook a zip is that holds no files of its own to look at."""
    return FileKind.OPEN_WORKBOOK if is_open_workbook(head) else FileKind.WORKBOOK


def is_open_workbook(head: bytes) -> bool:
    """Return whether a zip is an OpenDocument spreadsheet."""
    return _OPEN_WORKBOOK in head[:120]


def picture_type(data: bytes) -> str | None:
    """Return the media type of a JPEG, PNG or WebP picture; None: it is none of these."""
    for begin, named in _PICTURES.items():
        if data.startswith(begin) and (begin != b"RIFF" or data[8:12] == b"WEBP"):
            return named
    return None


def kind_of(head: bytes, name: str) -> FileKind:
    """Return the kind of a file from its first bytes; raise `FileProblem` for what is unreadable.

    Only for plain text does the ending of the name count.
    """
    if not head:
        raise FileProblem(
            worded(
                "{name} must hold something, but it is empty. Save or download it again.", name=name
            )
        )
    for magic, why in _REFUSED_MAGIC:
        if head.startswith(magic):
            raise FileProblem(worded("{name} {why}.", name=name, why=why))
    ending = PurePosixPath(name.lower()).suffix
    if ending == ".shx" and head.startswith(_SHAPEFILE):  # it begins as the .shp does
        raise FileProblem(worded("{name} {value}.", name=name, value=_REFUSED_ENDINGS[ending]))
    for magic, kind in _MAGIC:
        if head.startswith(magic):
            return kind
    if ending in _REFUSED_ENDINGS:
        raise FileProblem(worded("{name} {value}.", name=name, value=_REFUSED_ENDINGS[ending]))
    return _text_kind(head, name)


def _text_kind(head: bytes, name: str) -> FileKind:
    text = head
    for bom in _BOMS:
        text = text.removeprefix(bom)
    if head.startswith(_BOMS[1:]):
        text = text.replace(b"\x00", b"")
    start = text.lstrip()
    if start.startswith((b"{", b"[", b"\x1e{")):
        return FileKind.GEOJSON
    if start.startswith(b"<"):
        return _xml_kind(start, name)
    for pattern, kind in _TEXTS:
        if pattern.match(text):
            return kind
    if _is_wide_text(text):
        raise FileProblem(
            worded(
                "{name} seems to be text in UTF-16 without the mark that says so. Save it as "
                'UTF-8, in a spreadsheet as "CSV UTF-8".',
                name=name,
            )
        )
    if b"\x00" in text:
        raise FileProblem(
            worded(
                "{name} must be {readable}, but it is none of them.", name=name, readable=READABLE
            )
        )
    return FileKind.TABLE


def _is_wide_text(head: bytes) -> bool:
    """Return whether bytes are Latin letters of two bytes each, of which one is empty."""
    pairs = head[: len(head) // 2 * 2]
    for empty, letters in ((pairs[1::2], pairs[::2]), (pairs[::2], pairs[1::2])):
        if len(empty) > _FEW_LETTERS and not letters.count(0):
            # a few letters may be Hebrew or Arabic
            return 2 * empty.count(0) > len(empty)
    return False


_FEW_LETTERS = 8


def _xml_kind(start: bytes, name: str) -> FileKind:
    bare = re.sub(rb"<!--.*?(-->|$)|<\?.*?(\?>|$)", b"", start, flags=re.DOTALL)
    # map files have no DTD of their own; whatever stands in one is there to be expanded
    if b"<!ENTITY" in bare or re.search(rb"<!DOCTYPE[^>\[]*\[", bare):
        raise FileProblem(
            worded(
                "{name} must not define XML entities, but it does; that is "
                "how such files are made to read others or to fill the "
                "memory. Export it again.",
                name=name,
            )
        )
    tag = _TAG.search(re.sub(rb"<!DOCTYPE[^>]*>", b"", bare))
    root = tag.group(1).lower() if tag else b""
    if root in _XML_ROOTS:
        return _XML_ROOTS[root]
    if root in _REFUSED_ROOTS:
        raise FileProblem(worded("{name} {value}.", name=name, value=_REFUSED_ROOTS[root]))
    if b"opengis.net/gml" in start:
        return FileKind.GML
    raise FileProblem(
        worded(
            "{name} must be KML, GML or GPX where it is XML, but it begins "
            "with {value}. Export it as GeoPackage or GeoJSON.",
            name=name,
            value=f"<{root.decode()}>" if root else "something else",
        )
    )
