"""One door for every format: told by its name, read back by readers that are none of ours."""

import json
import re
import sys
from dataclasses import replace
from datetime import datetime
from io import BytesIO
from types import ModuleType
from xml.etree import ElementTree as ET
from zipfile import ZipFile

import numpy as np
import pandas as pd
import pyogrio
import pytest
import yaml

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.io.writers import FORMATS, write_handoff
from fieldmon.io.writers.handoff import HandoffFormat
from fieldmon.plot.layout import rectangle
from tests.io.writers.handed import crooked, day, empty, long, usual
from tests.pages import Page


def by_gdal(layer, column="plant"):
    """Return a reader of one column of a layer, by GDAL."""
    return lambda paths: pyogrio.read_dataframe(paths[0], layer=layer)[column]


def zipped(paths):
    return pyogrio.read_dataframe(f"/vsizip/{paths[0]}/stops.shp")["plant"]


def of_graph(paths):
    """Return the plants that a Nav2 graph's nodes and waypoints name, which must be the same."""
    graph, datum, waypoints = (path.read_text("utf-8") for path in paths)
    assert "datum" in yaml.safe_load(datum)["/**"]["ros__parameters"]
    named = [f["properties"].get("metadata", {}) for f in json.loads(graph)["features"]]
    stops = [
        pair for node in named if node for pair in zip(node["stops"], node["plants"], strict=True)
    ]
    plants = [plant for _, plant in sorted(stops)]
    assert plants == [stop["plant"] for stop in yaml.safe_load(waypoints)["waypoints"].values()]
    return plants


#: by format, who reads it here: plants in order, from the files written
READERS = {
    "nav2": of_graph,
    "nav2-pauses": of_graph,
    "waypoints": lambda paths: [
        stop["plant"] for stop in yaml.safe_load(paths[0].read_text("utf-8"))["waypoints"].values()
    ],
    "geojson": lambda paths: pyogrio.read_dataframe(paths[0], where="kind = 'stop'")["plant"],
    "gpkg": by_gdal("stops"),
    "shapefile": zipped,
    "csv": lambda paths: pd.read_csv(paths[0])["plant"],
    "kml": by_gdal("stops"),
    "gpx": lambda paths: by_gdal("waypoints", "cmt")(paths).str.extract(r"plant (\d+);")[0],
    "sheet": lambda paths: [
        row["data-plant"]
        for row in Page(paths[0].read_text("utf-8")).all("tr")
        if "data-plant" in row
    ],
}


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("make", [usual, crooked])
def test_every_format_is_read_back_by_another_program(tmp_path, name, make):
    assert name in READERS, f"Add a reader of {name} to READERS: see CONTRIBUTING, Add a format."
    plan = make()
    paths = write_handoff(plan, tmp_path / f"day{FORMATS[name].endings[0]}")
    assert_all_is_written(name, paths)
    assert [int(plant) for plant in READERS[name](paths)] == plan.route.plant.tolist()


def assert_all_is_written(name, paths):
    """Check that a folder holds these files of a format, each with something in it."""
    assert sorted(paths[0].parent.iterdir()) == sorted(paths)
    assert all(path.stat().st_size for path in paths)
    assert FORMATS[name].several == (len(paths) > 1)


@pytest.mark.parametrize("name", ["geojson", "gpkg", "shapefile", "kml", "gpx", "sheet"])
def test_a_file_with_room_for_it_says_what_no_other_route_can_expect(name):
    plan = usual()
    known = replace(plan, route=replace(plan.route, found_bound=2.0 * plan.route.expected_finds))
    made = FORMATS[name].make(known)
    whole = b"".join(made.values())
    if name == "shapefile":
        with ZipFile(BytesIO(whole)) as archive:
            whole = archive.read("route.dbf")
    assert b"no route of these hours can expect more than" in whole
    assert b"no route of these hours" not in b"".join(FORMATS[name].make(plan).values())


@pytest.mark.parametrize("name", ["csv", "geojson", "kml", "gpx", "sheet"])
@pytest.mark.parametrize(
    ("start", "shown", "never"),
    [
        (datetime(2027, 3, 26, 1, 15), "03:", "02:"),  # hours that do not exist
        (datetime(2026, 10, 25, 0, 45), "01:", "02:"),  # an hour that comes twice
    ],
)
def test_arrivals_after_clocks_are_put_forward_or_back_are_what_they_show(
    name, start, shown, never
):
    plan = day(rectangle(9, 14), start=start)
    whole = b"".join(FORMATS[name].make(plan).values()).decode("utf-8", "replace")
    times = re.findall(r"[T>](\d\d:)\d\d", whole)
    assert (shown in times, never in times) == (True, False)


@pytest.mark.parametrize("name", FORMATS)
def test_every_ending_of_a_format_is_its_own(tmp_path, name):
    wanted = FORMATS[name].make(usual())
    for ending in FORMATS[name].endings:
        paths = write_handoff(usual(), tmp_path / f"day{ending}")
        assert len(paths) == len(wanted)
        assert paths[0].name == f"day{ending}"


def test_a_new_format_is_a_file_and_a_line(tmp_path, monkeypatch):
    module = ModuleType("fieldmon.io.writers.plain")
    module.route_plain = lambda plan: " ".join(stop.label for stop in plan.stops).encode()
    monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setitem(
        FORMATS, "plain", HandoffFormat("plain:route_plain", (".txt",), worded("people"))
    )
    plan = usual()
    (path,) = write_handoff(plan, tmp_path / "day.txt")
    assert path.read_text("utf-8").startswith(plan.stops[0].label)
    assert write_handoff(plan, tmp_path / "day.csv", "plain")[0].read_bytes() == path.read_bytes()


