"""Who asks is remembered with the day that was asked for."""

from datetime import date
from pathlib import Path

from app.state import last_heard

SEASON = Path("last_heard.gpkg")


def test_the_day_asked_for_is_known_since_it_was_first():
    assert last_heard.last(SEASON, "Ann") is None
    last_heard.note(SEASON, "Ann")
    assert last_heard.last(SEASON, "Ann")[1:] == (None, None, None)
    last_heard.note(SEASON, "Ann", date(2026, 4, 6))
    first = last_heard.last(SEASON, "Ann")
    last_heard.note(SEASON, "Ann")
    last_heard.note(SEASON, "Ann", date(2026, 4, 6))
    again = last_heard.last(SEASON, "Ann")
    assert again[1:] == first[1:] == (date(2026, 4, 6), first.at, None)
    assert again.at >= first.at
    last_heard.note(SEASON, "Ann", date(2026, 4, 6), 3)
    last_heard.note(SEASON, "Ann")
    assert last_heard.last(SEASON, "Ann").plan == 3
    last_heard.note(SEASON, "Ann", date(2026, 4, 7))
    assert last_heard.last(SEASON, "Ann").since >= again.at
    assert last_heard.last(SEASON, "Ben") is None
