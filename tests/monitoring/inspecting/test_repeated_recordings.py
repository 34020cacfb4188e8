"""What is written beside an inspection is kept, whoever writes it and whenever."""

import shutil
import sqlite3
from contextlib import closing
from itertools import permutations

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.io.options import Upload
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.inspecting import inspection_lots, repeated_recordings
from fieldmon.monitoring.season.inspection_import import read_brought
from tests.monitoring.merging.copies import content
from tests.monitoring.seasons import BEGINS, a_plot, a_season

DAY = np.datetime64(BEGINS)


@pytest.fixture(scope="module")
def empty(tmp_path_factory):
    return a_season(tmp_path_factory.mktemp("empty") / "season.gpkg", a_plot(0.0004, 0.0003)).path


@pytest.fixture
def season(empty, tmp_path):
    return Season(shutil.copy(empty, tmp_path / "season.gpkg"))


def find(notes="", who="", plant=5, result=FOUND, count=3.0, **more):
    """Return an inspection, as most of these tests bring it."""
    columns = {name: np.array([value]) for name, value in more.items()}
    texts = {"who": np.array([who], object), "notes": np.array([notes], object)}
    count = np.nan if result != FOUND else count
    of = np.array([plant]), np.array([result]), DAY
    return Inspections.of(*of, count=np.array([count]), **texts, **columns)


def beside(season, plant=5):
    """Return who and notes of the inspection of a plant that counts, in the file opened anew."""
    told = Season(season.path).inspections
    (k,) = np.flatnonzero(told.plant == plant)
    assert check_against_log(season) == ()
    assert season.inspections.notes[k] == told.notes[k]
    return told.who[k], told.notes[k]


def test_a_note_added_later_is_kept_and_said_and_undone(season):
    season.record(find(who="Ada"), "monday.csv")
    done = season.record(find("webs", "Ada"), "again.csv")
    assert (done.new, done.known, done.noted, done.filled, done.batch) == (0, 1, 1, 0, 2)
    assert done.more == "1 note added"
    assert beside(season) == ("Ada", "webs")
    assert len(season.inspections) == 1
    last = season.log()[-1]
    assert (last.kind, last.sentence()) == (
        "noted", "again.csv: 1 note added to what was known, batch 2",
    )  # fmt: skip
    assert "row 1, plant 6" in season.undo()
    assert beside(season) == ("Ada", "")
    season.redo(2)
    assert beside(season) == ("Ada", "webs")


def test_the_same_note_twice_brings_nothing(season):
    season.record(find("webs", "Ada"))
    for told in (find("webs", "Ada"), find("webs"), find("", "ada")):
        done = season.record(told)
        assert (done.new, done.known, done.more, done.batch) == (0, 1, "", None)
    for _ in range(2):
        season.record(find("eggs", "Bob"))
    assert season.record(find("webs", "Bob")).batch is None
    assert [one.rows for one in season.batches()] == [1, 1]
    assert beside(season) == ("Ada", "webs; eggs (Bob)")


def test_what_two_people_saw_counts_once_and_still_when_either_file_is_undone(season):
    season.record(find(who="Ada").and_those(find(who="Ada", plant=6)), "ada.csv")
    bobs = find(who="Bob", count=np.nan).and_those(find(who="Bob", plant=7))
    done = season.record(bobs, "bob.csv")
    assert (done.new, done.known, done.seen_by_another, done.batch) == (1, 1, 1, 2)
    assert done.more == "1 by a second person added"
    assert season.log()[-1].sentence().endswith("batch 2; 1 by a second person added")
    assert season.record(bobs, "again.csv").batch is None
    assert season.inspections.plant.tolist() == [5, 6, 7]
    assert "1 of the same results counts still" in season.undo(1)
    assert beside(season) == ("Bob", "")
    assert {*season.inspections.plant.tolist()} == {5, 7}
    assert season.inspections.count.tolist() == [3.0, 3.0]
    season.redo(1)
    assert "1 of the same results counts still" in season.undo(2)
    assert beside(season) == ("Ada", "")
    assert season.inspections.plant.tolist() == [5, 6]


def test_the_same_note_of_two_sources_brought_at_once_is_added_once(season):
    season.record(find())
    done = season.record_all([(find("webs"), "one"), (find("webs"), "two")])
    assert [one.noted for one in done] == [1, 0]
    assert beside(season) == ("", "webs")


def test_what_was_left_open_is_filled(season):
    season.record(find())
    done = season.record(find(who="Ada", detects=0.5))
    assert (done.noted, done.filled, done.more) == (0, 1, "1 completed")
    assert beside(season)[0] == "Ada"
    assert season.history.detections.tolist() == [0.5]
    season.undo()
    assert beside(season)[0] == ""
    assert np.isnan(season.inspections.detects).all()


