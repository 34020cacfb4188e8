"""What the log says of days: by which settings each was worked."""

import json
from datetime import date

import pytest

from fieldmon.monitoring.changes import logged_days, season_log
from fieldmon.plot.local_clock import LocalClock


# what a log says of the 7th, with the settings (a letter) and the day on which it was said
@pytest.mark.parametrize(
    ("said", "by"),
    [
        ("", ""),
        ("planned a 7, planned b 8", "b"),  # nothing was recorded
        ("seen a 7, seen b 8", "a"),
        ("planned a 7, seen a 7, planned b 7, seen b 7", "b"),  # planned anew, and worked on
        ("planned a 7, seen a 7, planned b 7", "a"),
        ("planned a 7, seen a 7, planned b 7, seen b 8", "a"),  # a late find
        ("planned a 7, seen b 8, planned b 8, seen b 8", "a"),  # recorded the next day
        ("seen a 7, planned b 8", "a"),
    ],
)
def test_a_day_keeps_the_settings_that_it_was_worked_by(db, monkeypatch, said, by):
    day = date(2026, 4, 7)
    for k, one in enumerate(said.split(", ") if said else ()):
        kind, chosen, on = one.split()
        monkeypatch.setattr(season_log, "_canonical", _at(f"2026-04-0{on}T10:00:0{k}.000000Z"))
        days = {"date": str(day)} if kind == "planned" else {"from": "2026-04-06", "to": str(day)}
        season_log.append(db, kind, by={"robot": chosen}, **days)
    worked = logged_days.worked_by(db, day, LocalClock("UTC"))
    assert worked == ({"robot": by} if by else None)
    assert logged_days.worked_by(db, date(2026, 4, 9), LocalClock("UTC")) is None


def _at(moment):
    return lambda entry: json.dumps({**entry, "at": moment})


def test_routes_given_out_in_a_copy_that_was_taken_in_are_told_too(db):
    other = {"kind": "planned", "at": "2", "who": "Ben", "what": {"date": "7", "digest": "b"}}
    season_log.append(db, "planned", "Ann", date="7", digest="a")
    theirs = [{"digest": "x", "entry": json.dumps(other, separators=(",", ":"))}]
    season_log.append(db, "merged", theirs=theirs)
    told = [(one.who, one.date, one.digest) for one in logged_days.given_out(db)]
    assert told == [("Ann", "7", "a"), ("Ben", "7", "b")]


@pytest.mark.parametrize(
    ("since", "holds"),
    [
        ([], True),
        ([("seen", {"from": "2026-04-07", "to": "2026-04-07", "found": 0})], True),
        ([("seen", {"from": "2026-04-07", "to": "2026-04-07", "found": 1})], False),
        ([("seen", {"from": "2026-04-06", "to": "2026-04-07", "found": 0})], False),
        ([("planned", {"date": "2026-04-08", "digest": "b"}), ("advised", {})], True),
        ([("undone", {})], False),
    ],
)
def test_a_plan_holds_as_long_as_nothing_but_what_is_clean_was_told_since(db, since, holds):
    season_log.append(db, "planned", date="2026-04-07", digest="a")
    for kind, what in since:
        season_log.append(db, kind, **what)
    assert logged_days.holds_still(db, date(2026, 4, 7), "a") is holds
