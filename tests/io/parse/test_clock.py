"""Times of day as people write them, and what a zone makes of them."""

from datetime import datetime, timedelta, timezone
from zoneinfo import ZoneInfo

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.io.parse.clock import clock_time, is_clock_alone, is_skipped, local_time, zone_of

DAY = np.datetime64("2026-11-18")


@given(st.integers(0, 86_399), st.sampled_from(("2026-11-18 ", "18.11.2026, ", "2026-11-18T", "")))
def test_a_time_of_day_is_its_seconds_since_midnight_with_or_without_a_day_before_it(second, day):
    hour, minute = second // 3600, second // 60 % 60
    assert clock_time(f"{day}{hour}:{minute:02d}").seconds == second - second % 60
    full = clock_time(f"{day}{hour:02d}:{minute:02d}:{second % 60:02d}")
    assert (full.seconds, full.offset) == (second, None)


@pytest.mark.parametrize(
    ("cell", "seconds"),
    [
        ("12:30 am", 30 * 60),
        ("12:30 PM", 12 * 3600 + 30 * 60),
        ("8:05 p.m.", 20 * 3600 + 5 * 60),
        ("08:30:05.75", 8 * 3600 + 30 * 60 + 5),
        ("45979.5", 12 * 3600),
    ],
)
def test_halves_of_the_day_and_parts_of_a_day_are_read(cell, seconds):
    assert clock_time(cell).seconds == seconds


@pytest.mark.parametrize(
    "cell", ["", "2026-11-18", "24:01", "25:00", "8:61", "noon", "45979", "8.30"]
)
def test_what_is_no_time_of_day_is_none(cell):
    assert clock_time(cell) is None


@pytest.mark.parametrize(
    ("cell", "hours"), [("8:30Z", 0), ("8:30 UTC", 0), ("8:30+02:00", 2), ("8:30-0530", -5.5)]
)
def test_a_zone_behind_a_time_says_how_far_it_is_ahead_of_utc(cell, hours):
    assert clock_time(cell).offset == timedelta(hours=hours)


def test_24_00_is_the_midnight_at_the_end_of_its_day():
    assert local_time(DAY, clock_time("2026-11-18 24:00"), None) == DAY + 1


def test_a_zone_that_there_is_not_leaves_no_time():
    assert clock_time("8:30+25:00") is None


@pytest.mark.parametrize(
    ("cell", "alone"), [("8:30", True), ("", True), ("2026-11-18 8:30", False), ("soon", False)]
)
def test_a_clock_is_alone_where_no_day_stands_before_it(cell, alone):
    assert is_clock_alone(cell) == alone


@given(st.datetimes(datetime(2020, 1, 1), datetime(2030, 1, 1)), st.integers(-24, 24))
def test_local_time_is_that_of_the_named_zone_whatever_zone_was_stated(moment, half_hours):
    moment = moment.replace(microsecond=0)
    ahead = timedelta(hours=half_hours / 2)
    stated = moment.replace(tzinfo=timezone(ahead))
    sign, minutes = ("-" if half_hours < 0 else "+"), abs(half_hours) * 30
    cell = f"{moment:%H:%M:%S}{sign}{minutes // 60:02d}:{minutes % 60:02d}"
    here = ZoneInfo("Asia/Jerusalem")
    read = local_time(np.datetime64(moment.date()), clock_time(cell), here)
    assert read == np.datetime64(stated.astimezone(here).replace(tzinfo=None))


def test_without_a_zone_named_a_time_keeps_its_own_clock():
    for cell in ("8:30", "8:30Z"):
        assert local_time(DAY, clock_time(cell), None) == np.datetime64("2026-11-18T08:30:00")
    here = zone_of("+02:00")
    assert local_time(DAY, clock_time("8:30"), here) == np.datetime64("2026-11-18T08:30:00")


@pytest.mark.parametrize(("name", "hours"), [("+02:00", 2), ("-5", -5), ("+0530", 5.5)])
def test_a_zone_is_named_by_its_offset(name, hours):
    assert zone_of(name).utcoffset(None) == timedelta(hours=hours)


def test_a_zone_is_named_by_its_place():
    assert str(zone_of(" Asia/Jerusalem ")) == "Asia/Jerusalem"


@pytest.mark.parametrize("name", ["", "Paran", "+15:00", "../etc/passwd", "2 h"])
def test_what_is_no_zone_is_a_sentence(name):
    with pytest.raises(SettingError, match="Asia/Jerusalem"):
        zone_of(name)


def test_a_zone_skips_an_hour_where_its_clocks_are_put_forward():
    here, night = zone_of("Asia/Jerusalem"), np.datetime64("2025-03-28T00:00:00")
    skipped = [is_skipped(night + np.timedelta64(30 * k, "m"), here) for k in range(12)]
    assert np.flatnonzero(skipped).tolist() == [4, 5]
