"""What can be saved of a damaged season is saved."""

import random
import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from fieldmon.errors import FieldmonError, FileProblem
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.days.kept_wishes import keep_wishes, wishes_kept
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.season import salvage as saving
from fieldmon.monitoring.season.salvage import salvage
from fieldmon.planning.wishes import Wishes
from tests.monitoring.seasons import BEGINS, a_season, a_small_plot, some_results, state
from tests.monitoring.test_seasons_of_old import FOLDER
from tests.thorough import seeds


def test_a_damaged_file_is_refused_or_right_and_mostly_salvaged(path, tmp_path):
    whole = path.read_bytes()
    saved = []
    for seed in seeds(8, 20):
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
    assert sum(n == 12 for n in saved) >= len(seeds(8, 20)) / 2


def test_half_a_file_is_refused_and_what_is_left_is_saved(path, tmp_path):
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * 0.9)])
    with pytest.raises(FileProblem, match="salvage"):
        Season(path).store.check()
    saved = salvage(path, tmp_path / "rescued.gpkg")
    assert saved.rows["plants"] > 0


def test_rows_behind_the_damage_are_saved_as_well_as_those_before_it(path, tmp_path):
    """Read forwards up to the damage, and backwards down to it."""
    season, n = Season(path), 2000
    plants, notes = np.arange(n) % 400, [f"note {k:04d} {'x' * 60}" for k in range(n)]
    on = np.datetime64(BEGINS) + np.arange(n) // 400
    found = Inspections.of(plants, np.zeros(n, int), on, notes=np.array(notes, object))
    season.record(found, "many", confirmed=True)
    data = bytearray(path.read_bytes())
    page = data.index(b"note 1000") // 4096
    data[page * 4096 : (page + 1) * 4096] = bytes(4096)
    path.write_bytes(data)
    saved = salvage(path, tmp_path / "rescued.gpkg")
    assert "inspections" in saved.lost
    kept = Season(tmp_path / "rescued.gpkg").history.inspections.notes.tolist()
    assert {notes[50], notes[900], notes[1100], notes[-1]} <= set(kept)
    assert n - 100 < saved.rows["inspections"] < n + 12


@pytest.fixture
def row_by_row(monkeypatch):
    """Let rows be read into Python and written out of it; return the tables of which they were."""
    read, rows = [], saving._rows
    monkeypatch.setattr(saving, "_rows", lambda *of: read.append(of[1].name) or rows(*of))
    return read


def test_rows_that_can_all_be_read_never_leave_sqlite(path, tmp_path, row_by_row):
    saved = salvage(path, tmp_path / "rescued.gpkg")
    assert (saved.lost, saved.rows["inspections"], row_by_row) == ((), 12, [])


@pytest.mark.parametrize("name", ["notes", "plant"])
def test_what_is_no_text_is_lost_and_the_rest_saved(path, tmp_path, row_by_row, name):
    with closing(sqlite3.connect(path)) as db:
        db.execute(f"UPDATE inspections SET {name} = CAST(x'ff2d' AS TEXT) WHERE fid = 5")  # noqa: S608
        db.commit()
    saved = salvage(path, tmp_path / "rescued.gpkg")
    assert (saved.lost, saved.rows["inspections"]) == (("inspections",), 11)
    assert row_by_row == ["inspections"]


def test_what_sqlite_copies_is_what_is_copied_row_by_row(weeks, tmp_path, monkeypatch):
    salvage(weeks, tmp_path / "one.gpkg")
    monkeypatch.setattr(saving, "_taken_whole", lambda *_: None)
    salvage(weeks, tmp_path / "other.gpkg")
    one, other = (rows_of(tmp_path / f"{name}.gpkg") for name in ("one", "other"))
    assert one == other


def rows_of(file):
    """Return the rows of each table that is saved, but for when its log was gone on with."""
    with closing(sqlite3.connect(file)) as db:
        return {
            table.name: db.execute(f"SELECT * FROM {table.name} ORDER BY 1").fetchall()  # noqa: S608
            for table in schema.CAUSES
            if table not in (schema.META, schema.LOG)
        }


def test_a_whole_file_is_salvaged_whole(path, tmp_path):
    saved = salvage(path, tmp_path / "rescued.gpkg")
    assert (saved.lost, saved.whole) == ((), True)
    one, other = Season(path), Season(tmp_path / "rescued.gpkg")
    assert np.array_equal(one.evening(BEGINS), other.evening(BEGINS))
    assert state(tmp_path / "rescued.gpkg") == 12


def days_of(file):
    with Season(file).store.reading() as db:
        rows = db.execute("SELECT * FROM days ORDER BY day").fetchall()
    return [row[1:] for row in rows]


@pytest.fixture(scope="module")
def long_season(tmp_path_factory):
    """Make a season of two weeks, once; return its file."""
    season = a_season(tmp_path_factory.mktemp("weeks") / "season.gpkg", a_small_plot())
    season.plan(BEGINS)
    season.record(some_results(season, n=12, found=[2, 3, 4]), "monday.csv", "Ann")
    for day in range(1, 12, 3):
        at = np.arange(day, day + 5)
        season.record(Inspections.of(at, at % 2, np.datetime64(BEGINS) + day), f"day {day}")
    return season.path


