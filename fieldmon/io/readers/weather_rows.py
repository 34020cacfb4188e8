"""From measurements at any times to weather by the hour or by the day."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime, tzinfo
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted, worded
from fieldmon.errors import FileProblem
from fieldmon.io.import_report import ImportMessage, dropped, repaired, seen
from fieldmon.pests.weather import DAY_S, HOUR_S, MEASURED, Weather, weather_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.pests.weather import Floats, Times

# 23 to 25 hours are a day where clocks change
_LEAST_DAY_S = 20 * HOUR_S


@dataclass(frozen=True, eq=False)
class WeatherRows:
    """Measurements as a file has them, in our units.

    Parameters
    ----------
    at
        ``(n,)`` datetime64[s], UTC; NaT where there is no time.
    measured
        ``(n,)`` each, some of `MEASURED`.
    forecast
        ``(n,)`` whether the file says that it was forecast.
    zone
        The place's time zone, by which days begin.
    zone_name
        Its name.
    """

    at: Times
    measured: dict[str, Floats]
    forecast: NDArray[np.bool_]
    zone: tzinfo
    zone_name: str = ""

    def chosen(self, which: NDArray[np.generic]) -> WeatherRows:
        """Return some of the rows, by mask or indices."""
        measured = {name: values[which] for name, values in self.measured.items()}
        return WeatherRows(
            self.at[which], measured, self.forecast[which], self.zone, self.zone_name
        )

    def gathered(self, name: str, now: datetime | None) -> tuple[Weather, list[ImportMessage]]:
        """Return the weather by the hour or day, and what was done to come there.

        Parameters
        ----------
        name
            The file's, for sentences.
        now
            What begins later was forecast; None: only what the file says was.
        """
        rows, messages = self._in_order()
        if not len(rows.at):
            raise FileProblem(
                worded("{name} must hold weather with its times, but holds none.", name=name)
            )
        steps = np.diff(rows.at).astype(np.int64)
        step = float(np.median(steps)) if len(steps) else DAY_S
        by_day = step > HOUR_S
        if HOUR_S < step < _LEAST_DAY_S:
            said = worded("Measured every {hours:g} h: gathered into days.", hours=step / HOUR_S)
            messages.append(repaired(said))
        elif step < HOUR_S:
            said = worded(
                "Measured every {minutes:g} {minutes:minute|minutes}: gathered into hours.",
                minutes=step / 60,
            )
            messages.append(seen(said))
        weather = rows.binned(by_day=by_day, now=now)
        return weather, [*messages, *_about_gaps(weather), *_about_forecast(weather)]

    def _in_order(self) -> tuple[WeatherRows, list[ImportMessage]]:
        messages = []
        timed = ~np.isnat(self.at)
        if not timed.all():
            n = int(np.count_nonzero(~timed))
            messages.append(
                dropped(worded("{n} {n:line|lines} without a time {n:was|were} left out.", n=n))
            )
        rows = self.chosen(np.flatnonzero(timed))
        # of one time, what was measured comes last
        rows = rows.chosen(np.lexsort((~rows.forecast, rows.at)))
        again = np.zeros(len(rows.at), bool)
        again[:-1] = rows.at[1:] == rows.at[:-1]
        if n_again := int(np.count_nonzero(again)):
            said = worded(
                "{n} {n:time stands|times stand} twice; the last of each was taken, measured "
                "rather than forecast.",
                n=n_again,
            )
            messages.append(dropped(said))
            rows = rows.chosen(np.flatnonzero(~again))
        return rows, messages

    def binned(self, *, by_day: bool, now: datetime | None) -> Weather:
        """Return these rows, in order of time, gathered into local hours or days."""
        begins = self._local_midnights() if by_day else self._local_hours()
        at, first = np.unique(begins.astype("datetime64[s]"), return_index=True)
        ends = np.append(first[1:], len(begins))
        bins = [slice(int(a), int(b)) for a, b in zip(first, ends, strict=True)]
        made = {name: np.array([self._of(name, one) for one in bins]) for name in MEASURED}
        alone = not by_day and len(bins) == len(begins)
        if alone:
            # one measurement has no extremes
            for name in ("low_c", "high_c"):
                made[name] = self.measured.get(name, np.full(len(at), np.nan))
        made["forecast"] = np.array([bool(self.forecast[one].any()) for one in bins], float)
        if now is not None:
            moment = now if now.tzinfo else now.replace(tzinfo=self.zone)
            later = np.datetime64(int(moment.timestamp()), "s")
            made["forecast"] = np.maximum(made["forecast"], (at > later).astype(float))
        return weather_of(at, DAY_S if by_day else HOUR_S, self.zone_name, **made)

    def _of(self, name: str, rows: slice) -> float:
        """Return what some rows measured of something: a sum of rain, a mean, an extreme."""
        if name in {"low_c", "high_c"}:
            return self._extreme(name, rows)
        if name == "wind_from_deg":
            return self._wind_from(rows)
        values = self.measured.get(name, np.empty(0))[rows]
        values = values[~np.isnan(values)]
        if not len(values):
            return float("nan")
        return float(values.sum() if name == "rain_mm" else values.mean())

    def _extreme(self, name: str, rows: slice) -> float:
        """Return the low or high of some rows: their own, or that of several temperatures."""
        stated = self.measured.get(name)
        values = self.measured.get("temperature_c", np.empty(0))[rows]
        if stated is not None and not np.isnan(stated[rows]).all():
            values = stated[rows]
        elif rows.stop - rows.start == 1:
            return float("nan")
        values = values[~np.isnan(values)]
        if not len(values):
            return float("nan")
        return float(values.min() if name == "low_c" else values.max())

    def _wind_from(self, rows: slice) -> float:
        """Return where the wind came from, the mean of its vectors."""
        if "wind_from_deg" not in self.measured:
            return float("nan")
        angle = np.radians(self.measured["wind_from_deg"][rows])
        speed = self.measured.get("wind_speed_m_s", np.ones(len(self.at)))[rows]
        known = ~np.isnan(angle) & ~np.isnan(speed)
        if not known.any():
            return float("nan")
        x, y = (np.sum(speed * f(angle), where=known) for f in (np.sin, np.cos))
        # a hair west of north is north, not 360
        turned = round(float(np.degrees(np.arctan2(x, y))), 3) % 360.0
        return turned if np.hypot(x, y) > 1e-9 else float("nan")

    def _local_hours(self) -> Times:
        """Return when the local hour of each row begins, UTC; in India at half past."""
        seconds = self.at.astype(np.int64)
        clocks = [datetime.fromtimestamp(one, self.zone) for one in seconds.tolist()]
        since_s = np.array([60 * clock.minute + clock.second for clock in clocks], np.int64)
        return (seconds - since_s).astype("datetime64[s]")

    def _local_midnights(self) -> Times:
        """Return when the local day of each row begins, UTC."""
        made: dict[object, int] = {}
        seconds = []
        at = self.at.astype(np.int64)
        # a day that is stated as UTC midnight is that day all the same, west of Greenwich too
        zone = self.zone if (at % DAY_S).any() else UTC
        for one in at.tolist():
            day = datetime.fromtimestamp(one, zone).date()
            if day not in made:
                midnight = datetime(day.year, day.month, day.day, tzinfo=self.zone)
                made[day] = int(midnight.timestamp())
            seconds.append(made[day])
        return np.array(seconds, "datetime64[s]")


def utc_times(local: Times, zone: tzinfo) -> Times:
    """Return local times ``(n,)`` as UTC; where clocks go back, an hour that comes again is later.

    Where the newest stand first, it is earlier.

    Parameters
    ----------
    local
        datetime64[s] without a zone, NaT where unknown.
    zone
        Where they were read.
    """
    seen_before: set[datetime] = set()
    made = np.full(len(local), "NaT", "datetime64[s]")
    timed = np.flatnonzero(~np.isnat(local))
    newest_first = len(timed) > 0 and local[timed[0]] > local[timed[-1]]
    for i in timed[::-1] if newest_first else timed:
        one = local[i].astype("datetime64[s]")
        naive: datetime = one.astype(datetime)
        moment = naive.replace(tzinfo=zone, fold=int(naive in seen_before))
        seen_before.add(naive)
        made[i] = np.datetime64(int(moment.timestamp()), "s")
    return made


def _about_gaps(weather: Weather) -> list[ImportMessage]:
    if not (n := weather.gaps):
        return []
    known = weather.at[~np.isnan(weather.temperature_c)]
    jumps = np.diff(known).astype(np.int64)
    at = int(np.argmax(jumps))
    longest = round(int(jumps[at]) / weather.step_s) - 1
    said = worded(
        "{n} without a temperature; the longest gap, {longest}, begins after {after} UTC.",
        n=_so_many(n, weather),
        longest=_so_many(longest, weather),
        after=str(known[at]).replace("T", " ")[:16],
    )
    return [dropped(said)]


def _about_forecast(weather: Weather) -> list[ImportMessage]:
    n = int(np.count_nonzero(weather.forecast))
    if not n:
        return []
    return [seen(worded("{n} are taken as forecast.", n=_so_many(n, weather)))]


def _so_many(n: int, weather: Weather) -> Worded:
    """Return so many hours or days in words."""
    return counted(n, "hour") if weather.hourly else counted(n, "day")
