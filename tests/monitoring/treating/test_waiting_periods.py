"""A waiting period is never shown shorter than it was entered, wherever and whenever."""

import zoneinfo
from datetime import UTC, date, datetime, time, timedelta

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from fieldmon.monitoring.treating.waiting_periods import WaitingPeriod, end_of
from fieldmon.plot.local_clock import LocalClock

JERUSALEM = LocalClock("Asia/Jerusalem")
ZONES = st.sampled_from(sorted(zoneinfo.available_timezones() - {"Factory", "localtime"}))
MOMENTS = st.datetimes(datetime(1990, 1, 1), datetime(2036, 12, 31), timezones=st.just(UTC))
HOUR = timedelta(hours=1)


@example("Asia/Jerusalem", datetime(2026, 3, 26, 8, tzinfo=UTC), 3)  # a day of 23 hours in it
@example("Asia/Jerusalem", datetime(2026, 10, 22, 20, tzinfo=UTC), 3)  # and one of 25
@example("Pacific/Apia", datetime(2011, 12, 28, 12, tzinfo=UTC), 2)  # and one left out
@example("Pacific/Kwajalein", datetime(1993, 8, 20, 12, tzinfo=UTC), 1)
@example("America/Havana", datetime(2026, 11, 1, 3, 30, tzinfo=UTC), 1)
@given(ZONES, MOMENTS, st.integers(0, 120))
def test_no_moment_of_the_first_day_of_harvest_is_within_the_waiting_period(zone, ended, days):
    clock = LocalClock(zone)
    shown = WaitingPeriod(ended, days, None, clock).harvest_from
    # every moment whose date by the local calendar is that day or later, from the end on
    for quarter in range(-4 * 50, 4 * 26):
        moment = ended + timedelta(days=days, minutes=15 * quarter)
        if moment >= ended and clock.at(moment).date() >= shown:
            assert moment - ended >= timedelta(days=days)
    assert shown >= clock.at(ended).date() + timedelta(days=days)  # by the calendar too
    assert shown <= clock.at(ended).date() + timedelta(days=days + 2)


@example("Asia/Jerusalem", datetime(2026, 10, 24, 11, 30, tzinfo=UTC), 12.0)  # ends at 01:30 twice
@example("Asia/Jerusalem", datetime(2026, 3, 26, 12, 30, tzinfo=UTC), 12.0)
@given(ZONES, MOMENTS, st.floats(0, 240))
def test_nobody_who_reads_the_local_clock_enters_too_soon(zone, ended, hours):
    clock = LocalClock(zone)
    shown = WaitingPeriod(ended, None, hours, clock).entry_from
    wait = timedelta(hours=hours)
    for minutes in range(1, 190, 3):
        moment = ended + wait - timedelta(minutes=minutes)
        assert clock.at(moment) < shown
    assert shown >= clock.at(ended + wait)


@pytest.mark.parametrize(
    ("said", "days", "harvest"),
    [
        (time(10), 3, date(2026, 5, 5)),  # over on the 4th at 10:00: the 5th is the first whole day
        (None, 3, date(2026, 5, 5)),  # without a time it ended at the end of its day
        (time(), 3, date(2026, 5, 4)),
        (None, 0, date(2026, 5, 2)),
    ],
)
def test_a_waiting_period_in_may(said, days, harvest):
    ended = end_of(JERUSALEM, date(2026, 5, 1), said)
    assert WaitingPeriod(ended, days, None, JERUSALEM).harvest_from == harvest


def test_entry_over_a_night_in_which_clocks_are_put_back_is_at_the_second_two_oclock():
    ended = end_of(JERUSALEM, date(2026, 10, 24), time(13, 30))
    # twelve hours later the clock shows 01:30 for the first time, and once more an hour later
    assert WaitingPeriod(ended, None, 12, JERUSALEM).entry_from == datetime(2026, 10, 25, 2, 30)


def test_what_nobody_said_is_not_shown():
    nothing = WaitingPeriod(datetime(2026, 5, 1, tzinfo=UTC), None, None, JERUSALEM)
    assert (nothing.harvest_from, nothing.entry_from) == (None, None)


def test_entry_over_a_night_in_which_clocks_are_put_forward_is_after_all_its_hours():
    ended = end_of(JERUSALEM, date(2026, 3, 26), time(20))
    # at 02:00 it was 03:00: by the clock alone only eleven hours would have passed
    assert WaitingPeriod(ended, None, 12, JERUSALEM).entry_from == datetime(2026, 3, 27, 9)
