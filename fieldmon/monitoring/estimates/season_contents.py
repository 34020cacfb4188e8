"""What a season's file says at one moment, and the change of it within one transaction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.infestation.hotspots import record_states
from fieldmon.infestation.records import usable
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.settings.settings import as_json

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Sequence
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.records import Records
    from fieldmon.monitoring.changes.file_revision import FileRevision
    from fieldmon.monitoring.estimates.mornings import Mornings
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.treating.treatment import Treatment
    from fieldmon.plot.plot import Plot


@dataclass(frozen=True, eq=False)
class SeasonContents:
    """What the file said when it was read last."""

    revision: FileRevision
    settings: MonitoringSettings
    history: History
    mornings: Mornings

    def morning(self, day: int) -> Belief:
        """Return what is believed on the morning of a day."""
        return self.mornings.of(day)

    def still_counts(
        self, revision: FileRevision, settings: MonitoringSettings, treated: Sequence[Treatment]
    ) -> bool:
        """Tell whether all that the mornings follow from is still what it was."""
        return (
            self.revision.inspections == revision.inspections
            and as_json(self.settings) == as_json(settings)
            and len(self.history.treatments) == len(treated)
            and all(map(_same_treatment, self.history.treatments, treated))
        )

    def recorded_before(self, on: date) -> list[date]:
        """Return the last day up to `on` on which anything was recorded, if there is one."""
        recorded = self.history.inspections.date
        before: list[date] = recorded[recorded <= np.datetime64(on, "D")][-1:].tolist()
        return before


class MorningAsked(NamedTuple):
    """What the file says now; what is believed on the morning of a day; the day's number."""

    contents: SeasonContents
    morning: Belief
    day: int

    @classmethod
    def of(cls, contents: SeasonContents, on: date) -> MorningAsked:
        """Return those of the day `on`."""
        day = contents.settings.day(on)
        return cls(contents, contents.morning(day), day)


class SeasonReading:
    """A season's file at one moment; what it says is read once it is asked for.

    Parameters
    ----------
    db
        The file, for this moment alone.
    settings, contents
        What reads what is chosen, and all that counts.
    """

    def __init__(
        self,
        db: sqlite3.Connection,
        settings: Callable[[sqlite3.Connection], MonitoringSettings],
        contents: Callable[[sqlite3.Connection], SeasonContents],
    ) -> None:
        self.db, self._settings, self._contents = db, settings, contents

    @cached_property
    def settings(self) -> MonitoringSettings:
        """What is chosen for the season."""
        return self._settings(self.db)

    @cached_property
    def contents(self) -> SeasonContents:
        """All that counts, and what is believed of it."""
        return self._contents(self.db)


class SeasonChange:
    """One change of a season within its transaction.

    Parameters
    ----------
    db
        The file, for this transaction alone.
    """

    def __init__(self, db: sqlite3.Connection) -> None:
        self.db = db
        #: the first day that is another now; None: none is
        self.since: int | None = None

    def reaches(self, day: int) -> None:
        """Say that a day is not what it was."""
        self.since = day if self.since is None else min(self.since, day)


def nothing_yet(
    plot: Plot,
    settings: MonitoringSettings,
    prior: NDArray[np.float64],
    records: Records,
    told: float,
) -> History:
    """Return the history of a season in which nothing was found or treated.

    `prior` is the chance map ``(n,)`` of its first morning, and `told` what inspections were told
    to find when it began.
    """
    belief = settings.belief.first_morning(plot.grid, prior, settings.pest, told)
    known = usable(records, np.datetime64(settings.begins, "D")).records
    return History(
        plot.grid,
        settings.begins,
        belief,
        belief=settings.belief,
        detection=mean_told(settings),
        recorded=record_states(plot.grid, known) if len(known) else None,
        pest_in_weather=settings.pest_in_weather(),
    )


def mean_told(settings: MonitoringSettings) -> float:
    """Return what inspections are told to find; of a team that all find alike, that exactly."""
    told = [one.robot.detects for one in settings.team] or [settings.robot.detects]
    return told[0] if len({*told}) == 1 else float(np.mean(told))


def newest_day(db: sqlite3.Connection) -> int:
    """Return the last day of which the file keeps figures."""
    (day,) = db.execute("SELECT max(day) FROM days").fetchone()
    return int(day)


def _same_treatment(one: Treatment, other: Treatment) -> bool:
    names = "day", "efficacy", "second"
    alike = all(getattr(one, name) == getattr(other, name) for name in names)
    return alike and np.array_equal(one.plants, other.plants)
