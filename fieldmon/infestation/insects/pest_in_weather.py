"""What a pest does in a day's weather: how warm it is, how much moves, where the wind goes."""

from __future__ import annotations

from dataclasses import dataclass, fields
from datetime import date, datetime, timedelta
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple
from zoneinfo import ZoneInfo

import numpy as np

from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.infestation.insects.kernels import DistanceKernel
from fieldmon.infestation.insects.spread import Spread
from fieldmon.pests.degree_days import Thresholds, degree_days_of_hours
from fieldmon.pests.pest import seen_by_pest
from fieldmon.pests.usual_days import LEAST_HOURS, UsualDays
from fieldmon.pests.weather import HOUR_S

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.pests.pest import Movement, Pest
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.projection import Frame
    from fieldmon.plot.robot import Robot

    Floats = NDArray[np.float64]

_HOURS = 24
# a day is warmest at three in the afternoon, coldest at three at night
_WARMEST = 15.0
# temperature of a pest that no weather and no figure of its own gives one (our choice)
_MILD_C = 20.0
# winds are told apart by metres a second, so that a few kernels serve a season
_WIND_STEP_M_S = 0.5
# a two-dimensional Cauchy jump's median, over its scale
_CAUCHY_MEDIAN = 3.0**0.5
# without weather no day differs from another
_NO_DAY = date(2026, 1, 1)
# a chance of 1 would be an endless rate
_MOST = 1.0 - 1e-9


class Spell(NamedTuple):
    """Some hours of a pest: an hour, or a night and its day.

    Parameters
    ----------
    days
        How long, in days.
    warmth
        Degree-days for each of the pest's stages.
    sends
        Infestations that an infested plant sends out; of an adjacent kernel, to each plant next
        to it.
    wind_m_s
        Where the wind goes, along the rows (x) and across them (y), in metres a second.
    """

    days: float
    warmth: tuple[float, ...]
    sends: float
    wind_m_s: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class PestSpread(Spread):
    """A night's spread as a chance map takes it, of a pest in its weather.

    Parameters
    ----------
    movement
        How the pest comes from plant to plant; None: as `Spread` says.
    sends
        Infestations that an infested plant sends out by its kernel in this night.
    wind_m_s
        Where the wind goes, along the rows and across them, in metres a second.
    days
        How long the night and its day are.
    warmth
        Degree-days for each stage of the pest.
    edge_per_day
        Chance that a plant at the plot's edge is infested from there.
    mortality_per_day
        Chance that a plant's infestation ends of itself.
    """

    movement: Movement | None = None
    sends: float = 0.0
    wind_m_s: tuple[float, float] = (0.0, 0.0)
    days: float = 1.0
    warmth: tuple[float, ...] = ()
    edge_per_day: float = 0.0
    mortality_per_day: float = 0.0


class DayWeather(NamedTuple):
    """A local day, by its hours, ``(24,)`` each; NaN: nobody knows.

    Parameters
    ----------
    temperature_c, rain_mm
        Of each hour.
    east_m_s, north_m_s
        Where the wind goes.
    """

    temperature_c: Floats
    rain_mm: Floats
    east_m_s: Floats
    north_m_s: Floats

    @classmethod
    def unknown(cls) -> DayWeather:
        """Return a day of which nothing is known."""
        return cls(*(np.full(_HOURS, np.nan) for _ in range(4)))


