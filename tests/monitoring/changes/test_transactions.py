"""The file of a season survives what happens to files."""

import os
import random
import shutil
import sqlite3
import time
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np
import pyogrio
import pytest

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season, is_season
from fieldmon.monitoring.changes.transactions import Store
from fieldmon.monitoring.file import connections
from tests.monitoring.file.test_connections import ENDLESS
from tests.monitoring.open_elsewhere import as_qgis, beside
from tests.monitoring.seasons import BEGINS, state, three_results
from tests.monitoring.working import day_by_day, one_by_one, started

SEASONS_OF_OLD = Path(__file__).parents[1] / "seasons_of_old"
KILLS = int(os.environ.get("FIELDMON_KILLS", "4"))


@pytest.fixture(autouse=True)
def opened_once():
    """Let files be opened for each thing that is done, as programs without pages do."""


def n_recorded(path):
    with closing(sqlite3.connect(path, timeout=30.0)) as db:
        return db.execute("SELECT count(*) FROM inspections").fetchone()[0]


def test_a_process_killed_at_any_moment_leaves_a_whole_season(path):
    """Kill -9 at random moments; 200 of them with FIELDMON_KILLS=200."""
    rng = random.Random(1)
    season = Season(path)
    season.plan(BEGINS)  # with loops that may have to be compiled first
    began_s = time.monotonic()
    season.plan(BEGINS)
    season.record(three_results(), "to see how long it takes")
    pace_s = time.monotonic() - began_s  # of this machine, now
    before, grew = state(path), 0
    for kill in range(KILLS):
        process = started(day_by_day, path)
        while kill % 2 and process.is_alive() and n_recorded(path) == before:
            time.sleep(0.01)  # every other one has written for sure
        time.sleep(rng.uniform(0.01, 6 * pace_s))
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
    before, rounds = state(path), 8
    both = [started(one_by_one, path, who, rounds) for who in (0, 1)]
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


