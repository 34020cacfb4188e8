"""Several stations in one table are asked for, not mixed."""

import pytest

from fieldmon.errors import ChoiceNeeded
from fieldmon.io.readers.weather_options import WeatherOptions


def table(head, *of, hours=range(24), more=""):
    """Return a table of some names and minutes, station by station, B ten degrees warmer."""
    rows = [
        f"{name},2026-11-18 {h:02d}:{minute:02d},{h + 10 * (name == 'B')}{more}\n"
        for name, minute in of
        for h in hours
    ]
    return f"{head},time,temp (C){',extra' * bool(more)}\n{''.join(rows)}"


@pytest.mark.parametrize("minutes", [(0, 0), (0, 30), (0, 7)])
@pytest.mark.parametrize("head", ["station", "Sensor", "Logger ID"])
def test_stations_side_by_side_are_asked_for_whatever_their_minutes(read_weather, head, minutes):
    both = table(head, *zip("AB", minutes, strict=True))
    with pytest.raises(ChoiceNeeded, match=r"2 stations \(A, B\)") as asked:
        read_weather(both)
    assert (asked.value.option, asked.value.choices) == ("where", (f"{head}=A", f"{head}=B"))
    told = read_weather(both, WeatherOptions(zone="UTC", where=f"{head}=B")).value
    assert told.temperature_c.tolist() == list(range(10, 34))


def test_a_column_of_any_name_that_tells_apart_times_that_stand_twice_is_asked_for(read_weather):
    both = table("No,Corner", ("1,A", 0), ("2,B", 0))
    with pytest.raises(ChoiceNeeded, match=r"told apart by Corner \(A, B\)") as asked:
        read_weather(both)
    assert asked.value.choices == ("Corner=A", "Corner=B")


@pytest.mark.parametrize(
    "text",
    [
        # a station that got another name
        table("station", ("A", 0), hours=range(12))
        + table("station", ("A2", 0), hours=range(12, 24)).split("\n", 1)[1],
        # one that has none on some lines
        table("station", ("A", 0), ("", 30)),
        # a remark on a few double lines
        table("Remark", ("ok", 0)) + "again,2026-11-18 23:00,23\n",
        # the same lines twice
        table("Corner", ("A", 0), ("A", 0)),
        # what was forecast, and measured later
        table("Forecast", ("yes", 0), ("no", 0)),
        # what the logger itself measured
        "time,temp (C),Logger (V)\n"
        + "".join(f"2026-11-18 {h:02d}:00,{h},{12 + h / 7:.2f}\n" for h in range(24)),
    ],
)
def test_one_station_is_not_asked_for(read_weather, text):
    weather = read_weather(text).value
    assert weather.temperature_c.tolist() == list(range(24))
