"""A monitoring season that grows day by day, kept in one GeoPackage."""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.digest import digest
from fieldmon.compute.random_streams import RandomStreams
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.hotspots import HotSpots, hot_spots
from fieldmon.infestation.pairs import PairApproximation
from fieldmon.infestation.prior import prior_chance
from fieldmon.monitoring import (
    batches,
    day_figures,
    derived_layers,
    inspection_table,
    routes,
    schema,
    settings_log,
    tables,
)
from fieldmon.monitoring.day_figures import DayFigures, Progress
from fieldmon.monitoring.geopackage import blob, geometry, touch
from fieldmon.monitoring.history import Crew, History, Treatment
from fieldmon.monitoring.settings import SeasonSetup, as_json, from_json, seconds
from fieldmon.monitoring.transactions import Store, get_meta, set_meta
from fieldmon.planning.plan import DayPlan
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_day
from fieldmon.plot.grid import RowLabel, row_label

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable
    from datetime import date, time
    from pathlib import Path

    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.observations import Observations
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.monitoring.batches import Batch
    from fieldmon.monitoring.inspection_table import Results
    from fieldmon.monitoring.tables import Remark
    from fieldmon.plot.plot import Plot

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Recorded:
    """What recording did.

    Parameters
    ----------
    batch
        Its number, for undoing; None if nothing was new.
    new, known
        Results that were added, and results that the season held already.
    """

    batch: int | None
    new: int
    known: int


@dataclass(frozen=True, eq=False)
class Status:
    """Where a season stands on a day, after what was recorded of it.

    Parameters
    ----------
    day
        Number of the day, from 0.
    on
        Its date.
    plants
        Plants of the plot.
    inspected, found
        Plants inspected so far at least once, and plants found infested so far.
    inspected_today, found_today
        Plants inspected and found infested on this day.
    estimate
        How many are infested and not found yet, as believed.
    days_since
        ``(r,)`` days since any plant of each row was inspected; NaN: never.
    hot_spots
        Where finds cluster.
    """

    day: int
    on: date
    plants: int
    inspected: int
    found: int
    inspected_today: int
    found_today: int
    estimate: PlotEstimate
    days_since: Floats
    hot_spots: HotSpots

    @property
    def detection_pct(self) -> float:
        """Return the finds in percent of finds and what is still expected out there."""
        everything = self.found + self.estimate.expected
        return 100.0 * self.found / everything if everything else 100.0


@dataclass(frozen=True, eq=False)
class _Snapshot:
    """What the file said when it was read last; mornings are added as they are asked for."""

    revision: str
    setup: SeasonSetup
    history: History
    mornings: list[Belief]

    def morning(self, day: int) -> Belief:
        while len(self.mornings) <= day:
            number = len(self.mornings) - 1
            self.mornings.append(self.history.night_after(self.mornings[number], number))
        return self.mornings[day]


