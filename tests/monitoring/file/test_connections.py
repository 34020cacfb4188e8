"""A season's file is waited for, kept open where it may be, and never worked on without end."""

import shutil
import sqlite3
from contextlib import closing, contextmanager
from functools import partial
from itertools import count
from types import SimpleNamespace

import pytest

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season, kept_open
from fieldmon.monitoring.changes.transactions import Store
from fieldmon.monitoring.file import connections
from tests.monitoring.seasons import BEGINS, state, three_results

ENDLESS = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x FROM c"


@pytest.fixture(autouse=True)
def opened_once():
    """Let files be opened for each thing that is done, as programs without pages do."""


def test_a_file_held_by_another_program_is_a_sentence(path, monkeypatch):
    monkeypatch.setattr("fieldmon.monitoring.file.connections._PATIENCE_S", 0.2)
    season = Season(path)
    with closing(sqlite3.connect(path)) as other:
        other.execute("BEGIN EXCLUSIVE")
        with pytest.raises(FileProblem, match="another program"):
            season.record(three_results(), "x")


def test_what_is_kept_open_is_opened_once_says_what_is_new_and_locks_nothing(path, monkeypatch):
    season, opened, connect = Season(path), [], connections.connect
    days = season.days()
    monkeypatch.setattr(connections, "_PATIENCE_S", 0.0)
    with kept_open():
        before = season.revision
        monkeypatch.setattr(
            connections, "connect", lambda *of: opened.append(of[0]) or connect(*of)
        )
        assert season.settings.begins == BEGINS
        with season.store.reading() as db, season.store.reading() as inner:
            assert db is not inner
        with kept_open():  # a page within a page
            assert season.days() == days
        assert opened == [path]  # for the reading within a reading
        Season(path).record(three_results(), "another window")
        assert season.revision != before
        assert len(season.history.inspections) == 15
        assert opened == [path]  # nor for what is written
        with closing(sqlite3.connect(path, timeout=0)) as other:
            other.execute("BEGIN EXCLUSIVE")
            with pytest.raises(FileProblem, match="must be free"):
                season.revision  # noqa: B018 - it reads
    season.revision  # noqa: B018
    assert len(opened) == 2


def test_a_season_that_another_program_kept_in_three_files_is_one_though_we_keep_it_open(path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("PRAGMA journal_mode = WAL")
        with kept_open():
            season = Season(path)
            db.close()
            season.record(three_results(), "x")
            with season.store.reading() as one:
                assert one.execute("PRAGMA journal_mode").fetchone() == ("delete",)


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
    monkeypatch.setattr(connections, "_ASK_AGAIN_S", 0.01)
    monkeypatch.setattr(connections, "_MOMENT_S", 0.0)
    # each look at the clock takes 20 ms, however busy the machine is
    looks = count()
    clock = SimpleNamespace(monotonic=lambda: 0.02 * next(looks))
    monkeypatch.setattr(connections, "time", clock)
    with held(path, how):
        for to_write, free in ((False, read), (True, written)):
            told = []
            wait = partial(connections.wait_until_free, path, told.append, to_write=to_write)
            assert wait(patience_s=0.05) == free
            assert told == sorted(told)
            assert bool(told) != free


def test_the_wait_is_over_when_the_other_program_lets_go(path, monkeypatch):
    monkeypatch.setattr(connections, "_ASK_AGAIN_S", 0.01)
    monkeypatch.setattr(connections, "_MOMENT_S", 0.0)
    with held(path, "EXCLUSIVE") as other, kept_open():
        assert connections.wait_until_free(path, lambda _: other.execute("ROLLBACK"))
        assert Season(path).history.inspections is not None


def test_nobody_waits_for_a_file_that_is_not_there(tmp_path):
    assert connections.wait_until_free(tmp_path / "none.gpkg", print, to_write=True)
    assert not [*tmp_path.iterdir()]


def test_a_trigger_that_never_ends_is_given_up_and_nothing_is_changed(path, monkeypatch):
    monkeypatch.setattr(connections, "_MOST_STEPS", 20_000_000)
    with closing(sqlite3.connect(path)) as db:
        never = f"DELETE FROM hot_spots WHERE fid IN ({ENDLESS})"  # noqa: S608
        db.execute(f"CREATE TRIGGER x AFTER INSERT ON inspections BEGIN {never}; END")
        db.commit()
    season = Season(path)
    with pytest.raises(FileProblem, match="come to an end, but a view or a trigger in"):
        season.record(three_results(), "monday")
    assert state(path) == 12


def test_of_a_kept_file_each_transaction_may_take_as_many_steps(path, monkeypatch):
    store = Store(path)
    monkeypatch.setattr(connections, "_MOST_STEPS", 3_000_000)
    counted = f"SELECT count(*) FROM (SELECT x FROM ({ENDLESS} LIMIT 100000))"  # noqa: S608
    with kept_open():
        for _ in range(5):
            with store.reading() as db:
                assert db.execute(counted).fetchone() == (100_000,)
