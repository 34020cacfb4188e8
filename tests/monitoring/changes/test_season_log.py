"""The log of a season: a changed past is refused, and said where."""

import json
import re
import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import timedelta
from hashlib import sha256

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.compute.units import Units
from fieldmon.decisions.labels import ProductLabel
from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring import Application, Season
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.days.advised import advise
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.inspecting.certifier_tables import log_table
from fieldmon.monitoring.phones.findings import take
from fieldmon.monitoring.phones.scouts import let_in
from fieldmon.monitoring.treating import treatments
from fieldmon.plot.local_clock import LocalClock
from fieldmon.reports.certification import certification_report
from fieldmon.reports.season import season_report
from tests.monitoring.phone import NOW, a_finding, without_records
from tests.monitoring.seasons import BEGINS, state, three_results

N = 7
CLOCK = LocalClock("UTC")


@pytest.fixture(scope="module")
def written():
    """Give a log of seven entries, in memory, as bytes of a database."""
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as db:
        schema.lay_out(db)
        for k in range(N):
            season_log.append(db, "seen", f"Ann {k}", source="מטע.csv", found=k, batch=k)
        yield db.serialize()


def opened(written):
    db = sqlite3.connect(":memory:", isolation_level=None)
    db.deserialize(written)
    return closing(db)


def by_hand(path, change):
    """Change a file as somebody does who takes away first what would notice it."""
    triggers = "SELECT name FROM sqlite_master WHERE type = 'trigger'"
    with closing(sqlite3.connect(path)) as db:
        for (name,) in db.execute(triggers).fetchall():
            db.execute(f"DROP TRIGGER {name}")
        db.execute(change)
        db.commit()


@given(st.data())
def test_any_byte_of_any_entry_that_is_changed_is_found_and_the_entry_named(written, data):
    number = data.draw(st.integers(1, N))
    column = data.draw(st.sampled_from(["entry", "digest"]))
    with opened(written) as db:
        (text,) = db.execute(f"SELECT {column} FROM log WHERE fid = ?", (number,)).fetchone()  # noqa: S608
        raw = bytearray(text.encode())
        raw[data.draw(st.integers(0, len(raw) - 1))] ^= data.draw(st.integers(1, 127))
        changed = raw.decode("utf-8", "surrogateescape")
        if "\0" in changed or "\udc80" <= max(changed) <= "\udcff":
            changed = text[:-1]  # what SQLite cannot hold as text
        db.execute(f"UPDATE log SET {column} = ? WHERE fid = ?", (changed, number))  # noqa: S608
        with pytest.raises(FileProblem, match=rf"entry {number} "):
            season_log.refuse_changed(db)


@given(st.sets(st.integers(1, N), min_size=1))
def test_entries_that_were_taken_out_are_missed_from_the_first_one_on(written, gone):
    with opened(written) as db:
        db.executemany("DELETE FROM log WHERE fid = ?", [(number,) for number in gone])
        with pytest.raises(FileProblem, match=rf"entry {min(gone)} is missing"):
            season_log.refuse_changed(db)


@given(st.permutations(range(1, N + 1)).filter(lambda order: order != list(range(1, N + 1))))
def test_entries_in_another_order_are_noticed_where_the_order_breaks(written, order):
    first = next(k for k, number in enumerate(order, 1) if number != k)
    with opened(written) as db:
        rows = dict(db.execute("SELECT fid, entry || char(10) || digest FROM log").fetchall())
        for k, number in enumerate(order, 1):
            entry, _, mark = rows[number].rpartition("\n")
            db.execute("UPDATE log SET entry = ?, digest = ? WHERE fid = ?", (entry, mark, k))
        with pytest.raises(FileProblem, match=rf"entry {first} "):
            season_log.refuse_changed(db)


@given(st.integers(1, N))
def test_a_chain_that_was_made_anew_from_an_entry_on_is_told_by_its_last_digest(written, number):
    with opened(written) as db:
        *_, last = season_log.entries(db)
        rows = db.execute("SELECT entry FROM log WHERE fid >= ? ORDER BY fid", (number,)).fetchall()
        db.execute("DELETE FROM log WHERE fid >= ?", (number,))
        found = db.execute("SELECT fid, digest FROM log ORDER BY fid DESC LIMIT 1").fetchone()
        season_log._note_head(db, *(found or (0, season_log._NOTHING)))
        for (entry,) in rows:
            said = json.loads(entry)
            season_log.append(db, said["kind"], "somebody else", **said["what"])
        assert season_log.entries(db)[-1].digest != last.digest


