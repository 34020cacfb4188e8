"""A monitoring season that grows day by day, kept in one GeoPackage."""

from __future__ import annotations

import threading
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.compute.wording import worded
from fieldmon.decisions.labels import label_for
from fieldmon.decisions.map_verdict import map_verdict
from fieldmon.decisions.zones import outline_of
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.hotspots import record_states
from fieldmon.infestation.observations import Observations, usable
from fieldmon.infestation.prior import prior_chance
from fieldmon.io.writers.geojson import RouteNotes
from fieldmon.monitoring import (
    batches,
    cautions,
    copy_corrections,
    day_figures,
    derived_layers,
    drafts,
    first_morning,
    inspection_lots,
    inspection_table,
    label_table,
    merging,
    outside_changes,
    qgis_project,
    routes,
    schema,
    season_log,
    settings_log,
    tables,
    treatment_effect,
    treatments,
)
from fieldmon.monitoring.advice import AdviceSettings, advice
from fieldmon.monitoring.applications import Application
from fieldmon.monitoring.batches import Recorded
from fieldmon.monitoring.day_figures import DayFigures, Progress
from fieldmon.monitoring.history import BeliefSettings, History, Shift, Treatment
from fieldmon.monitoring.merging import Merged
from fieldmon.monitoring.mornings import Mornings, is_behind
from fieldmon.monitoring.mornings import keep as keep_mornings
from fieldmon.monitoring.mornings import take as take_mornings
from fieldmon.monitoring.recorded_before import (
    Contradictions,
    contradicting,
    contradictions,
    said_before,
)
from fieldmon.monitoring.settings import MonitoringSettings, as_json, from_json, seconds
from fieldmon.monitoring.status import Status
from fieldmon.monitoring.transactions import Store, get_meta, set_meta
from fieldmon.monitoring.treatments import TreatedPlace
from fieldmon.pests.development import development
from fieldmon.planning.assumptions import assumed_by
from fieldmon.planning.plan import DayPlan, plan_in
from fieldmon.planning.route import route_of
from fieldmon.planning.team_day import Posted, team_day
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.grid import RowLabel, row_label
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable, Iterator, Sequence
    from datetime import date, time

    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.compute.units import Units
    from fieldmon.decisions.labels import ProductLabel
    from fieldmon.decisions.map_verdict import MapVerdict
    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.infestation.learnt import Learnt
    from fieldmon.infestation.level_range import LevelRange
    from fieldmon.monitoring.advice import Advice
    from fieldmon.monitoring.batches import Batch
    from fieldmon.monitoring.cautions import Caution
    from fieldmon.monitoring.season_log import LogEntry
    from fieldmon.monitoring.tables import KeptMessage
    from fieldmon.monitoring.treatment_effect import TreatmentEffect
    from fieldmon.monitoring.treatments import KeptTreatment
    from fieldmon.pests.development import Development
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.wishes import Wishes
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.plot.travel import Aisles
    from fieldmon.samplers.base import Scene

    Floats = NDArray[np.float64]


class _Revision(NamedTuple):
    """What changes when anything that counts does, whoever changed it.

    Parameters
    ----------
    changes
        How often the file was changed by us.
    inspections
        How often a row of the inspections was changed, by whomever.
    """

    changes: int
    inspections: int

    @classmethod
    def of(cls, db: sqlite3.Connection) -> _Revision:
        kept = (get_meta(db, name) for name in ("revision", schema.INSPECTIONS_CHANGED))
        return cls(*(int(value or 0) for value in kept))


class _Prior(NamedTuple):
    """The chance map of the first morning ``(n,)``, and from which choices and causes it is."""

    key: tuple[object, object]
    causes: str
    chance: Floats


