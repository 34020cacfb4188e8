"""Days that a program hands over, whatever says them."""

from datetime import UTC, date, datetime, timedelta
from types import SimpleNamespace
from zoneinfo import ZoneInfo

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from fieldmon.compute.day_arguments import day_in, day_of, days_of, seconds_of
from fieldmon.errors import ObservationError, SettingError

#: still the day before in UTC
AT = datetime(2026, 11, 30, 1, 30, tzinfo=ZoneInfo("Asia/Jerusalem"))


def test_days_are_dates_texts_or_numpys_and_no_numbers():
    for good in ("2026-11-18", date(2026, 11, 18), datetime(2026, 11, 18, 5), np.datetime64("NaT")):
        assert days_of(good) is not None
    days = pd.Series(pd.period_range("2026-11-18", periods=2, freq="D"))
    assert days_of(days).astype(str).tolist() == ["2026-11-18", "2026-11-19"]
    assert days_of([date(2026, 11, 18), None]).astype(str).tolist() == ["2026-11-18", "NaT"]
    for bad in (
        None,
        "",
        "soon",
        20_000,
        1e30,
        10**30,
        [10**30],
        [1, 2],
        pd.NaT,
        [[1], [1, 2]],
        True,
        # numpy takes a day of what is longer than one
        "2026-11",
        ["2026-11-18", "2026"],
        np.array(["2026-11", "NaT"], "datetime64[M]"),
        [np.datetime64("2026-11-18", "W")],
        pd.Series(pd.period_range("2026-11", periods=2, freq="M")),
    ):
        assert days_of(bad) is None


@pytest.mark.parametrize(
    ("given", "day"),
    [
        ("2026-11-18", date(2026, 11, 18)),
        (datetime(2026, 11, 18, 5), date(2026, 11, 18)),
        ("2026-11-18T05:00", date(2026, 11, 18)),  # as `plan_day` takes it
        (np.datetime64("2026-11-18T05"), date(2026, 11, 18)),
        (np.datetime64(10**9, "D"), np.datetime64(10**9, "D")),
        (np.datetime64("2026-11"), np.datetime64("2026-11")),
        (3, 3),
    ],
)
def test_a_day_is_taken_from_a_text_or_a_time_and_the_rest_is_left(given, day):
    assert day_of("A harvest", given) == day


def test_a_text_that_is_no_day_is_refused():
    with pytest.raises(SettingError, match="A harvest must be a day as 2026-11-18, but it is 'soo"):
        day_of("A harvest", "soon")


def test_a_moment_is_the_day_on_the_plot_and_refused_where_none_is_known():
    late = datetime(2026, 11, 18, 23, 30, tzinfo=UTC)
    for said in (late, "2026-11-18T23:30+00:00"):
        assert day_in(said, lambda moment: moment + timedelta(hours=2)) == date(2026, 11, 19)
        with pytest.raises(SettingError, match="must be the plot's own, but 2026-11-18 23:30"):
            day_in(said)


class OfPolars(np.ndarray):
    """A column as polars has it: numpy would take it in UTC."""

    dtype = SimpleNamespace(time_zone="Asia/Jerusalem")


@pytest.mark.parametrize(
    "column",
    [
        pd.Series([AT]),
        pd.DatetimeIndex([AT]),
        pd.Series([AT]).astype("timestamp[us, tz=Asia/Jerusalem][pyarrow]"),
        pa.array([AT]),
        pa.chunked_array([[AT]]),
        np.array(["2026-11-29T23:30"], "datetime64[us]").view(OfPolars),
    ],
    ids=lambda column: type(column).__name__,
)
def test_columns_whose_type_names_a_zone_are_refused(column):
    for read in (days_of, seconds_of):
        with pytest.raises(ObservationError, match=r"Jerusalem.* names a zone"):
            read(column)


def test_arrow_columns_of_local_times_are_taken():
    local = pa.array([AT.replace(tzinfo=None)])
    assert days_of(local).tolist() == [AT.date()]
    assert seconds_of(pd.Series(local, dtype="timestamp[us][pyarrow]")).tolist() == [5400.0]