class Season:
    """A season on disk. Begin one with `create`, come back to it with ``Season(path)``.

    Each call reads what is new in the file before it answers, and what it writes is one
    transaction: windows and programs can work on the same season at once.

    Raises
    ------
    FileProblem
        If the file is missing, damaged, of a newer version, or held by another program.
    """

    def __init__(self, path: str | Path) -> None:
        self.store = Store(path)
        self._lock = threading.RLock()
        self._last: _Snapshot | None = None
        self._prior: tuple[object, Floats] | None = None
        with self.store.reading() as db:
            self.plot: Plot = tables.read_plot(db)
            self.observations: Observations = tables.read_observations(db)
            self.risk: Floats | None = tables.read_arrays(db, "risk").get("risk")

    @classmethod
    def create(
        cls,
        path: str | Path,
        plot: Plot,
        observations: Observations,
        setup: SeasonSetup,
        remarks: Iterable[Remark] = (),
        risk: Floats | None = None,
    ) -> Season:
        """Begin a season in a new file, whole or not at all; raise `FileProblem` if it exists.

        `risk` ``(n,)`` is one more chance of being infested at the start, from a raster for
        instance, see `fieldmon.infestation.prior.prior_chance`.
        """
        begins = np.datetime64(setup.begins, "D")
        prior = prior_chance(plot.grid, plot.field, observations, begins, setup.prior, risk)
        history = _nothing_yet(plot, setup, prior)
        first = _Snapshot("", setup, history, [history.prior])
        with Store.new(path) as db:
            tables.write_plot(db, plot)
            tables.write_observations(db, observations)
            tables.write_remarks(db, remarks)
            if risk is not None:
                tables.write_array(db, "risk", risk)
            settings_log.write(db, as_json(setup))
            set_meta(db, "revision", "0")
            derived_layers.refresh(db, plot, setup, history, first.morning)
        return cls(path)

    @property
    def path(self) -> Path:
        """Return the file."""
        return self.store.path

    @property
    def revision(self) -> str:
        """Return what changes when anything that counts does, whoever changed it."""
        with self.store.reading() as db:
            return _revision(db)

    @property
    def setup(self) -> SeasonSetup:
        """Return what is chosen for the season."""
        return self._now().setup

    @property
    def history(self) -> History:
        """Return all that happened so far."""
        return self._now().history

    @cached_property
    def label(self) -> RowLabel:
        """Row and number of every plant, as people count."""
        return row_label(self.plot.grid)

    def change(self, setup: SeasonSetup, seen: SeasonSetup) -> None:
        """Choose otherwise; raise `FileProblem` if the choices are no longer those `seen`."""
        with self._lock, self.store.writing() as db:
            if as_json(_setup(db)) != as_json(seen):
                raise FileProblem(
                    "The season's settings must be as they were when you looked, but another "
                    "window changed them. Look again and repeat your change."
                )
            settings_log.write(db, as_json(setup))
            self._refresh(db)

    def before_change(self) -> SeasonSetup | None:
        """Return what counted before the last change of settings; None: nothing was changed."""
        with self.store.reading() as db:
            parts = settings_log.before_now(db)
        return None if parts is None else from_json(parts)

    def undo_change(self) -> SeasonSetup:
        """Take the last change of settings back; return what counts again.

        Raise `SettingError` if there is none.
        """
        with self._lock, self.store.writing() as db:
            setup = settings_log.undo(db)
            self._refresh(db)
        return setup

    # -- the working day

    def plan(self, on: date, now: time | None = None, *, keep: bool = True) -> DayPlan:
        """Plan what is left of a day from all that is known.

        Parameters
        ----------
        on
            The day.
        now
            Local time; None: the start of the work or, once something of the day was recorded,
            the time of the last of it.
        keep
            whether the route is kept in the file: the same one once, an empty one never.
        """
        with self._lock:
            snapshot = self._now()
            setup = snapshot.setup
            day = setup.day(on)
            crew = Crew(
                self.plot.aisles, setup.robot, seconds(setup.starts), RandomStreams(setup.seed)
            )
            now_s = None if now is None else seconds(now)
            scene = snapshot.history.scene(crew, day, snapshot.morning(day), now_s)
            work = plan_day(scene, setup.decides())
            today = DayPlan(scene, work, route_of(scene, work))
            if keep and len(today.route):
                with self.store.writing() as db:
                    if routes.keep(db, setup, self.label, today):
                        self._refresh(db, day)
        return today

    def kept_route(self, on: date) -> NDArray[np.int32]:
        """Return the plants ``(k,)`` of the latest route kept for a day; empty if there is none."""
        day = self.setup.day(on)
        with self.store.reading() as db:
            return routes.plants(db, day)

    def record(self, found: Results, source: str, who: str = "") -> Recorded:
        """Add results of inspections; those that the season holds already change nothing.

        Raises
        ------
        ObservationError
            If a plant is not on this plot, or a result has no date or an impossible one.
        SettingError
            If a date is not of this season.
        """
        with self._lock, self.store.writing() as db:
            batch = batches.begin(db, "findings", source, who)
            made = inspection_table.rows(
                found, self.plot.grid, self.label, _setup(db), (batch, who)
            )
            new = inspection_table.store(db, made)
            batches.end(db, batch, new)
            if new:
                self._refresh(db, _setup(db).day(found.day.min().item()))
        return Recorded(batch if new else None, new, len(found) - new)

    def treat(
        self, on: date, efficacy: float, area: MultiPolygon | None = None, product: str = ""
    ) -> Recorded:
        """Note that an area (lon/lat; None: the whole plot) was treated, after the day's work."""
        ground = self.plot.field.boundary if area is None else area
        plants = self._inside(ground)
        if not plants.any():
            raise SettingError(
                "The area treated must hold plants of this plot, but it holds none. "
                "Check its coordinates."
            )
        with self._lock, self.store.writing() as db:
            day = _setup(db).day(on)
            treatment = Treatment(day, plants, efficacy)  # or raise
            batch = batches.begin(db, "treatment", product, "")
            said = (day, str(on), treatment.efficacy, product, int(plants.sum()))
            mark = digest((said, blob(ground)), length=24, end=b"")
            names = schema.TREATMENTS.names
            cursor = db.execute(
                f"INSERT OR IGNORE INTO treatments ({', '.join(names)}) "  # noqa: S608 - ours
                f"VALUES ({', '.join('?' * len(names))})",
                (blob(ground), *said, batch, mark, 0),
            )
            new = cursor.rowcount
            batches.end(db, batch, new)
            touch(db, schema.TREATMENTS.name, ground.bounds)
            if new:
                self._refresh(db, day)
        return Recorded(batch if new else None, new, 1 - new)

    def undo(self, batch: int | None = None, inspection: int | None = None) -> str:
        """Take a batch back (None: the last one), or one inspection; nothing is deleted.

        Return a sentence that says what was undone. Raise `SettingError` if there is nothing.
        """
        with self._lock, self.store.writing() as db:
            if inspection is None:
                said = batches.undo(db, batch)
            else:
                said = batches.undo_one(db, inspection)
            self._refresh(db)
        return said

    # -- what is known

    def morning(self, on: date) -> Floats:
        """Return the chance map ``(n,)`` of a morning."""
        with self._lock:
            snapshot = self._now()
            return snapshot.morning(snapshot.setup.day(on)).chance

    def evening(self, on: date) -> Floats:
        """Return the chance map ``(n,)`` of a day, after what was recorded of it so far."""
        with self._lock:
            snapshot = self._now()
            day = snapshot.setup.day(on)
            return snapshot.history.evening(snapshot.morning(day), day).chance

    def status(self, on: date) -> Status:
        """Return where the season stands on a day."""
        with self._lock:
            snapshot = self._now()
            setup, history, grid = snapshot.setup, snapshot.history, self.plot.grid
            day = setup.day(on)
            morning = snapshot.morning(day)
        progress = Progress.of(history, day)
        return Status(
            day=day,
            on=on,
            plants=len(grid),
            inspected=progress.inspected,
            found=progress.found,
            inspected_today=progress.inspected_today,
            found_today=progress.found_today,
            estimate=derived_layers.evening_estimate(history, morning, day),
            days_since=progress.days_since,
            hot_spots=hot_spots(grid, history.states(day)),
        )

    def progress(self, on: date) -> Progress:
        """Return how far the inspections are after a day's work; nothing is estimated for it."""
        now = self._now()
        return Progress.of(now.history, now.setup.day(on))

    def day_figures(self, on: date) -> DayFigures:
        """Return a day in figures: those kept with it, or else worked out, which takes seconds."""
        for kept in self.days():
            if kept.on == on:
                return kept
        with self._lock:
            now = self._now()
            day = now.setup.day(on)
            estimate = derived_layers.evening_estimate(now.history, now.morning(day), day)
        return DayFigures.of(on, Progress.of(now.history, day), estimate)

    def days(self) -> tuple[DayFigures, ...]:
        """Return the figures of the days on which anything was planned or recorded, in order."""
        with self.store.reading() as db:
            return day_figures.kept(db)

    def batches(self) -> tuple[Batch, ...]:
        """Return everything recorded, the last one first."""
        with self.store.reading() as db:
            return batches.all_of(db)

    def remarks(self) -> tuple[Remark, ...]:
        """Return what the imports had to say."""
        with self.store.reading() as db:
            return tables.read_remarks(db)

    def last_date(self) -> date:
        """Return the last day on which anything was planned or recorded; at first the first."""
        with self.store.reading() as db:
            (day,) = db.execute("SELECT max(day) FROM days").fetchone()
            return _setup(db).date(int(day))

    def verify(self) -> tuple[str, ...]:
        """Hold the chance maps rebuilt from the causes to the digests kept; say what differs."""
        with self._lock:
            snapshot = self._now()
            with self.store.reading() as db:
                kept = db.execute("SELECT day, date, digest FROM days ORDER BY day").fetchall()
            return tuple(
                f"The chance map of {on} comes out differently from the one used then: it was "
                "made by another version of fieldmon, or the file was changed by other hands."
                for day, on, then in kept
                if derived_layers.map_digest(snapshot.morning(day).chance) != then
            )

    def rebuild(self) -> None:
        """Write all layers that follow from the causes anew."""
        with self._lock, self.store.writing() as db:
            self._refresh(db)

    # -- inside

    def _now(self) -> _Snapshot:
        with self._lock, self.store.reading() as db:
            return self._read(db)

    def _read(self, db: sqlite3.Connection) -> _Snapshot:
        """Return what the file says; nothing is read again that did not change."""
        revision = _revision(db)
        if self._last is None or self._last.revision != revision:
            setup = _setup(db)
            prior = self._first_morning(setup)
            treatments = tuple(
                Treatment(day, self._inside(geometry(geom)), efficacy)
                for day, geom, efficacy in db.execute(
                    "SELECT day, geom, efficacy FROM treatments WHERE undone = 0 ORDER BY fid"
                )
            )
            history = replace(
                _nothing_yet(self.plot, setup, prior),
                inspections=inspection_table.load(db),
                treatments=treatments,
            )
            self._last = _Snapshot(revision, setup, history, [history.prior])
        return self._last

    def _first_morning(self, setup: SeasonSetup) -> Floats:
        key = (setup.begins, setup.prior)
        if self._prior is None or self._prior[0] != key:
            begins = np.datetime64(setup.begins, "D")
            plot, records = self.plot, self.observations
            chance = prior_chance(plot.grid, plot.field, records, begins, setup.prior, self.risk)
            self._prior = (key, chance)
        return self._prior[1]

    def _inside(self, area: shapely.Geometry) -> NDArray[np.bool_]:
        ground = self.plot.grid.frame.geometry_m(area)
        shapely.prepare(ground)
        inside: NDArray[np.bool_] = shapely.intersects_xy(ground, self.plot.grid.xy_m)
        return inside

    def _refresh(self, db: sqlite3.Connection, since: int = 0) -> None:
        """Write what follows from the causes, within the transaction that changes them."""
        self._last = None
        now = self._read(db)
        derived_layers.refresh(db, self.plot, now.setup, now.history, now.morning, since)
        self._last = None  # the transaction may yet fail


def _nothing_yet(plot: Plot, setup: SeasonSetup, prior: Floats) -> History:
    belief = PairApproximation.of(plot.grid, prior)
    return History(plot.grid, belief, beliefs=setup.beliefs, detection=setup.robot.detects)


def _revision(db: sqlite3.Connection) -> str:
    """Return what changes when anything that counts does, whoever changed it."""
    counted = db.execute("SELECT count(*), max(fid), total(undone) FROM inspections").fetchone()
    return repr((get_meta(db, "revision"), counted))


def _setup(db: sqlite3.Connection) -> SeasonSetup:
    return from_json(settings_log.now(db))
