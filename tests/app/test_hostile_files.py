"""Texts that do harm in every text field of every readable format: read as text, shown as text."""

import re
import tempfile
from dataclasses import replace
from datetime import date
from pathlib import Path
from types import SimpleNamespace

import geopandas as gpd
import numpy as np
import openpyxl
import pandas as pd
import pytest
from shapely import LineString, Point

from app.words import language, texts
from fieldmon.compute.units import Units
from fieldmon.errors import FieldmonError
from fieldmon.infestation.inspections import Inspections
from fieldmon.io.options import PlotOptions, RecordOptions, Upload
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.sandbox import tasks
from fieldmon.monitoring import Season
from fieldmon.reports.html import html_text
from fieldmon.reports.season import season_report
from tests.app.test_hostile_texts import EVERY, EVIL, LEADS
from tests.awkward import DAY, HERE, SECOND, SQUARE
from tests.awkward_real_files import _TASKS, ods, pfd, pln
from tests.monitoring.seasons import a_plot
from tests.old_workbook import xls
from tests.pages import held
from tests.paths import ROOT

LONG = f"{EVERY} {'x' * 10_000}"
# what a text may not bring along: whoever reads it would read something else
_CONTROLS = re.compile("[\u202a-\u202e\u2066-\u2069]")
WRITTEN = {  # by GDAL: the format's name, and how the file is called
    "geojson": "GeoJSON",
    "gpkg": "GPKG",
    "kml": "KML",
    "gml": "GML",
    "fgb": "FlatGeobuf",
    "tab": "MapInfo File",
    "mif": "MapInfo File",
    "shp": "ESRI Shapefile",
    "sqlite": "SQLite",
}
LETTERS = {"tab": 250, "mif": 250, "shp": 250}  # as many as fit into a field of these


def in_xml(text):
    return (
        text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").replace('"', "&quot;")
    )


def by_gdal(folder, kind, frame):
    """Write a frame by GDAL; return the file."""
    options = {"SPATIALITE": "YES", "INIT_WITH_EPSG": "NO"} if kind == "sqlite" else {}
    if kind == "mif":
        options = {"FORMAT": "MIF"}
    path = folder / f"data.{kind}"
    frame.to_file(path, driver=WRITTEN[kind], engine="pyogrio", **options)
    return path


def table_of(kind, rows, folder):
    """Write rows, the names of columns first, as a table of a kind."""
    frame = pd.DataFrame(rows[1:], columns=rows[0])
    if kind == "xlsx":
        book = openpyxl.Workbook()
        for row in rows:
            book.active.append(row)
        book.save(folder / "data.xlsx")
        return folder / "data.xlsx"
    if kind == "ods":
        return Upload(
            "data.ods", ods([[in_xml(v) if isinstance(v, str) else v for v in row] for row in rows])
        )
    text = frame.to_csv(index=False, sep="\t" if kind == "tsv" else ",")
    return Upload(f"data.{kind}", text.encode())


def shown_as_text(read):
    """Hold what was read, and what is said about it, to be text wherever it is shown."""
    for said in read.messages:
        line = language.in_words(said.sentence)
        assert not (EVIL in line and LEADS.search(line)), line[:300]


def held_as_text(text, letters):
    """Hold one text to be the one that was written, shown on a page and in the app."""
    words = re.findall(r"\w+", EVERY[: letters - 10])
    assert set(words[:-1]) <= set(re.findall(r"\w+", text)), text[:300]
    assert not LEADS.search(texts.isolated(text)), text[:300]
    assert not _CONTROLS.search(texts.isolated(text).strip("\u2066\u2067\u2068\u2069"))


PLOTS = [*WRITTEN, "parquet", "csv", "xlsx", "ods", "xml"]


@pytest.mark.parametrize("kind", PLOTS)
def test_the_name_of_a_plot_is_text_whatever_format_it_comes_in(tmp_path, kind):
    name = LONG[: LETTERS.get(kind, 20_000)]
    frame = gpd.GeoDataFrame({"name": [name, "B"]}, geometry=[SQUARE, SECOND], crs=4326)
    if kind in WRITTEN:
        source = by_gdal(tmp_path, kind, frame)
    elif kind == "parquet":
        frame.to_parquet(tmp_path / "data.parquet")
        source = tmp_path / "data.parquet"
    elif kind == "xml":
        body = pfd(1, in_xml(name), pln(1, SQUARE)) + pfd(2, "B", pln(1, SECOND))
        source = Upload("TASKDATA.XML", _TASKS.format(body=body).encode())
    else:
        rows = [["WKT", "name"], [SQUARE.wkt, name], [SECOND.wkt, "B"]]
        source = table_of(kind, rows, tmp_path)
    (tmp_path / "work").mkdir()
    read = tasks.plots(str(tmp_path / "work"), source, PlotOptions())
    assert len(read.value) == 2
    (own,) = (field.name for field in read.value if field.name != "B")  # in any order
    held_as_text(own, LETTERS.get(kind, len(EVERY)))
    shown_as_text(read)