def test_nothing_is_written_on_a_changed_past(path):
    by_hand(path, "UPDATE log SET entry = replace(entry, 'Ann', 'Eve') WHERE fid = 3")
    season = Season(path)
    for act in (
        lambda: season.record(three_results(), "more"),
        lambda: season.treat(BEGINS, 0.5),
        season.undo,
        season.log,
    ):
        with pytest.raises(FileProblem, match="entry 3 is not what was written"):
            act()


def test_nothing_is_recorded_on_rows_that_were_changed_unnoticed(path):
    Season(path).treat(BEGINS, 0.5)
    by_hand(path, "SELECT 1")
    assert Season(path).record(three_results(), "held to the log, and whole").new == 3
    by_hand(path, "UPDATE treatments SET waiting_days = 1")
    season = Season(path)
    for act in (lambda: season.treat(BEGINS, 0.5), season.undo):
        with pytest.raises(FileProblem, match="Row 1 of the layer treatments is not what was"):
            act()


def test_what_another_program_changes_in_the_log_is_noticed_as_elsewhere(path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("DELETE FROM log WHERE fid = 2")
        db.commit()
    with pytest.raises(FileProblem, match=r"row 2 of the layer log .* was deleted"):
        Season(path).status(BEGINS)


def test_the_log_says_what_was_seen_planned_advised_treated_and_undone_by_whom(path):
    season = Season(path)
    advise(season, BEGINS, "Treat: 6 % of the plants are believed infested.", "Ben")
    advise(season, BEGINS, "Treat: 6 % of the plants are believed infested.", "Ben")
    season.treat(BEGINS, 0.5, application=Application("soap", operator="Cyd"))
    season.undo(who="Dan")
    season.change(replace(season.settings, harvest=BEGINS + timedelta(9)), season.settings, "Eve")
    season.undo_change("Eve")
    log = season.log()
    assert [(one.kind, one.who) for one in log] == [
        ("begins", ""), ("planned", ""), ("seen", "Ann"), ("advised", "Ben"), ("treated", "Cyd"),
        ("undone", "Dan"), ("changed", "Eve"), ("changed", "Eve"),
    ]  # fmt: skip
    said = [one.sentence() for one in log]
    stops = log[1].what["stops"]
    assert re.fullmatch(
        rf"2026-04-06: {stops} stops by adaptive, about \d(\.\d|\d+) of them visibly infested",
        said[1],
    )
    assert said[2] == "monday.csv: 3 found, 9 clean, 0 could not be inspected, batch 1"
    assert said[4].startswith("2026-04-06: soap on ")
    assert said[5] == "Batch 2 was undone: 1 treatment with soap."
    assert said[6].startswith("settings: ")
    assert said[7].startswith("settings, the last change taken back: ")
    assert check_against_log(season) == ()
    assert [one.number for one in log] == list(range(1, 9))
    assert list(season_log.lines(log, CLOCK))[-1].endswith(log[-1].digest)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("UPDATE inspections SET result = 'clean' WHERE fid = 4", "Row 4 of the layer inspections"),
        ("UPDATE inspections SET undone = 1 WHERE fid = 4", "The batch 1 of the file is not what"),
        ("UPDATE inspections SET who = 'Eve' WHERE fid = 4", "The batch 1 of the file is not what"),
        ("DELETE FROM inspections WHERE fid = 4", "The batch 1 of the file is not what entry 3"),
        ("DELETE FROM batches WHERE fid = 1", "The batch 1 that entry 3"),
        ("UPDATE settings SET value = '{}' WHERE name = 'team'", "The settings of the file"),
        ("UPDATE routes SET digest = 'x'", "The route of 2026-04-06 that entry 2"),
        ("UPDATE observations SET present = 0", "The plot of the file is not what entry 1"),
        ("INSERT INTO batches (at, kind, rows) VALUES ('', 'findings', 0)", "nothing of batch 2"),
    ],
)
def test_a_file_that_says_otherwise_than_its_log_is_found(path, change, said):
    by_hand(path, change)
    assert any(said in one for one in check_against_log(Season(path)))


