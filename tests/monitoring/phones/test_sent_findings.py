"""When each thing that a phone sends was seen is worked out by a clock that is right."""

from datetime import timedelta

import numpy as np
import pytest

from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import findings, scouts
from fieldmon.monitoring.phones.findings import take
from tests.monitoring.phone import NOW, a_finding
from tests.monitoring.seasons import BEGINS

HOUR, DAY = timedelta(hours=1), timedelta(days=1)


@pytest.fixture
def season(path):
    return Season(path)


@pytest.fixture
def key(season):
    return scouts.let_in(season, "Ann")


@pytest.fixture(autouse=True)
def _now(monkeypatch):
    monkeypatch.setattr(findings, "utc_now", lambda: NOW)


@pytest.mark.parametrize(
    ("ahead", "clock"), [(0, "09:00:00"), (20, "09:00:20"), (-7 * 3600, "09:00:00")]
)
def test_a_wrong_clock_is_put_right_and_both_times_are_kept(season, key, ahead, clock):
    """The phone says when it sends; a clock that is hours off was set wrong."""
    phone = NOW + timedelta(seconds=ahead)
    take(season, key, [a_finding(3, at=phone)], phone)
    with season.store.reading() as db:
        kept = db.execute("SELECT at_phone, sent_phone, received FROM tellings").fetchone()
        (row,) = db.execute(
            "SELECT date, time FROM inspections WHERE fid = (SELECT inspection FROM tellings)"
        )
    assert row == ("2026-04-06", clock)
    assert kept[:2] == (phone.isoformat(), phone.isoformat())
    assert kept[2].startswith("2026-04-06T06:00:00")


def test_what_is_meant_for_another_day_has_no_time(season, key):
    other = BEGINS + timedelta(days=2)
    take(season, key, [a_finding(3, on=other)], NOW)
    done = season.history.inspections.on(other)
    assert done.plant.tolist() == [3]
    assert np.isnan(done.second).all()


@pytest.mark.parametrize(("fast_s", "shifted"), [(119.0, False), (121.0, True), (-121.0, True)])
def test_a_clock_is_put_right_if_it_is_two_minutes_wrong_and_else_believed(
    season, key, monkeypatch, fast_s, shifted
):
    monkeypatch.setattr(findings, "utc_now", lambda: NOW)
    fast = timedelta(seconds=fast_s)
    take(season, key, [a_finding(0, at=NOW + fast)], NOW + fast)
    second = season.history.inspections.second
    assert second[~np.isnan(second)].tolist() == [9 * 3600.0 + (0.0 if shifted else fast_s)]


def test_a_day_that_is_named_has_times_if_it_is_the_day_of_the_phone(season, key):
    take(season, key, [a_finding(3, on=BEGINS), a_finding(4, on=BEGINS + timedelta(days=1))], NOW)
    seen, day = season.history.inspections, BEGINS + timedelta(days=1)
    assert seen.second[(seen.plant == 3) & (seen.date == np.datetime64(BEGINS))][-1] == 9 * 3600.0
    assert np.isnan(seen.second[(seen.plant == 4) & (seen.date == np.datetime64(day))]).all()


@pytest.mark.parametrize(
    ("at", "after", "second"),
    [
        (NOW - HOUR, NOW - 2 * HOUR, 8 * 3600.0),
        (NOW - HOUR, None, 8 * 3600.0),
        (NOW - DAY, NOW - HOUR, np.nan),  # a battery was empty: the day is sure, the time is not
        (NOW.replace(year=1970), NOW - HOUR, np.nan),
        (NOW + 3 * DAY, NOW - HOUR, np.nan),
        (NOW - DAY, NOW - 2 * DAY, None),  # a day that can be true is believed; of another day here
        (NOW + 3 * DAY, NOW - DAY, None),
        (NOW + 3 * DAY, None, None),
        (NOW.replace(year=1970), None, None),
    ],
    ids=str,
)
def test_a_time_after_its_arrival_or_before_the_least_it_can_be_is_not_believed(
    season, key, at, after, second
):
    (done,) = take(season, key, [a_finding(37, at=at, after=after)], NOW)
    seen = season.history.inspections
    seen = seen.take(seen.plant == 37)
    assert bool(done.problem) == (second is None)
    if second is None:
        assert len(seen) == 0
    else:
        assert seen.date.tolist() == [BEGINS]
        np.testing.assert_equal(seen.second, [second])


@pytest.mark.parametrize(
    ("times", "fast", "hour"),
    [
        ((-6, -6, -6), -9, 3),  # the clock went wrong after the tap
        ((-6, -6, -8), -9, 3),
        ((3, -6, -6), 0, 3),  # it was set right after the tap
        ((-1, -2, -3), 1, 7),
        ((-1, -2, -3), -9, 7),
        ((7, 1, -3), 9, 7),  # what was taken for the time is still to come, or too early
        ((7, -5, -3), 9, 7),
        ((-3, -3, -6), 2, 4),  # it may have been set ahead while the phone slept, before the tap
    ],
)
def test_a_time_is_put_right_by_what_the_clock_was_off_at_the_tap_where_that_is_known(
    season, key, times, fast, hour
):  # hours from now, 9 o'clock: by the phone's clock, as it took it, and at least
    at, known_at, after = (NOW + one * HOUR for one in times)
    one = a_finding(37, at=at, known_at=known_at, after=after)
    take(season, key, [one], NOW + fast * HOUR)
    seen = season.history.inspections
    seen = seen.take(seen.plant == 37)
    assert (seen.date.tolist(), seen.second.tolist()) == ([BEGINS], [hour * 3600.0])
