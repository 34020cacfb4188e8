"""The file of a season as it is read: what it says now, and the transactions that change it."""

from __future__ import annotations

import threading
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.kinds import checked
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.hotspots import record_states
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.records import Records, usable
from fieldmon.monitoring.changes import logged_days, outside_changes, season_log
from fieldmon.monitoring.changes.transactions import Store, get_meta
from fieldmon.monitoring.estimates import derived_layers, first_morning
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.estimates.mornings import Mornings
from fieldmon.monitoring.estimates.mornings import keep as keep_mornings
from fieldmon.monitoring.estimates.mornings import take as take_mornings
from fieldmon.monitoring.estimates.told_detection import told_at_first, told_detection
from fieldmon.monitoring.file import label_table, qgis_project, schema, tables
from fieldmon.monitoring.inspecting import inspection_lots
from fieldmon.monitoring.settings import settings_log
from fieldmon.monitoring.settings.settings import MonitoringSettings, as_json, from_json, seconds
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.monitoring.settings.shift_work import Besides, Shift
from fieldmon.monitoring.treating import treatments
from fieldmon.monitoring.treating.closures import closed_on, entry_waits, open_to_people
from fieldmon.planning.members import ways_of
from fieldmon.plot.grid import PlantNumbers, plant_numbers
from fieldmon.plot.local_clock import grid_clock, local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator, Sequence
    from contextlib import AbstractContextManager
    from datetime import date, datetime, time
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.compute.day_arguments import Day, TimeOfDay
    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring.changes.log_entry import LogEntry
    from fieldmon.monitoring.settings.shift_work import ShiftWork
    from fieldmon.monitoring.treating.closures import Closure, EntryWait
    from fieldmon.monitoring.treating.treatment import Treatment
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.travel import Aisles
    from fieldmon.samplers.base import Scene

    Floats = NDArray[np.float64]


class FileRevision(NamedTuple):
    """What changes when anything that counts does, whoever changed it.

    Parameters
    ----------
    changes
        How often the file was changed by us.
    inspections
        How often a row of the inspections was changed, by whomever.
    written
        A random name of our last change: a copy that was brought back, and changed as often since,
        has another one. Empty: an earlier version made it.
    """

    changes: int
    inspections: int
    written: str = ""

    @classmethod
    def of(cls, db: sqlite3.Connection) -> FileRevision:
        """Return what the file says of itself."""
        names = ("revision", schema.INSPECTIONS_CHANGED)
        changes, inspections = (int(get_meta(db, name) or 0) for name in names)
        return cls(changes, inspections, get_meta(db, schema.WRITTEN) or "")

    def once_kept(self, db: sqlite3.Connection) -> FileRevision:
        """Return what the file will say once the transaction that writes it is kept."""
        return FileRevision(self.changes + 1, self.inspections, get_meta(db, schema.COMES) or "")


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


class _Prior(NamedTuple):
    """The chance map of the first morning ``(n,)``, and from which choices and causes it is."""

    key: tuple[object, object]
    causes: str
    chance: Floats


