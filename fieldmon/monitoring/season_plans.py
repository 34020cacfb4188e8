"""What a season has its robots and scouts do on a day."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.errors import FileProblem
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.monitoring import routes, season_log
from fieldmon.monitoring.day_figures import PlannedAndDone
from fieldmon.monitoring.history import made_by
from fieldmon.monitoring.mornings import is_behind
from fieldmon.monitoring.open_season import FileRevision, OpenSeason, newest_day, settings_of
from fieldmon.planning.plan import DayPlan, plan_in
from fieldmon.planning.route import route_of
from fieldmon.planning.team_day import team_day
from fieldmon.planning.team_worker import Posted

if TYPE_CHECKING:
    from datetime import date, time

    from numpy.typing import NDArray

    from fieldmon.monitoring.settings import MonitoringSettings
    from fieldmon.planning.wishes import Wishes
    from fieldmon.samplers.base import Scene


@checked
class SeasonPlans(OpenSeason):
    """The days of a season as they are planned, and the routes that are kept of them."""

    def plan(
        self, on: date, now: time | None = None, *, keep: bool = True,
        wishes: Wishes | None = None, who: str | None = None,
    ) -> DayPlan:  # fmt: skip
        """Plan what is left of a day from all that is known; see `planned_by`.

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

        `on`, `now`, `keep` and `wishes` are those of `plan`.
        In the order of the team. Aisles that the routes kept of this day gave to one stay its own
        unless another way to give them out gains enough, see `Teamwork`.
        """
        with self._lock:
            contents = self._now()
            settings, day = self._planned_by(contents, on), contents.settings.day(on)
            scenes = [self._scene(contents, on, now, who) for who in _names(settings)]
            if settings.team:
                days = self._team_days(settings, day, scenes, wishes)
            else:
                days = (plan_in(scenes[0], settings.decides(), wishes),)
            noted = tuple(
                self._noted(settings, today, who)
                for today, who in zip(days, _names(settings), strict=True)
            )
            if keep:
                self._keep(settings, noted)
        return noted

    def kept_route(self, on: date, who: str = "") -> NDArray[np.int32]:
        """Return the plants ``(k,)`` of the latest route kept for the day `on`; empty without one.

        Of a team it is that of `who` is named, or of the first.
        """
        with self._lock, self.store.reading() as db:  # both of one moment
            settings = self._read(db).settings
            if settings.team:
                who = settings.member(who).name if who else settings.team[0].name
            return routes.plants(db, settings.day(on), who)

    def planned_and_done(self, on: date, who: str | None = None) -> PlannedAndDone | None:
        """Return the plan kept of the day `on`, held to what was inspected; None: none was kept.

        `who`: of one of a team alone; None: of all who work.
        """
        with self._lock, self.store.reading() as db:  # both of one moment
            done = self._inspections(db).on(on).inspected
            of_all = routes.of_day(db, settings_of(db).day(on))
        name = None if who is None else who.casefold()
        kept = [one for one in of_all if name is None or one.who.casefold() == name]
        if not kept:
            return None
        return PlannedAndDone.of(
            [(one.last, one.of_all) for one in kept],
            np.unique(made_by(done, who).plant),
            max(one.hours for one in kept),
        )

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
        with self._lock, self.store.reading() as db:
            now, newest = self._read(db), newest_day(db)
            if not is_behind(db, now.mornings, newest):
                return
        with suppress(FileProblem), self.store.writing(patience_s=0.0) as db:
            if FileRevision.of(db) == now.revision:
                self._keep_mornings(db, now.mornings, newest)

    def _noted(self, settings: MonitoringSettings, today: DayPlan, who: str) -> DayPlan:
        begins = routes.begins(settings, today, who)
        notes = RouteNotes(self.plot.field.name, settings.sampler, begins, who or None)
        return replace(today, route=replace(today.route, notes=notes))

    def _team_days(
        self, settings: MonitoringSettings, day: int, scenes: list[Scene], wishes: Wishes | None
    ) -> tuple[DayPlan, ...]:
        posts = []
        for member, scene in zip(settings.team, scenes, strict=True):
            begun_s = member.starts_s + member.robot.day_s - scene.seconds_left
            told = scene if wishes is None else wishes.applied_to(scene)
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


def _names(settings: MonitoringSettings) -> tuple[str, ...]:
    """Return who works: the names of the team, or nobody's for the one."""
    return tuple(member.name for member in settings.team) or ("",)