def points(kind, rows, folder):
    """Write rows with ``lon`` and ``lat`` as points or as a table."""
    if kind == "xls":
        return Upload("data.xls", xls(rows))
    if kind not in WRITTEN:
        return table_of(kind, rows, folder)
    frame = pd.DataFrame(rows[1:], columns=rows[0])
    where = [Point(*place) for place in frame[["lon", "lat"]].to_numpy()]
    frame = gpd.GeoDataFrame(frame.drop(columns=["lon", "lat"]), geometry=where, crs=4326)
    return by_gdal(folder, kind, frame)


@pytest.mark.parametrize("kind", ["csv", "tsv", "xlsx", "ods", "xls", "geojson", "gpkg", "shp"])
def test_species_and_stage_of_a_record_are_text_whatever_format_they_come_in(tmp_path, kind):
    said = EVERY[:250] if kind in LETTERS else EVERY if kind == "xls" else LONG
    rows = [["lon", "lat", "date", "count", "species", "stage"], [*HERE[0], DAY, 7, said, said]]
    (tmp_path / "work").mkdir()
    source = points(kind, rows, tmp_path)
    read = tasks.records(str(tmp_path / "work"), source, RecordOptions(), None)
    (species,), (stage,) = read.value.species.tolist(), read.value.stage.tolist()
    for text in (species, stage):
        held_as_text(text, LETTERS.get(kind, len(EVERY)))
    shown_as_text(read)


@pytest.mark.parametrize("kind", ["csv", "tsv", "xlsx", "ods", "xls", "geojson", "gpkg", "shp"])
def test_who_inspected_and_noted_what_is_text_whatever_format_it_comes_in(tmp_path, kind):
    said = EVERY[:250] if kind in LETTERS else EVERY if kind == "xls" else LONG
    rows = [["lon", "lat", "result", "who", "notes"], [*HERE[0], "found", said, said]]
    (tmp_path / "work").mkdir()
    source, options = points(kind, rows, tmp_path), InspectionOptions(day=np.datetime64(DAY))
    read = tasks.inspection_rows(str(tmp_path / "work"), source, options)
    said_of = read.value
    for text in (*said_of.notes.tolist(), *said_of.who.tolist()):
        held_as_text(str(text), LETTERS.get(kind, len(EVERY)))
    shown_as_text(read)