def test_the_ending_or_the_name_tells_the_format(tmp_path):
    plan = usual()
    (by_ending,) = write_handoff(plan, tmp_path / "a.CSV")
    (by_name,) = write_handoff(plan, tmp_path / "a.txt", "csv")
    assert by_ending.read_bytes() == by_name.read_bytes()
    for name in ("a.gpkg.zip", "a.CSV.Zip"):
        with pytest.raises(SettingError, match=r"Leave out \.zip, or end it in .shp.zip"):
            write_handoff(plan, tmp_path / name)
    with pytest.raises(SettingError, match="must end in one of"):
        write_handoff(plan, tmp_path / "a.docx")
    with pytest.raises(SettingError, match=r"written as gpx, kml, .* not as 'docx'"):
        write_handoff(plan, tmp_path / "a.csv", "docx")


@pytest.mark.parametrize("to", [None, 5])
def test_what_is_no_path_is_refused_in_a_sentence(to):
    with pytest.raises(SettingError, match="A file must be given by its path"):
        write_handoff(usual(), to)


def test_every_ending_tells_one_format_only():
    endings = [ending for chosen in FORMATS.values() for ending in chosen.endings]
    assert len(set(endings)) == len(endings)


@pytest.mark.parametrize("name", FORMATS)
def test_a_place_that_cannot_be_written_to_is_a_sentence(tmp_path, name):
    with pytest.raises(FileProblem, match="must exist"):
        write_handoff(usual(), tmp_path / "none" / f"a{FORMATS[name].endings[0]}")


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("make", [long, empty])
def test_every_format_is_written_for_every_day(tmp_path, name, make):
    plan = make()
    to = tmp_path / f"a{FORMATS[name].endings[0]}"
    if name in {"nav2", "nav2-pauses", "waypoints"} and not len(plan.route):
        with pytest.raises(SettingError, match="drives nowhere"):
            write_handoff(plan, to)
        assert list(tmp_path.iterdir()) == []
        return
    assert_all_is_written(name, write_handoff(plan, to))


def _filled_in(path, said):
    """Fill in a file given out: the results of some stops, by their places in the day."""
    if path.suffix == ".csv":
        table = pd.read_csv(path, dtype={"found": object, "notes": object})
        for k, (found, count, note) in said.items():
            table.loc[k, ["found", "count", "notes"]] = "yes" if found else "no", count, note
        table.to_csv(path, index=False)
    elif path.suffix == ".geojson":
        root = json.loads(path.read_text())
        for k, (found, count, note) in said.items():
            root["features"][k + 1]["properties"].update(found=found, count=count, notes=note)
        path.write_text(json.dumps(root))
    elif path.suffix == ".gpkg":
        table = pyogrio.read_dataframe(path, layer="stops")
        for k, (found, count, note) in said.items():
            table.loc[k, ["found", "count", "notes"]] = "found" if found else "clean", count, note
        pyogrio.write_dataframe(table, path, layer="stops")
    elif path.suffix == ".kml":
        tree = ET.parse(path)  # noqa: S314
        stops = tree.getroot().iter("{http://www.opengis.net/kml/2.2}ExtendedData")
        cells = [{data.get("name"): data[0] for data in stop} for stop in stops]
        for k, (found, count, note) in said.items():
            cells[k]["found"].text = "yes" if found else "no"
            cells[k]["count"].text = "" if count is None else str(count)
            cells[k]["notes"].text = note
        tree.write(path)
    else:
        tree, gpx = ET.parse(path), "{http://www.topografix.com/GPX/1/1}"  # noqa: S314
        waypoints = tree.getroot().findall(f"{gpx}wpt")
        for k, (found, count, note) in said.items():
            waypoints[k].find(f"{gpx}name").text += f" +{count}" if found else " 0"
            waypoints[k].find(f"{gpx}cmt").text += f"; {note}" if note else ""
        tree.write(path)


@pytest.mark.parametrize("ending", ["csv", "geojson", "gpkg", "kml", "gpx"])
def test_what_each_stop_finds_comes_back_from_every_format(tmp_path, ending):
    plan = usual()
    detects = np.where(np.arange(len(plan.route)) % 2, 1 / 3, 0.84)
    plan = replace(plan, route=replace(plan.route, detects=detects))
    (path,) = write_handoff(plan, tmp_path / f"day.{ending}")
    _filled_in(path, {0: (True, 3, "on the fruit"), 1: (False, None, ""), 4: (False, None, "dry")})
    read = read_inspections(path, plan.grid).value
    assert read.detects.tolist() == [0.84, 0.333333, 0.84]
    assert read.notes.tolist() == ["on the fruit", "", "dry"]


@pytest.mark.parametrize("ending", ["csv", "geojson", "gpkg", "kml", "gpx"])
@pytest.mark.parametrize("make", [usual, crooked])
def test_a_day_filled_in_alike_comes_in_alike_from_every_format(tmp_path, make, ending):
    """Planned arrivals are no times of inspections, and what is planned is no note of a scout."""
    plan = make()
    (path,) = write_handoff(plan, tmp_path / f"day.{ending}")
    said = {0: (True, 3, "on the fruit"), 1: (False, None, ""), 4: (False, None, "dry")}
    _filled_in(path, said)
    read = read_inspections(path, plan.grid).value
    assert read.plant.tolist() == plan.route.plant[list(said)].tolist()
    assert read.result.tolist() == [FOUND, CLEAN, CLEAN]
    assert np.array_equal(read.count, [3, np.nan, np.nan], equal_nan=True)
    assert set(read.date.astype(str).tolist()) == {"2026-11-18"}
    assert np.isnan(read.second).all()
    assert read.notes.tolist() == [note for _, _, note in said.values()]
