"""The file of a season survives what happens to files."""

import os
import random
import shutil
import sqlite3
import time
from contextlib import closing, contextmanager
from functools import partial
from itertools import count
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pyogrio
import pytest

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season, is_season, kept_open
from fieldmon.monitoring.changes import transactions
from fieldmon.monitoring.changes.transactions import Store
from tests.monitoring.open_elsewhere import as_qgis, beside
from tests.monitoring.seasons import BEGINS, state, three_results
from tests.monitoring.working import day_by_day, one_by_one, started

SEASONS_OF_OLD = Path(__file__).parents[1] / "seasons_of_old"
KILLS = int(os.environ.get("FIELDMON_KILLS", "8"))


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
        while kill % 2 and process.is_alive() and state(path) == before:
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
    before, rounds = state(path), 25
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


def test_a_file_held_by_another_program_is_a_sentence(path, monkeypatch):
    monkeypatch.setattr("fieldmon.monitoring.changes.transactions._PATIENCE_S", 0.2)
    season = Season(path)
    with closing(sqlite3.connect(path)) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(FileProblem, match="another program"):
            season.record(three_results(), "x")


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
    monkeypatch.setattr("fieldmon.monitoring.changes.transactions._PATIENCE_S", 0.2)
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
    monkeypatch.setattr(transactions, "_PATIENCE_S", 0.0)
    store, to = Season(path).store, tmp_path / "moved" / "season.gpkg"
    to.parent.mkdir()
    with closing(as_qgis(path)) as qgis:
        qgis.execute("UPDATE inspections SET notes = 'not yet in the file' WHERE fid = 5")
        with pytest.raises(FileProblem):
            store.move(to)
    with closing(transactions.connect(path)) as other:
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
    connect = transactions.connect

    def small(file, patience_s=None):
        db = connect(file, patience_s)
        if file != path:
            db.execute("PRAGMA max_page_count = 8")
        return db

    monkeypatch.setattr(transactions, "connect", small)
    with pytest.raises(FileProblem, match=r"room on the disk for \S*copy.gpkg, but it is full"):
        Store(path).back_up(tmp_path / "copy.gpkg")
    assert not (tmp_path / "copy.gpkg").exists()


def test_what_is_kept_open_is_opened_once_says_what_is_new_and_locks_nothing(path, monkeypatch):
    season, opened, connect = Season(path), [], transactions.connect
    days = season.days()
    monkeypatch.setattr(transactions, "_PATIENCE_S", 0.0)
    with kept_open():
        before = season.revision
        monkeypatch.setattr(
            transactions, "connect", lambda *of: opened.append(of[0]) or connect(*of)
        )
        assert season.settings.begins == BEGINS
        with season.store.reading() as db, season.store.reading() as inner:
            assert db is not inner
        with kept_open():  # a page within a page
            assert season.days() == days
        assert opened == [path]  # for the reading within a reading
        Season(path).record(three_results(), "another window")
        n = len(opened)
        assert season.revision != before
        assert len(season.history.inspections) == 15
        assert len(opened) == n
        with closing(sqlite3.connect(path, timeout=0)) as other:
            other.execute("BEGIN EXCLUSIVE")
            with pytest.raises(FileProblem, match="must be free"):
                season.revision  # noqa: B018 - it reads
    season.revision  # noqa: B018
    assert len(opened) == n + 1


def test_a_file_that_is_away_for_a_moment_finds_its_place_empty(path):
    season = Season(path)
    path.rename(path.with_name("away"))
    for ask in (lambda: season.settings, lambda: season.record(three_results())):
        with pytest.raises(FileProblem, match="there is none"):
            ask()
        assert not path.exists()
    path.with_name("away").rename(path)
    assert season.record(three_results()).new == 3


def test_a_file_that_takes_the_place_of_one_kept_open_is_the_one_that_is_read(path, tmp_path):
    season = Season(path)
    with kept_open():
        before = season.revision
        shutil.copy(path, tmp_path / "other.gpkg")
        Season(tmp_path / "other.gpkg").record(three_results(), "elsewhere")
        (tmp_path / "other.gpkg").replace(path)
        assert season.revision != before


