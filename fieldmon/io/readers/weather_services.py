"""Weather services whose tables do not say all: their columns, units, zones and hours.

Sources, read in November 2026
------------------------------
- NASA POWER, power.larc.nasa.gov/docs: YEAR, MO, DY and HR of 0 to 23, in local solar time (LST)
  unless UTC was asked for, as a line above the table says; -999 is missing.
- DWD, opendata.dwd.de/climate_environment/CDC: MESS_DATUM as YYYYMMDDHH in UTC; TT_TU in °C, R1 in
  mm, F in m/s; -999 is missing.
- KNMI, daggegevens.knmi.nl: YYYYMMDD and HH of 1 to 24 in UT, hour 5 from 4 to 5; T in 0.1 °C, FH
  in 0.1 m/s, RH is rain in 0.1 mm and -1 less than 0.05 mm, U the humidity; DD 990 is variable.
- Open-Meteo, open-meteo.com/en/docs: two lines of the place above the table, with the seconds that
  its times are ahead of UTC.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from datetime import UTC, timedelta, timezone
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import ImportMessage, Remedy, guessed, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.values import numbers
from fieldmon.io.parse.weather_columns import WeatherColumn, weather_column

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping
    from datetime import tzinfo

    from fieldmon.compute.wording import Worded
    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.readers.weather_options import WeatherOptions

# warmer in degrees it is nowhere where these services measure
_SURELY_TENTHS = 60.0
_FARTHEST_ZONE_S = 14 * 3600
_TENTHS = {"c": "0.1c", "m/s": "0.1m/s", "mm": "0.1mm"}


@dataclass(frozen=True)
class WeatherService:
    """What a service's tables do not say themselves.

    Parameters
    ----------
    title
        Its name; empty: no service that is known.
    columns
        Plain name of a column -> what it measures, and in which unit.
    tenths
        Whether it gives temperatures, winds and rain in tenths.
    utc
        Whether its times are in UTC.
    hours_end
        Whether its hours are counted 1 to 24, each the one that ends then.
    solar
        Whether its times are local solar time unless it says UTC.
    """

    title: str = ""
    columns: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    tenths: bool = False
    utc: bool = False
    hours_end: bool = False
    solar: bool = False


NO_SERVICE = WeatherService()
_NASA = WeatherService(
    "NASA POWER",
    {
        "t2m": ("temperature_c", "c"), "t2mmin": ("low_c", "c"), "t2mmax": ("high_c", "c"),
        "rh2m": ("humidity_pct", "%"), "prectotcorr": ("rain_mm", "mm"),
        **dict.fromkeys(("ws2m", "ws10m"), ("wind_speed_m_s", "m/s")),
        **dict.fromkeys(("wd2m", "wd10m"), ("wind_from_deg", "")),
    },
    solar=True,
)  # fmt: skip
_DWD = WeatherService(
    "DWD",
    {
        **dict.fromkeys(("tttu", "tt10", "tmk"), ("temperature_c", "c")),
        "tnk": ("low_c", "c"), "txk": ("high_c", "c"),
        **dict.fromkeys(("rftu", "rf10", "upm"), ("humidity_pct", "%")),
        **dict.fromkeys(("r1", "rws10", "rsk"), ("rain_mm", "mm")),
        **dict.fromkeys(("f", "ff", "ff10", "fm"), ("wind_speed_m_s", "m/s")),
        **dict.fromkeys(("d", "dd", "dd10"), ("wind_from_deg", "")),
    },
    utc=True,
)  # fmt: skip
_KNMI = WeatherService(
    "KNMI",
    {
        **dict.fromkeys(("t", "tg"), ("temperature_c", "c")),
        "tn": ("low_c", "c"), "tx": ("high_c", "c"),
        **dict.fromkeys(("u", "ug"), ("humidity_pct", "%")),
        "rh": ("rain_mm", "mm"),
        **dict.fromkeys(("fh", "fg"), ("wind_speed_m_s", "m/s")),
        **dict.fromkeys(("dd", "ddvec"), ("wind_from_deg", "")),
    },
    tenths=True, utc=True, hours_end=True,
)  # fmt: skip
# by columns that all must be there
_TOLD_BY = (
    (frozenset({"year", "mo", "dy"}), _NASA),
    (frozenset({"year", "doy"}), _NASA),
    (frozenset({"messdatum"}), _DWD),
    (frozenset({"yyyymmdd", "hh"}), _KNMI),
    (frozenset({"yyyymmdd", "h"}), _KNMI),
    (frozenset({"yyyymmdd", "stn"}), _KNMI),
)


def service_of(layer: Layer) -> WeatherService:
    """Return the service that a table comes from, by its columns."""
    names = {plain(name) for name in layer.columns}
    return next((service for told_by, service in _TOLD_BY if told_by <= names), NO_SERVICE)


def columns_of_service(
    layer: Layer, names: Collection[str], service: WeatherService, options: WeatherOptions
) -> tuple[list[WeatherColumn], list[ImportMessage]]:
    """Return those of the columns `names` that a service has, in its units, and what to say.

    Raises
    ------
    ChoiceNeeded
        If nothing tells whether its temperatures are in tenths.
    """
    found: dict[str, WeatherColumn] = {}
    for name in names:
        measure, unit = service.columns.get(plain(name), ("", ""))
        own = weather_column(name)
        # who wrote a unit changed the table, and knows it
        if measure and not (own and own.unit):
            found.setdefault(measure, WeatherColumn(name, measure, unit))
    columns = list(found.values())
    if not service.tenths or not columns:
        return columns, []
    in_tenths, said = _in_tenths(layer, columns, options)
    if in_tenths is None:
        return [one._replace(unit="") for one in columns], said
    units = _TENTHS if in_tenths else {}
    return [one._replace(unit=units.get(one.unit, one.unit)) for one in columns], said


def _in_tenths(
    layer: Layer, columns: list[WeatherColumn], options: WeatherOptions
) -> tuple[bool | None, list[ImportMessage]]:
    """Return whether values are in tenths, None where they are none; ask if nothing tells it."""
    told = options.unit("temperature")
    if told:
        return told.startswith("0.1"), []
    if re.search(r"\b0[.,]1\b", layer.above):
        return True, []
    warm = [one for one in columns if one.unit == "c"]
    if not warm:
        return None, []
    values = np.concatenate([numbers(layer.columns[one.name], options.decimal) for one in warm])
    values = values[np.isfinite(values) & (np.abs(values) < 999)]
    if (values % 1).any():
        return None, []
    if len(values) and np.abs(values).max() > _SURELY_TENTHS:
        said = worded(
            "{name} goes up to {most:g}; read as tenths, as KNMI gives them.",
            name=warm[0].name,
            most=float(np.abs(values).max()),
        )
        remedy = Remedy("temperature_unit", "C", worded("Read as Celsius"))
        return True, [guessed(said, None, remedy)]
    raise ChoiceNeeded(
        worded(
            "{name} has no unit, and KNMI gives tenths of a degree. Is it in tenths or degrees?",
            name=warm[0].name,
        ),
        "temperature_unit",
        ("0.1 C", "C"),
    )


def told_zone(layer: Layer, service: WeatherService) -> tuple[tzinfo | None, list[ImportMessage]]:
    """Return the zone of a service's times where it or the lines above a table tell it."""
    if service.utc:
        return UTC, [seen(worded("Times are in UTC, as {title} gives them.", title=service.title))]
    if service.solar:
        return _of_nasa(layer.above)
    ahead_s = _seconds_ahead(layer.above)
    if ahead_s is None:
        return None, []
    zone = timezone(timedelta(seconds=ahead_s))
    return zone, [_said_above(zone.tzname(None))]


