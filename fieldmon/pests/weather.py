"""The weather of a place: what a station measured, and what was forecast."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from datetime import date, datetime
from functools import cached_property
from typing import TYPE_CHECKING, Any
from zoneinfo import ZoneInfo

import numpy as np

from fieldmon.compute.arguments import must_be_zone
from fieldmon.compute.array_arguments import entries_of
from fieldmon.compute.arrays import read_only
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Times = NDArray[np.datetime64]

HOUR_S, DAY_S = 3_600, 86_400
#: what can be measured, and between which values it can be on earth
MEASURED = {
    "temperature_c": (-70.0, 60.0),
    "low_c": (-70.0, 60.0),
    "high_c": (-70.0, 60.0),
    "wind_speed_m_s": (0.0, 100.0),
    "wind_from_deg": (0.0, 360.0),
    "rain_mm": (0.0, 2_000.0),
    "humidity_pct": (0.0, 100.0),
}


@checked
@dataclass(frozen=True, eq=False)
class Weather:
    """Hours or days of weather, one entry each, in the order of time; NaN: not measured.

    What no place on earth has is refused, for it is in another unit.

    Parameters
    ----------
    at
        ``(n,)`` datetime64[s], UTC: when each local hour or day begins.
    step_s
        3 600 or 86 400.
    temperature_c
        ``(n,)`` the mean.
    low_c, high_c
        ``(n,)`` the extremes; of hours often not measured.
    wind_speed_m_s, wind_from_deg
        ``(n,)`` the mean wind, and where it comes from: 0 north, 90 east.
    rain_mm, humidity_pct
        ``(n,)`` the sum of rain, the mean relative humidity. The humidity is kept, but not used.
    forecast
        ``(n,)`` whether it was forecast rather than measured.
    zone
        Name of the place's time zone, by which days begin; empty: UTC.

    Raises
    ------
    SettingError
        If columns differ in length, a step is neither of the two, there is no such zone, a time is
        missing or said twice, or a value is none on earth.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> with open("station.csv", "w") as file:
    ...     print("Date,Tmin (C),Tmax (C)", file=file)
    ...     print("2025-11-18,10,20", file=file)
    >>> weather = fm.read_weather("station.csv", plot)
    >>> weather.low_c.tolist(), weather.high_c.tolist(), weather.hourly
    ([10.0], [20.0], False)
    """

    at: Times
    step_s: int
    temperature_c: Floats
    low_c: Floats
    high_c: Floats
    wind_speed_m_s: Floats
    wind_from_deg: Floats
    rain_mm: Floats
    humidity_pct: Floats
    forecast: NDArray[np.bool_]
    zone: str = ""

    def __post_init__(self) -> None:
        must_hold_kinds(self, "Weather's")
        for each in fields(self):
            value = getattr(self, each.name)
            if isinstance(value, np.ndarray):
                if value.shape != (len(self.at),):
                    raise SettingError(
                        worded(
                            "Weather must have one {name} for each of its {n} times, but it has "
                            "{n_2}.",
                            name=each.name,
                            n=len(self.at),
                            n_2=value.size,
                        )
                    )
                object.__setattr__(self, each.name, read_only(value.copy()))
        if self.step_s not in (HOUR_S, DAY_S):
            raise SettingError(
                worded(
                    "Weather must be by hours or days, but a step is {step_s} s.",
                    step_s=self.step_s,
                )
            )
        must_be_zone("Weather's zone", self.zone)
        self._must_have_times()
        self._must_be_possible()

    def _must_have_times(self) -> None:
        """Raise `SettingError` where a time is missing, or said of two entries."""
        if n := int(np.isnat(self.at).sum()):
            raise SettingError(
                worded(
                    "Weather must say of each entry when it begins, but of {n} of {all} it does "
                    "not. Leave those out.",
                    n=n,
                    all=len(self),
                )
            )
        in_order = np.sort(self.at)
        if (twice := in_order[1:] == in_order[:-1]).any():
            raise SettingError(
                worded(
                    "Weather must have one entry of each time, but there are {n} of {at}. Keep "
                    "one of them.",
                    n=int(np.count_nonzero(self.at == in_order[1:][twice][0])),
                    at=in_order[1:][twice][0],
                )
            )

    def _must_be_possible(self) -> None:
        """Raise `SettingError` where no place has such weather: it is in another unit."""
        for name, (low, high) in MEASURED.items():
            values = getattr(self, name)
            wrong = (values < low) | (values > high)
            if wrong.any():
                k = int(wrong.argmax())
                raise SettingError(
                    worded(
                        "Weather's {name} must be from {low:g} to {high:g}, but at {at} it is "
                        "{value:g}. Give it in the unit in which its name ends.",
                        name=name,
                        low=low,
                        high=high,
                        at=self.at[k],
                        value=float(values[k]),
                    )
                )
        if (wrong := self.low_c > self.high_c).any():
            k = int(wrong.argmax())
            raise SettingError(
                worded(
                    "Weather's low_c must not be above its high_c, but at {at} they are {low:g} "
                    "and {high:g}.",
                    at=self.at[k],
                    low=float(self.low_c[k]),
                    high=float(self.high_c[k]),
                )
            )

    def __len__(self) -> int:
        return len(self.at)

    def __repr__(self) -> str:
        if not len(self):
            return "Weather(nothing)"
        kind = "hours" if self.hourly else "days"
        return f"Weather({len(self)} {kind} from {self.at[0]} UTC)"

    @property
    def hourly(self) -> bool:
        """Return whether entries are hours."""
        return self.step_s == HOUR_S

    @property
    def gaps(self) -> int:
        """Return how many hours or days between the first and the last have no temperature."""
        known = self.at[~np.isnan(self.temperature_c)]
        if not len(known):
            return 0
        between = int((known[-1] - known[0]) / np.timedelta64(1, "s")) / self.step_s
        return max(round(between) + 1 - len(known), 0)

    def between(self, first: np.datetime64, end: np.datetime64) -> Weather:
        """Return what begins at `first` or later and before `end`, both UTC."""
        return self.chosen((self.at >= first) & (self.at < end))

    def chosen(self, which: NDArray[np.bool_]) -> Weather:
        """Return the entries of the mask `which` ``(n,)``; raise `SettingError` if it is none."""
        picked = entries_of("Entries of weather", which, len(self))
        parts: dict[str, Any] = {
            each.name: getattr(self, each.name)[picked]
            for each in fields(self)
            if isinstance(getattr(self, each.name), np.ndarray)
        }
        return replace(self, **parts)

    def local_days(self) -> NDArray[np.datetime64]:
        """Return the local date on which each entry begins, ``(n,)`` datetime64[D]."""
        return self._local_days

    @cached_property
    def _local_days(self) -> NDArray[np.datetime64]:
        # a year of hours takes a hundredth of a second, and is asked for again and again
        if not self.zone:
            return self.at.astype("datetime64[D]")
        zone = ZoneInfo(self.zone)
        seconds = self.at.astype("datetime64[s]").astype(np.int64)
        days = [datetime.fromtimestamp(int(one), zone).date() for one in seconds]
        return read_only(np.array(days, "datetime64[D]"))

    def by_day(self) -> Iterator[tuple[date, Weather]]:
        """Yield each local date and what there is of it."""
        days = self.local_days()
        for day in np.unique(days):
            yield day.astype(date), self.chosen(days == day)


def weather_of(at: Times, step_s: int, zone: str = "", **measured: Floats) -> Weather:
    """Return weather of what was measured; the rest is NaN, and nothing of it forecast.

    Parameters
    ----------
    at, step_s, zone
        As `Weather` has them.
    measured
        Some of `MEASURED`, ``(n,)`` each, and ``forecast``.

    Examples
    --------
    >>> import numpy as np
    >>> days = np.arange("2026-11-01", "2026-11-04", dtype="datetime64[D]").astype("datetime64[s]")
    >>> weather_of(days, 86_400, low_c=np.array([9.0, 8, 7]), high_c=np.array([21.0, 22, 23]))
    Weather(3 days from 2026-11-01T00:00:00 UTC)
    """
    n = len(at)
    given = {name: np.asarray(measured.get(name, np.full(n, np.nan)), float) for name in MEASURED}
    if np.isnan(given["temperature_c"]).all():
        given["temperature_c"] = (given["low_c"] + given["high_c"]) / 2
    forecast = np.asarray(measured.get("forecast", np.zeros(n)), bool)
    return Weather(at.astype("datetime64[s]"), step_s, forecast=forecast, zone=zone, **given)
