"""The file of a season survives what happens to files."""

import os
import random
import shutil
import sqlite3
import time
from contextlib import closing, contextmanager
from multiprocessing import get_context
from xml.etree import ElementTree as ET

import numpy as np
import pyogrio
import pytest

from fieldmon.errors import FieldmonError, FileProblem
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season, is_season, schema
from fieldmon.monitoring.salvage import salvage
from tests.monitoring.seasons import BEGINS, a_season, some_results
from tests.monitoring.working import day_by_day, one_by_one

KILLS = int(os.environ.get("FIELDMON_KILLS", "20"))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    path = tmp_path_factory.mktemp("made") / "season.gpkg"
    season = a_season(path)
    season.plan(BEGINS)
    season.record(some_results(season, n=12, found=[2, 3, 4]), "monday.csv", "Ann")
    return path


@pytest.fixture
def path(made, tmp_path):
    return shutil.copy(made, tmp_path / "season.gpkg")


def working(task, *words):
    """Start a process that is warm already, so that it is at work within milliseconds."""
    process = get_context("fork").Process(target=task, args=words)
    process.start()
    return process


def state(path):
    """Return what counts of a season: it must hold together."""
    season = Season(path)
    season.store.check()
    assert season.verify() == ()
    with season.store.reading() as db:
        inspections = db.execute("SELECT digest FROM inspections ORDER BY fid").fetchall()
        batches = db.execute("SELECT rows FROM batches WHERE kind = 'findings'").fetchall()
        days = db.execute("SELECT sum(inspected) FROM days").fetchone()[0]
        routes = db.execute("SELECT fid, stops FROM routes").fetchall()
        stops = dict(db.execute("SELECT route, count(*) FROM stops GROUP BY route").fetchall())
    assert sum(n for (n,) in batches) == len(inspections)
    assert days == len(inspections)
    assert stops == {route: n for route, n in routes if n}
    return len(inspections)


def test_a_process_killed_at_any_moment_leaves_a_whole_season(path):
    """Kill -9 at random moments; 200 of them with FIELDMON_KILLS=200."""
    rng = random.Random(1)
    started = time.monotonic()
    season = Season(path)
    season.plan(BEGINS)
    season.record(three_results(), "to see how long it takes")
    pace_s = time.monotonic() - started  # of this machine, now
    before, grew = state(path), 0
    for _ in range(KILLS):
        process = working(day_by_day, path)
        time.sleep(rng.uniform(0.01, 10 * pace_s))
        process.kill()
        process.join()
        now = state(path)
        assert now >= before
        grew += now > before
        before = now
    assert grew > KILLS / 10, "hardly anything was written between the kills: they prove nothing"
    with Season(path).store.writing():
        pass  # a killed process may leave an empty journal; who writes next takes it away
    assert [file.name for file in path.parent.iterdir()] == ["season.gpkg"]


@pytest.mark.parametrize("content", [b"", b"plant;found\n1;yes\n", b"\x00" * 5000])
def test_what_is_no_season_is_not_called_a_damaged_one(content, tmp_path):
    other = tmp_path / "other.csv"
    other.write_bytes(content)
    with pytest.raises(FileProblem, match="must be the file of a season"):
        Season(other)
    assert other.read_bytes() == content


def test_two_processes_recording_at_once_lose_nothing(path):
    before, rounds = state(path), 100
    both = [working(one_by_one, path, who, rounds) for who in (0, 1)]
    for process in both:
        process.join(240)
        assert process.exitcode == 0
    with Season(path).store.reading() as db:
        rows = db.execute("SELECT who, plant FROM inspections WHERE fid > ?", (before,)).fetchall()
    n = len(Season(path).plot.grid)
    wanted = {(str(who), (k * 2 + who) % n) for who in (0, 1) for k in range(rounds)}
    assert len(rows) == 2 * rounds
    assert set(rows) == wanted
    assert state(path) == before + 2 * rounds


