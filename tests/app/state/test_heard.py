"""Who asks is remembered with the day that was asked for."""

from datetime import date
from pathlib import Path

from app.state import heard

SEASON = Path("heard.gpkg")


def test_the_day_asked_for_is_known_since_it_was_first():
    assert heard.last(SEASON, "Ann") is None
    heard.note(SEASON, "Ann")
    assert heard.last(SEASON, "Ann")[1:] == (None, None, None)
    heard.note(SEASON, "Ann", date(2026, 4, 6))
    first = heard.last(SEASON, "Ann")
    heard.note(SEASON, "Ann")
    heard.note(SEASON, "Ann", date(2026, 4, 6))
    again = heard.last(SEASON, "Ann")
    assert again[1:] == first[1:] == (date(2026, 4, 6), first.at, None)
    assert again.at >= first.at
    heard.note(SEASON, "Ann", date(2026, 4, 6), 3)
    heard.note(SEASON, "Ann")
    assert heard.last(SEASON, "Ann").plan == 3
    heard.note(SEASON, "Ann", date(2026, 4, 7))
    assert heard.last(SEASON, "Ann").since >= again.at
    assert heard.last(SEASON, "Ben") is None