@checked
@dataclass(frozen=True, eq=False)
class PestInWeather:
    """A pest and the weather of the place, day by day.

    Parameters
    ----------
    pest
        The pest.
    weather
        What was measured and forecast; None: every day is as the pest's figures hold.
    begins
        The date of day 0. It must be given where there is weather.

    Raises
    ------
    SettingError
        If there is weather and no date, or one is of another kind.

    Examples
    --------
    >>> import fieldmon as fm
    >>> mite = fm.PestInWeather(fm.read_pest("spider-mite"))
    >>> settings = fm.SimulationSettings(n_days=5, pest=mite)
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> start = fm.draw_start(plot, fm.plan_day(plot, on="2026-11-18").chance)
    >>> robot = mite.pest.seen_by(fm.Robot())
    >>> fm.simulate(plot, start, "naive", robot=robot, settings=settings).left.shape
    (5,)
    """

    pest: Pest
    weather: Weather | None = None
    begins: date = _NO_DAY

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A pest's")
        if self.weather is not None and self.begins is _NO_DAY:
            raise SettingError(
                worded(
                    "A pest in its weather must begin on a day, but none is given. Give "
                    "begins=date(2026, 11, 18)."
                )
            )

    @property
    def content(self) -> tuple[object, ...]:
        """Return what tells a pest in its weather from any other, for a digest."""
        of = self.weather
        # `vars` would have what is cached too, and change with whoever looks
        weather = () if of is None else (getattr(of, one.name) for one in fields(of))
        return (self.pest, str(self.begins), *weather)

    def day(self, number: int) -> DayWeather:
        """Return the weather of the day of a `number`: of its date, or the usual of it."""
        on = self.begins + timedelta(days=number)
        known = self._known.get(on)
        if known is None:
            return self.usual(on)
        unknown = np.isnan(known.temperature_c)
        if not unknown.any():
            return known
        warm = np.where(unknown, self.usual(on).temperature_c, known.temperature_c)
        return known._replace(temperature_c=_filled(warm))

    def known(self, number: int) -> bool:
        """Tell whether the weather of the day of a `number` was measured or forecast."""
        return self.begins + timedelta(days=number) in self._known

    def measured(self, number: int) -> bool:
        """Tell whether all that is known of the weather of the day of a `number` was measured."""
        return self.known(number) and self.begins + timedelta(days=number) not in self._forecast

    def usual(self, on: date) -> DayWeather:
        """Return the mean of the days that stand for one without weather, `on` a date."""
        days, usual = self._usual
        if not days:
            return DayWeather.unknown()
        stand_ins = usual.of(np.datetime64(on, "D"))
        return _mean([days[one] for one in stand_ins.which], stand_ins.weight)

    def night(self, number: int, frame: Frame) -> Spell:
        """Return the day of a `number` and its night as one spell, on a plot of this `frame`."""
        return self._spell(self.day(number), range(_HOURS), frame)

    def hours(self, number: int, frame: Frame, starts: int = 6) -> list[Spell]:
        """Return the 24 hours from that at which work `starts` on the day of a `number`.

        The wind is told by the plot's `frame`.
        """
        today, tomorrow = self.day(number), self.day(number + 1)
        return [
            self._spell(today if hour >= starts else tomorrow, [hour], frame)
            for hour in [*range(starts, _HOURS), *range(starts)]
        ]

    def spread(self, number: int, frame: Frame) -> PestSpread:
        """Return what a chance map takes the night after the day of a `number` to be.

        The wind is told by the plot's `frame`.
        """
        spell, pest = self.night(number, frame), self.pest
        adjacent = pest.movement.kernel == "adjacent"
        entry = pest.entry
        return PestSpread(
            rate_per_day=float(-np.expm1(-spell.sends)) if adjacent else 0.0,
            to="each",
            arrivals_per_day=entry.anywhere_per_day,
            movement=None if adjacent else pest.movement,
            sends=spell.sends,
            wind_m_s=spell.wind_m_s,
            days=spell.days,
            warmth=spell.warmth,
            edge_per_day=entry.edge_per_day,
            mortality_per_day=pest.mortality_per_day,
        )

    def _spell(self, day: DayWeather, hours: Sequence[int], frame: Frame) -> Spell:
        """Return some hours of a day as one spell."""
        pest, of = self.pest, list(hours)
        temperature = _temperature(day, pest)[of]
        moves = hours_of_movement(pest.movement)[of] * _rains(day, pest, of)
        rate = _rate(pest, temperature)
        weight = moves / moves.sum() if moves.sum() > 0.0 else moves
        east, north = (
            float(np.nan_to_num(wind[of]) @ weight) for wind in (day.east_m_s, day.north_m_s)
        )
        still = pest.movement.wind == "none"
        return Spell(
            days=len(of) / _HOURS,
            warmth=warmth(pest, temperature),
            sends=float(rate @ moves),
            wind_m_s=(0.0, 0.0) if still else along_rows(east, north, frame),
        )

    @cached_property
    def _known(self) -> dict[date, DayWeather]:
        """Every local day of the weather, in order."""
        return {} if self.weather is None else _days(self.weather)

    @cached_property
    def _forecast(self) -> set[date]:
        """Local days of which some weather was forecast."""
        if self.weather is None:
            return set()
        return set(self.weather.local_days()[self.weather.forecast].astype(object).tolist())

    @cached_property
    def _usual(self) -> tuple[list[DayWeather], UsualDays]:
        """Return the days whose warmth is known, all of them if that of none is."""
        warm = {on: day for on, day in self._known.items() if not np.isnan(day.temperature_c).any()}
        days = warm or self._known
        return list(days.values()), UsualDays(np.array(list(days), "datetime64[D]"))