def test_what_is_drawn_in_the_browser_makes_no_markup_of_texts():
    """The map's and the scout's scripts write texts as texts; only signs of their own are drawn."""
    markup = re.compile(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|DOMParser")
    found = [
        line.strip()
        for folder in ("map_view", "scout_page")
        for path in sorted(Path(ROOT / "app" / folder / "src").rglob("*.js"))
        for line in path.read_text("utf-8").splitlines()
        if markup.search(line)
    ]
    assert [line for line in found if "SIGNS[kind]" not in line] == []


#: a line of a drawing holds no second one, and at most 2 049 letters
IN_A_LINE = f"{' '.join(EVERY.split())} {'x' * 1_000}"
SURVEYED = """<?xml version="1.0"?>
<gpx version="1.1" creator="{said}" xmlns="http://www.topografix.com/GPX/1/1">
<metadata><name>{said}</name><desc>{said}</desc></metadata>{body}</gpx>"""


def gpx(*bodies):
    """Return a GPX file with a text that does harm wherever one may stand."""
    return Upload("data.gpx", SURVEYED.format(said=in_xml(LONG), body="".join(bodies)).encode())


def waypoint(place, name):
    said = in_xml(LONG)
    return (
        f'<wpt lat="{place[1]}" lon="{place[0]}"><time>{DAY}T05:00:00Z</time><name>{name}</name>'
        f"<cmt>{said}</cmt><desc>{said}</desc><src>{said}</src><type>{said}</type>"
        f"<extensions><who>{said}</who></extensions></wpt>"
    )


def track(area, name):
    points = "".join(f'<trkpt lat="{y}" lon="{x}"/>' for x, y in area.exterior.coords)
    return f"<trk><name>{name}</name><cmt>{name}</cmt><trkseg>{points}</trkseg></trk>"


def drawing(folder):
    """Return a drawing with a text that does harm as its comment and as the name of a layer."""
    lines = [area.exterior for area in (SQUARE, SECOND)]
    frame = gpd.GeoDataFrame({"Layer": ["HARM", "B"]}, geometry=lines, crs=4326)
    (folder / "data.dxf").unlink(missing_ok=True)
    frame.to_file(folder / "data.dxf", driver="DXF", engine="pyogrio")  # it would make it harmless
    said = IN_A_LINE.encode()
    drawn = (folder / "data.dxf").read_bytes().replace(b"HARM", said)
    return Upload("data.dxf", b"999\n" + said + b"\n" + drawn)


def read_in(folder, task, *asked):
    """Read by a task in a folder of its own."""
    return task(tempfile.mkdtemp(dir=folder), *asked)


def surveyed_plots(folder):
    source = gpx(track(SQUARE, in_xml(LONG)), track(SECOND, "B"))
    return read_in(folder, tasks.plots, source, PlotOptions(layer="tracks"))


def test_the_names_of_tracks_and_of_a_drawings_layers_are_text(tmp_path):
    drawn = PlotOptions(crs="EPSG:4326", name_column="Layer")
    for read, letters in (
        (surveyed_plots(tmp_path), len(EVERY)),
        (read_in(tmp_path, tasks.plots, drawing(tmp_path), drawn), 220),  # of a layer's name
    ):
        (own,) = (field.name for field in read.value if field.name != "B")
        held_as_text(own, letters)
        shown_as_text(read)


def test_names_and_comments_of_waypoints_are_text(tmp_path):
    options = RecordOptions(columns=(("species", "cmt"), ("stage", "desc"), ("present", "")))
    source = gpx(waypoint(HERE[0], in_xml(LONG)))
    records = read_in(tmp_path, tasks.records, source, options, None)
    for text in (*records.value.species.tolist(), *records.value.stage.tolist()):
        held_as_text(text, len(EVERY))
    shown_as_text(records)
    found = gpx(waypoint(HERE[0], "found"))
    asked = InspectionOptions(day=np.datetime64(DAY))
    rows = read_in(tmp_path, tasks.inspection_rows, found, asked)
    for text in (*rows.value.notes.tolist(), *rows.value.who.tolist()):
        held_as_text(str(text), len(EVERY))
    shown_as_text(rows)


def test_a_season_of_such_files_is_text_on_paper_and_on_the_scouts_page(tmp_path):
    name = next(one.name for one in surveyed_plots(tmp_path).value if one.name != "B")
    waypoints = gpx(waypoint(HERE[0], "found"))
    asked = InspectionOptions(day=np.datetime64(DAY))
    said = str(read_in(tmp_path, tasks.inspection_rows, waypoints, asked).value.notes[0])
    for text in (name, said):  # what pages and the scout's page are looked at with in a browser
        assert " ".join(text.split()) == " ".join(LONG.split())
    plot = a_plot()
    plot = replace(plot, field=replace(plot.field, name=name))
    season = Season.create(tmp_path / "Harm.gpkg", plot, begins=date.fromisoformat(DAY))
    plants, found = np.arange(4), np.array([1, 0, 0, 0])
    told = [np.array([said] * 4, object)] * 2
    on = date.fromisoformat(DAY)
    season.record(Inspections.of(plants, found, np.datetime64(on), who=told[0], notes=told[1]))
    (sheet,) = season.plan(on).route.to_file(tmp_path / "sheet.html")
    printed = sheet.read_text("utf-8"), html_text(season_report(season, on, Units()))
    for page in printed:
        held(page, ["<script>window.hit=1</script>"])


def test_refusals_of_files_with_such_texts_are_text(tmp_path):
    """Which layer, which column: names out of the file stand in the question."""
    half = SimpleNamespace(exterior=LineString(SQUARE.exterior.coords[:3]))
    for source, task, asked in (
        (drawing(tmp_path), tasks.plots, (PlotOptions(),)),
        (drawing(tmp_path), tasks.plots, (PlotOptions(layer=IN_A_LINE),)),
        (gpx(track(half, in_xml(LONG))), tasks.plots, (PlotOptions(),)),
        (gpx(waypoint(HERE[0], in_xml(LONG))), tasks.records, (RecordOptions(), None)),
    ):
        with pytest.raises(FieldmonError) as refused:
            read_in(tmp_path, task, source, *asked)
        line = language.in_words(str(refused.value))
        assert not (EVIL in line and LEADS.search(line)), line[:300]
