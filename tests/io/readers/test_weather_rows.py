"""Measurements at any times become hours or days."""

from datetime import date, datetime
from zoneinfo import ZoneInfo

import numpy as np
import pytest

import fieldmon as fm
from fieldmon.errors import FileProblem
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.io.readers.weather_rows import WeatherRows, utc_times

BERLIN, NEW_YORK = ZoneInfo("Europe/Berlin"), ZoneInfo("America/New_York")


def rows(at, zone=BERLIN, **measured):
    at = np.array(at, "datetime64[s]")
    given = {name: np.array(values, float) for name, values in measured.items()}
    return WeatherRows(at, given, np.zeros(len(at), bool), zone, zone.key)


def test_six_hours_apart_are_gathered_into_days_with_their_extremes():
    at = np.datetime64("2026-06-01T22:00") + 6 * 3600 * np.arange(8).astype("timedelta64[s]")
    weather, said = rows(at, temperature_c=range(8)).gathered("w", None)
    assert weather.local_days().astype(str).tolist() == ["2026-06-02", "2026-06-03"]
    assert weather.low_c.tolist() == [0, 4]
    assert weather.high_c.tolist() == [3, 7]
    assert "every 6 h: gathered into days" in str(said[0])


@pytest.mark.parametrize("zone", ["America/New_York", "Pacific/Auckland", "Asia/Jerusalem"])
def test_a_day_stated_as_utc_midnight_is_that_day_wherever_the_place_is(zone):
    days = np.arange("2026-01-01", "2026-01-04", dtype="datetime64[D]")
    weather, _ = rows(days, ZoneInfo(zone), low_c=[1, 2, 3], high_c=[4, 5, 6]).gathered("w", None)
    assert weather.local_days().tolist() == days.tolist()


def test_a_day_stated_by_an_evening_of_the_place_is_that_evening_s():
    local = np.arange("2026-01-01T20:30", "2026-01-04", 24 * 60, dtype="datetime64[m]")
    weather, _ = rows(utc_times(local, NEW_YORK), NEW_YORK, temperature_c=[1, 2, 3]).gathered(
        "w", None
    )
    assert weather.local_days().astype(str).tolist() == ["2026-01-01", "2026-01-02", "2026-01-03"]


def test_rows_come_into_order_and_the_last_of_two_counts():
    at = ["2026-06-01T02:00", "2026-06-01T01:00", "2026-06-01T02:00", "NaT"]
    weather, said = rows(at, temperature_c=[1, 2, 3, 4]).gathered("w", None)
    assert weather.temperature_c.tolist() == [2, 3]
    assert [str(one).split(":")[0] for one in said] == ["dropped", "dropped"]


def test_nothing_timed_is_refused():
    with pytest.raises(FileProblem, match="with its times, but holds none"):
        rows(["NaT"], temperature_c=[1]).gathered("w", None)


def test_local_times_become_utc_and_the_hour_that_comes_again_is_later():
    local = np.array(
        ["2026-10-25T01:00", "2026-10-25T02:00", "2026-10-25T02:00", "NaT"], "datetime64[s]"
    )
    made = utc_times(local, BERLIN)
    assert made[:3].astype(str).tolist() == [
        "2026-10-24T23:00:00", "2026-10-25T00:00:00", "2026-10-25T01:00:00"
    ]  # fmt: skip
    assert np.isnat(made[3])
    assert utc_times(local[2::-1], BERLIN).tolist() == made[2::-1].tolist()


@pytest.mark.parametrize("minutes", [60, 15])
@pytest.mark.parametrize(
    "zone",
    ["Asia/Kolkata", "Asia/Kathmandu", "Asia/Tehran", "America/St_Johns", "Australia/Adelaide"],
)
def test_hours_begin_by_the_clock_of_the_place_where_that_is_no_hour_of_utc(zone, minutes):
    """Clocks of Adelaide are put back in these days, and an hour comes twice."""
    first = datetime(2026, 4, 4, tzinfo=ZoneInfo(zone)).timestamp()
    at = (int(first) + 60 * minutes * np.arange(72 * 60 // minutes)).astype("datetime64[s]")
    clock = [datetime.fromtimestamp(s, ZoneInfo(zone)).hour for s in at.astype(int).tolist()]
    weather, _ = rows(at, ZoneInfo(zone), temperature_c=clock).gathered("w", None)
    assert weather.at.tolist() == at[:: 60 // minutes].tolist()
    assert weather.local_days()[:25].astype(str).tolist() == 24 * ["2026-04-04"] + ["2026-04-05"]
    known = PestInWeather(fm.read_pest("spider-mite"), weather, date(2026, 4, 4))
    assert [known.day(k).temperature_c.tolist() for k in (0, 1)] == 2 * [list(range(24))]
