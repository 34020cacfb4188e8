"""What can be chosen when weather is read."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.options import ZonedOptions
from fieldmon.io.parse.clock import zone_of
from fieldmon.io.parse.weather_columns import UNITS, WRITTEN, unit_named
from fieldmon.io.readers.running_rain import EACH, RUNNING


@dataclass(frozen=True)
class WeatherOptions(ZonedOptions):
    """What can be chosen when weather is read.

    Parameters
    ----------
    zone
        Time zone of times that name none, and by which days begin: ``"Asia/Jerusalem"``. None:
        UTC; `on` gives the plot's.
    temperature_unit, wind_unit, rain_unit
        Units where the file does not state them: C, F, K, 0.1 C; m/s, km/h, mph, kn, 0.1 m/s; mm,
        cm, in, 0.1 mm.
    rain_is
        ``"each"``: every value is what fell since the one before; ``"running"``: it is counted up,
        until it falls. None: as it looks.
    location
        Which place of a file that holds several, counted from 1.
    now
        What begins later was forecast, also as ISO text; None: nothing was, unless a column says
        so.
    """

    temperature_unit: str | None = None
    wind_unit: str | None = None
    rain_unit: str | None = None
    rain_is: str | None = None
    location: str | None = None
    now: datetime | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check_now()
        if self.zone is not None:
            zone_of(self.zone)
        if self.rain_is not in (None, EACH, RUNNING):
            raise SettingError(
                worded("Rain must be each or running, but it is {told!r}.", told=self.rain_is)
            )
        for kind, told in (
            ("temperature", self.temperature_unit),
            ("speed", self.wind_unit),
            ("rain", self.rain_unit),
        ):
            if told is not None and UNITS.get(unit_named(told), (None,))[0] != kind:
                raise SettingError(
                    worded(
                        "The unit of {kind} must be {known}, but it is {told!r}.",
                        kind=kind,
                        known=WRITTEN[kind],
                        told=told,
                    )
                )

    def _check_now(self) -> None:
        """Take text as a time; refuse what is none."""
        told = self.now
        if isinstance(told, str):
            try:
                told = datetime.fromisoformat(told)
            except ValueError:
                pass
            else:
                object.__setattr__(self, "now", told)
        if told is not None and not isinstance(told, datetime):
            raise SettingError(
                worded(
                    'The time now must be a date with its time, as "2026-11-18T06:00+02:00", but '
                    "it is {told!r}.",
                    told=told,
                )
            )

    def unit(self, kind: str) -> str:
        """Return the unit told for a kind of measure, as `UNITS` has it; empty: none was."""
        told = {
            "temperature": self.temperature_unit, "speed": self.wind_unit, "rain": self.rain_unit
        }  # fmt: skip
        return unit_named(told.get(kind) or "")