@dataclass(frozen=True, eq=False)
class _Contents:
    """What the file said when it was read last."""

    revision: _Revision
    settings: MonitoringSettings
    history: History
    mornings: Mornings

    def morning(self, day: int) -> Belief:
        return self.mornings.of(day)

    def still_counts(
        self, revision: _Revision, settings: MonitoringSettings, treated: Sequence[Treatment]
    ) -> bool:
        """Tell whether all that the mornings follow from is still what it was."""
        return (
            self.revision.inspections == revision.inspections
            and as_json(self.settings) == as_json(settings)
            and len(self.history.treatments) == len(treated)
            and all(map(_same_treatment, self.history.treatments, treated))
        )


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
        self._last: _Contents | None = None
        self._written: _Contents | None = None
        self._prior: _Prior | None = None
        self._aisles: dict[tuple[float, float], Aisles] = {}
        with self.store.reading() as db:
            self.plot: Plot = tables.read_plot(db)
            self.observations: Observations = tables.read_observations(db)
            self.risk: Floats | None = tables.read_arrays(db, "risk").get("risk")
        #: findings that another program added to the file, and why some of them do not count
        self.drafts = self.take_drafts()

    def __repr__(self) -> str:
        """Say which file and which plot."""
        return f"<Season {self.path.name}: {self.plot!r}>"

    @classmethod
    def create(
        cls,
        path: str | Path,
        plot: Plot,
        observations: Observations | None = None,
        settings: MonitoringSettings | None = None,
        messages: Iterable[KeptMessage] = (),
        risk: Floats | None = None,
        **chosen: Any,  # noqa: ANN401 - fields of the settings
    ) -> Season:
        """Begin a season in a new file, whole or not at all; raise `FileProblem` if it exists.

        Settings may be given one by one instead, as ``begins=date(2026, 11, 18)`` or
        ``robot=Robot(hours=4)``; a season begins today (in the plot's time zone) unless told
        otherwise.

        `risk` ``(n,)`` is one more chance of being infested at the start, from a raster for
        instance, see `fieldmon.infestation.prior.prior_chance`.
        """
        if settings is None:
            today = local_clock(plot.field).today()
            settings = MonitoringSettings(**({"begins": today} | chosen))
        if observations is None:
            observations = Observations.none()
        begins = np.datetime64(settings.begins, "D")
        prior = prior_chance(plot.grid, plot.field, observations, begins, settings.prior, risk)
        history = _nothing_yet(plot, settings, prior, observations)
        first = _Contents(_Revision(0, 0), settings, history, Mornings(history))
        with Store.new(path) as db:
            tables.write_plot(db, plot)
            tables.write_observations(db, observations)
            tables.write_messages(db, messages)
            if risk is not None:
                tables.write_array(db, "risk", risk)
            settings_log.write(db, as_json(settings))
            set_meta(db, "revision", "0")
            derived_layers.refresh(db, plot, history, first.morning)
            qgis_project.keep(db, Path(path).name)
            season_log.begin(db, f"a season on {plot.field.name}")
        return cls(path)

    @property
    def path(self) -> Path:
        """Return the file."""
        return self.store.path

    @property
    def revision(self) -> str:
        """Return what changes when anything that counts does, whoever changed it."""
        with self.store.reading() as db:
            return repr(tuple(_Revision.of(db)))

    @property
    def settings(self) -> MonitoringSettings:
        """Return what is chosen for the season."""
        return self._now().settings

    @property
    def history(self) -> History:
        """Return all that happened so far."""
        return self._now().history

    def assumed(self) -> tuple[Assumed, ...]:
        """Return what the season's figures rest on though nobody said it."""
        settings = self.settings
        made = assumed_by(self.plot.assumed, settings.prior, settings.robot, self.plot.grid)
        rate = settings.belief.spread.rate_per_day
        if settings.pest is not None or rate != BeliefSettings().spread.rate_per_day:
            return made
        return (*made, Assumed("rate_per_day", rate))

    @cached_property
    def label(self) -> RowLabel:
        """Row and number of every plant, as people count."""
        return row_label(self.plot.grid)

    def change(self, settings: MonitoringSettings, seen: MonitoringSettings, who: str = "") -> None:
        """Choose otherwise; raise `FileProblem` if the choices are no longer those `seen`."""
        with self._lock, self.store.writing() as db:
            if as_json(_settings(db)) != as_json(seen):
                raise FileProblem(
                    worded(
                        "The season's settings must be as they were when you looked, but another "
                        "window changed them. Look again and repeat your change."
                    )
                )
            self._log_change(db, settings_log.write(db, as_json(settings)), who)
            self._refresh(db)

    def before_change(self) -> MonitoringSettings | None:
        """Return what counted before the last change of settings; None: nothing was changed."""
        with self.store.reading() as db:
            parts = settings_log.before_now(db)
        return None if parts is None else from_json(parts)

    def undo_change(self, who: str = "") -> MonitoringSettings:
        """Take the last change of settings back; return what counts again.

        Raise `SettingError` if there is none.
        """
        with self._lock, self.store.writing() as db:
            before = settings_log.now(db)
            settings = settings_log.undo(db)
            now = settings_log.now(db)
            self._log_change(db, [name for name in now if now[name] != before.get(name)], who)
            self._refresh(db)
        return settings

    def _log_change(self, db: sqlite3.Connection, names: list[str], who: str) -> None:
        now = settings_log.now(db)
        season_log.append(
            db, "changed", who,
            states={"settings": season_log.settings_state(db)},
            names=", ".join(names), now={name: now[name] for name in names},
        )  # fmt: skip

    # -- the working day

    def plan(
        self, on: date, now: time | None = None, *, keep: bool = True,
        wishes: Wishes | None = None, who: str | None = None,
    ) -> DayPlan:  # fmt: skip
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
        wishes
            What people want of the day besides.
        who
            Whose day, of a team; None: the first one's. All are planned, see `plan_each`.
        """
        days = self.plan_each(on, now, keep=keep, wishes=wishes)
        team = self.settings.team
        return days[team.index(self.settings.member(who)) if who and team else 0]

    def plan_each(
        self, on: date, now: time | None = None, *, keep: bool = True,
        wishes: Wishes | None = None,
    ) -> tuple[DayPlan, ...]:  # fmt: skip
        """Plan what is left of a day for each of the team, or for the one who works.

        In the order of the team. Aisles that the routes kept of this day gave to one stay its own
        unless another way to give them out gains enough, see `Teamwork`.
        """
        with self._lock:
            contents = self._now()
            settings, day = contents.settings, contents.settings.day(on)
            now_s = None if now is None else seconds(now)
            if settings.team:
                days = self._team_days(contents, day, now_s, wishes)
            else:
                shift = self._shift(settings, settings.robot)
                scene = contents.history.scene(shift, day, contents.morning(day), now_s)
                days = (plan_in(scene, settings.decides(), wishes),)
            noted = tuple(
                self._noted(settings, today, who)
                for today, who in zip(days, _names(settings), strict=True)
            )
            if keep:
                self._keep(settings, noted)
        return noted

    def _keep(self, settings: MonitoringSettings, noted: tuple[DayPlan, ...]) -> None:
        """Keep routes; those that are kept already are not written: that would wait for readers."""
        named = [
            (today, who)
            for today, who in zip(noted, _names(settings), strict=True)
            if len(today.route)
        ]
        with self.store.reading() as db:
            is_kept = all(routes.is_kept(db, today, who) for today, who in named)
        if is_kept:
            self._keep_what_was_worked_out()
            return
        with self._writing() as db:
            before = self._read(db)
            kept = [
                (today, who)
                for today, who in named
                if routes.keep(db, settings, self.label, today, who)
            ]
            for today, who in kept:
                season_log.append(db, "planned", who, **routes.in_words(settings, today))
            if kept:
                self._refresh(db, named[0][0].scene.day, before)

    def _keep_what_was_worked_out(self) -> None:
        """Keep mornings that another version of fieldmon left to us; wait for nobody."""
        now = self._now()
        with self.store.reading() as db:
            newest = _newest(db)
            if not is_behind(db, now.mornings, newest):
                return
        with suppress(FileProblem), self.store.writing(patience_s=0.0) as db:
            if _Revision.of(db) == now.revision:
                self._keep_mornings(db, now.mornings, newest)

    def _keep_mornings(self, db: sqlite3.Connection, mornings: Mornings, newest: int) -> None:
        keep_mornings(db, mornings, newest)
        if self._prior is not None:
            first_morning.keep(db, self._prior.causes, self._prior.chance)

    def _noted(self, settings: MonitoringSettings, today: DayPlan, who: str) -> DayPlan:
        begins = routes.begins(settings, today, who)
        notes = RouteNotes(self.plot.field.name, settings.sampler, begins, who or None)
        return replace(today, route=replace(today.route, notes=notes))

    def _shift(
        self, settings: MonitoringSettings, robot: Robot, member: TeamMember | None = None
    ) -> Shift:
        starts_s, streams = seconds(settings.starts), RandomStreams(settings.seed)
        if member is None:
            return Shift(self.plot.aisles, robot, starts_s, streams)
        return Shift(self.aisles_from(member.gate), robot, starts_s + member.starts_s, streams)

    def aisles_from(self, gate: tuple[float, float] | None) -> Aisles:
        """Return the ways on the plot with another gate; None: its own."""
        if gate is None:
            return self.plot.aisles
        if gate not in self._aisles:
            self._aisles[gate] = self.plot.with_gate(gate).aisles
        return self._aisles[gate]

    def _team_days(
        self, contents: _Contents, day: int, now_s: float | None, wishes: Wishes | None
    ) -> tuple[DayPlan, ...]:
        settings, history = contents.settings, contents.history
        scenes, posts = [], []
        for member in settings.team:
            shift = self._shift(settings, member.robot, member)
            scene = history.scene(shift, day, contents.morning(day), now_s, member.name)
            begun_s = member.starts_s + member.robot.day_s - scene.seconds_left
            told = scene if wishes is None else wishes.told(scene)
            scenes.append(scene)
            posts.append(Posted(told, begun_s, np.zeros(len(scene.chance), np.bool_)))
        before = self._given_out(settings, day)
        works = team_day(posts, settings.decides(), settings.teamwork, before=before)
        return tuple(
            DayPlan(scene, work, route_of(scene, work))
            for scene, work in zip(scenes, works, strict=True)
        )

    def _given_out(self, settings: MonitoringSettings, day: int) -> NDArray[np.int64] | None:
        """Return who has each aisle by the routes kept of a day, -1: nobody; None: none is kept."""
        aisle = self.plot.grid.corridor[self.plot.grid.row]
        given = np.full(int(aisle.max()) + 1, -1)
        with self.store.reading() as db:
            for k, member in enumerate(settings.team):
                given[aisle[routes.plants(db, day, member.name)]] = k
        return given if (given >= 0).any() else None

    def scene(self, on: date, now: time | None = None, who: str = "") -> Scene:
        """Return a day as it stands after what was recorded of it; `now` as in `plan`.

        Of a team it is that of the one named, or of the first.
        """
        with self._lock:
            return self._scene(self._now(), on, now, who)

    def _scene(
        self, contents: _Contents, on: date, now: time | None = None, who: str = ""
    ) -> Scene:
        settings, day = contents.settings, contents.settings.day(on)
        now_s = None if now is None else seconds(now)
        morning = contents.morning(day)
        if not settings.team:
            shift = self._shift(settings, settings.robot)
            return contents.history.scene(shift, day, morning, now_s)
        member = settings.member(who) if who else settings.team[0]
        shift = self._shift(settings, member.robot, member)
        return contents.history.scene(shift, day, morning, now_s, member.name)

    def kept_route(self, on: date, who: str = "") -> NDArray[np.int32]:
        """Return the plants ``(k,)`` of the latest route kept for a day; empty if there is none.

        Of a team it is that of the one named, or of the first.
        """
        with self._lock, self.store.reading() as db:
            settings = self._read(db).settings
            if settings.team:
                who = settings.member(who).name if who else settings.team[0].name
            return routes.plants(db, settings.day(on), who)

    def contradictions(self, inspections: Inspections) -> Contradictions:
        """Return those that say otherwise than what is recorded of the same plant and day."""
        return contradictions(inspections, self.history.inspections)

    def record(
        self,
        inspections: Inspections,
        source: str = "",
        who: str = "",
        *,
        confirmed: bool = False,
        into: int | None = None,
    ) -> Recorded:
        """Add inspections; those that the season holds already change nothing.

        Parameters
        ----------
        inspections
            What was found where and when.
        source, who
            File or screen it comes from; the person, where the inspections name none.
        confirmed
            Whether results count that contradict what is recorded of the same plant and day.
        into
            Batch to add them to, as `Recorded` numbers it; None: a new one.

        Raises
        ------
        ContradictionError
            If there are such results and nobody confirmed them.
        ObservationError
            If a plant is not on this plot, or a result has no date or an impossible one.
        SettingError
            If a date is not of this season.
        """
        with self._writing() as db:
            before = self._read(db)
            held = before.history.inspections
            if not confirmed:
                contradictions(inspections, held).refuse(self.label)
            news = inspections.take(~said_before(inspections, held))
            batch = batches.begin(db, "findings", source, who) if into is None else into
            if into is not None:
                batches.must_count(db, into)
            made = inspection_table.rows(
                news, self.plot.grid, self.label, _settings(db), (batch, who)
            )
            new = inspection_table.store(db, made)
            batches.end(db, batch, new, grows=into is not None)
            if new:
                self._log_seen(db, news, (batch, source, who))
                first = _settings(db).day(inspections.date.min().item())
                self._refresh(db, first, before)
        return Recorded(batch if new else None, new, len(inspections) - new)

    def _log_seen(
        self, db: sqlite3.Connection, news: Inspections, said: tuple[int, str, str]
    ) -> None:
        batch, source, who = said
        names = {str(name) for name in news.who} - {""}
        season_log.append(
            db, "seen", who or ", ".join(sorted(names)), states=season_log.states(db, [batch]),
            batch=batch, source=source, **inspection_table.in_words(news.result, news.date),
        )  # fmt: skip

    @contextmanager
    def changing(self) -> Iterator[SeasonChange]:
        """Give the file for one change: all is kept with what follows from it, or nothing."""
        with self._lock, self.store.writing() as db:
            change = SeasonChange(db)
            yield change
            if change.since is not None:
                self._refresh(db, change.since)

    def settings_in(self, db: sqlite3.Connection) -> MonitoringSettings:
        """Return what is chosen for the season, as a transaction sees it."""
        return self._read(db).settings

    def contradicting(self, on: date) -> Inspections:
        """Return a day's inspections of plants that were both clean and found on it."""
        return contradicting(self.history.inspections.on(on))

    def treat(
        self, on: date, efficacy: float | None = None, area: MultiPolygon | None = None,
        product: str = "", *, application: Application | None = None,
        plants: NDArray[np.bool_] | None = None,
    ) -> Recorded:  # fmt: skip
        """Note that a part of the plot was treated, after the day's work.

        Parameters
        ----------
        on
            The day.
        efficacy
            Chance that an infested plant is clean afterwards; None: what the season learnt of this
            product, see `effects`.
        area
            Outline, lon/lat; None: the whole plot, unless `plants` are given.
        product
            What was used, where nothing else is said of it.
        application
            What was applied and how. What it does not say of waiting periods and of the
            mode-of-action group comes from the product's label, where the season has one.
        plants
            ``(n,)`` the plants that were treated one by one, instead of an area.

        Raises
        ------
        SettingError
            If no plant was treated, or nothing tells how well it works.
        """
        said = Application(product) if application is None else application
        if area is not None and plants is not None:
            raise SettingError(
                worded("A treatment is of an area or of plants, but both were given.")
            )
        place = self._treated(area) if plants is None else self._treated_one_by_one(plants)
        if not place.plants.any():
            raise SettingError(
                worded(
                    "The area treated must hold plants of this plot, but it holds none. Check its "
                    "coordinates."
                )
            )
        works = self._efficacy(said.product) if efficacy is None else efficacy
        with self._writing() as db:
            before = self._read(db)
            day = _settings(db).day(on)
            said = said.by_label(
                label_for(label_table.read(db), said.product, said.crop, said.pest)
            )
            treatment = Treatment(day, place.plants, works)  # or raise
            batch = batches.begin(db, "treatment", said.product, said.operator)
            new = treatments.store(
                db, treatment, (place, on, said), batch, local_clock(self.plot.field)
            )
            batches.end(db, batch, new)
            if new:
                season_log.append(
                    db, "treated", said.operator, states=season_log.states(db, [batch]),
                    batch=batch, date=str(on), said=treatments.in_words(place, said),
                    efficacy=works, **said.said(),
                )  # fmt: skip
                self._refresh(db, day, before)
        return Recorded(batch if new else None, new, 1 - new)

    def _treated(self, area: MultiPolygon | None) -> TreatedPlace:
        boundary = self.plot.field.boundary
        ground = boundary if area is None else area
        frame = self.plot.grid.frame
        on_plot = shapely.intersection(frame.geometry_m(ground), frame.geometry_m(boundary))
        return TreatedPlace(ground, self._inside(ground), float(on_plot.area) / 1e4)

    def _treated_one_by_one(self, plants: NDArray[np.bool_]) -> TreatedPlace:
        grid = self.plot.grid
        if plants.shape != (len(grid),):
            raise SettingError(
                worded(
                    "Whether it was treated must be said of each of the {n} plants, but it is of "
                    "{size}.",
                    n=len(grid),
                    size=plants.size,
                )
            )
        outline = outline_of(grid, np.asarray(plants, bool))
        area_ha = float(grid.frame.geometry_m(outline).area) / 1e4
        return TreatedPlace(outline, np.asarray(plants, bool), area_ha, by_plant=True)

    def _efficacy(self, product: str) -> float:
        """Return how well a product works, as the season learnt it."""
        known = treatment_effect.learnt_efficacy(self.effects(self.last_date()), product)
        if known is None:
            raise SettingError(
                worded(
                    "How well a treatment works must be said (efficacy, 0 to 1), for this season "
                    "has not learnt it: no plant was inspected before and after a treatment with "
                    "{product}.",
                    product=product or worded("a product that nobody named"),
                )
            )
        return known.efficacy

    def treatments(self) -> tuple[KeptTreatment, ...]:
        """Return the treatments that count, in the order in which they ended."""
        with self._lock, self.store.reading() as db:
            return self._treatments(db)

    def _treatments(self, db: sqlite3.Connection) -> tuple[KeptTreatment, ...]:
        outside_changes.refuse(db)
        return treatments.kept(db, self._inside, local_clock(self.plot.field))

    def keep_labels(self, labels: Iterable[ProductLabel], source: str = "", who: str = "") -> int:
        """Let these be what labels allow, instead of those before; return how many there are."""
        kept = tuple(labels)
        with self._lock, self.store.writing() as db:
            if kept != label_table.read(db):
                label_table.write(db, kept)
                season_log.append(
                    db, "labels", who, states={"labels": season_log.labels_state(db)},
                    labels=len(kept), source=source,
                )  # fmt: skip
        return len(kept)

    def labels(self) -> tuple[ProductLabel, ...]:
        """Return what the labels of products allow, as the user's own table says."""
        with self.store.reading() as db:
            return label_table.read(db)

    def cautions(self, on: date, units: Units | None = None) -> tuple[Caution, ...]:
        """Return what to beware of on a day: harvest, entry, resistance, what labels allow."""
        with self._lock, self.store.reading() as db:  # all of one moment
            settings, labels = self._read(db).settings, label_table.read(db)
            done = self._treatments(db)
        rules = cautions.RulesToKeep(labels, settings.harvest, settings.starts)
        if units is not None:
            rules = replace(rules, units=units)
        return cautions.cautions(done, rules, on)

    def harvest_from(self, on: date) -> tuple[date, KeptTreatment] | None:
        """Return the first day of harvest that treatments up to a day allow, and which one waits.

        None: no treatment is known to need a wait.
        """
        with self._lock, self.store.reading() as db:  # both of one moment
            done = [one for one in self._treatments(db) if one.on <= on]
            labels = label_table.read(db)
        return cautions.harvest_from(done, labels)

    def effects(self, on: date, units: Units | None = None) -> tuple[TreatmentEffect, ...]:
        """Return what inspections up to the evening of a day tell of each treatment before it."""
        with self._lock, self.store.reading() as db:  # both of one moment
            now, done = self._read(db), self._treatments(db)
        day = now.settings.day(on)
        return treatment_effect.effects(done, now.history, day, units)

    def advise(self, on: date, said: str, who: str = "") -> None:
        """Write into the log what was advised for a day, unless that was written last of it."""
        with self._lock, self.store.reading() as db:
            if _advised(db, on)[-1:] == [said]:
                return
        with self._lock, self.store.writing() as db:
            if _advised(db, on)[-1:] != [said]:  # nor has anybody else written it meanwhile
                season_log.append(db, "advised", who, date=str(on), said=said)

    def log(self) -> tuple[LogEntry, ...]:
        """Return the log, the first entry first.

        Raise `FileProblem` where the past was changed: at which entry.
        """
        with self.store.reading() as db:
            return season_log.entries(db)

    def held_to_log(self) -> tuple[str, ...]:
        """Return a sentence for each thing that the file says otherwise than its log."""
        with self.store.reading() as db:
            wrong = {
                "inspections": inspection_table.not_what_they_say(db),
                "treatments": treatments.not_what_they_say(db),
            }
            return (
                *season_log.differing(db),
                *(
                    worded(
                        "Row {row} of the layer {layer} is not what was recorded.",
                        row=row,
                        layer=layer,
                    )
                    for layer, rows in wrong.items()
                    for row in rows
                ),
            )

    def undo(self, batch: int | None = None, inspection: int | None = None, who: str = "") -> str:
        """Take a batch back (None: the last one), or one inspection; nothing is deleted.

        Return a sentence that says what was undone. Raise `SettingError` if there is nothing.
        """
        with self._lock, self.store.writing() as db:
            if inspection is None:
                number, said = batches.undo(db, batch)
            else:
                number, said = batches.undo_one(db, inspection)
            states = season_log.states(db, [number])
            season_log.append(db, "undone", who, states=states, batch=number, said=said)
            self._refresh(db)
        return said

    def correct(self, who: str) -> int:
        """Take what another program changed of inspections as corrections; return how many.

        They are a batch of their own, of this person; undoing it takes the corrected rows out.
        Raise `FileProblem` if more than inspections was changed, or what makes no sense.
        """
        with self._lock, self.store.writing() as db:
            outside_changes.refuse_more(db)
            settings, plot = _settings(db), (self.plot.grid, self.label)
            n = outside_changes.correct(db, plot, settings, who)
            if n:
                season_log.append(db, "corrected", who, states=season_log.states(db), rows=n)
                self._refresh(db)
        return n

    def take_drafts(self) -> tuple[str, ...]:
        """Let findings count that another program added to the file itself.

        They are a batch of their own. Return a sentence for each that does not count, and why; it
        stays as it is. Where more was changed, nothing is taken before that is settled.
        """
        plot = self.plot.grid, self.label
        with self._lock, self.store.reading() as db:
            if not drafts.any_waiting(db) or outside_changes.waiting(db):
                return ()
            known = self._read(db)
            found = drafts.read(db, plot, known.settings, known.history.inspections)
        if any(one.inspection is not None for one in found):
            try:
                with self._writing() as db:
                    before = self._read(db)
                    found = drafts.read(db, plot, before.settings, before.history.inspections)
                    good = [one for one in found if one.inspection is not None]
                    self._take_drafts(db, good, before.settings)
            except FileProblem as error:  # who may only read it reads it without them
                return (str(error),)
        return tuple(one.sentence for one in found if one.inspection is None)

    def _take_drafts(
        self, db: sqlite3.Connection, taken: list[drafts.Draft], settings: MonitoringSettings
    ) -> None:
        batch = batches.begin(db, "findings", drafts.SOURCE, "")
        said = (self.plot.grid, self.label), settings, batch
        news = drafts.keep(db, taken, *said)
        batches.end(db, batch, len(taken))
        self._log_seen(db, news, (batch, drafts.SOURCE, ""))
        # there are as many rows as before: all is read again
        self._refresh(db, settings.day(news.date.min().item()))

    def corrections_in(self, copy: Path) -> tuple[outside_changes.OutsideChange, ...]:
        """Return what another program changed of inspections in a copy of this season.

        A file that is no copy of it has none.
        """
        with self.store.reading() as db, Store(copy).reading() as theirs:
            try:
                merging.refuse_strangers(db, theirs)
            except FileProblem:
                return ()
            return copy_corrections.waiting(theirs)

    def take_corrections(self, copy: Path, name: str, who: str) -> int:
        """Take what was corrected or deleted in a copy of this season; return how many were new.

        They are a batch of their own, of this person. Raise `FileProblem` if a changed row makes no
        sense or is not here, and `SettingError` if nobody is named.
        """
        if not who.strip():
            raise SettingError(
                worded(
                    "Corrections must have an author, but {name} was changed by another program "
                    "and nobody says who did. Give --who NAME.",
                    name=name,
                )
            )
        with self._lock, self.store.writing() as db, Store(copy).reading() as theirs:
            plot = self.plot.grid, self.label
            n = copy_corrections.take(db, theirs, plot, _settings(db), (name, who.strip()))
            if n:
                states = season_log.states(db)
                season_log.append(db, "corrected", who.strip(), states=states, rows=n)
                self._refresh(db)
        return n

    def merge(self, other: Season) -> Merged:
        """Take in what another copy of this season holds: all that is in either, once each.

        The other one stays as it is. Raise `FileProblem` if it is no copy of this season.
        """
        with self._lock, self.store.writing() as db:
            before, was = inspection_table.n_counting(db), season_log.states(db)
            with other._lock, other.store.reading() as theirs:
                contradict = contradictions(
                    other._read(theirs).history.inspections, self._read(db).history.inspections
                )
                told = season_log.taken_in(db, theirs)
                chosen = merging.merge(db, theirs)
            self._refresh(db)
            new = inspection_table.n_counting(db) - before
            if told or season_log.states(db) != was:
                season_log.append(
                    db, "merged", states=season_log.states(db), new=new, entries=len(told),
                    theirs=told,
                )  # fmt: skip
        return Merged(new, (*contradict.sentences(self.label), *chosen))

    # -- what is known

    def morning(self, on: date) -> Floats:
        """Return the chance map ``(n,)`` of a morning."""
        with self._lock:
            contents = self._now()
            return contents.morning(contents.settings.day(on)).chance

    def evening(self, on: date) -> Floats:
        """Return the chance map ``(n,)`` of a day, after what was recorded of it so far."""
        with self._lock:
            contents = self._now()
            day = contents.settings.day(on)
            return contents.history.evening(contents.morning(day), day).chance

    def level_range(self, on: date) -> LevelRange:
        """Return how far the chances of `evening` may be off together: 90 %, on the odds."""
        with self._lock:
            contents = self._now()
            day = contents.settings.day(on)
            return contents.history.level_range(contents.morning(day), day)

    def verdict(
        self, on: date, level: float, sure: float = 0.9, plants: NDArray[np.bool_] | None = None
    ) -> MapVerdict:
        """Return whether treating pays after a day's work; see `fieldmon.decisions`.

        Plants that were found and not treated count: they are infested. `plants` ``(n,)`` is the
        part of the plot that is asked about; None: all.
        """
        with self._lock:
            contents = self._now()
            day = contents.settings.day(on)
            evening = contents.history.evening(contents.morning(day), day)
        return map_verdict(
            contents.history.grid, evening.chance, level, evening.pair_chance,
            plants=plants, sure=sure, doubt=evening.doubt,
        )  # fmt: skip

    def advice(self, on: date, asked: AdviceSettings | None = None) -> Advice:
        """Return whether to treat after a day's work, where, and how many looks decide.

        Parameters
        ----------
        on
            The day.
        asked
            The threshold, the sprayer and the costs; None: the defaults.
        """
        with self._lock:
            contents = self._now()
            scene, day = self._scene(contents, on), contents.settings.day(on)
            evening = contents.history.evening(contents.morning(day), day)
        return advice(contents.history.grid, evening, asked or AdviceSettings(), scene)

    def status(self, on: date) -> Status:
        """Return where the season stands on a day."""
        with self._lock:
            contents = self._now()
            day = contents.settings.day(on)
            now = Status.of(contents.history, contents.morning(day), day)
        return replace(now, development=_development(contents, on))

    def development(self, on: date) -> Development | None:
        """Return how far the pest has come on a day, counted from its first find.

        Until there is one, from the season's first day. None: no pest or weather was given, or
        its development is not known.
        """
        return _development(self._now(), on)

    def forecast(self, on: date) -> Forecast:
        """Return how many plants are infested on the mornings after a day, nobody inspecting."""
        with self._lock:
            contents = self._now()
            day = contents.settings.day(on)
            morning = contents.morning(day)
        return contents.history.forecast(morning, day)  # others may plan meanwhile

    def learnt(self, on: date) -> tuple[Learnt, ...]:
        """Return what the inspections up to the evening of a day tell of the insects."""
        with self._lock:
            contents = self._now()
            day = contents.settings.day(on)
            return contents.history.learnt(contents.morning(day), day)

    def progress(self, on: date) -> Progress:
        """Return how far the inspections are after a day's work; nothing is estimated for it."""
        now = self._now()
        return Progress.of(now.history, now.settings.day(on))

    def day_figures(self, on: date) -> DayFigures:
        """Return a day in figures: those kept with it, or else worked out, which takes seconds."""
        for kept in self.days():
            if kept.on == on:
                return kept
        with self._lock:
            now = self._now()
            day = now.settings.day(on)
            estimate = now.history.estimate(now.morning(day), day)
        return DayFigures.of(on, Progress.of(now.history, day), estimate)

    def days(self) -> tuple[DayFigures, ...]:
        """Return the figures of the days on which anything was planned or recorded, in order."""
        with self.store.reading() as db:
            return day_figures.kept(db)

    def batches(self) -> tuple[Batch, ...]:
        """Return everything recorded, the last one first."""
        with self.store.reading() as db:
            return batches.all_of(db)

    def messages(self) -> tuple[KeptMessage, ...]:
        """Return what the imports had to say."""
        with self.store.reading() as db:
            return tables.read_messages(db)

    def last_date(self) -> date:
        """Return the last day on which anything was planned or recorded; at first the first."""
        with self.store.reading() as db:
            return _settings(db).date(_newest(db))

    def verify(self, *, whole: bool = True) -> tuple[str, ...]:
        """Hold the file to its digests; return a sentence for each thing that differs.

        Whole, every morning since the first is worked out again and each row is held to the log;
        else only the last morning that the file keeps, and those after it.
        """
        doubt = () if self.store.doubt is None else (self.store.doubt,)
        held = self.held_to_log() if whole else ()
        return (*doubt, *held, *self.other_maps(whole=whole))

    def other_maps(self, *, whole: bool = True) -> tuple[str, ...]:
        """Return a sentence for each day whose chance map is not the one that was used then."""
        with self._lock:
            with self.store.reading() as db:  # both at one moment: others may write between
                contents = self._read(db)
                kept = db.execute("SELECT day, date, digest FROM days ORDER BY day").fetchall()
            since = 0 if whole else contents.mornings.last_until(kept[-1][0])
            return tuple(
                worded(
                    "The chance map of {on} comes out differently from the one used then: it was "
                    "made by another version of fieldmon, or the file was changed by other hands.",
                    on=on,
                )
                for day, on, then in kept
                if day >= since and derived_layers.map_digest(contents.morning(day).chance) != then
            )

    def rebuild(self) -> None:
        """Write all layers that follow from the causes anew."""
        with self._lock, self.store.writing() as db:
            self._refresh(db)

    # -- inside

    def _now(self) -> _Contents:
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
        self, db: sqlite3.Connection, before: _Contents | None = None, since: int = 0
    ) -> _Contents:
        """Return what the file says; nothing is read again that did not change.

        What the same transaction read `before` its changes, which reach back to the day `since`,
        need not be read and worked out again.
        """
        outside_changes.refuse(db)
        revision = _Revision.of(db)
        if self._last is None or self._last.revision != revision:
            settings, treated = _settings(db), treatments.load(db, self._inside)
            if before is not None and before.still_counts(revision, settings, treated):
                self._last = replace(before, revision=revision)
                return self._last
            prior = self._first_morning(db, settings)
            if before is not None and before.revision.inspections == revision.inspections:
                inspections = before.history.inspections
            else:
                inspections = inspection_lots.load(db, settings.begins)
            history = replace(
                _nothing_yet(self.plot, settings, prior, self.observations),
                inspections=inspections,
                treatments=treated,
            )
            if before is None:
                mornings = Mornings(history)
                take_mornings(db, mornings)
            else:
                mornings = before.mornings.after_change(history, since)
            self._last = _Contents(revision, settings, history, mornings)
        return self._last

    def _first_morning(self, db: sqlite3.Connection, settings: MonitoringSettings) -> Floats:
        key = (settings.begins, settings.prior)
        if self._prior is None or self._prior.key != key:
            causes = first_morning.causes(db, *key)
            chance = first_morning.take(db, causes)
            if chance is None:
                begins, plot = np.datetime64(settings.begins, "D"), self.plot
                chance = prior_chance(
                    plot.grid, plot.field, self.observations, begins, settings.prior, self.risk
                )
            self._prior = _Prior(key, causes, chance)
        return self._prior.chance

    def _inside(self, area: shapely.Geometry) -> NDArray[np.bool_]:
        ground = self.plot.grid.frame.geometry_m(area)
        shapely.prepare(ground)
        inside: NDArray[np.bool_] = shapely.intersects_xy(ground, self.plot.grid.xy_m)
        return inside

    def _refresh(
        self, db: sqlite3.Connection, since: int = 0, before: _Contents | None = None
    ) -> None:
        """Write what follows from the causes, within the transaction that changes them.

        Nothing before `since` has changed; what the transaction read `before` its changes saves
        working those mornings out again.
        """
        self._last = None
        now = self._read(db, before, since)
        newest = derived_layers.refresh(db, self.plot, now.history, now.morning, since)
        self._keep_mornings(db, now.mornings, newest)
        inspection_lots.keep(db)
        qgis_project.keep(db, self.path.name)
        self._last = None  # the transaction may yet fail
        kept = now.revision._replace(changes=now.revision.changes + 1)
        self._written = replace(now, revision=kept)