def test_gdal_opens_every_layer_where_it_is(path):
    season = Season(path)
    layers = dict(pyogrio.list_layers(path))
    shown = {table.name for table in (*schema.TABLES, schema.CHANCE) if table.shape}
    assert shown <= set(layers)
    plants = pyogrio.read_dataframe(path, layer="plants")
    assert np.abs(plants.get_coordinates().to_numpy() - season.plot.grid.lonlat()).max() < 1e-12
    assert plants.crs.to_epsg() == 4326
    chance = pyogrio.read_dataframe(path, layer="chance")
    assert chance["chance"].to_numpy() == pytest.approx(season.evening(BEGINS), abs=1e-6)
    assert set(chance["state"]) == {"never inspected", "looked clean", "found infested"}
    inspections = pyogrio.read_dataframe(path, layer="inspections")
    assert (inspections["result"] == "found").sum() == 3
    line = pyogrio.read_dataframe(path, layer="routes").geometry.iloc[0]
    route = season.plan(BEGINS, keep=False)
    assert line.length > 0
    assert route.scene.day == 0
    assert pyogrio.read_dataframe(path, layer="plots")["name"].iloc[0] == "מטע Paran"


def test_the_file_is_a_geopackage_by_its_own_rules(path):
    with closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA application_id").fetchone() == (0x47504B47,)
        assert db.execute("PRAGMA user_version").fetchone()[0] >= 10200
        assert db.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert db.execute("PRAGMA foreign_key_check").fetchall() == []
        named = {name for (name,) in db.execute("SELECT table_name FROM gpkg_contents")}
        there = {name for (name,) in db.execute("SELECT name FROM sqlite_master")}
        assert named <= there
        for table, kind in db.execute(
            "SELECT table_name, geometry_type_name FROM gpkg_geometry_columns"
        ):
            for (blob,) in db.execute(f"SELECT geom FROM {table} WHERE geom NOTNULL"):  # noqa: S608
                assert blob[:3] == b"GP\x00"
                assert int.from_bytes(blob[4:8], "little") == 4326
                assert kind


def test_every_layer_has_a_style_that_is_xml(path):
    with closing(sqlite3.connect(path)) as db:
        styles = db.execute(
            "SELECT f_table_name, styleQML, useAsDefault FROM layer_styles"
        ).fetchall()
        layers = {name for (name,) in db.execute("SELECT table_name FROM gpkg_geometry_columns")}
    assert {name for name, _, _ in styles} | {"places"} == layers
    for _, qml, default in styles:
        assert ET.fromstring(qml).find("renderer-v2") is not None  # noqa: S314 - our own
        assert default == 1


