"""The QGIS project in a season's file: what it shows, and that it names its own file."""

import io
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import zipfile
from contextlib import closing
from dataclasses import replace
from datetime import timedelta
from xml.etree import ElementTree as ET

import pytest
from pyproj import Transformer

from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.io.parse.geometry import area_m2
from fieldmon.monitoring import Season, Store
from fieldmon.monitoring.file.qgis_project import _mercator
from fieldmon.planning.members import TeamMember, team_of
from fieldmon.plot.robot import Robot
from tests.monitoring.seasons import BEGINS, a_season

INTERNAL = {"fieldmon", "settings", "import_findings", "arrays", "batches", "days", "plant_state"}


def project_of(path):
    with closing(sqlite3.connect(path)) as db:
        ((name, metadata, content),) = db.execute("SELECT * FROM qgis_projects").fetchall()
    assert name == "fieldmon"
    assert "last_modified_time" in json.loads(metadata)
    with zipfile.ZipFile(io.BytesIO(bytes.fromhex(content))) as archive:
        (inner,) = archive.namelist()
        assert inner == "fieldmon.qgs"
        return ET.fromstring(archive.read(inner))  # noqa: S314 - our own


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    season = a_season(tmp_path_factory.mktemp("qgis") / "vines.gpkg")
    for k in range(3):
        season.plan(BEGINS + timedelta(days=k))
    return season


def layers(project):
    return {one.find("layername").text: one for one in project.iter("maplayer")}


def rows_shown(path, layer):
    """Return the rows of a layer that its project's source chooses."""
    source = layer.find("datasource").text
    table = source.partition("layername=")[2].partition("|")[0]
    only = source.partition("subset=")[2] or "1"
    with closing(sqlite3.connect(path)) as db:
        return db.execute(f"SELECT * FROM {table} WHERE {only}").fetchall()  # noqa: S608


def test_only_todays_route_is_on_and_earlier_days_are_a_group(season):
    project = project_of(season.path)
    assert len(rows_shown(season.path, layers(project)["Route today"])) == 1
    stops = rows_shown(season.path, layers(project)["Stops today"])
    assert len(stops) == len(season.kept_route(BEGINS + timedelta(days=2)))
    (group,) = [g for g in project.iter("layer-tree-group") if g.get("name") == "Earlier days"]
    assert group.get("checked") == "Qt::Unchecked"
    named = [one.get("name") for one in group]
    assert named == [f"Route {BEGINS + timedelta(days=k)}" for k in (1, 0)]
    for name in named:
        assert len(rows_shown(season.path, layers(project)[name])) == 1


def test_of_a_team_the_last_route_of_each_is_shown(tmp_path):
    team = a_season(tmp_path / "team.gpkg", team=team_of(2, Robot(hours=0.5)))
    team.plan_each(BEGINS)
    last = team.plan_each(BEGINS + timedelta(days=1))
    shown = layers(project_of(team.path))
    for name in ("Route today", f"Route {BEGINS}"):
        assert len(rows_shown(team.path, shown[name])) == 2
    stops = rows_shown(team.path, shown["Stops today"])
    assert len(stops) == sum(len(day.route) for day in last)


def test_routes_of_whoever_is_no_longer_out_are_not_shown(tmp_path):
    robot = Robot(hours=0.5)
    first = TeamMember("Ann O'Neill", robot), TeamMember("R1", robot)
    season = a_season(tmp_path / "team.gpkg", team=first)
    season.plan_each(BEGINS)
    for team, n in ((team_of(3, robot), 3), ((), 1), (first, 2)):
        season.change(replace(season.settings, team=team), season.settings)
        last = season.plan_each(BEGINS)
        shown = layers(project_of(season.path))
        routes = rows_shown(season.path, shown["Route today"])
        assert len(routes) == n
        stops = rows_shown(season.path, shown["Stops today"])
        assert len(stops) == sum(len(day.route) for day in last)
    season.plan_each(BEGINS + timedelta(days=1))
    shown = layers(project_of(season.path))
    assert rows_shown(season.path, shown[f"Route {BEGINS}"]) == routes