def _nothing_yet(
    plot: Plot, settings: MonitoringSettings, prior: Floats, records: Observations
) -> History:
    belief = settings.belief.first_morning(plot.grid, prior, settings.pest)
    known = usable(records, np.datetime64(settings.begins, "D")).observations
    return History(
        plot.grid,
        settings.begins,
        belief,
        belief=settings.belief,
        detection=settings.robot.detects,
        recorded=record_states(plot.grid, known) if len(known) else None,
        detection_of={one.name.casefold(): one.robot.detects for one in settings.team},
        living=settings.living(),
    )


def _development(now: _Contents, on: date) -> Development | None:
    pest, weather = now.settings.pest, now.settings.weather
    if pest is None or weather is None:
        return None
    return development(pest, weather, now.history.first_find(on) or now.settings.begins, on)


def _newest(db: sqlite3.Connection) -> int:
    (day,) = db.execute("SELECT max(day) FROM days").fetchone()
    return int(day)


def _advised(db: sqlite3.Connection, on: date) -> list[str]:
    """Return what was advised for a day, in order."""
    advised = (one.what for one in season_log.entries(db) if one.kind == "advised")
    return [str(one["said"]) for one in advised if one["date"] == str(on)]


def _same_treatment(one: Treatment, other: Treatment) -> bool:
    same_time = (one.day, one.efficacy) == (other.day, other.efficacy)
    return same_time and np.array_equal(one.plants, other.plants)


def _names(settings: MonitoringSettings) -> tuple[str, ...]:
    """Return who works: the names of the team, or nobody's for the one."""
    return tuple(member.name for member in settings.team) or ("",)


def _settings(db: sqlite3.Connection) -> MonitoringSettings:
    return from_json(settings_log.now(db))