def test_a_note_comes_beside_new_findings_and_in_their_batch(season):
    season.record(find(who="Ada"))
    both = find("webs", "Ada").and_those(find("", "Ada", plant=6))
    done = season.record(both, "both.csv")
    assert (done.new, done.known, done.noted, done.batch) == (1, 1, 1, 2)
    assert season.log()[-1].sentence().endswith("batch 2; 1 note added")
    assert beside(season) == ("Ada", "webs")
    season.undo()
    assert season.inspections.plant.tolist() == [5]
    assert beside(season) == ("Ada", "")


def test_a_file_without_times_notes_what_was_tapped(season):
    season.record(find(second=3600.4))  # kept to the second
    assert season.record(find("webs", count=np.nan)).noted == 1
    assert season.record(find("webs", second=3600.4)).noted == 0
    assert season.record(find("webs; eggs", second=3600.4)).noted == 1
    season.undo()
    assert beside(season) == ("", "webs")
    told = season.inspections
    assert (told.second.tolist(), told.count.tolist()) == ([3600.0], [3.0])
    assert "1 of the same results counts still" in season.undo(1)
    assert beside(season) == ("", "webs")


@pytest.mark.parametrize(
    ("note", "together"),
    [
        ("gone: burnt", "gone: gate locked; burnt (Bob)"),
        ("Missing.", "gate locked; Missing. (Bob)"),
    ],
)
def test_a_plant_is_gone_once_anybody_notes_it(season, note, together):
    season.record(find("gate locked", "Ada", result=SKIPPED))
    assert not season.history.gone(0)[5]
    season.record(find(note, "Bob", result=SKIPPED))
    assert season.history.gone(0)[5]
    assert beside(season)[1] == together
    season.undo()
    assert not season.history.gone(0)[5]


def test_a_chance_that_is_none_is_refused_also_of_what_is_known(season):
    season.record(find())
    with pytest.raises(Exception, match="detects"):
        season.record(find(detects=7.0))


@pytest.mark.parametrize("order", list(permutations(["Ada", "Bob", "Cid"]))[::2])
def test_notes_of_copies_are_kept_whichever_takes_in_the_other(empty, tmp_path, order):
    copies = {}
    for who in ("Ada", "Bob", "Cid"):  # in whichever order: their clocks say the same second
        copies[who] = Season(shutil.copy(empty, tmp_path / f"{who}.gpkg"))
        copies[who].record(find(f"of {who}", who), f"{who}.csv")
    first, *others = (copies[who] for who in order)
    noted = [first.merge(other).noted for other in others]
    assert noted == [1, 1]
    who, notes = beside(first)
    assert {f"of {one}" in notes for one in copies} == {True}
    assert {one in f"{who} {notes}" for one in copies} == {True}
    with first.store.reading() as db:
        before = content(db)
    done = first.merge(others[0])
    assert (done.new, done.noted) == (0, 0)
    with first.store.reading() as db:
        assert content(db) == before


def test_either_copy_says_the_same_and_an_undo_takes_its_own_note_back(season, tmp_path):
    season.record(find("webs", "Ada"), "ada.csv")
    other = Season(shutil.copy(season.path, tmp_path / "other.gpkg"))
    other.record(find("eggs", "Bob"), "bob.csv")
    back = Season(shutil.copy(season.path, tmp_path / "back.gpkg"))
    done = season.merge(other)
    assert (done.new, done.noted, done.more) == (0, 1, "1 note added")
    assert season.log()[-1].sentence().endswith("1 note added")
    assert other.merge(back).noted == 0
    assert beside(season) == beside(other) == ("Ada", "webs; eggs (Bob)")
    season.undo()
    assert beside(season) == ("Ada", "webs")
    other.merge(season)  # what was undone in one copy is undone
    assert beside(other) == ("Ada", "webs")


def test_notes_of_one_row_that_differ_between_copies_are_both_kept(season, tmp_path):
    season.record(find("webs", "Ada"))
    other = Season(shutil.copy(season.path, tmp_path / "other.gpkg"))
    with closing(sqlite3.connect(other.path)) as db:  # notes are anybody's
        db.execute("UPDATE inspections SET notes = 'eggs'")
        db.commit()
    back = Season(shutil.copy(season.path, tmp_path / "back.gpkg"))
    assert season.merge(other).noted == 1
    other.merge(back)
    assert beside(season) == beside(other) == ("Ada", "eggs; webs")


