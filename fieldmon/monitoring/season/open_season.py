"""The file of a season as it is read: what it says now, and the transactions that change it."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.kinds import checked
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.records import Records, usable
from fieldmon.monitoring.changes import outside_changes, season_log
from fieldmon.monitoring.changes.file_revision import FileRevision
from fieldmon.monitoring.changes.transactions import Store
from fieldmon.monitoring.estimates import derived_layers, first_morning
from fieldmon.monitoring.estimates.mornings import Mornings, causes_until
from fieldmon.monitoring.estimates.mornings import keep as keep_mornings
from fieldmon.monitoring.estimates.mornings import take as take_mornings
from fieldmon.monitoring.estimates.season_contents import (
    SeasonChange,
    SeasonContents,
    SeasonReading,
    mean_told,
    newest_day,
    nothing_yet,
)
from fieldmon.monitoring.estimates.told_detection import told_at_first, told_detection
from fieldmon.monitoring.file import qgis_project, tables
from fieldmon.monitoring.inspecting import inspection_lots
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.monitoring.treating import treatments
from fieldmon.plot.grid import PlantNumbers, plant_numbers
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator
    from datetime import datetime
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.changes.log_entry import LogEntry
    from fieldmon.monitoring.estimates.history import History
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.plot.plot import Plot

    Floats = NDArray[np.float64]


class _Prior(NamedTuple):
    """The chance map of the first morning ``(n,)``, and from which choices and causes it is."""

    key: tuple[object, object]
    causes: str
    chance: Floats


@checked
class OpenSeason:
    """A season's file, read anew whenever it changed; see `fieldmon.monitoring.Season`."""

    def __init__(self, path: str | Path) -> None:
        #: its file: copies of it, and transactions for programs that read its tables
        self.store = Store(path)
        self._lock = threading.RLock()
        self._last: SeasonContents | None = None
        self._written: SeasonContents | None = None
        self._prior: _Prior | None = None
        # what the first evening followed from when it was written last, and that history
        self._first_evening: tuple[str, History] | None = None
        with self.store.reading() as db:
            #: the plants and the ways between them
            self.plot: Plot = tables.read_plot(db)
            #: all records that it was given; see `records_known`
            self.records: Records = tables.read_records(db)
            #: ``(n,)`` one more chance of being infested at the start; None: none was given
            self.risk: Floats | None = tables.read_arrays(db, "risk").get("risk")
            self._first_entry = season_log.first(db)

    @property
    def path(self) -> Path:
        """Return the file."""
        return self.store.path

    def _plot_time(self, moment: datetime) -> datetime:
        """Return the plot's own time of a moment that names its zone: so all its days are read."""
        return local_clock(self.plot.field).at(moment)

    @property
    def key(self) -> str:
        """Return what stands for this season in keys of what is kept: no other file has it."""
        return f"{self.path} {self._first_entry}"

    @property
    def revision(self) -> str:
        """Return what changes when anything that counts does, whoever changed it."""
        with self.store.reading() as db:
            return repr(tuple(FileRevision.of(db)))

    @property
    def settings(self) -> MonitoringSettings:
        """Return what is chosen for the season."""
        with self.reading() as now:
            return now.settings

    @contextmanager
    def reading(self) -> Iterator[SeasonReading]:
        """Give the file as it is at one moment, for a program that reads more than one thing."""
        with self._lock, self.store.reading() as db:
            yield SeasonReading(db, self._settings, self._read)

    @contextmanager
    def changing(self) -> Iterator[SeasonChange]:
        """Give the file for one change: all is kept with what follows from it, or nothing."""
        with self._lock, self.store.writing() as db:
            change = SeasonChange(db)
            yield change
            if change.since is not None:
                self._refresh(db, change.since)

    def _settings(self, db: sqlite3.Connection) -> MonitoringSettings:
        outside_changes.refuse(db)
        return settings_of(db) if (known := self._known(db)) is None else known.settings

    @property
    def history(self) -> History:
        """Return all that happened so far."""
        return self._now().history

    @property
    def inspections(self) -> Inspections:
        """Return those of `history`, for who asks for no more: nothing is worked out for them."""
        with self._lock, self.store.reading() as db:
            return self._inspections(db)

    def _inspections(self, db: sqlite3.Connection) -> Inspections:
        outside_changes.refuse(db)
        if (known := self._known(db)) is not None:
            return known.history.inspections
        return inspection_lots.load(db, settings_of(db).begins)

    def _known(self, db: sqlite3.Connection) -> SeasonContents | None:
        """Return what was read last, if the file still says it."""
        last = self._last
        return last if last is not None and last.revision == FileRevision.of(db) else None

    def log(self) -> tuple[LogEntry, ...]:
        """Return the log, the first entry first.

        Raise `FileProblem` where the past was changed: at which entry.
        """
        with self.store.reading() as db:
            return season_log.entries(db)

    def records_known(self) -> Records:
        """Return the records from which the season began."""
        begins = np.datetime64(self.settings.begins, "D")
        return usable(self.records, begins).records

    @cached_property
    def plant_numbers(self) -> PlantNumbers:
        """Row and number of every plant, as people count."""
        return plant_numbers(self.plot.grid)

    def _now(self) -> SeasonContents:
        with self._lock, self.store.reading() as db:
            return self._read(db)

    @contextmanager
    def _writing(self) -> Iterator[sqlite3.Connection]:
        """Give the file for one transaction; what it wrote is known once it is kept."""
        with self._lock:
            self._written = None
            with self.store.writing() as db:
                yield db
            self._last, self._written = self._written or self._last, None

    def _read(
        self, db: sqlite3.Connection, before: SeasonContents | None = None, since: int = 0
    ) -> SeasonContents:
        """Return what the file says; nothing is read again that did not change.

        What the same transaction read `before` its changes, which reach back to the day `since`,
        need not be read and worked out again.
        """
        outside_changes.refuse(db)
        revision = FileRevision.of(db)
        if self._last is None or self._last.revision != revision:
            settings, treated = settings_of(db), treatments.load(db, self._inside)
            if before is not None and before.still_counts(revision, settings, treated):
                self._last = replace(before, revision=revision)
                return self._last
            prior = self._first_morning(db, settings)
            if before is not None and before.revision.inspections == revision.inspections:
                inspections = before.history.inspections
            else:
                inspections = inspection_lots.load(db, settings.begins)
            begun = nothing_yet(self.plot, settings, prior, self.records, told_at_first(db))
            told = told_detection(db, inspections, settings.begins)
            history = replace(
                begun,
                inspections=inspections,
                treatments=treated,
                detection=told if len(told) else mean_told(settings),
            )
            if before is None:
                mornings = Mornings(history)
                take_mornings(db, mornings)
            else:
                mornings = before.mornings.after_change(history, since)
            self._last = SeasonContents(revision, settings, history, mornings)
        return self._last

    def _first_morning(self, db: sqlite3.Connection, settings: MonitoringSettings) -> Floats:
        key = (settings.begins, settings.prior)
        if self._prior is None or self._prior.key != key:
            causes = first_morning.causes(db, *key)
            chance = first_morning.take(db, causes)
            if chance is None:
                begins, plot = np.datetime64(settings.begins, "D"), self.plot
                chance = prior_chance(
                    plot.grid, plot.field, self.records, begins, settings.prior, self.risk
                )
            self._prior = _Prior(key, causes, chance)
        return self._prior.chance

    def _inside(self, area: shapely.Geometry) -> NDArray[np.bool_]:
        ground = self.plot.grid.frame.geometry_m(area)
        shapely.prepare(ground)
        inside: NDArray[np.bool_] = shapely.intersects_xy(ground, self.plot.grid.xy_m)
        return inside

    def _refresh(
        self,
        db: sqlite3.Connection,
        since: int | None = None,
        before: SeasonContents | None = None,
    ) -> None:
        """Write what follows from the causes, within the transaction that changes them.

        Nothing before `since` has changed; what the transaction read `before` its changes saves
        working those mornings out again. None: nothing has changed before the last morning that
        the file keeps and that still follows from all that happened until then.
        """
        self._last = None
        inspection_lots.keep(db)  # what is read next is read of these
        now = self._read(db, before, since or 0)
        self._remember_first_evening(now.history)
        if since is None:
            since = now.mornings.last_until(newest_day(db))
        newest = derived_layers.refresh(db, self.plot, now.history, now.morning, since)
        self._keep_mornings(db, now.mornings, newest)
        qgis_project.keep(db, self.path.name, lambda day: self._unused_routes(db, now, day, since))
        self._last = None  # the transaction may yet fail
        self._written = replace(now, revision=now.revision.once_kept(db))

    def _remember_first_evening(self, history: History) -> None:
        """Let what the layers say of the first evening be worked out again only if it changed."""
        causes = causes_until(history, 1)
        if self._first_evening is not None and self._first_evening[0] == causes:
            history.remember_first_evening(self._first_evening[1])
        self._first_evening = causes, history

    def _unused_routes(
        self,
        db: sqlite3.Connection,  # noqa: ARG002 - as where there are plans
        contents: SeasonContents,  # noqa: ARG002
        day: int,  # noqa: ARG002
        since: int,  # noqa: ARG002
    ) -> set[str]:
        """Return whose routes of a day nobody goes by any more; nothing before `since` changed."""
        return set()

    def _keep_mornings(self, db: sqlite3.Connection, mornings: Mornings, newest: int) -> None:
        keep_mornings(db, mornings, newest)
        if self._prior is not None:
            first_morning.keep(db, self._prior.causes, self._prior.chance)