def test_a_file_of_version_1_becomes_one_of_today(path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("DROP TABLE treatments")
        db.execute("DELETE FROM gpkg_geometry_columns WHERE table_name = 'treatments'")
        db.execute("DELETE FROM gpkg_contents WHERE table_name = 'treatments'")
        db.execute("ALTER TABLE routes DROP COLUMN at_plant")
        db.execute("ALTER TABLE routes DROP COLUMN seconds_left")
        db.execute("UPDATE fieldmon SET value = '1' WHERE key = 'version'")
        db.commit()
    season = Season(path)
    assert season.status(BEGINS).found == 3
    season.treat(BEGINS, 0.5)
    season.plan(BEGINS)
    assert state(path) == 12


def test_a_file_of_a_newer_version_is_refused(path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE fieldmon SET value = '99' WHERE key = 'version'")
        db.commit()
    with pytest.raises(FileProblem, match="newer fieldmon"):
        Season(path)


def test_other_files_are_no_seasons(path, tmp_path):
    assert is_season(path)
    other = tmp_path / "plots.gpkg"
    pyogrio.write_dataframe(pyogrio.read_dataframe(path, layer="plots"), other, layer="plots")
    (tmp_path / "text.gpkg").write_text("hello")
    (tmp_path / "empty.gpkg").touch()
    for name in ("plots.gpkg", "text.gpkg", "empty.gpkg", "none.gpkg"):
        assert not is_season(tmp_path / name)
        with pytest.raises(FileProblem):
            Season(tmp_path / name)


def test_a_damaged_file_is_refused_or_right_and_mostly_salvaged(path, tmp_path):
    whole = path.read_bytes()
    saved = []
    for seed in range(20):
        data, rng = bytearray(whole), random.Random(seed)
        for _ in range(3):
            page = rng.randrange(1, len(data) // 4096)
            data[page * 4096 : page * 4096 + 4096] = rng.randbytes(4096)
        path.write_bytes(data)
        said = "salvage"
        try:
            season = Season(path)
            season.store.check()
            season.status(BEGINS)
        except FieldmonError as problem:
            said = str(problem)
        assert "salvage" in said
        rescued = tmp_path / f"rescued{seed}.gpkg"
        try:
            done = salvage(path, rescued)
        except FileProblem as problem:
            said = str(problem)
            assert "nothing is" in said
            assert not rescued.exists()
            continue
        saved.append(done.rows["inspections"])
        if done.whole:
            assert len(Season(rescued).history.inspections) == done.rows["inspections"]
    assert sum(n == 12 for n in saved) >= 10


def test_half_a_file_is_refused_and_what_is_left_is_saved(path, tmp_path):
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * 0.9)])
    with pytest.raises(FileProblem, match="salvage"):
        Season(path).store.check()
    saved = salvage(path, tmp_path / "rescued.gpkg")
    assert saved.rows["plants"] > 0


def test_a_whole_file_is_salvaged_whole(path, tmp_path):
    saved = salvage(path, tmp_path / "rescued.gpkg")
    assert (saved.lost, saved.whole) == ((), True)
    one, other = Season(path), Season(tmp_path / "rescued.gpkg")
    assert np.array_equal(one.evening(BEGINS), other.evening(BEGINS))
    assert state(tmp_path / "rescued.gpkg") == 12


def test_a_file_held_by_another_program_is_a_sentence(path, monkeypatch):
    monkeypatch.setattr("fieldmon.monitoring.transactions._PATIENCE_S", 0.2)
    season = Season(path)
    with closing(sqlite3.connect(path)) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(FileProblem, match="another program"):
            season.record(three_results(), "x")


def test_a_file_that_cannot_be_written_is_a_sentence(path):
    season = Season(path)
    results = three_results()
    with closing(sqlite3.connect(path)) as db:  # a disk without room, as SQLite sees it
        pages = db.execute("PRAGMA page_count").fetchone()[0]
    original = season.store.writing

    @contextmanager
    def small():
        with original() as db:
            db.execute(f"PRAGMA max_page_count = {pages}")
            yield db

    season.store.writing = small
    big = type(results)(
        **{
            name: np.resize(values, 5000) if name != "plant" else np.arange(5000) % 400
            for name, values in vars(results).items()
        }
        | {"second": np.arange(5000.0)}
    )
    with pytest.raises(FileProblem, match="full"):
        season.record(big, "x")
    season.store.writing = original
    assert state(path) == 12


def three_results():
    plants = np.arange(100, 103)
    return Inspections.of(plants, np.zeros(3, np.int8), np.datetime64(BEGINS, "D"))


def test_rows_that_another_program_adds_do_not_count_before_they_are_recorded(path):
    season = Season(path)
    before = season.evening(BEGINS)
    extra = pyogrio.read_dataframe(path, layer="inspections").tail(1)
    extra[["digest", "batch", "undone", "plant", "day"]] = None
    pyogrio.write_dataframe(extra, path, layer="inspections", append=True)
    assert np.array_equal(season.evening(BEGINS), before)
    assert len(season.history.inspections) == 12
