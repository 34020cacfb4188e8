"""What can be chosen when inspections are read."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.io.import_report import Remedy
from fieldmon.io.options import ZonedOptions
from fieldmon.io.parse.clock import zone_of
from fieldmon.io.parse.dates import dates

#: takes what was left out as doubtful
TAKE = Remedy("take_doubtful", "yes", worded("Take it all the same"))


@dataclass(frozen=True)
class InspectionOptions(ZonedOptions):
    """What can be chosen when inspections are read.

    Parameters
    ----------
    day
        The day of inspections that have none, as numpy's ``datetime64[D]``.
    work_day
        Their day where no record of the file says one; None, or beside others that do: none.
    who
        Who inspected, where the file does not say.
    accuracy_m
        How far off positions may be where the file does not say; None: they are taken as exact.
    zone
        Time zone of the plot (``"Asia/Jerusalem"``, ``"+02:00"``), for times that a file states in
        UTC or another zone, as all GPX files do. None: such times keep their own clock; `on`
        gives the plot's.
    gone
        Words of one's own for a plant that does not stand there any more, set apart by commas.
    take_doubtful
        Take what would be listed and left out: the nearest plant, the plant's id before its row
        and number or position, a find before a contradicting "clean", a day that has not come.
    """

    day: np.datetime64 | None = None
    work_day: np.datetime64 | None = None
    who: str | None = None
    accuracy_m: float | None = None
    gone: str | None = None
    take_doubtful: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.accuracy_m is not None and not 0 <= self.accuracy_m <= 1000:
            raise SettingError(
                worded(
                    "The accuracy of positions must be 0 to 1000 m, but it is {accuracy_m}.",
                    accuracy_m=self.accuracy_m,
                )
            )
        if self.zone is not None:
            zone_of(self.zone)
        if self.place is not None:
            raise SettingError(
                worded(
                    "An inspection is of the plant that it names, and is doubted where its "
                    "position is elsewhere: take_doubtful=yes takes it. Leave place out."
                )
            )

    def choose(self, option: str, value: str) -> Self:
        """Return these options with one of them set from text."""
        if option == "day":
            read = dates(np.array([value], dtype=object), self.date_order).day[0]
            if np.isnat(read):
                raise SettingError(
                    worded("A day must be a date (2026-11-18), but it is {value!r}.", value=value)
                )
            return replace(self, day=read)
        if option == "accuracy_m":
            try:
                return replace(self, accuracy_m=float(value))
            except ValueError:
                raise SettingError(
                    worded(
                        "The accuracy must be a number of metres, but it is {value!r}.", value=value
                    )
                ) from None
        return super().choose(option, value)
