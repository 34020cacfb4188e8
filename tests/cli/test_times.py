"""Days and times of the day on the command line."""

from datetime import date, datetime, time

import pytest

from fieldmon.cli.times import clock, day
from fieldmon.errors import SettingError


def test_days_and_times_are_read_as_they_are_written():
    assert day("2026-11-02") == date(2026, 11, 2)
    assert clock("07:30") == time(7, 30)


def test_no_day_is_today():
    before = datetime.now().astimezone().date()
    meant = day(None)
    assert before <= meant <= datetime.now().astimezone().date()


def test_what_is_none_is_a_sentence_with_its_option():
    with pytest.raises(SettingError, match="--date must be a day as YYYY-MM-DD"):
        day("2.11.2026")
    with pytest.raises(SettingError, match="--start must be a time as HH:MM, but it is 'dawn'"):
        clock("dawn")
    with pytest.raises(SettingError, match="--now must be"):
        clock("25:00", "--now")