def test_a_file_of_a_newer_version_is_refused(path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE fieldmon SET value = '99' WHERE key = 'version'")
        db.commit()
    with pytest.raises(FileProblem, match=r"format 99.*it needs fieldmon >= 0\.2"):
        Season(path)
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE fieldmon SET value = '7.1' WHERE key = 'needs'")
        db.commit()
    with pytest.raises(FileProblem, match=r"it needs fieldmon >= 7\.1"):
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


def test_who_writes_is_alone_from_the_first_moment(path):
    """Or two who read first and then write would both write what only one of them has seen."""
    with (
        Season(path).store.writing(),
        closing(sqlite3.connect(path, timeout=0, isolation_level=None)) as other,
        pytest.raises(sqlite3.OperationalError, match="locked"),
    ):
        other.execute("BEGIN IMMEDIATE")


def no_links(*_):
    raise OSError(95, "Operation not supported")


@pytest.mark.parametrize("link", [os.link, no_links], ids=["links", "a stick without links"])
def test_a_season_begun_at_the_same_moment_by_another_is_not_overwritten(
    tmp_path, monkeypatch, link
):
    monkeypatch.setattr(os, "link", link)
    ours, theirs = tmp_path / "ours.gpkg", tmp_path / "theirs.gpkg"
    with Store.new(ours):
        pass
    assert ours.read_bytes()[:6] == b"SQLite"
    with pytest.raises(FileProblem, match="by someone else just now"), Store.new(theirs):
        theirs.write_text("theirs")
    assert theirs.read_text() == "theirs"
    assert {file.name for file in tmp_path.iterdir()} == {"ours.gpkg", "theirs.gpkg"}


# --- other programs that have the file open, and what they leave behind ---------------------------


@contextmanager
def reader_of(path):
    """Hold a season as a program does that reads it for long."""
    with closing(sqlite3.connect(path, isolation_level=None)) as other:
        other.execute("BEGIN")
        other.execute("SELECT count(*) FROM inspections").fetchone()
        yield


def test_reading_and_planning_what_is_planned_already_wait_for_no_reader(path, monkeypatch):
    monkeypatch.setattr("fieldmon.monitoring.file.connections._PATIENCE_S", 0.2)
    season = Season(path)
    season.plan(BEGINS)
    with reader_of(path):
        assert season.status(BEGINS).found == 3
        assert len(season.plan(BEGINS, keep=False).route)
        assert len(season.plan(BEGINS).route)
        assert is_season(path)
        with pytest.raises(FileProblem, match=r"has held it.*nothing was changed"):
            season.record(three_results(), "x")
    assert state(path) == 12


# --- copies ---------------------------------------------------------------------------------------


def test_a_copy_is_whole_and_one_file_whoever_works_on_the_season(path, tmp_path):
    season, copy = Season(path), tmp_path / "copy.gpkg"
    with closing(as_qgis(path)) as qgis:
        qgis.execute("UPDATE inspections SET notes = 'not yet in the file' WHERE fid = 5")
        season.store.back_up(copy)
    assert beside(copy) == ["copy.gpkg"]
    assert "not yet in the file" in Season(copy).history.inspections.notes.tolist()
    assert state(copy) == 12
    with pytest.raises(FileProblem, match="exists already"):
        season.store.back_up(copy)
    with pytest.raises(FileProblem, match="must exist before"):
        season.store.back_up(tmp_path / "nowhere" / "copy.gpkg")


def test_a_season_is_moved_only_while_nobody_else_has_it_open(path, tmp_path, monkeypatch):
    monkeypatch.setattr(connections, "_PATIENCE_S", 0.0)
    store, to = Season(path).store, tmp_path / "moved" / "season.gpkg"
    to.parent.mkdir()
    with closing(as_qgis(path)) as qgis:
        qgis.execute("UPDATE inspections SET notes = 'not yet in the file' WHERE fid = 5")
        with pytest.raises(FileProblem):
            store.move(to)
    with closing(connections.connect(path)) as other:
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(FileProblem):
            store.move(to)
    assert beside(to) == []
    store.move(to)
    assert (path.exists(), beside(to)) == (False, ["season.gpkg"])
    assert "not yet in the file" in Season(to).history.inspections.notes.tolist()
    with pytest.raises(FileProblem):
        store.move(tmp_path / "again.gpkg")


def test_a_damaged_season_is_not_copied_as_if_it_were_whole(path, tmp_path):
    store = Season(path).store
    data = bytearray(path.read_bytes())
    last = len(data) // 4096 - 3
    data[last * 4096 : (last + 2) * 4096] = b"\xff" * 8192
    path.write_bytes(data)
    with pytest.raises(FileProblem, match=r"is damaged.*salvage"):
        store.back_up(tmp_path / "copy.gpkg")
    assert not (tmp_path / "copy.gpkg").exists()


def test_a_file_of_an_earlier_version_is_copied_before_it_is_changed(tmp_path):
    old = shutil.copy(SEASONS_OF_OLD / "adaptive.gpkg", tmp_path / "old.gpkg")
    before = old.read_bytes()
    Season(old)
    copy = tmp_path / "old.gpkg.format-2"
    assert beside(old) == ["old.gpkg", "old.gpkg.format-2"]
    with closing(sqlite3.connect(copy)) as db, closing(sqlite3.connect(":memory:")) as then:
        then.deserialize(before)
        assert list(db.iterdump()) == list(then.iterdump())
    Season(old)
    assert beside(old) == ["old.gpkg", "old.gpkg.format-2"]


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
    with pytest.raises(FileProblem, match="make room and try again"):
        season.record(big, "x", confirmed=True)
    season.store.writing = original
    assert state(path) == 12


def test_a_full_disk_is_that_of_the_file_that_is_written(path, tmp_path, monkeypatch):
    connect = connections.connect

    def small(file, patience_s=None):
        db = connect(file, patience_s)
        if file != path:
            db.execute("PRAGMA max_page_count = 8")
        return db

    monkeypatch.setattr(connections, "connect", small)
    with pytest.raises(FileProblem, match=r"room on the disk for \S*copy.gpkg, but it is full"):
        Store(path).back_up(tmp_path / "copy.gpkg")
    assert not (tmp_path / "copy.gpkg").exists()


def test_a_file_that_is_away_for_a_moment_finds_its_place_empty(path):
    season = Season(path)
    path.rename(path.with_name("away"))
    for ask in (lambda: season.settings, lambda: season.record(three_results())):
        with pytest.raises(FileProblem, match="there is none"):
            ask()
        assert not path.exists()
    path.with_name("away").rename(path)
    assert season.record(three_results()).new == 3


def a_view_instead(path, name):
    """Let a layer be a view that never ends, as a stranger may."""
    with closing(sqlite3.connect(path)) as db:
        columns = [row[1] for row in db.execute(f"PRAGMA table_info({name})")]
        of_it = "SELECT type, name FROM sqlite_master WHERE type IN ('trigger', 'view')"
        for kind, one in db.execute(of_it).fetchall():
            db.execute(f"DROP {kind} {one}")
        db.execute(f"DROP TABLE {name}")
        made = ", ".join(f"x + {k} AS {column}" for k, column in enumerate(columns, 1))
        db.execute(f"CREATE VIEW {name} AS SELECT {made} FROM ({ENDLESS}) WHERE x < 0")  # noqa: S608
        db.commit()


def test_a_layer_that_is_an_endless_view_is_refused_and_never_read(path):
    a_view_instead(path, "arrays")
    began = time.process_time()
    with pytest.raises(FileProblem, match=r"must be a table, but arrays is none in \S*season.gpkg"):
        Season(path)
    a_view_instead(path, "fieldmon")
    assert not is_season(path)
    with pytest.raises(FileProblem, match="is none in"):
        Season(path)
    assert time.process_time() - began < 5
