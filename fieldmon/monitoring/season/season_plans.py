"""What a season has its robots and scouts do on a day."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.errors import FileProblem
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.changes.file_revision import FileRevision
from fieldmon.monitoring.days import kept_routes, kept_wishes
from fieldmon.monitoring.estimates.day_figures import PlannedAndDone
from fieldmon.monitoring.estimates.mornings import is_behind
from fieldmon.monitoring.estimates.season_contents import newest_day
from fieldmon.monitoring.file.connections import kept_open
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.season.season_days import SeasonDays
from fieldmon.monitoring.settings.settings import seconds
from fieldmon.monitoring.settings.shift_work import Besides
from fieldmon.planning.members import person_key
from fieldmon.planning.plan import DayPlan, plan_in
from fieldmon.planning.route import route_of
from fieldmon.planning.team_day import team_day
from fieldmon.planning.team_worker import Posted
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Sequence
    from datetime import date
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.compute.day_arguments import Day, TimeOfDay
    from fieldmon.monitoring.days.kept_routes import KeptPlans, KeptRoute
    from fieldmon.monitoring.estimates.season_contents import SeasonContents
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.settings.shift_work import ScoutCrew
    from fieldmon.planning.wishes import Wishes
    from fieldmon.samplers.base import Scene


@checked
class SeasonPlans(SeasonDays):
    """The days of a season as they are planned, and the routes that are kept of them."""

    def __init__(self, path: str | Path) -> None:
        super().__init__(path)
        self._unused_then: dict[int, set[str]] = {}

    @kept_open()
    def plan(
        self, on: Day, now: TimeOfDay | None = None, *, keep: bool = True,
        wishes: Wishes | None = None, who: str | Besides | None = None,
    ) -> DayPlan:  # fmt: skip
        """Plan what is left of a day from all that is known; see `planned_by`.

        Parameters
        ----------
        on
            The day; ``"2026-11-18"`` will do, here and wherever a season asks for one.
        now
            Local time; None: the start of the work or, once something of the day was recorded,
            the time of the last of it.
        keep
            whether the route is kept in the file: the same one once, an empty one never.
        wishes
            What people want of the day besides; None: what is kept of it.
        who
            Whose day, of a team; None: the first one's. All are planned, see `plan_each`. Or that
            of the season's robot `Besides` others, who is not where they inspected last.
        """
        with self._lock:
            contents = self._now()
            settings = self._planned_by(contents, on)
            if isinstance(who, Besides):
                scene, wishes = self._scene(contents, on, now, who), self._wished(on, wishes)
                alone = (plan_in(scene, settings.decides(), wishes),)
                return self._given(contents, on, alone, (who,), ("",), keep=keep)[0]
            days = self.plan_each(on, now, keep=keep, wishes=wishes)
        return days[settings.team.index(settings.member(who)) if who and settings.team else 0]

    @kept_open()
    def plan_each(
        self, on: Day, now: TimeOfDay | None = None, *, keep: bool = True,
        wishes: Wishes | None = None, crew: ScoutCrew | None = None,
    ) -> tuple[DayPlan, ...]:  # fmt: skip
        """Plan what is left of a day for each of the team, or for the one who works.

        Aisles that the routes kept of this day gave to one stay its own unless another way to give
        them out gains enough, see `Teamwork`, or who joined since would have none.

        Parameters
        ----------
        on, now, keep, wishes
            As `plan` takes them.
        crew
            Scouts who are no team's, and share the same plants, instead of the team. Each has the
            season's robot and goes on from where they stand, in aisles of their own.

        Returns
        -------
        tuple of DayPlan
            In the order of the team, or of the crew.
        """
        with self._lock:
            contents, wishes = self._now(), self._wished(on, wishes)
            if crew is not None:
                days = self._crew_days(contents, on, now, wishes, crew)
                return self._given(contents, on, days, crew.names, crew.kept_as, keep=keep)
            settings = self._planned_by(contents, on)
            scenes = [self._scene(contents, on, now, who) for who in _names(settings)]
            if settings.team:
                day_s = seconds(settings.starts)
                begun_s = [self._begun_s(contents, on, who) - day_s for who in _names(settings)]
                gone_s = [scene.robot.day_s - scene.seconds_left for scene in scenes]
                posts = zip(scenes, np.add(begun_s, gone_s).tolist(), strict=True)
                days = self._team_days(settings, _names(settings), tuple(posts), wishes)
            else:
                days = (plan_in(scenes[0], settings.decides(), wishes),)
            return self._given(contents, on, days, _names(settings), keep=keep)

    def _wished(self, on: date, wishes: Wishes | None) -> Wishes | None:
        """Return what is wanted of a day besides; None: nothing."""
        return (kept_wishes.wishes_kept(self, on) if wishes is None else wishes) or None

    def _crew_days(
        self, contents: SeasonContents, on: date, now: time | None, wishes: Wishes | None,
        crew: ScoutCrew,
    ) -> tuple[DayPlan, ...]:  # fmt: skip
        """Return the days of scouts who are no team's, by the time and the wishes asked for."""
        settings, told_s = self._planned_by(contents, on), crew.left_s or {}
        scenes = [self._scene_of_all(contents, on, now, who) for who in crew.names]
        scenes = [
            replace(scene, seconds_left=min(told_s.get(who, scene.seconds_left),
                                            scene.robot.day_s))
            for scene, who in zip(scenes, crew.names, strict=True)
        ]  # fmt: skip
        scenes = [
            self._open_to(scene, contents, on, who)
            for scene, who in zip(scenes, crew.names, strict=True)
        ]
        if len(crew.names) == 1:
            return (plan_in(scenes[0], settings.decides(), wishes),)
        posts = tuple((scene, 0.0) for scene in scenes)  # all go on now
        return self._team_days(settings, crew.names, posts, wishes)

    def _given(
        self, contents: SeasonContents, on: date, days: tuple[DayPlan, ...],
        who: Sequence[str | Besides], kept_as: tuple[str, ...] | None = None, *,
        keep: bool = True,
    ) -> tuple[DayPlan, ...]:  # fmt: skip
        """Return the days of those named, each route with its notes; keep the routes."""
        settings = self._planned_by(contents, on)
        names = tuple(str(one) for one in who) if kept_as is None else kept_as
        noted = tuple(
            self._noted(settings, today, (name, self._begun_s(contents, on, one)))
            for today, name, one in zip(days, names, who, strict=True)
        )
        if keep:
            self._keep(contents, on, noted, names)
        return noted

    def kept_route(self, on: Day, who: str = "") -> NDArray[np.int32]:
        """Return the plants ``(k,)`` of the latest route kept for the day `on`; empty without one.

        Parameters
        ----------
        on
            The day.
        who
            Name of one of a team, or of a scout beside it; empty: the first of the team.
        """
        with self._lock, self.store.reading() as db:  # both of one moment
            settings = self._planned_by(self._read(db), on, db)
            named = settings.at_work(who)
            last = kept_routes.kept_last(db, settings.day(on))
            return kept_routes.plants(
                db, last.get(person_key(who if named is None else named.name))
            )

    def _codes(
        self, db: sqlite3.Connection, on: date, *, is_over: bool
    ) -> dict[str, tuple[int, int] | None]:
        known = scouts.scouts_on(db, local_clock(self.plot.field), on, is_over=is_over)
        return {one.name: one.rows for one in known}

    def _people_out(self, db: sqlite3.Connection, contents: SeasonContents, on: date) -> set[str]:
        """Return who is out, by `person_key`, of those whose routes are kept of a day."""
        last = kept_routes.kept_last(db, contents.settings.day(on))
        if len(last) < 2:
            return {*last}
        codes = self._codes(db, on, is_over=self._is_earlier(contents, on))
        settings = self._planned_by(contents, on, db)
        out = _out(last, codes, settings)
        own = kept_routes.plants(db, last.get(""))
        if not settings.team and len(self._in_nobodys_rows(own, codes, out)):
            out.add("")
        return out

    def _in_nobodys_rows(
        self, plants: NDArray[np.int32], codes: dict[str, tuple[int, int] | None], out: set[str]
    ) -> NDArray[np.int32]:
        """Return those of the season's own route for whose rows nobody who is out has a code."""
        theirs = np.zeros(len(plants), np.bool_)
        for name, rows in codes.items():
            if person_key(name) in out:
                theirs |= scouts.inside(self.plant_numbers, rows)[plants]
        return plants[~theirs]

    def _unused_routes(
        self, db: sqlite3.Connection, contents: SeasonContents, day: int, since: int
    ) -> set[str]:
        wanted = "SELECT DISTINCT who FROM routes WHERE day = ?"
        names = {who for (who,) in db.execute(wanted, (day,))}
        if all(contents.settings.named(who) for who in names):
            return set()
        if day >= since:
            self._unused_then.pop(day, None)
        elif day in self._unused_then:  # to look it up takes reading all of the log
            return self._unused_then[day]
        on = contents.settings.date(day)
        out = self._people_out(db, contents, on)
        gone = {who for who in names if person_key(who) not in out}
        if day < since and self._is_earlier(contents, on):
            self._unused_then[day] = gone
        return gone

    def planned_and_done(self, on: Day, who: str | None = None) -> PlannedAndDone | None:
        """Return the plan kept of the day `on`, held to what was done; None: none was kept.

        Of a plan that nobody goes by any more only what was done of it is part. Of a plan of which
        others have some rows by now, its hours are those of the stops that count, as if each took
        the same.

        Parameters
        ----------
        on
            The day.
        who
            One of a team alone; None: all who are out, and the season's own route where nobody
            who is out has a code for the rows.
        """
        with self._lock, self.store.reading() as db:  # both of one moment
            contents = self._read(db)
            kept = kept_routes.of_day(db, contents.settings.day(on))
            out = self._people_out(db, contents, on) if who is None else {person_key(who)}
            codes = self._codes(db, on, is_over=self._is_earlier(contents, on))
        if who is not None:
            kept = [one for one in kept if one.who in out]
        if not kept:
            return None
        names = [one.name for one in self._planned_by(contents, on).team]
        every: list[str | Besides] = [*names, Besides(tuple(names))] if names else [""]
        each = every if who is None else [who]
        done = [self._worked(contents, on, one).plant for one in each]
        none = np.empty(0, np.int32)
        goes_by = {one.who: one.last for one in kept if one.who in out}
        if "" in goes_by and who is None:
            goes_by[""] = self._in_nobodys_rows(goes_by[""], codes, out)
        told = np.unique(np.concatenate(done))
        return PlannedAndDone.of(
            [(goes_by.get(one.who, none), one.of_all) for one in kept], told,
            [
                one.hours(self._begun(contents, on, one, codes))
                * one.share_of(goes_by[one.who], told)
                for one in kept
                if one.who in out
            ],
        )  # fmt: skip

    def _begun(
        self, contents: SeasonContents, on: date, kept: KeptPlans,
        codes: dict[str, tuple[int, int] | None],
    ) -> datetime | None:  # fmt: skip
        """Return when the work of whoever goes by these plans began; None: as the first one says.

        That counts where the first was made before it, and the last during it. The season's own
        route is that of who is alone, or of the robot besides those with codes.
        """
        alone = [*codes.values()] in ([], [None])
        who = kept.who or ("" if alone else Besides(tuple(codes)))
        done = self._worked(contents, on, who)
        first, last = np.isin(kept.at, done.plant)
        if first or not last or not np.isfinite(done.second[0]):
            return None
        midnight = datetime.combine(on, time())
        return midnight + timedelta(seconds=round(self._begun_s(contents, on, who)))

    def _keep(
        self, contents: SeasonContents, on: date, noted: tuple[DayPlan, ...],
        names: tuple[str, ...],
    ) -> None:  # fmt: skip
        """Keep routes; those that are kept already are not written: that would wait for readers."""
        settings = self._planned_by(contents, on)
        named = [(today, who) for today, who in zip(noted, names, strict=True) if len(today.route)]
        with self.store.reading() as db:
            is_kept = all(kept_routes.is_kept(db, today, who) for today, who in named)
            by = self._chosen_for(contents, on, db)
        if is_kept:
            self._keep_what_was_worked_out()
            return
        with self._writing() as db:
            before = self._read(db)
            kept = [
                (today, who)
                for today, who in named
                if kept_routes.keep(db, settings, self.plant_numbers, today, who)
            ]
            for today, who in kept:
                season_log.append(
                    db, "planned", who, by=by, **kept_routes.in_words(settings, today)
                )
            if kept:
                self._refresh(db, named[0][0].scene.day, before)

    def _keep_what_was_worked_out(self) -> None:
        """Keep mornings that another version of fieldmon left to us; wait for nobody."""
        with self._lock, self.store.reading() as db:
            now, newest = self._read(db), newest_day(db)
            if not is_behind(db, now.mornings, newest):
                return
        with suppress(FileProblem), self.store.writing(patience_s=0.0) as db:
            if FileRevision.of(db) == now.revision:
                self._keep_mornings(db, now.mornings, newest)

    def _noted(
        self, settings: MonitoringSettings, today: DayPlan, of: tuple[str, float]
    ) -> DayPlan:
        who, begun_s = of
        begins = kept_routes.begins(settings, today, begun_s)
        notes = RouteNotes(self.plot.field.name, settings.sampler, begins, who or None)
        return replace(today, route=replace(today.route, notes=notes))

    def _team_days(
        self, settings: MonitoringSettings, names: tuple[str, ...],
        stand: tuple[tuple[Scene, float], ...], wishes: Wishes | None,
    ) -> tuple[DayPlan, ...]:  # fmt: skip
        """Return the days of several, who go on from a scene at a second of their common day."""
        posts = [
            Posted(scene if wishes is None else wishes.applied_to(scene), from_s,
                   np.zeros(len(scene.chance), np.bool_))
            for scene, from_s in stand
        ]  # fmt: skip
        before, joined = self._given_out(names, stand[0][0].day)
        works = team_day(posts, settings.decides(), settings.teamwork, before=before)
        idle = [k for k in joined if not len(works[k])]
        if before is not None and idle:  # the others have all aisles, from when they were fewer
            anew = team_day(posts, settings.decides(), settings.teamwork)
            works = anew if any(len(anew[k]) for k in idle) else works
        return tuple(
            DayPlan(scene, work, route_of(scene, work))
            for (scene, _), work in zip(stand, works, strict=True)
        )

    def _given_out(
        self, names: tuple[str, ...], day: int
    ) -> tuple[NDArray[np.int64] | None, list[int]]:
        """Return who has each aisle by the routes kept of a day, and who has no route of it.

        -1: nobody has it; None: no route is kept.
        """
        aisle = self.plot.grid.corridor[self.plot.grid.row]
        given = np.full(int(aisle.max()) + 1, -1)
        with self.store.reading() as db:
            last = kept_routes.kept_last(db, day)
            for k, who in enumerate(names):
                given[aisle[kept_routes.plants(db, last.get(person_key(who)))]] = k
        joined = [k for k, who in enumerate(names) if person_key(who) not in last]
        return given if (given >= 0).any() else None, joined


def _out(
    last: dict[str, KeptRoute], codes: dict[str, tuple[int, int] | None],
    settings: MonitoringSettings,
) -> set[str]:  # fmt: skip
    """Return who is out, by `person_key`, of those whose routes are kept of a day.

    They are of the team or have a code. The season's own route is that of who is alone, and that
    of nobody here where another was given to somebody.
    """
    out = {*last} & ({person_key(one.name) for one in settings.team} | {*map(person_key, codes)})
    if not settings.team and [*codes.values()] == [None] and "" in last:
        return {max(out | {""}, key=lambda who: last[who].number)}
    return out or ({""} if "" in last else {*last})


def _names(settings: MonitoringSettings) -> tuple[str, ...]:
    """Return who works: the names of the team, or nobody's for the one."""
    return tuple(member.name for member in settings.team) or ("",)
