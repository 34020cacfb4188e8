"""Measurements at any times become hours or days."""

from zoneinfo import ZoneInfo

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.io.readers.weather_rows import WeatherRows, utc_times

BERLIN = ZoneInfo("Europe/Berlin")


def rows(at, **measured):
    at = np.array(at, "datetime64[s]")
    given = {name: np.array(values, float) for name, values in measured.items()}
    return WeatherRows(at, given, np.zeros(len(at), bool), BERLIN, "Europe/Berlin")


def test_six_hours_apart_are_gathered_into_days_with_their_extremes():
    at = np.datetime64("2026-06-01T22:00") + 6 * 3600 * np.arange(8).astype("timedelta64[s]")
    weather, said = rows(at, temperature_c=range(8)).gathered("w", None)
    assert weather.local_days().astype(str).tolist() == ["2026-06-02", "2026-06-03"]
    assert weather.low_c.tolist() == [0, 4]
    assert weather.high_c.tolist() == [3, 7]
    assert "every 6 h: gathered into days" in str(said[0])


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
