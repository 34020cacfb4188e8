"""A line for each who is out: what is known, and what to look after."""

from dataclasses import replace
from datetime import datetime, timedelta
from types import SimpleNamespace

import pytest

from app.show import who_is_out
from app.state import last_heard
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.monitoring.days.day_ahead import DayAhead, WorkPart, route_ahead
from fieldmon.monitoring.days.scouts_out import ScoutOut
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.plot.local_clock import local_clock, utc_now
from tests.monitoring.phone import a_finding
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture
def choices(tmp_path):
    season = a_season(tmp_path / "out.gpkg")
    return SimpleNamespace(open_season=season, plot=season.plot, on=BEGINS, is_today=True,
                           units=UnitsInLanguage(),
                           clock=local_clock(season.plot.field))  # fmt: skip


PART = WorkPart((1, 8), "Ann")


def test_nobody_is_out_where_there_are_no_codes(choices):
    assert who_is_out.lines(choices) == ()


def test_a_line_says_rows_code_phone_and_how_far(choices):
    key = scouts.let_in(choices.open_season, "Ann", (1, 8))
    (line,) = who_is_out.lines(choices)
    assert (line.title, line.cautions) == ("\u2068Ann\u2069, rows 1 to 8", ())
    assert texts.OUT_SILENT in line.said
    route = route_ahead(choices.open_season, BEGINS, WorkPart((1, 8), "Ann")).plant
    take(choices.open_season, key, [a_finding(int(route[0]), on=BEGINS)],
         utc_now() + timedelta(hours=1))  # fmt: skip
    last_heard.note(
        choices.open_season.path,
        "Ann",
        BEGINS,
        DayAhead.of(choices.open_season, BEGINS).plan_of(PART),
    )
    (line,) = who_is_out.lines(choices)
    assert f"1 of {len(route)} recorded" in line.said
    assert "has the day since " in line.said
    assert line.cautions == (texts.OUT_CLOCK.format(minutes=60),)
    last_heard.note(choices.open_season.path, "Ann", BEGINS + timedelta(days=1))
    (line,) = who_is_out.lines(choices)
    assert texts.OUT_OTHER_DAY.format(day="Tue 7 Apr") in line.cautions


def test_a_time_of_another_day_names_it(choices):
    at = choices.clock.moment(BEGINS, datetime(2026, 4, 6, 7, 30).time())
    assert who_is_out._clock(choices, at) == "07:30"
    assert who_is_out._clock(choices, at + timedelta(days=1)) == "Tue 7 Apr 07:30"
    choices.is_today = False  # the day shown is over, or to come
    assert who_is_out._clock(choices, at) == "Mon 6 Apr 07:30"


@pytest.mark.parametrize(
    ("off", "said"),
    [(timedelta(minutes=-7), "7 min off"), (timedelta(hours=3), "3 h off"),
     (-timedelta(days=3 * 365), "more than a day off")],
)  # fmt: skip
def test_how_far_a_clock_is_off_is_said_as_one_would_count_it(off, said):
    assert said in who_is_out._clock_off(off)


def test_late_finds_and_rows_that_overlap_are_said(choices, monkeypatch):
    one = ScoutOut(
        "Ann", (1, 8), None, None, timedelta(), 0, 5, 1, (), True, True, ("Ben", "Cem"), 3
    )
    monkeypatch.setattr(who_is_out, "scouts_out", lambda *_: (one, replace(one, ahead=0)))
    late = texts.OUT_NEWER.format(n=3)
    ann, done = who_is_out.lines(choices)
    assert "3 newer finds" in late
    assert late in ann.cautions
    assert late not in done.cautions
    assert texts.OUT_OVERLAPS.format(others="\u2068Ben\u2069, \u2068Cem\u2069") in ann.cautions
