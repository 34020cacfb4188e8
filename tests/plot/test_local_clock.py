"""Today is the plot's, wherever the program runs."""

import zoneinfo
from datetime import UTC, date, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest
import tzfpy
from hypothesis import assume, example, given
from hypothesis import strategies as st
from shapely import MultiPolygon, box

from fieldmon.plot import local_clock as clocks
from fieldmon.plot.field import Field
from fieldmon.plot.local_clock import LocalClock, local_clock, zone_outline


def field_at(lon, lat):
    return Field("plot", MultiPolygon([box(lon, lat, lon + 0.001, lat + 0.001)]))


@pytest.mark.parametrize(
    ("lon", "lat", "zone"),
    [
        (35.15, 30.36, "Asia/Jerusalem"),
        (0.62, 41.62, "Europe/Madrid"),
        (-119.5, 36.3, "America/Los_Angeles"),
        (150.9, -34.2, "Australia/Sydney"),
    ],
)
def test_the_zone_is_that_of_the_plots_position(lon, lat, zone):
    assert local_clock(field_at(lon, lat)) == LocalClock(zone)


def test_one_moment_is_another_day_on_the_other_side_of_the_world(monkeypatch):
    monkeypatch.setattr(clocks, "utc_now", lambda: datetime(2026, 11, 21, 22, 30, tzinfo=UTC))
    assert local_clock(field_at(35.15, 30.36)).today() == date(2026, 11, 22)
    assert local_clock(field_at(-119.5, 36.3)).today() == date(2026, 11, 21)
    assert local_clock(field_at(35.15, 30.36)).now() == datetime(2026, 11, 22, 0, 30)


def test_summer_time_is_kept():
    jerusalem = LocalClock("Asia/Jerusalem")
    summer, winter = (datetime(2026, month, 1, 12, tzinfo=UTC) for month in (7, 12))
    assert (jerusalem.at(summer).hour, jerusalem.at(winter).hour) == (15, 14)


def test_where_no_zone_is_known_the_machines_clock_counts(monkeypatch):
    monkeypatch.setattr(tzfpy, "get_tz", lambda lon, lat: "")  # noqa: ARG005
    clock = local_clock(field_at(35.15, 30.36))
    assert clock.zone == ""
    moment = datetime(2026, 11, 21, 22, 30, tzinfo=UTC)
    assert clock.at(moment) == moment.astimezone().replace(tzinfo=None)


ZONES = st.sampled_from(sorted(zoneinfo.available_timezones() - {"Factory", "localtime"}))
MOMENTS = st.datetimes(datetime(1990, 1, 1), datetime(2037, 12, 31), timezones=st.just(UTC))


@example("Asia/Jerusalem", datetime(2026, 10, 24, 22, 30, tzinfo=UTC))  # 01:30, for the first time
@example("Asia/Jerusalem", datetime(2026, 10, 24, 23, 30, tzinfo=UTC))  # and for the second
@example("America/Havana", datetime(2026, 11, 1, 5, 10, tzinfo=UTC))  # put back to midnight
@example("Pacific/Kwajalein", datetime(1993, 8, 21, 13, 0, tzinfo=UTC))  # a day left out
@example("Australia/Lord_Howe", datetime(2026, 4, 4, 15, 5, tzinfo=UTC))  # by half an hour
@given(ZONES, MOMENTS)
def test_a_time_that_passed_is_never_shown_by_the_clock_before_the_moment(zone, moment):
    clock = LocalClock(zone)
    shown = clock.passed(moment)
    assert shown >= clock.at(moment)
    for minutes in range(1, 200):
        assert clock.at(moment - timedelta(minutes=minutes)) < shown
    assert shown - clock.at(moment) < timedelta(hours=1, minutes=1) or zone == "Antarctica/Troll"
    assert (shown.second, shown.microsecond) == (0, 0)