def test_a_correction_takes_notes_of_others_along(season):
    season.record(find("webs", "Ada"))
    season.record(find("eggs", "Bob"))
    season.record_instead(find("clean after all", "Ada", result=CLEAN))
    assert beside(season) == ("Ada", "clean after all; eggs (Bob)")
    season.undo()
    assert beside(season) == ("Ada", "webs; eggs (Bob)")


def test_what_a_correction_took_away_does_not_come_back(season):
    season.record(find("webs", "Ada", detects=0.5))
    with closing(sqlite3.connect(season.path)) as db:
        db.execute("UPDATE inspections SET who = 'Bob', detects = NULL")
        db.commit()
    season.correct("Bob")
    assert beside(season) == ("Bob", "webs")
    assert np.isnan(season.inspections.detects).all()


def test_a_copy_that_is_recorded_brings_the_notes_of_others(season, empty, tmp_path):
    season.record(find("webs", "Ada"))
    season.record(find("eggs", "Bob"))
    other = Season(shutil.copy(empty, tmp_path / "other.gpkg"))
    other.record(find("webs", "Ada"))
    (tmp_path / "room").mkdir()
    options = InspectionOptions()
    read = read_brought(other, season.path, options, tmp_path / "room").findings
    assert other.record(read).noted == 1
    assert beside(other) == beside(season) == ("Ada", "webs; eggs (Bob)")


def test_lots_hold_what_others_say_and_are_made_anew_when_it_is_taken_back(season, monkeypatch):
    monkeypatch.setattr(schema, "LOT_BITS", 1)
    with closing(sqlite3.connect(season.path)) as db:
        for event in ("insert", "update", "delete"):
            db.execute(f"DROP TRIGGER inspections_{event}_counted")
            db.execute(f"DROP TRIGGER IF EXISTS inspections_{event}_replacing")
        schema.count_inspections(db)
        db.commit()
    for plant in range(4, 8):
        season.record(find("webs", "Ada", plant=plant))
    season.record(find("eggs", "Bob"))
    with season.store.writing() as db:
        inspection_lots.keep(db)
    assert beside(season) == ("Ada", "webs; eggs (Bob)")
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM inspection_lots").fetchone()[0] >= 2
    season.undo()
    assert beside(season) == ("Ada", "webs")


def test_what_others_say_is_found_by_an_index(season):
    with season.store.reading() as db:
        plan = db.execute(f"EXPLAIN QUERY PLAN {repeated_recordings._OF_OTHERS}").fetchall()
    assert any("inspections_beside" in row[-1] for row in plan)


def test_two_lines_of_one_file_that_differ_in_their_notes_are_both_kept(season):
    lines = f"row,number,date,result,notes\n1,6,{BEGINS},found,webs\n1,6,{BEGINS},found,eggs\n"
    read = read_inspections(Upload("two.csv", lines.encode()), season.plot.grid).value
    assert read.notes.tolist() == ["webs; eggs"]


def test_who_inspected_corrected_twice_is_who_it_was_before_where_the_last_is_undone(
    season, tmp_path
):
    season.record(find("webs", "Ada"))
    for who in ("Bob", "Cid"):
        with closing(sqlite3.connect(season.path)) as db:
            db.execute("UPDATE inspections SET who = ? WHERE undone = 0", (who,))
            db.commit()
        season.correct("Dan")
    other = Season(shutil.copy(season.path, tmp_path / "other.gpkg"))
    assert beside(season) == ("Cid", "webs")
    season.undo()
    assert beside(season) == ("Bob", "webs")
    other.merge(season)
    assert beside(other) == ("Bob", "webs")
    season.undo()
    assert beside(season) == ("Ada", "webs")


def test_a_note_that_another_program_adds_as_a_finding_of_its_own_comes_to_what_is_known(season):
    season.record(find("webs", "Ada"))
    with closing(sqlite3.connect(season.path)) as db:
        for plant in (5, 5, 6):
            db.execute(
                "INSERT INTO inspections (plant, date, result, who, notes) "
                "VALUES (?, ?, 'found', 'Bob', 'eggs')",
                (plant, str(BEGINS)),
            )
        db.commit()
    opened = Season(season.path)
    assert opened.drafts == ()
    assert sorted(opened.inspections.plant.tolist()) == [5, 6]
    assert beside(opened) == ("Ada", "webs; eggs (Bob)")
    assert opened.log()[-1].kind == "seen"
    assert "note" in opened.log()[-1].sentence()
    opened.undo()
    assert beside(opened) == ("Ada", "webs")
    assert opened.inspections.plant.tolist() == [5]