def seen_in_weather(robot: Robot, known: PestInWeather | None) -> Robot:
    """Return the robot with the chance of detection of the pest that is known, if one is."""
    return robot if known is None else seen_by_pest(robot, known.pest)


def hours_of_movement(movement: Movement) -> Floats:
    """Return the share of a day's movement in each hour, ``(24,)``; they sum to 1."""
    first, end = movement.hours
    length = (end - first) % _HOURS or _HOURS
    hour = np.arange(_HOURS)
    share: Floats = np.zeros(_HOURS)
    for turn in (0, _HOURS):  # past midnight
        low = np.maximum(hour + turn, first)
        share += np.clip(np.minimum(hour + turn + 1, first + length) - low, 0.0, 1.0)
    part: Floats = share / share.sum()
    return part


def warmth(pest: Pest, temperature_c: Floats) -> tuple[float, ...]:
    """Return the degree-days that hours of a temperature ``(h,)`` bring each of a pest's stages."""
    return tuple(
        float(
            degree_days_of_hours(
                temperature_c, Thresholds(stage.threshold_c, stage.upper_c, pest.cutoff)
            ).sum()
        )
        for stage in pest.stages
    )


def kernel_of(movement: Movement) -> DistanceKernel:
    """Return the kernel of a movement that goes farther than the plants next to it."""
    reach_m = 1.0 if movement.reach_m is None else movement.reach_m
    cauchy = movement.kernel == "cauchy"
    return DistanceKernel(
        "cauchy" if cauchy else "exponential",
        reach_m / _CAUCHY_MEDIAN if cauchy else reach_m,
        1.0 / movement.along_over_across,
        movement.share_of_long_jumps,
    )


def along_rows(east: float, north: float, frame: Frame) -> tuple[float, float]:
    """Return a wind along the rows and across them, to half a metre a second."""
    bearing = np.deg2rad(frame.bearing_deg)
    along = east * np.sin(bearing) + north * np.cos(bearing)
    across = -east * np.cos(bearing) + north * np.sin(bearing)
    steps = np.rint(np.array([along, across]) / _WIND_STEP_M_S) * _WIND_STEP_M_S + 0.0
    return float(steps[0]), float(steps[1])


def _rate(pest: Pest, temperature: Floats) -> Floats:
    """Return what an infested plant sends out a day at each temperature."""
    rate = pest.infests_per_day(temperature)
    if pest.movement.kernel == "adjacent":
        return -np.log1p(-np.minimum(rate, _MOST))
    return rate


def _temperature(day: DayWeather, pest: Pest) -> Floats:
    """Return the temperature of each hour; where nobody knows it, that of the pest's figures."""
    at = pest.movement.at_c
    return np.where(np.isnan(day.temperature_c), _MILD_C if at is None else at, day.temperature_c)


def _rains(day: DayWeather, pest: Pest, hours: list[int]) -> NDArray[np.bool_]:
    """Tell whether it rains enough for the pest in each hour, or in all of the day."""
    least = pest.movement.least_rain_mm
    rain = day.rain_mm[hours] if pest.movement.by_hour else np.full(len(hours), day.rain_mm.sum())
    # where nobody measured rain nothing is held back for want of it
    enough: NDArray[np.bool_] = np.isnan(rain) | (rain >= least)
    return enough