@checked
class OpenSeason:
    """A season's file, read anew whenever it changed; see `fieldmon.monitoring.Season`."""

    def __init__(self, path: str | Path) -> None:
        self.store = Store(path)
        self._lock = threading.RLock()
        self._last: SeasonContents | None = None
        self._written: SeasonContents | None = None
        self._prior: _Prior | None = None
        self._aisles: dict[tuple[float, float], Aisles] = {}
        self._unused_then: dict[int, set[str]] = {}
        self._planned_as_now: date | None = None
        self._enters = False
        self._waits: tuple[FileRevision, tuple[EntryWait, ...]] | None = None
        with self.store.reading() as db:
            self.plot: Plot = tables.read_plot(db)
            self.records: Records = tables.read_records(db)
            self.risk: Floats | None = tables.read_arrays(db, "risk").get("risk")
            self._first_entry = season_log.first(db)

    @property
    def path(self) -> Path:
        """Return the file."""
        return self.store.path

    def plot_time(self, moment: datetime) -> datetime:
        """Return the plot's own time of a moment that names its zone: so all its days are read."""
        return local_clock(self.plot.field).at(moment)

    @property
    def key(self) -> str:
        """Return what stands for this season in keys of what is kept: no other file has it."""
        return f"{self.path} {self._first_entry}"

    def is_another_now(self) -> bool:
        """Return whether another season's file, or one of an earlier version, took its place."""
        with self.store.reading() as db:
            is_ours = get_meta(db, "version") == str(schema.VERSION)
            return not is_ours or season_log.first(db) != self._first_entry

    def one_moment(self) -> AbstractContextManager[None]:
        """Let all answers within this block be of one moment, whoever writes meanwhile waits."""
        return self.store.one_moment()

    @property
    def revision(self) -> str:
        """Return what changes when anything that counts does, whoever changed it."""
        with self.store.reading() as db:
            return repr(tuple(FileRevision.of(db)))

    @property
    def settings(self) -> MonitoringSettings:
        """Return what is chosen for the season."""
        with self.reading() as (_, settings):
            return settings

    @contextmanager
    def reading(self) -> Iterator[tuple[sqlite3.Connection, MonitoringSettings]]:
        """Give the file as it is at one moment, and what is chosen for the season then."""
        with self._lock, self.store.reading() as db:
            yield db, self._settings(db)

    def _settings(self, db: sqlite3.Connection) -> MonitoringSettings:
        outside_changes.refuse(db)
        return settings_of(db) if (known := self._known(db)) is None else known.settings

    def settings_on(self, on: Day) -> MonitoringSettings:
        """Return what counts, with who worked on a day, from when, and who chose, as it was then.

        As when the day was planned before its work or, if it never was, first recorded: whatever is
        planned of it later changes nothing, see `logged_days.worked_by`. What is believed is of
        now, for all days (but see `fieldmon.monitoring.estimates.told_detection`).
        """
        return self._counted_on(on)

    def _counted_on(
        self, *days: date, read: sqlite3.Connection | None = None
    ) -> MonitoringSettings:
        """Return what counted on the first of some days that was planned or recorded; else now."""
        with self.store.reading() if read is None else nullcontext(read) as db:
            now, parts = settings_of(db), settings_log.of(db, self._chosen_on(db, *days))
        then = from_json(parts) if parts else now
        return replace(
            now, robot=then.robot, starts=then.starts, sampler=then.sampler,
            sampler_settings=then.sampler_settings, team=then.team, teamwork=then.teamwork,
        )  # fmt: skip

    def _chosen_on(self, db: sqlite3.Connection, *days: date) -> settings_log.Marks:
        """Return by which settings the first of some days was worked; else those of now."""
        clock = local_clock(self.plot.field)
        worked = (logged_days.worked_by(db, day, clock) for day in days)
        return next((one for one in worked if one is not None), None) or settings_log.marks(db)

    @property
    def was_changed(self) -> bool:
        """Return whether anything else was ever chosen than what the season began with."""
        with self.store.reading() as db:
            return len(settings_log.all_moments(db)) > 1

    def planned_by(self, on: Day) -> MonitoringSettings:
        """Return what a day is planned by: an earlier one by what counted then, see `settings_on`.

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
        return self._counted_on(on, *_recorded_before(contents, on), read=read)

    def _chosen_for(
        self, contents: SeasonContents, on: date, db: sqlite3.Connection
    ) -> settings_log.Marks:
        """Return which settings `_planned_by` gives."""
        if not self._is_earlier(contents, on):
            return settings_log.marks(db)
        return self._chosen_on(db, on, *_recorded_before(contents, on))

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

    def is_earlier(self, on: Day) -> bool:
        """Return whether the day `on` goes by what counted then, see `planned_by`."""
        return self._is_earlier(self._now(), on)

    def _is_earlier(self, contents: SeasonContents, on: date) -> bool:
        recorded, day = contents.history.inspections.date, np.datetime64(on, "D")
        if on == self._planned_as_now:
            return False
        if not len(recorded) or day > recorded[-1]:
            return False
        return bool(day < recorded[-1]) or on < local_clock(self.plot.field).today()

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

    def last_date(self) -> date:
        """Return the last day on which anything was planned or recorded; at first the first."""
        with self.store.reading() as db:
            return settings_of(db).date(newest_day(db))

    def last_recorded(self) -> date:
        """Return the last day of which an inspection or a treatment counts; at first the first."""
        history = self.history
        days = [*history.days[-1:].tolist(), *(one.day for one in history.treatments)]
        return self.settings.date(max(days, default=0))

    def recorded_ahead(self) -> date | None:
        """Return the last day of which something counts, if it has not come; None: it has.

        A slip in a date hides what was seen from every day before.
        """
        history, today = self.history, local_clock(self.plot.field).today()
        is_anything = len(history.inspections) or len(history.treatments)
        return last if is_anything and (last := self.last_recorded()) > today else None

    def default_date(self) -> date:
        """Return the day that is meant where none is named: the last date, but today at most.

        Where today is before the season it is the last date.
        """
        last, today = self.last_date(), local_clock(self.plot.field).today()
        return last if today < self.settings.begins else min(last, today)

    @cached_property
    def plant_numbers(self) -> PlantNumbers:
        """Row and number of every plant, as people count."""
        return plant_numbers(self.plot.grid)

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

    def closed(
        self, on: Day, who: str | Besides = "", seconds_left: float | None = None
    ) -> tuple[Closure, ...]:
        """Return the plants where people may not be yet when work, or what is left of it, begins.

        That is by its own times, and by the clock where that is later. They are those of all rows
        in which any was treated.

        Parameters
        ----------
        on, who
            As `scene` takes them.
        seconds_left
            Of the day; None: what its scene says.
        """
        with self._lock, self.store.reading() as db:  # all of one moment
            return self._closed(self._read(db), on, who, seconds_left)

    def closed_between(self, on: Day, begins_s: float, ends_s: float) -> tuple[Closure, ...]:
        """Return what `closed` does, of work from `begins_s` to `ends_s` of the day `on`."""
        now = local_clock(self.plot.field).now()
        waits = self._entry_waits()
        return closed_on(waits, on, begins_s, ends_s, now if now.date() == on else None)

    @contextmanager
    def entering_treated(self) -> Iterator[None]:
        """Let days be planned for who may enter all the same, as robots: nothing is closed."""
        with self._lock:
            before, self._enters = self._enters, True
            try:
                yield
            finally:
                self._enters = before

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
        return self.closed_between(on, begins_s, clock.second_after(on, begun_s, day_s))

    def _entry_waits(self) -> tuple[EntryWait, ...]:
        with self.store.reading() as db:
            revision = FileRevision.of(db)
            if self._waits is None or self._waits[0] != revision:
                done = treatments.kept(db, self._inside, local_clock(self.plot.field))
                self._waits = revision, entry_waits(done, label_table.read(db), self.plot.grid)
            return self._waits[1]

    def _open_to(
        self, scene: Scene, contents: SeasonContents, on: date, who: str | Besides
    ) -> Scene:
        """Return a scene in which nobody is sent to plants that are closed to people."""
        closed = () if self._enters else self._closed(contents, on, who, scene.seconds_left)
        return open_to_people(scene, closed)

    def begun_s(self, on: Day, who: str | Besides = "") -> float:
        """Return the second of the day `on` at which work began, or will; `who` as in `plan`.

        That is as the settings say, unless the first inspection was made minutes before or after.
        """
        with self._lock:
            return self._begun_s(self._now(), on, who)

    def _begun_s(self, contents: SeasonContents, on: date, who: str | Besides) -> float:
        return self._work(contents, on, who).begun_s(contents.settings.day(on))

    def until_s(self, on: Day, who: str | Besides = "") -> float:
        """Return until which second of the day `on` results are of its work; `who` as in `plan`.

        Past midnight it is 86 400 and more.
        """
        with self._lock:
            contents = self._now()
            return self._work(contents, on, who).until_s(contents.settings.day(on))

    def left_s(self, on: Day, now: TimeOfDay | None = None, who: str | Besides = "") -> float:
        """Return the seconds left of the working day `on`; `now` and `who` as in `scene`."""
        with self._lock:
            contents = self._now()
            work, day = self._work(contents, on, who), contents.settings.day(on)
            gone_s = work.gone_s(day, None if now is None else seconds(now))
            return max(0.0, work.shift.robot.day_s - gone_s)

    def worked(self, on: Day, who: str | Besides = "") -> Inspections:
        """Return what somebody inspected in the work of the day `on`; `who` as in `plan`.

        Also past midnight, where inspections are dated the next day: seconds go on from 86 400.
        """
        with self._lock:
            return self._worked(self._now(), on, who)

    def _worked(self, contents: SeasonContents, on: date, who: str | Besides) -> Inspections:
        return self._work(contents, on, who).own(contents.settings.day(on))

    def _work(self, contents: SeasonContents, on: date, who: str | Besides) -> ShiftWork:
        """Return somebody's work by what counted on the day `on`."""
        return contents.history.work(*self._shift(self._planned_by(contents, on), who))

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
        shift, name = self._shift(settings, who)
        if isinstance(name, str):
            ways_of(shift.robot, shift.aisles, name)  # or raise with the name
        return contents.history.scene(shift, day, morning, now_s, name)

    def aisles_from(self, gate: tuple[float, float] | None) -> Aisles:
        """Return the ways on the plot with another gate; None: its own."""
        if gate is None:
            return self.plot.aisles
        gate = (gate[0], gate[1])  # a list is none that can be remembered
        if gate not in self._aisles:
            self._aisles[gate] = self.plot.with_gate(gate).aisles
        return self._aisles[gate]

    def _shift(
        self, settings: MonitoringSettings, who: str | Besides
    ) -> tuple[Shift, str | Besides | None]:
        """Return how somebody works, and whose inspections are theirs; None: everybody's."""
        starts_s, streams = seconds(settings.starts), RandomStreams(settings.seed)
        member = settings.at_work(who) if isinstance(who, str) else None
        if member is None:
            return Shift(self.plot.aisles, settings.robot, starts_s, streams), who or None
        aisles, starts_s = self.aisles_from(member.gate), starts_s + member.starts_s
        return Shift(aisles, member.robot, starts_s, streams), member.name

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
                detection=told if len(told) else _mean_told(settings),
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
        if since is None:
            since = now.mornings.last_until(newest_day(db))
        newest = derived_layers.refresh(db, self.plot, now.history, now.morning, since)
        self._keep_mornings(db, now.mornings, newest)
        qgis_project.keep(db, self.path.name, lambda day: self._unused_routes(db, now, day, since))
        self._last = None  # the transaction may yet fail
        self._written = replace(now, revision=now.revision.once_kept(db))

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


def nothing_yet(
    plot: Plot, settings: MonitoringSettings, prior: Floats, records: Records, told: float
) -> History:
    """Return the history of a season in which nothing was found or treated.

    `told` is what inspections were told to find when it began.
    """
    belief = settings.belief.first_morning(plot.grid, prior, settings.pest, told)
    known = usable(records, np.datetime64(settings.begins, "D")).records
    return History(
        plot.grid,
        settings.begins,
        belief,
        belief=settings.belief,
        detection=_mean_told(settings),
        recorded=record_states(plot.grid, known) if len(known) else None,
        pest_in_weather=settings.pest_in_weather(),
    )


def _recorded_before(contents: SeasonContents, on: date) -> list[date]:
    """Return the last day up to the day `on` on which anything was recorded, if there is one."""
    recorded = contents.history.inspections.date
    before: list[date] = recorded[recorded <= np.datetime64(on, "D")][-1:].tolist()
    return before


def _mean_told(settings: MonitoringSettings) -> float:
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
