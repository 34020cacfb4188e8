"""Today is the plot's, wherever the program runs."""

from datetime import UTC, date, datetime

import pytest
import tzfpy
from shapely import MultiPolygon, box

from fieldmon.plot import local_clock as clocks
from fieldmon.plot.field import Field
from fieldmon.plot.local_clock import LocalClock, local_clock


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