@contextmanager
def held(path, how):
    """Hold a season's file as another program does."""
    with closing(sqlite3.connect(path, isolation_level=None)) as db:
        db.execute(f"BEGIN {how}")
        yield db
        if db.in_transaction:
            db.execute("ROLLBACK")


@pytest.mark.parametrize(
    ("how", "read", "written"),
    [("EXCLUSIVE", False, False), ("IMMEDIATE", True, False), ("DEFERRED", True, True)],
)
def test_who_waits_for_a_held_season_hears_for_how_long(path, monkeypatch, how, read, written):
    monkeypatch.setattr(transactions, "_ASK_AGAIN_S", 0.01)
    monkeypatch.setattr(transactions, "_MOMENT_S", 0.0)
    # each look at the clock takes 20 ms, however busy the machine is
    looks = count()
    clock = SimpleNamespace(monotonic=lambda: 0.02 * next(looks))
    monkeypatch.setattr(transactions, "time", clock)
    with held(path, how):
        for to_write, free in ((False, read), (True, written)):
            told = []
            wait = partial(transactions.wait_until_free, path, told.append, to_write=to_write)
            assert wait(patience_s=0.05) == free
            assert told == sorted(told)
            assert bool(told) != free


def test_the_wait_is_over_when_the_other_program_lets_go(path, monkeypatch):
    monkeypatch.setattr(transactions, "_ASK_AGAIN_S", 0.01)
    monkeypatch.setattr(transactions, "_MOMENT_S", 0.0)
    with held(path, "EXCLUSIVE") as other, kept_open():
        assert transactions.wait_until_free(path, lambda _: other.execute("ROLLBACK"))
        assert Season(path).history.inspections is not None


def test_nobody_waits_for_a_file_that_is_not_there(tmp_path):
    assert transactions.wait_until_free(tmp_path / "none.gpkg", print, to_write=True)
    assert not [*tmp_path.iterdir()]


_ENDLESS = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x FROM c"


def a_view_instead(path, name):
    """Let a layer be a view that never ends, as a stranger may."""
    with closing(sqlite3.connect(path)) as db:
        columns = [row[1] for row in db.execute(f"PRAGMA table_info({name})")]
        of_it = "SELECT type, name FROM sqlite_master WHERE type IN ('trigger', 'view')"
        for kind, one in db.execute(of_it).fetchall():
            db.execute(f"DROP {kind} {one}")
        db.execute(f"DROP TABLE {name}")
        made = ", ".join(f"x + {k} AS {column}" for k, column in enumerate(columns, 1))
        db.execute(f"CREATE VIEW {name} AS SELECT {made} FROM ({_ENDLESS}) WHERE x < 0")  # noqa: S608
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


def test_a_trigger_that_never_ends_is_given_up_and_nothing_is_changed(path, monkeypatch):
    monkeypatch.setattr(transactions, "_MOST_STEPS", 20_000_000)
    with closing(sqlite3.connect(path)) as db:
        never = f"DELETE FROM hot_spots WHERE fid IN ({_ENDLESS})"  # noqa: S608
        db.execute(f"CREATE TRIGGER x AFTER INSERT ON inspections BEGIN {never}; END")
        db.commit()
    season = Season(path)
    with pytest.raises(FileProblem, match="come to an end, but a view or a trigger in"):
        season.record(three_results(), "monday")
    assert state(path) == 12


def test_of_a_kept_file_each_transaction_may_take_as_many_steps(path, monkeypatch):
    store = Store(path)
    monkeypatch.setattr(transactions, "_MOST_STEPS", 3_000_000)
    counted = f"SELECT count(*) FROM (SELECT x FROM ({_ENDLESS} LIMIT 100000))"  # noqa: S608
    with kept_open():
        for _ in range(5):
            with store.reading() as db:
                assert db.execute(counted).fetchone() == (100_000,)