def _days(weather: Weather) -> dict[date, DayWeather]:
    """Return a station's rows by local day and hour."""
    # from where the wind comes, the other way round
    to = np.deg2rad(weather.wind_from_deg + 180.0)
    east, north = weather.wind_speed_m_s * np.sin(to), weather.wind_speed_m_s * np.cos(to)
    dates = weather.local_days()
    made: dict[date, DayWeather] = {}
    for on in dates.astype(object).tolist():
        made.setdefault(on, DayWeather.unknown())
    if weather.hourly:
        _put_hours(list(made.values()), weather, east, north)
        return made
    for k, day in enumerate(made[on] for on in dates.astype(object).tolist()):
        day.temperature_c[:] = _curve(weather, k)
        day.rain_mm[:], day.east_m_s[:], day.north_m_s[:] = (
            weather.rain_mm[k] / _HOURS, east[k], north[k],
        )  # fmt: skip
    return made


def _put_hours(days: list[DayWeather], weather: Weather, east: Floats, north: Floats) -> None:
    """Put hours into their local days, in place; where clocks change one comes twice or never."""
    dates = weather.local_days()
    _, of_day = np.unique(dates, return_inverse=True)
    at = _HOURS * of_day + _local_hours(weather)
    columns = weather.temperature_c, weather.rain_mm, east, north
    for name, values in zip(DayWeather._fields, columns, strict=True):
        known = ~np.isnan(values)
        n = np.bincount(at[known], minlength=_HOURS * len(days))
        total = np.bincount(at[known], values[known], minlength=len(n))
        # rain of the hour that comes twice in autumn is the sum of both
        each = np.where(n > 0, total / (1 if name == "rain_mm" else np.maximum(n, 1)), np.nan)
        for day, hours in zip(days, each.reshape(-1, _HOURS), strict=True):
            getattr(day, name)[:] = hours
    # the hour that clocks skip in spring lacks no rain
    one_later = np.diff(weather.at).astype(np.int64) == HOUR_S
    for skipped in at[1:][one_later & (np.diff(at) == 2)] - 1:
        rain = days[skipped // _HOURS].rain_mm
        if not np.isnan(rain).all():
            rain[skipped % _HOURS] = 0.0
    for day in days:
        known = np.flatnonzero(~np.isnan(day.temperature_c))
        # of a day that begins or ends with its weather the other hours are not as the last known
        if known.size and known[-1] - known[0] >= LEAST_HOURS - 1:
            day.temperature_c[:] = _filled(day.temperature_c)


def _local_hours(weather: Weather) -> NDArray[np.int64]:
    """Return the local hour at which each row begins, ``(n,)``."""
    since = weather.at.astype("datetime64[s]").astype(np.int64)
    if weather.zone:
        zone = ZoneInfo(weather.zone)
        return np.array([datetime.fromtimestamp(s, zone).hour for s in since.tolist()], np.int64)
    hours: NDArray[np.int64] = since // 3600 % _HOURS
    return hours


def _curve(weather: Weather, k: int) -> Floats:
    """Return the hours of a day of which the mean, or the low and the high are known."""
    low, high, mean = weather.low_c[k], weather.high_c[k], weather.temperature_c[k]
    swing = 0.0 if np.isnan(high - low) else (high - low) / 2.0
    middle = (low + high) / 2.0 if np.isnan(mean) else mean
    turned = np.cos((np.arange(_HOURS) + 0.5 - _WARMEST) * 2.0 * np.pi / _HOURS)
    curve: Floats = middle + swing * turned
    return curve


def _filled(hours: Floats) -> Floats:
    """Return hours ``(24,)`` of which those not measured are as those about them."""
    known = np.flatnonzero(~np.isnan(hours))
    return np.interp(np.arange(_HOURS), known, hours[known]) if known.size else hours


def _mean(days: Sequence[DayWeather], weight: Floats) -> DayWeather:
    """Return the weighed mean of some days, hour by hour, of what is known of each."""
    parts = []
    for values in zip(*days, strict=True):
        each = np.array(values)
        known = ~np.isnan(each)
        counts = known * weight[:, None]
        total = (np.where(known, each, 0.0) * counts).sum(axis=0)
        with np.errstate(invalid="ignore"):
            parts.append(total / counts.sum(axis=0))
    return DayWeather(*parts)