@pytest.mark.parametrize(
    ("row", "other"),
    [
        *((0, other) for other in ({"waiting_days": 3}, {"by_label": None})),
        *((1, other) for other in ({"by_label": ""}, {"irac_groups": None})),
    ],
)
def test_what_labels_added_and_that_they_did_is_held_to_the_log(path, tmp_path, other, row):
    """Also if who changes it gives the row its new digest, and of a row that stands back."""
    season, theirs = Season(path), Season(shutil.copy(path, tmp_path / "other.gpkg"))
    for one, days in ((season, 7), (theirs, 14)):
        one.keep_labels([ProductLabel("Acarol", waiting_days=days, irac_groups=("6",))])
        one.treat(BEGINS, 0.5, application=Application("Acarol"))
    season.merge(theirs)
    assert check_against_log(season) == ()
    with season.store.reading() as db:
        changed = treatments._rows(db, "1")[row] | other
    (column, value), mark = *other.items(), treatments.digest_of(changed)
    sets = f"{column} = {'NULL' if value is None else repr(value)}, digest = '{mark}'"
    by_hand(path, f"UPDATE treatments SET {sets} WHERE fid = {row + 1}")  # noqa: S608 - ours
    said = f"The batch {changed['batch']} of the file is not what entry"
    assert any(one.startswith(said) for one in check_against_log(Season(path)))


def test_what_phones_tell_and_take_back_is_in_the_log(path):
    season = Season(path)
    key = let_in(season, "Ben")
    one = a_finding(3, FOUND)
    take(season, key, [one, a_finding(4, CLEAN)], NOW)
    take(season, key, [a_finding(None, None, undoes=one.id)], NOW)
    take(season, key, [one], NOW)  # once more, as networks do
    told = [entry for entry in season.log() if entry.who == "Ben"]
    assert [entry.kind for entry in told] == ["seen", "undone"]
    assert told[0].what["found"] == 1
    assert check_against_log(season) == ()


def test_corrections_are_added_and_nothing_is_taken_out(path):
    with closing(sqlite3.connect(path)) as db:
        db.execute("UPDATE inspections SET result = 'clean' WHERE fid = 4")
        db.commit()
    season = Season(path)
    season.correct("Ann")
    *_, before, last = season.log()
    assert (before.kind, last.kind, last.who, last.what["rows"]) == ("seen", "corrected", "Ann", 1)
    assert check_against_log(season) == ()


def test_two_copies_keep_both_logs_when_they_become_one(path, tmp_path):
    Season(path).record(three_results(40), "before", "Ann")
    other = shutil.copy(path, tmp_path / "other.gpkg")
    here, there = Season(path), Season(other)
    here.record(three_results(), "here", "Ann")
    there.record(three_results(1), "there", "Ben")
    there.treat(BEGINS, 0.5)
    first = {one.source: one.number for one in there.batches()}["before"]
    there.undo(first, who="Ben")
    theirs = there.log()[-3:]
    here.merge(there)
    last = here.log()[-1]
    assert (last.kind, last.what["entries"], last.what["new"]) == ("merged", 3, 3)
    assert [one["digest"] for one in last.what["theirs"]] == [one.digest for one in theirs]
    assert check_against_log(here) == ()
    # who took back what, and when, is shown, and nobody needs to read the entry for it
    assert last.theirs == theirs
    came = "3 inspections, 1 treatment, 3 entries; 3 inspections were taken back there"
    assert came in last.sentence()
    *_, undone, _ = season_log.lines(here.log(), CLOCK)
    assert undone.startswith("       in the copy:  ")
    assert "undone     Ben           Batch 2 was undone: 3 inspections from before." in undone
    # of the copy's numbers another batch may be meant here
    theirs_said = [one.sentence() for one in last.theirs]
    assert all(one.endswith(". The number of the batch is the copy's.") for one in theirs_said)
    assert not any("copy's" in one.sentence() for one in here.log()[:-1])
    assert log_table(here)["said"][-1] == theirs_said[-1]
    table = log_table(here)
    assert (table["who"][-1], table["what"][-1], table["copy_entry"][-1]) == (
        "Ben", "undone", theirs[-1].number,
    )  # fmt: skip
    for made in (
        certification_report([here], Units()),
        season_report(here, BEGINS, Units()),
    ):
        said = " ".join(made.words())
        assert "by \u2068Ben\u2069, in a copy that was merged: Batch 2 was undone: 3 insp" in said
    n = len(here.log())
    here.merge(there)
    assert len(here.log()) == n  # nothing was new
    there.merge(here)
    assert [one["digest"] for one in there.log()[-1].what["theirs"]][-1] == last.digest
    assert check_against_log(there) == ()


