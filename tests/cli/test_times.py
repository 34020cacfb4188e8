"""Days and times of the day on the command line."""

from datetime import UTC, date, datetime, time

import pytest

from fieldmon.cli.times import WorkStart, clock, day, day_on
from fieldmon.errors import SettingError
from fieldmon.plot import local_clock
from tests.monitoring.seasons import a_plot


def test_days_and_times_are_read_as_they_are_written():
    assert day("2026-11-02") == date(2026, 11, 2)
    assert clock("07:30") == time(7, 30)


def test_no_day_is_today_where_the_plot_lies(monkeypatch):
    late = datetime(2026, 11, 21, 23, 0, tzinfo=UTC)
    monkeypatch.setattr(local_clock, "utc_now", lambda: late)
    assert day(None) is None
    assert day_on(a_plot().field, None) == date(2026, 11, 22)
    assert day_on(a_plot().field, date(2026, 11, 2)) == date(2026, 11, 2)
    starts = WorkStart(None, time(6, 30)).on_plot(a_plot().field)
    assert starts == datetime(2026, 11, 22, 6, 30)


def test_what_is_none_is_a_sentence_with_its_option():
    with pytest.raises(SettingError, match="--date must be a day as YYYY-MM-DD"):
        day("2.11.2026")
    with pytest.raises(SettingError, match="--start must be a time as HH:MM, but it is 'dawn'"):
        clock("dawn")
    with pytest.raises(SettingError, match="--now must be"):
        clock("25:00", "--now")