@pytest.fixture
def weeks(long_season, tmp_path):
    """Return a season of two weeks."""
    return shutil.copy(long_season, tmp_path / "season.gpkg")


def test_what_is_wanted_of_a_day_is_saved(path, tmp_path):
    wishes = Wishes(wanted=(3,), unwanted=(7,))
    keep_wishes(Season(path), BEGINS, wishes)
    salvage(path, tmp_path / "rescued.gpkg")
    assert wishes_kept(Season(tmp_path / "rescued.gpkg"), BEGINS) == wishes


def test_mornings_that_follow_from_what_was_saved_are_not_worked_out_again(
    weeks, tmp_path, monkeypatch
):
    before = days_of(weeks)
    monkeypatch.setattr(History, "night_after", None)
    saved = salvage(weeks, tmp_path / "rescued.gpkg")
    assert saved.whole
    assert days_of(tmp_path / "rescued.gpkg") == before
    assert "mornings" not in saved.rows  # what was recorded is counted, not what follows


@pytest.mark.parametrize(
    "lost",
    ["inspections WHERE fid = 1", "inspections WHERE day = 10", "days WHERE day = 7", "days"],
)
def test_layers_of_a_season_that_lost_rows_are_those_of_a_rebuilt_one(weeks, tmp_path, lost):
    with closing(sqlite3.connect(weeks)) as db:
        db.execute("UPDATE fieldmon SET value = '1' WHERE key = 'open'")  # nobody notes it
        db.execute(f"DELETE FROM {lost}")  # noqa: S608 - as above
        db.execute("UPDATE fieldmon SET value = '0' WHERE key = 'open'")
        db.commit()
    salvage(weeks, tmp_path / "rescued.gpkg")
    days = days_of(tmp_path / "rescued.gpkg")
    Season(tmp_path / "rescued.gpkg").rebuild()
    assert days_of(tmp_path / "rescued.gpkg") == days


def test_a_rescued_file_notes_what_is_changed_in_it_as_any_other(path, tmp_path):
    salvage(path, tmp_path / "rescued.gpkg")
    wanted = "SELECT sql FROM sqlite_master WHERE type = 'trigger' ORDER BY name"
    told = []
    for file in (path, tmp_path / "rescued.gpkg"):
        with closing(sqlite3.connect(file)) as db:
            told.append(db.execute(wanted).fetchall())
    assert told[0] == told[1]
    assert len(told[0]) > 30


def test_what_is_no_file_or_no_season_cannot_be_saved(tmp_path):
    with pytest.raises(FileProblem, match="there is none"):
        salvage(tmp_path / "none.gpkg", tmp_path / "x.gpkg")
    (tmp_path / "text.gpkg").write_text("hello" * 1000)
    with pytest.raises(FileProblem, match="nothing is"):
        salvage(tmp_path / "text.gpkg", tmp_path / "x.gpkg")
    assert not (tmp_path / "x.gpkg").exists()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ("UPDATE fieldmon SET value = '999' WHERE key = 'version'", "made by a newer fieldmon"),
        ("UPDATE settings SET value = json_set(value, '$.colour', 1) WHERE name = 'robot'",
         "does not know robot colour. The file was probably written by a newer fieldmon"),
    ],
)  # fmt: skip
def test_what_a_newer_fieldmon_wrote_is_not_said_to_be_lost(path, tmp_path, change, says):
    with closing(sqlite3.connect(path)) as db:
        db.execute(change)
        db.execute("DELETE FROM outside_changes")
        db.commit()
    try:
        said = salvage(path, tmp_path / "rescued.gpkg").why
    except FileProblem as problem:
        said = str(problem)
        assert not (tmp_path / "rescued.gpkg").exists()
    assert says in said


def test_a_file_that_exists_is_never_overwritten(path, tmp_path):
    (tmp_path / "mine.gpkg").write_text("mine")
    with pytest.raises(FileProblem, match="exists already"):
        salvage(path, tmp_path / "mine.gpkg")
    assert (tmp_path / "mine.gpkg").read_text() == "mine"


def test_a_log_with_a_hole_is_begun_anew_and_says_why(path, tmp_path):
    with closing(sqlite3.connect(path)) as db:
        (n,) = db.execute("SELECT count(*) FROM log").fetchone()
        assert n > 2
        db.execute("DELETE FROM log WHERE fid = 2")
        db.commit()
    salvage(path, tmp_path / "rescued.gpkg")
    rescued = Season(tmp_path / "rescued.gpkg")
    first = rescued.log()[0]
    assert "could not be saved whole" in first.sentence()
    assert check_against_log(rescued) == ()