def test_a_copy_whose_past_was_changed_is_not_taken_in(path, tmp_path):
    other = shutil.copy(path, tmp_path / "other.gpkg")
    by_hand(other, "UPDATE log SET digest = 'x' WHERE fid = 2")
    before = path.read_bytes()
    with pytest.raises(FileProblem, match="entry 2 is not what was written"):
        Season(path).merge(Season(other))
    assert len(path.read_bytes()) == len(before)


def test_the_log_of_an_old_season_begins_at_its_migration_and_says_so(path):
    without_records(path)
    season = Season(path)
    (first,) = season.log()
    assert first.sentence() == (
        "the log begins: the file was of format 6; what stands in it is held to now"
    )
    assert set(first.what["states"]) == {"batch 1", "settings", "labels", "plot"}
    season.treat(BEGINS, 0.5)
    assert state(path) == 12
    by_hand(path, "DELETE FROM inspections WHERE fid = 4")
    assert "The batch 1 of the file is not what entry 1" in check_against_log(Season(path))[0]


def test_a_copy_that_is_brought_back_is_taken_as_it_is(path, tmp_path):
    copy = shutil.copy(path, tmp_path / "before.gpkg")
    season = Season(path)
    season.record(three_results(), "more")
    shutil.copy(copy, path)
    season.record(three_results(1), "again")
    assert [one.kind for one in season.log()] == ["begins", "planned", "seen", "seen"]


def test_a_log_is_told_line_by_line_and_how_many_entries_it_has(path):
    said = Season(path).log()
    told = list(season_log.lines(said, CLOCK))
    assert len(told) == len(said) + 1
    for line, one in zip(told, said, strict=False):
        assert line.split()[:3] == [str(one.number), one.at[:16], one.kind]
        assert line.endswith(f"{one.who or '-':12}  {one.sentence()}")
    assert told[-1] == (
        f"{len(said)} entries, the chain holds; the last digest is {said[-1].digest}"
    )
    (_, alone) = season_log.lines(said[:1], CLOCK)
    assert alone.startswith("1 entry, the chain")
    assert list(season_log.lines((), CLOCK)) == []


SAYS = st.tuples(
    st.sampled_from([None, "", "a", "b", ",", "a,b", "é"]),
    st.sampled_from([0, 1, None]),
    st.sampled_from([None, "", "Ann", "Ben|", ","]),
    st.sampled_from([None, None, 0.3, 0.84]),
)


@given(st.lists(SAYS, max_size=6), st.lists(SAYS, max_size=2))
def test_the_digest_of_a_batch_is_of_all_that_its_rows_say_in_order(inspected, treated):
    said = [None if None in row[:2] else "|".join(map(str, row[:2])) for row in inspected]
    said = [one and f"{one}|{row[2] or ''}{'' if row[3] is None else f'|{row[3]}'}"
            for one, row in zip(said, inspected, strict=True)]  # fmt: skip
    said += [None if None in row[:2] else f"{row[0]}|{row[1]}" for row in treated]
    in_order = sorted(said, key=lambda one: (one is not None, one or ""))
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as db:
        db.execute("CREATE TABLE batches (fid, at, kind, source, who)")
        db.execute("INSERT INTO batches VALUES (1, '2026', 'findings', 'x.csv', 'Ann')")
        for name, rows in (("inspections", inspected), ("treatments", treated)):
            columns = "digest TEXT, undone INTEGER, who TEXT, detects REAL, batch"
            db.execute(f"CREATE TABLE {name} (fid INTEGER PRIMARY KEY, {columns})")
            into = (
                f"INSERT INTO {name} (digest, undone, who, detects, batch) VALUES (?, ?, ?, ?, 1)"  # noqa: S608
            )
            db.executemany(into, rows)
        state = season_log.states(db, [1])["batch 1"]
    own = ("2026", "findings", "x.csv", "Ann")
    content = repr(own) + repr(tuple(in_order))
    assert state == sha256(content.encode()).hexdigest()[:32]


def test_a_batch_is_of_whom_its_entry_names(path):
    season, given = Season(path), three_results()
    season.record(replace(given, who=np.array(["Ben", "Ann", "Ben"], object)), "file")
    season.record(three_results(1), "more", "Dan")
    told, seen = season.batches(), [one for one in season.log() if one.kind == "seen"]
    assert [one.who for one in told][::-1][-2:] == [one.who for one in seen][-2:]
    assert [one.who for one in told][:2] == ["Dan", "Ann, Ben"]
