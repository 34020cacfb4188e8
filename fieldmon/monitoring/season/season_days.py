"""The days of a season as they are worked: by what, by whom, in which hours, on which plants."""

from __future__ import annotations

from contextlib import contextmanager, nullcontext
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.monitoring.changes import earlier_settings
from fieldmon.monitoring.changes.file_revision import FileRevision
from fieldmon.monitoring.file import label_table
from fieldmon.monitoring.season.open_season import OpenSeason
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.settings.settings import seconds
from fieldmon.monitoring.settings.shift_work import Besides, DayWork, shift_of
from fieldmon.monitoring.treating import treatments
from fieldmon.monitoring.treating.closures import closed_on, entry_waits, open_to_people
from fieldmon.planning.members import ways_of
from fieldmon.plot.local_clock import grid_clock, local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator
    from datetime import date, time
    from pathlib import Path

    from fieldmon.compute.day_arguments import Day, TimeOfDay
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.estimates.season_contents import SeasonContents
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.settings.shift_work import ShiftWork
    from fieldmon.monitoring.treating.closures import Closure, EntryWait
    from fieldmon.samplers.base import Scene


@checked
class SeasonDays(OpenSeason):
    """The days of a season, each with its work."""

    def __init__(self, path: str | Path) -> None:
        super().__init__(path)
        self._planned_as_now: date | None = None
        self._enters = False
        self._waits: tuple[FileRevision, tuple[EntryWait, ...]] | None = None

    def planned_by(self, on: Day) -> MonitoringSettings:
        """Return what a day is planned by: an earlier one by what counted then.

        A day is an earlier one once something was recorded of a later one or, if anything was of
        itself, once it is past by the plot's clock. If it was neither planned nor recorded itself,
        it goes by what counted on the day recorded before it; but see `as_now`.
        """
        return self._planned_by(self._now(), on)

    def _planned_by(
        self, contents: SeasonContents, on: date, read: sqlite3.Connection | None = None
    ) -> MonitoringSettings:
        if not self._is_earlier(contents, on):
            return contents.settings
        with self.store.reading() if read is None else nullcontext(read) as db:
            days = [on, *contents.recorded_before(on)]
            return earlier_settings.counted_on(db, days, local_clock(self.plot.field))

    def _chosen_for(
        self, contents: SeasonContents, on: date, db: sqlite3.Connection
    ) -> settings_log.Marks:
        """Return which settings `_planned_by` gives."""
        if not self._is_earlier(contents, on):
            return settings_log.marks(db)
        days = [on, *contents.recorded_before(on)]
        return earlier_settings.chosen_on(db, days, local_clock(self.plot.field))

    @contextmanager
    def as_now(self, on: Day) -> Iterator[None]:
        """Let the day `on` be planned by what counts now, though it is an earlier one.

        If nothing is recorded of it yet, it goes on by the plan that is kept of it.
        """
        with self._lock:
            self._planned_as_now = on
            try:
                yield
            finally:
                self._planned_as_now = None

    def _is_earlier(self, contents: SeasonContents, on: date) -> bool:
        """Return whether the day `on` goes by what counted then, see `planned_by`."""
        recorded, day = contents.history.inspections.date, np.datetime64(on, "D")
        if on == self._planned_as_now:
            return False
        if not len(recorded) or day > recorded[-1]:
            return False
        return bool(day < recorded[-1]) or on < local_clock(self.plot.field).today()

    def work(self, on: Day, who: str | Besides = "") -> DayWork:
        """Return somebody's work of the day `on`: its hours, and what was inspected in them.

        Parameters
        ----------
        on
            The day.
        who
            As `scene` takes it.
        """
        with self._lock:
            contents = self._now()
            work, day = self._work(contents, on, who), contents.settings.day(on)
            return DayWork(work, day, self._is_earlier(contents, on))

    def _work(self, contents: SeasonContents, on: date, who: str | Besides) -> ShiftWork:
        """Return somebody's work by what counted on the day `on`."""
        return contents.history.work(*shift_of(self.plot, self._planned_by(contents, on), who))

    def _begun_s(self, contents: SeasonContents, on: date, who: str | Besides) -> float:
        return self._work(contents, on, who).begun_s(contents.settings.day(on))

    def _worked(self, contents: SeasonContents, on: date, who: str | Besides) -> Inspections:
        return self._work(contents, on, who).own(contents.settings.day(on))

    def scene(self, on: Day, now: TimeOfDay | None = None, who: str | Besides = "") -> Scene:
        """Return the day `on` as it stands after what was recorded of it; `now` as in `plan`.

        Plants where people may not be yet seem inspected today, see `closed`.

        Parameters
        ----------
        on, now
            The day and the time, as `plan` takes them.
        who
            One of a team; empty: the first of it. Whoever else is named has the season's robot and
            stands where they inspected last, or at the gate. The season's robot may also be
            `Besides` others, see `plan`.
        """
        with self._lock, self.store.reading() as db:  # all of one moment
            return self._scene(self._read(db), on, now, who, db)

    def _scene(
        self, contents: SeasonContents, on: date, now: time | None = None,
        who: str | Besides = "", read: sqlite3.Connection | None = None,
    ) -> Scene:  # fmt: skip
        return self._open_to(self._scene_of_all(contents, on, now, who, read), contents, on, who)

    def _scene_of_all(
        self, contents: SeasonContents, on: date, now: time | None = None,
        who: str | Besides = "", read: sqlite3.Connection | None = None,
    ) -> Scene:  # fmt: skip
        """Return a scene with the plants that are closed to people."""
        settings, day = self._planned_by(contents, on, read), contents.settings.day(on)
        now_s = None if now is None else seconds(now)
        morning = contents.morning(day)
        shift, name = shift_of(self.plot, settings, who)
        if isinstance(name, str):
            ways_of(shift.robot, shift.aisles, name)  # or raise with the name
        return contents.history.scene(shift, day, morning, now_s, name)

    def closed(
        self, on: Day, who: str | Besides = "", seconds_left: float | None = None, *,
        between: tuple[float, float] | None = None,
    ) -> tuple[Closure, ...]:  # fmt: skip
        """Return the plants where people may not be yet when work, or what is left of it, begins.

        That is by its own times, and by the clock where that is later. They are those of all rows
        in which any was treated.

        Parameters
        ----------
        on, who
            As `scene` takes them.
        seconds_left
            Of the day; None: what its scene says.
        between
            From and until which second of the day is asked instead, whoever works; None: the hours
            of `who`.
        """
        if between is not None:
            return self._closed_between(on, *between)
        with self._lock, self.store.reading() as db:  # all of one moment
            return self._closed(self._read(db), on, who, seconds_left)

    def _closed(
        self, contents: SeasonContents, on: date, who: str | Besides, seconds_left: float | None
    ) -> tuple[Closure, ...]:
        if not contents.history.treatments:
            return ()
        work, day = self._work(contents, on, who), contents.settings.day(on)
        begun_s, day_s = work.begun_s(day), work.shift.robot.day_s
        if seconds_left is None:
            seconds_left = max(0.0, day_s - work.gone_s(day))
        clock = grid_clock(self.plot.grid)
        begins_s = clock.second_after(on, begun_s, day_s - seconds_left)
        return self._closed_between(on, begins_s, clock.second_after(on, begun_s, day_s))

    def _closed_between(self, on: date, begins_s: float, ends_s: float) -> tuple[Closure, ...]:
        now = local_clock(self.plot.field).now()
        waits = self._entry_waits()
        return closed_on(waits, on, begins_s, ends_s, now if now.date() == on else None)

    def _entry_waits(self) -> tuple[EntryWait, ...]:
        with self.store.reading() as db:
            revision = FileRevision.of(db)
            if self._waits is None or self._waits[0] != revision:
                done = treatments.kept(db, self._inside, local_clock(self.plot.field))
                self._waits = revision, entry_waits(done, label_table.read(db), self.plot.grid)
            return self._waits[1]

    @contextmanager
    def entering_treated(self) -> Iterator[None]:
        """Let days be planned for who may enter all the same, as robots: nothing is closed."""
        with self._lock:
            before, self._enters = self._enters, True
            try:
                yield
            finally:
                self._enters = before

    def _open_to(
        self, scene: Scene, contents: SeasonContents, on: date, who: str | Besides
    ) -> Scene:
        """Return a scene in which nobody is sent to plants that are closed to people."""
        closed = () if self._enters else self._closed(contents, on, who, scene.seconds_left)
        return open_to_people(scene, closed)