def _said_above(zone: str) -> ImportMessage:
    return seen(worded("Times are in {zone}, as the lines above the table say.", zone=zone))


def _of_nasa(above: str) -> tuple[tzinfo | None, list[ImportMessage]]:
    """Return the zone that NASA POWER says; solar time is that of the longitude, in whole hours."""
    if re.search(r"\bin UTC\b", above):
        return UTC, [_said_above("UTC")]
    place = re.search(r"longitude\s*([-+]?\d+(?:\.\d+)?)", above, re.IGNORECASE)
    if not re.search(r"\bin LST\b", above) or place is None or abs(float(place[1])) > 180.0:
        return None, []
    hours = round(float(place[1]) / 15.0)
    zone = timezone(timedelta(hours=hours))
    return zone, [seen(read_as_lst(zone))]


def read_as_lst(zone: timezone) -> Worded:
    """Return that times are local solar or standard time, which both are called LST."""
    return worded("Times are local time without summer time (LST), read as {zone}.",
                  zone=zone.tzname(None))  # fmt: skip


def _seconds_ahead(above: str) -> int | None:
    """Return how many seconds times are ahead of UTC, as Open-Meteo writes it above its table."""
    lines = [line.split(",") for line in above.splitlines()[:2]]
    if len(lines) < 2:
        return None
    facts = {name.strip(): value.strip() for name, value in zip(*lines, strict=False)}
    told = facts.get("utc_offset_seconds", "")
    ahead_s = int(told) if re.fullmatch(r"-?\d{1,5}", told) else None
    return ahead_s if ahead_s is not None and abs(ahead_s) <= _FARTHEST_ZONE_S else None
