"""Findings added to the season itself by another program count from its next opening on."""

import sqlite3
from contextlib import closing
from datetime import UTC, date, datetime

import pytest

from fieldmon.infestation.inspections import FOUND, SKIPPED
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes import outside_changes
from fieldmon.monitoring.estimates.last_days import recorded_ahead
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.inspecting.drafts import SOURCE
from tests.monitoring.changes.test_outside_changes import outside
from tests.monitoring.seasons import BEGINS, state

PLANT = 200


def add(path, plant=PLANT, **said):
    """Add a finding as QGIS does: a point, a result, a date."""
    row = {"result": "found", "date": str(BEGINS)} | said
    names = ", ".join(row)
    with closing(sqlite3.connect(path)) as db:
        db.execute(
            f"INSERT INTO inspections (geom, {names}) "  # noqa: S608 - written here
            f"SELECT geom, {', '.join('?' * len(row))} FROM plants WHERE plant = ?",
            (*row.values(), plant),
        )
        db.commit()


def test_a_finding_saved_into_the_season_counts_at_its_next_opening(path):
    before = Season(path).history.states(0)[PLANT]
    add(path, who="Ann", notes="underside", time="09:30:00", count=3, detects=0.3)
    season = Season(path)
    assert season.drafts == ()
    inspections = season.history.inspections
    (k,) = (inspections.plant == PLANT).nonzero()[0]
    assert before == -1
    assert inspections.result[k] == FOUND
    assert (inspections.who[k], inspections.notes[k]) == ("Ann", "underside")
    assert (inspections.second[k], inspections.count[k]) == (9.5 * 3600, 3)
    assert season.history.detections[k] == 0.3
    last = season.batches()[0]
    assert (last.source, last.rows, last.kind) == (SOURCE, 1, "findings")
    assert season.log()[-1].kind == "seen"
    assert check_against_log(season) == ()
    assert state(path) == 13  # the draft's own row, not another one beside it
    with season.store.reading() as db:
        assert outside_changes.waiting(db) == ()
    # opened again, nothing more happens; and it can be taken back
    revision = Season(path).revision
    assert Season(path).revision == revision
    season.undo()
    assert Season(path).history.states(0)[PLANT] == -1


@pytest.mark.parametrize(("notes", "kept"), [(None, "gone"), ("burnt", "gone: burnt")])
def test_a_plant_added_as_gone_is_kept_as_skipped_and_gone(path, notes, kept):
    add(path, result="gone", notes=notes)
    season = Season(path)
    assert season.drafts == ()
    (k,) = (season.history.inspections.plant == PLANT).nonzero()[0]
    assert season.history.inspections.result[k] == SKIPPED
    assert season.history.inspections.notes[k] == kept
    assert season.history.gone(0).nonzero()[0].tolist() == [PLANT]
    assert season.verify() == ()


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ({"date": None}, "no date"),
        ({"result": None}, "none of"),
        ({"result": "maybe"}, "none of"),
        ({"date": "2020-01-01"}, "began on"),
        ({"date": "soon"}, "'soon' is not written as 2026-04-06"),
        ({"date": "2026-11-06"}, "its day, 2026-11-06, has not come, but others of the file have"),
        ({"plant": 99999, "plant_says": 1}, "none of 0 to"),
    ],
)
def test_a_point_that_says_too_little_stays_a_draft_and_the_others_count(
    path, monkeypatch, said, why
):
    monkeypatch.setattr(
        "fieldmon.plot.local_clock.utc_now", lambda: datetime(2026, 11, 5, 12, tzinfo=UTC)
    )
    bad = dict(said)
    if bad.pop("plant_says", None):
        outside(path, "SELECT 1")
        with closing(sqlite3.connect(path)) as db:
            db.execute(
                "INSERT INTO inspections (geom, plant, result, date) "
                "SELECT geom, 99999, 'found', ? FROM plants WHERE plant = 5", (str(BEGINS),)
            )  # fmt: skip
            db.commit()
    else:
        add(path, plant=PLANT + 1, **bad)
    add(path)
    season = Season(path)
    (sentence,) = season.drafts
    assert "Finding 13 (fid, in the layer Findings)" in sentence
    assert why in sentence
    assert season.history.states(0)[PLANT] == FOUND
    assert season.status(BEGINS).found == 4
    assert Season(path).drafts == season.drafts  # said until it is mended
    outside(path, "DELETE FROM inspections WHERE fid = 13")
    assert Season(path).drafts == ()


def test_where_no_other_day_has_come_a_draft_of_a_day_to_come_counts(path, monkeypatch):
    """It is a rehearsal."""
    monkeypatch.setattr(
        "fieldmon.plot.local_clock.utc_now", lambda: datetime(2026, 1, 5, 12, tzinfo=UTC)
    )
    add(path, date="2026-11-06")
    season = Season(path)
    assert season.drafts == ()
    assert recorded_ahead(season) == date(2026, 11, 6)


def test_what_contradicts_the_season_is_said_and_does_not_count(path):
    held = Season(path).history.inspections
    add(path, plant=int(held.plant[0]), result="found")
    season = Season(path)
    assert len(season.drafts) == 1
    assert len(season.history.inspections) == 12


def test_where_more_was_changed_nothing_is_taken_before_that_is_settled(path):
    add(path)
    outside(path, "DELETE FROM inspections WHERE fid = 1")
    season = Season(path)
    assert season.drafts == ()
    season.correct("Ann")
    assert Season(path).history.states(0)[PLANT] == FOUND
