"""Which day the pages are about."""

import shutil
from datetime import UTC, date, datetime

import numpy as np
import pytest

from app.state import work_day
from app.state.work_day import Calendar
from fieldmon.monitoring import Season
from fieldmon.plot import local_clock
from tests.app.driving import go, heading, opened, tap, texts_of

TODAY = date(2026, 11, 16)


@pytest.fixture
def six_days_later(monkeypatch):
    """Let it be 07:00 on the plot six days after the season began."""
    later = datetime(2026, 11, 22, 5, 0, tzinfo=UTC)
    monkeypatch.setattr(local_clock, "utc_now", lambda: later)


@pytest.mark.usefixtures("session")
def test_a_day_counts_until_today_does_again():
    calendar = Calendar(TODAY, first=date(2026, 11, 10), last=date(2026, 12, 1))
    assert work_day.of("a", calendar) == TODAY
    work_day.choose("a", date(2026, 11, 12))
    assert work_day.of("a", calendar) == date(2026, 11, 12)
    assert work_day.of("b", calendar) == TODAY
    work_day.choose("a", date(2027, 1, 1))
    assert work_day.of("a", calendar) == date(2026, 12, 1)
    work_day.back_to_today("a")
    assert work_day.of("a", calendar) == TODAY


@pytest.mark.usefixtures("six_days_later")
def test_a_season_opens_today_not_on_its_last_day(begun_file, seasons_folder):
    shutil.copy(begun_file, seasons_folder)
    app = opened("Gate 2026")
    assert heading(app) == "Gate · 2026-11-22"
    assert not app.warning
    go(app, "scout")
    tap(app, "scout_found")
    done = Season(seasons_folder / "Gate 2026.gpkg").history.inspections
    assert done.date.tolist() == [date(2026, 11, 22)]
    assert done.second.tolist() == [7 * 3600.0]


def test_the_address_leads_back_to_a_day_chosen_on_purpose(begun_file, seasons_folder):
    shutil.copy(begun_file, seasons_folder)
    app = opened("Gate 2026", day="2026-11-18")
    assert heading(app) == "Gate · 2026-11-18"
    assert "not today" in app.warning[0].value
    for nonsense in ("yesterday", "2026-13-01", ""):
        assert heading(opened("Gate 2026", day=nonsense)) == "Gate · 2026-11-16"


def test_a_page_left_open_over_night_is_about_the_new_day(season_app, monkeypatch):
    assert heading(season_app) == "Gate · 2026-11-16"
    later = datetime(2026, 11, 16, 23, 0, tzinfo=UTC)
    monkeypatch.setattr(local_clock, "utc_now", lambda: later)
    season_app.run()
    assert heading(season_app) == "Gate · 2026-11-17"
    assert "not today" not in texts_of(season_app)


def test_a_tap_for_another_day_has_no_time_that_nobody_said(season_app, season):
    season_app.date_input(key="day Gate 2026").set_value(date(2026, 11, 18)).run()
    go(season_app, "scout")
    tap(season_app, "scout_clean")
    done = season().history.inspections
    assert done.date.tolist() == [date(2026, 11, 18)]
    assert np.isnan(done.second).all()