@example("Asia/Jerusalem", datetime(2026, 10, 25, 1, 30))
@example("Asia/Jerusalem", datetime(2026, 3, 27, 2, 30))
@given(ZONES, st.datetimes(datetime(1990, 1, 1), datetime(2037, 12, 31)))
def test_the_latest_moment_of_a_local_time_is_that_time_or_later(zone, local):
    clock = LocalClock(zone)
    latest = clock.latest(local)
    assert clock.at(latest) >= local
    assert clock.at(latest + timedelta(minutes=1)) != local
    if clock.at(latest) == local:  # no other moment after it shows the same
        assert all(clock.at(latest + timedelta(minutes=15 * k)) > local for k in range(1, 9))


@pytest.mark.parametrize(
    ("zone", "start", "hours", "minutes"),
    [
        ("Asia/Jerusalem", "2027-03-26T01:00", 4, 60),
        ("Asia/Jerusalem", "2027-03-26T01:00", 0.9, 0),
        ("Asia/Jerusalem", "2027-03-26T03:00", 4, 0),
        ("Asia/Jerusalem", "2026-10-25T00:30", 4, -60),
        ("America/Santiago", "2026-09-05T22:00", 4, 60),  # at midnight
        ("America/Santiago", "2026-09-06T06:00", 12, 0),
        ("Australia/Lord_Howe", "2026-10-04T01:00", 4, 30),
        ("Australia/Lord_Howe", "2027-04-04T00:30", 4, -30),
        ("Asia/Kolkata", "2026-10-04T01:00", 24, 0),
    ],
)
def test_by_how_much_a_clock_is_put_forward_or_back_during_a_day(zone, start, hours, minutes):
    moved = LocalClock(zone).put_forward(datetime.fromisoformat(start), 3600 * hours)
    assert moved == timedelta(minutes=minutes)


@example("Asia/Jerusalem", datetime(2027, 3, 25, 23, 30, tzinfo=UTC), 3600)
@example("Asia/Jerusalem", datetime(2026, 10, 24, 21, 30, tzinfo=UTC), 12_600)
@given(ZONES, MOMENTS, st.integers(0, 86_400))
def test_after_some_seconds_it_is_what_the_clock_then_shows(zone, moment, seconds):
    clock = LocalClock(zone)
    start, end = clock.at(moment), moment + timedelta(seconds=seconds)
    assume(clock.moment(start.date(), start.time()) == moment)  # not the second time it shows it
    assert clock.after(start, seconds) == clock.at(end)
    own = moment.astimezone(ZoneInfo(zone))
    assert LocalClock("Asia/Kolkata").after(own, seconds).isoformat() == (
        end.astimezone(ZoneInfo(zone)).isoformat()
    )


@pytest.mark.parametrize(
    ("on", "later_h", "gone_h"),
    [
        ("2027-03-26", 4.5, 2.5),  # put forward at two
        ("2027-03-26", 1.75, 0.75),
        ("2026-10-25", 4.5, 3.5),  # put back at two: as if it were not
        ("2026-11-02", 27.5, 26.5),
    ],
)
def test_seconds_of_a_day_skip_what_the_clock_skips(on, later_h, gone_h):
    clock, day = LocalClock("Asia/Jerusalem"), date.fromisoformat(on)
    assert clock.second_after(day, 3600.0, 3600.0 * gone_h) == 3600.0 * later_h
    assert clock.seconds_between(day, 3600.0, 3600.0 * later_h) == 3600.0 * gone_h


@pytest.mark.parametrize("zone", ["America/Asuncion", "America/Argentina/Cordoba"])
def test_the_outline_of_a_zone_is_one_that_can_be_cut(zone):
    # as it is published, it crosses itself
    assert zone_outline(zone, 0.05).is_valid
    assert zone_outline(zone, 0.05) is zone_outline(zone, 0.05)  # made once, by tens of ms
    assert zone_outline(zone, 0.05).intersection(box(-60, -30, -50, -20)).area > 0
