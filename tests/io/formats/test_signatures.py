"""A file is known by its first bytes, whatever it is called."""

import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.formats.signatures import (
    CALLED,
    READABLE,
    TABULAR,
    USUAL_FILES,
    VECTOR,
    FileKind,
    kind_of,
    picture_type,
)


@pytest.mark.parametrize(
    ("head", "kind"),
    [
        (b"SQLite format 3\x00rest", FileKind.GEOPACKAGE),
        (b"PK\x03\x04", FileKind.ARCHIVE),
        (b"PK\x05\x06", FileKind.ARCHIVE),
        (b"\x00\x00\x27\x0a\x00", FileKind.SHAPEFILE),
        (b"fgb\x03fgb", FileKind.FLATGEOBUF),
        (b"PAR1", FileKind.PARQUET),
        (b"II*\x00", FileKind.RASTER),
        (b"MM\x00+", FileKind.RASTER),
        (b'  {"type":', FileKind.GEOJSON),
        (b'\xef\xbb\xbf{"type":', FileKind.GEOJSON),
        ("\ufeff{".encode("utf-16-le"), FileKind.GEOJSON),
        (b'\x1e{"type":', FileKind.GEOJSON),
        (b"<?xml version='1.0'?><!-- made by --><kml>", FileKind.KML),
        (b"<kml:kml xmlns:kml='x'>", FileKind.KML),
        (b"<gpx version='1.1'>", FileKind.GPX),
        (b"<wfs:FeatureCollection>", FileKind.GML),
        (b"<plots xmlns:gml='http://www.opengis.net/gml'>", FileKind.GML),
        (b"lon;lat\n1;2", FileKind.TABLE),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", FileKind.OLD_WORKBOOK),
        (b"!table\n!version 300\n", FileKind.MAPINFO_TAB),
        (b'Version 300\r\nCharset "WindowsLatin1"\r\n', FileKind.MAPINFO_MIF),
        (b"version 300 of our list\na;b\n", FileKind.TABLE),
        (b"  0\r\nSECTION\r\n", FileKind.DXF),
        (b"999\nmade by a program\n  0\nSECTION\n", FileKind.DXF),
        (b"<ISO11783_TaskData VersionMajor='4'>", FileKind.ISOXML),
    ],
)
@pytest.mark.parametrize("name", ["a", "a.zip", "a.pdf"])
def test_the_first_bytes_tell_the_kind_and_the_name_does_not(head, kind, name):
    assert kind_of(head, name) == kind


def test_a_riff_is_a_picture_only_if_it_says_so():
    assert picture_type(b"RIFF\x00\x00\x00\x00WEBPVP8 ") == "image/webp"
    assert picture_type(b"RIFF\x00\x00\x00\x00WAVEfmt ") is None
    assert picture_type(b"\xff\xd8\xff\xe0") == "image/jpeg"
    assert picture_type(b"\x89PNG\r\n\x1a\n") == "image/png"


@pytest.mark.parametrize(
    ("head", "says"),
    [
        (b"", "is empty"),
        (b"\x1f\x8b\x08", "gzip"),
        (b"7z\xbc\xaf\x27", "7z archive"),
        (b"Rar!\x1a", "RAR archive"),
        (b"%PDF-1.7", "PDF"),
        (b"\x89PNG\r\n", "positions in photos are not read"),
        (b"\xff\xd8\xff\xe0", "positions in photos are not read"),
        (b"AC1027", "CAD drawing"),
        (b"AutoCAD Binary DXF\r\n", "ASCII DXF"),
        (b"\x00\x00\x27\x0a\xff\xff\xfe\x70", "only an index of a shapefile"),
        (b"<XFC>", "holds TASKDATA.XML"),
        (b"<html>", "web page"),
        (b"<!DOCTYPE html><html>", "web page"),
        (b"<OGRVRTDataSource>", "points at other files"),
        (b"<wfs:WFS_Capabilities>", "describes a web service"),
        (b"<svg>", "drawing without positions"),
        (b"<root>", "begins with <root>"),
        (b"\x01\x00\x02\x00", "none of them"),
        ("date,lat,מספר\n".encode("utf-16-le"), "text in UTF-16 without the mark"),
        ("date,lat,מספר\n".encode("utf-16-be"), "text in UTF-16 without the mark"),
    ],
)
def test_what_cannot_be_read_is_refused_with_what_it_is(head, says):
    with pytest.raises(FileProblem, match=says):
        kind_of(head, "file.dat")


@pytest.mark.parametrize("name", ["a.dbf", "a.shx", "a.PRJ", "a.vrt", "a.sbn", "a.mid"])
def test_parts_of_other_files_are_refused_by_their_ending(name):
    with pytest.raises(FileProblem, match=r"Choose|Export"):
        kind_of(b"plain text", name)


@pytest.mark.parametrize(
    "head", [b"<!DOCTYPE x [<!ENTITY a 'b'>]><kml>", b"<?xml?><!DOCTYPE x [ ]><gpx>"]
)
def test_xml_that_defines_entities_is_refused(head):
    with pytest.raises(FileProblem, match="must not define XML entities"):
        kind_of(head, "a.kml")


def test_what_is_said_in_a_comment_does_not_count():
    assert kind_of(b"<!-- <html> <!ENTITY --><kml>", "a.kml") == FileKind.KML


def test_every_kind_is_a_vector_a_table_a_raster_or_an_archive():
    assert VECTOR | TABULAR | {FileKind.RASTER, FileKind.ARCHIVE} == set(FileKind)
    assert not VECTOR & TABULAR


#: kinds that are called otherwise in each language, by what they are in English
IN_WORDS = {
    FileKind.SHAPEFILE: "a shapefile",
    FileKind.GEODATABASE: "a zipped file geodatabase",
    FileKind.TABLE: "CSV",
    FileKind.WORKBOOK: ".xlsx",
    FileKind.OLD_WORKBOOK: ".xls",
    FileKind.OPEN_WORKBOOK: ".ods",
}


def test_every_kind_that_is_read_is_named_where_none_of_them_was_found():
    assert {*CALLED} | {*IN_WORDS} == VECTOR | TABULAR
    for names in (*CALLED.values(), *((word,) for word in IN_WORDS.values())):
        assert all(name in READABLE for name in names)
    assert READABLE.count("MapInfo") == 1
    assert USUAL_FILES == ("GeoPackage", "GeoJSON", "KML")