def test_every_layer_of_the_tree_is_there_and_none_is_internal(season):
    project = project_of(season.path)
    ids = {one.find("id").text for one in project.iter("maplayer")}
    assert ids == {one.get("id") for one in project.iter("layer-tree-layer")}
    assert all(len(one) > 10 for one in ids)  # QGIS replaces shorter ones
    sources = [one.find("datasource").text for one in project.iter("maplayer")]
    assert not INTERNAL & {one.partition("layername=")[2].partition("|")[0] for one in sources}
    preset = {one.get("id") for one in project.iter("visibility-preset") for one in one}
    assert preset <= ids


def test_only_findings_can_be_changed_with_a_list_of_results_and_todays_date(season):
    found = {name: one for name, one in layers(project_of(season.path)).items()
             if one.get("readOnly") == "0"}  # fmt: skip
    assert list(found) == ["Findings"]
    form = found["Findings"]
    values = [
        o.get("value")
        for o in form.iter("Option")
        if o.get("value") in {*RESULT_NAMES.values(), "gone"}
    ]
    assert sorted(values) == sorted([*RESULT_NAMES.values(), "gone"])
    widgets = {one.get("name"): one.find("editWidget").get("type")
               for one in form.iter("field") if one.find("editWidget") is not None}  # fmt: skip
    assert widgets["detects"] == widgets["digest"] == "Hidden"
    defaults = {one.get("field"): one.get("expression") for one in form.iter("default")}
    assert defaults["date"] == "to_date(now())"
    assert defaults["undone"] == "0"


def test_what_was_undone_is_not_shown(season):
    findings = layers(project_of(season.path))["Findings"]
    assert '"undone" = 0' in findings.find("datasource").text


def test_a_copy_under_another_name_gets_a_project_of_its_own(season, tmp_path):
    copy = tmp_path / "other name.gpkg"
    shutil.copy(season.path, copy)
    Season(copy).plan(BEGINS + timedelta(days=3))
    sources = {one.find("datasource").text.partition("|")[0]
               for one in project_of(copy).iter("maplayer")}  # fmt: skip
    assert sources == {"./other name.gpkg"}
    kept = {one.find("datasource").text.partition("|")[0]
            for one in project_of(season.path).iter("maplayer")}  # fmt: skip
    assert kept == {"./vines.gpkg"}


def test_a_copy_by_fieldmon_and_a_season_renamed_have_a_project_of_their_own(season, tmp_path):
    """Else whoever opens a copy beside the season in QGIS works in the season."""
    season.store.back_up(copy := tmp_path / "o'clock & more.gpkg")
    season.store.back_up(tmp_path / "again.gpkg")
    Store(tmp_path / "again.gpkg").move(moved := tmp_path / "moved.gpkg")
    for path in (season.path, copy, moved):
        project = project_of(path)
        sources = {one.find("datasource").text.partition("|")[0]
                   for one in project.iter("maplayer")}  # fmt: skip
        assert sources == {f"./{path.name}"}
        assert project.find("title").text == project.get("projectname") == path.stem
    before, after = (layers(project_of(path)) for path in (season.path, copy))
    assert {name: len(rows_shown(season.path, one)) for name, one in before.items()} == {
        name: len(rows_shown(copy, one)) for name, one in after.items()
    }


@pytest.mark.parametrize("content", [None, 7, "zz", b"\xff", "00", "other"])
def test_a_project_that_is_somebody_s_own_stays_in_a_copy_as_it_was(season, tmp_path, content):
    shutil.copy(season.path, path := tmp_path / "season.gpkg")
    if content == "other":
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as archive:
            archive.writestr("mine.qgs", "<qgis><datasource>./roads.gpkg|layername=r</datasource>")
        content = packed.getvalue().hex()
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE qgis_projects SET content = ?", (content,))
        db.commit()
    Store(path).back_up(copy := tmp_path / "copy.gpkg")
    with closing(sqlite3.connect(copy)) as db:
        assert db.execute("SELECT content FROM qgis_projects").fetchall() == [(content,)]
        db.execute("DROP TABLE qgis_projects")
        db.commit()
    Store(copy).back_up(tmp_path / "another.gpkg")