def test_a_file_of_an_earlier_version_is_salvaged_with_the_columns_that_it_has(tmp_path):
    old = shutil.copy(FOLDER / "of_format_6.gpkg", tmp_path / "old.gpkg")
    done = salvage(Path(old), tmp_path / "rescued.gpkg")
    assert done.whole
    was = Season(shutil.copy(old, tmp_path / "opened.gpkg")).history
    now = Season(tmp_path / "rescued.gpkg").history
    assert len(was.inspections) > 0
    assert now.inspections.plant.tolist() == was.inspections.plant.tolist()
    assert len(now.treatments) == len(was.treatments)


def test_of_inspections_that_stand_there_twice_the_first_is_saved(path, tmp_path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("DROP INDEX inspections_once")
        names = ", ".join(name for name in schema.INSPECTIONS.names if name != "notes")
        db.execute(
            f"INSERT INTO inspections (notes, {names}) SELECT 'twice', {names} "  # noqa: S608
            "FROM inspections WHERE fid <= 3"
        )
        db.execute("DELETE FROM outside_changes")
        db.commit()
        (n,) = db.execute("SELECT count(*) FROM inspections").fetchone()
    rescued = tmp_path / "rescued.gpkg"
    salvage(path, rescued)
    with closing(sqlite3.connect(rescued)) as db:
        assert db.execute("SELECT count(*) FROM inspections").fetchone() == (n - 3,)
        assert db.execute("SELECT 1 FROM inspections WHERE notes = 'twice'").fetchone() is None


def test_a_rescued_file_has_the_indexes_and_triggers_of_a_new_one(path, tmp_path):
    salvage(path, tmp_path / "rescued.gpkg")
    made = (
        "SELECT type, name, sql FROM sqlite_master WHERE type IN ('index', 'trigger') "
        "AND sql NOTNULL ORDER BY name"
    )
    with (
        closing(sqlite3.connect(path)) as one,
        closing(sqlite3.connect(tmp_path / "rescued.gpkg")) as two,
    ):
        assert one.execute(made).fetchall() == two.execute(made).fetchall()


def without(path, table):
    """Zero the page at which a table begins."""
    with closing(sqlite3.connect(path)) as db:
        (size,) = db.execute("PRAGMA page_size").fetchone()
        query = "SELECT rootpage FROM sqlite_master WHERE name = ?"
        (root,) = db.execute(query, (table,)).fetchone()
    data = bytearray(path.read_bytes())
    data[(root - 1) * size : root * size] = bytes(size)
    path.write_bytes(data)


def test_lost_inspections_are_noted_in_the_log_and_said_from_then_on(path, tmp_path):
    without(path, "inspections")
    done = salvage(path, tmp_path / "rescued.gpkg")
    gone = "12 of 12 rows of batch 1 (monday.csv)"
    assert (done.rows["inspections"], done.lost, done.gone) == (0, ("inspections",), (gone,))
    rescued = Season(tmp_path / "rescued.gpkg")
    assert rescued.log()[-1].sentence() == f"saved from a damaged file; lost: {gone}"
    (first, *_) = rescued.cautions(BEGINS)
    assert first.kind == "lost"
    assert f"saved from a damaged file, without {gone}. Go back" in first.sentence
    assert check_against_log(rescued) == ()


def test_a_log_of_which_nothing_is_left_says_that_it_is_lost_and_not_that_the_file_is_old(
    path, tmp_path
):
    without(path, "log")
    done = salvage(path, tmp_path / "rescued.gpkg")
    assert (done.rows["log"], done.gone) == (0, ("rows of the layer log",))
    (only,) = Season(tmp_path / "rescued.gpkg").log()
    assert "of the one before, which was damaged, nothing could be saved" in only.sentence()
    assert only.lost == ("rows of the layer log",)


def test_rows_are_counted_in_the_new_file_and_those_that_it_cannot_take_are_lost(path, tmp_path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("PRAGMA writable_schema = ON")
        db.execute(
            "UPDATE sqlite_master SET sql = replace(sql, 'digest TEXT NOT NULL', 'digest TEXT') "
            "WHERE name = 'log'"
        )
        db.commit()
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE log SET digest = NULL")
        db.commit()
    done = salvage(path, tmp_path / "rescued.gpkg")
    assert (done.rows["log"], "log" in done.lost) == (0, True)


@pytest.mark.parametrize("of", ["path", "weeks"])
def test_of_a_whole_file_nothing_is_said_to_be_lost(of, request, tmp_path):
    done = salvage(request.getfixturevalue(of), tmp_path / "rescued.gpkg")
    rescued = Season(tmp_path / "rescued.gpkg")
    assert (done.lost, done.gone, rescued.log()[-1].lost) == ((), (), ())
    assert [one for one in rescued.cautions(BEGINS) if one.kind == "lost"] == []


@pytest.mark.parametrize("file", sorted(FOLDER.glob("*.gpkg")), ids=lambda file: file.stem)
def test_of_a_file_of_an_earlier_version_only_what_it_had_can_be_lost(file, tmp_path):
    old = Path(shutil.copy(file, tmp_path / "old.gpkg"))
    done = salvage(old, tmp_path / "rescued.gpkg")
    assert (done.lost, done.gone) == ((), ())