def test_routes_of_a_team_have_a_colour_each_and_one_alone_is_black(season, tmp_path):
    team = a_season(tmp_path / "team.gpkg", team=team_of(2, Robot(hours=0.5)))
    team.plan_each(BEGINS)
    drawn = layers(project_of(team.path))["Route today"]
    with closing(sqlite3.connect(team.path)) as db:
        names = [who for (who,) in db.execute("SELECT who FROM routes ORDER BY who")]
    assert [one.get("value") for one in drawn.iter("category")] == names
    colours = [one.get("value") for one in drawn.iter("Option") if one.get("name") == "line_color"]
    assert len(set(colours)) == len(colours) == 2
    alone = layers(project_of(season.path))["Route today"]
    assert not list(alone.iter("category"))


_ASK_QGIS = """
import sys
from qgis.core import QgsDistanceArea, QgsApplication, QgsProject, QgsVectorLayerUtils, edit
app = QgsApplication([], False); app.initQgis()
project = QgsProject.instance()
assert project.read(f"geopackage:{sys.argv[1]}?projectName=fieldmon")
layers = {one.name(): one for one in project.mapLayers().values()}
assert all(one.isValid() for one in layers.values()), layers
measured = QgsDistanceArea()
measured.setSourceCrs(layers["Plot"].crs(), project.transformContext())
measured.setEllipsoid(project.ellipsoid())
plot = next(layers["Plot"].getFeatures()).geometry()
assert abs(measured.measureArea(plot) / float(sys.argv[3]) - 1) < 1e-4, measured.measureArea(plot)
assert project.title() == "field"
assert [one["day"] for one in layers["Route today"].getFeatures()] == [2]
assert layers["Plot"].readOnly() and not layers["Findings"].readOnly()
findings, stop = layers["Findings"], next(layers["Stops today"].getFeatures())
with edit(findings):
    one = QgsVectorLayerUtils.createFeature(findings, stop.geometry(), {
        findings.fields().indexOf("result"): "found"})
    assert one["date"].toString("yyyy") > "2020", one["date"]
    one["date"] = sys.argv[2]
    assert findings.addFeature(one)
print("ok", stop["plant"])
app.exitQgis()
"""


@pytest.mark.skipif(not os.path.isdir("/usr/lib/python3/dist-packages/qgis"),  # noqa: PTH112
                    reason="QGIS (Debian's python3-qgis) is not on this machine")  # fmt: skip
def test_qgis_opens_the_project_edits_and_saves_and_the_season_records_it(season, tmp_path):
    copy = tmp_path / "field.gpkg"
    shutil.copy(season.path, copy)
    Season(copy).rebuild()
    done = subprocess.run(
        ["/usr/bin/python3", "-c", _ASK_QGIS, str(copy), str(BEGINS),
         str(area_m2(season.plot.field.boundary))],
        check=False, capture_output=True, text=True,
        env={"QT_QPA_PLATFORM": "offscreen", "HOME": str(tmp_path), "PATH": os.environ["PATH"]},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert copy.read_bytes()[18:20] == b"\2\2"  # QGIS leaves its mark
    assert Season(copy).store.doubt is None  # and closed the season where it lies
    plant = int(done.stdout.split()[-1])
    from fieldmon.io.readers.inspections import read_inspections
    from fieldmon.monitoring.season.inspection_import import counting_copy

    (tmp_path / "counting").mkdir()
    counted = counting_copy(copy, tmp_path / "counting")
    read = read_inspections(counted, season.plot.grid).value
    assert read.plant.tolist() == [plant]
    assert sys.version_info >= (3, 11)


@pytest.mark.parametrize("box", [(35.1, 30.3, 35.2, 30.4), (-70.5, -33.75, -70.0, -33.0),
                                 (-179.9, 59.0, -179.0, 84.0)])  # fmt: skip
def test_the_view_is_the_box_in_metres_of_web_maps(box):
    there = Transformer.from_crs(4326, 3857, always_xy=True)
    wanted = [*there.transform(*box[:2]), *there.transform(*box[2:])]
    assert _mercator(box) == pytest.approx(wanted, abs=1e-3)
