"""`fieldmon plan` with a season: a day of it, or what is left of the day. Heavy imports wait."""

from __future__ import annotations

import shlex
from contextlib import contextmanager, nullcontext
from datetime import datetime, time, timedelta
from functools import cache
from math import isfinite
from typing import TYPE_CHECKING, NamedTuple

import typer

from fieldmon.cli.messages import (
    tell_assumed,
    tell_clock_change,
    tell_drafts,
    tell_found_again,
    tell_past_midnight,
)
from fieldmon.cli.outputs import ROUTE, day_in_words, write_chance_map, write_routes
from fieldmon.cli.season_files import (
    learnt_of_each,
    refuse_too_wide,
    refuse_unrecorded,
    refuse_what_was_chosen,
    season_of,
)
from fieldmon.cli.team_files import files_of_each, tell_member, write_member
from fieldmon.cli.times import clock, day, day_on
from fieldmon.errors import FileProblem, SettingError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from datetime import date
    from pathlib import Path

    from fieldmon.cli.plan_options import PlanOptions
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.planning.plan import DayPlan

# times are told to the minute
_MINUTE_S = 60.0
# what a plan of a season may be told; all else was chosen when it began
_OF_A_PLAN = {"plot", "output", "on", "now", "as_now", "enter_treated", "chance_map", "bound"}


def plan_season(context: typer.Context, options: PlanOptions, file: Path) -> None:
    """Plan a day of a season, keep the route in its file, and write it for whoever drives."""
    refuse_what_was_chosen(context, _OF_A_PLAN)
    season = season_of(file)
    tell_drafts(season.drafts)
    for sentence in season.settings.unlike_its_pest():
        typer.echo(f"doubtful: {sentence}", err=True)
    on = day_on(season.plot.field, day(options.on))
    enters = season.entering_treated() if options.enter_treated else nullcontext()
    with season.as_now(on) if options.as_now else nullcontext(), enters:
        _plan_day(season, options, on)


def _plan_day(season: Season, options: PlanOptions, on: date) -> None:
    """Plan a day for who works alone or for each of a team."""
    settings = season.planned_by(on)
    now = None if options.now is None else clock(options.now, "--now")
    _tell_settings_of_then(season, on, settings)
    hours = max(one.hours for one in (settings.robot, *(m.robot for m in settings.team)))
    tell_clock_change(datetime.combine(on, settings.starts), hours, season.plot.field)
    tell_past_midnight(on, settings)
    tell_found_again(season, on)
    if now is not None:
        _refuse_worked(season, on, now, [one.name for one in settings.team])
    plan = _plan_team if settings.team else _plan_alone
    plan(season, options, on, now, settings)


def _plan_alone(
    season: Season,
    options: PlanOptions,
    on: date,
    now: time | None,
    settings: MonitoringSettings,
) -> None:
    """Plan what is left of a day for who works alone, and write the route."""
    from fieldmon.monitoring.days.day_ahead import plan_ahead
    from fieldmon.planning.day_bound import with_bound
    from fieldmon.planning.route import with_forecast

    refuse_unrecorded(season, options.output or [ROUTE])
    if now is None:
        today = plan_ahead(season, on, keep=True, anew=options.enter_treated or options.as_now)
    else:
        today = season.plan(on, now)
    if options.bound and len(today.route):
        today = with_bound(today)
    off = _LeftOff.of(season, on, (("", today),))
    if off.all_closed and not options.enter_treated:
        raise _nobody_may_enter(on, off)
    _tell_skipped((today,))
    if not len(today.route):
        _refuse_nothing_left((today,))
        if left_h := today.scene.seconds_left / 3600:
            _tell_left_off(options, off, on_foot=True)
        raise SettingError(
            "The working day must be long enough to reach another plant and come back, but "
            f"{left_h:.1f} h are left of {on}. Plan another day with --date."
        )
    _tell_route(season, on, today)
    _tell_left_off(options, off, on_foot=settings.robot.on_foot)
    tell_assumed(season.assumed(settings))
    _tell_detection(season, on)
    ahead = with_forecast(today.route, lambda: season.forecast(on))
    with _kept(season, on):
        write_routes(ahead, options.output, season.settings.language)
        write_chance_map(options.chance_map, season.plot, season.evening(on))


@contextmanager
def _kept(season: Season, on: date) -> Iterator[None]:
    """Say that a season has the plan, though a file of it cannot be written."""
    try:
        yield
    except FileProblem as error:
        raise FileProblem(
            f"{error} The plan of {on} is kept in {season.path.name}; of files, only those named "
            "above were written."
        ) from error


def _tell_route(season: Season, on: date, today: DayPlan) -> None:
    """Print what was done of a day, what its route will find, and whether codes share its rows."""
    from fieldmon.monitoring.phones.scouts import codes_on
    from fieldmon.reports.words import DAY_OF_NOBODY

    n = _done(season.work(on).inspections)
    done = f"{n} done, " if n else ""
    infested = float(season.evening(on)[today.route.plant].sum())
    typer.echo(f"{on}: {done}{day_in_words(today.route, infested)}")
    if [*codes_on(season, on).values()] not in ([], [None]):
        typer.echo(f"seen: {DAY_OF_NOBODY}", err=True)


def _done(*each: Inspections) -> int:
    """Return how many plants somebody told of: once, whatever was said of it, and by how many."""
    return len(set().union(*(one.plant.tolist() for one in each)))


def _refuse_worked(season: Season, on: date, now: time, team: list[str]) -> None:
    """Refuse a time before somebody's last result: hours already worked are no hours left."""
    from fieldmon.monitoring.inspecting.known_inspections import number_of

    for name in team or [""]:
        work = season.work(on, name)
        worked = work.inspections
        second = worked.second
        if not len(second) or not isfinite(second[-1]):
            continue
        if work.left_s(now) < work.left_s() + _MINUTE_S:
            continue
        last = datetime.combine(on, time()) + timedelta(seconds=float(second[-1]))
        whose = f"{name}'s last result" if name else "the last result"
        number = number_of(season, worked)
        file = shlex.quote(str(season.path))
        raise SettingError(
            f"--now must not be before what was found, but it is {now:%H:%M} and {whose} of {on} "
            f"is of {last:%H:%M}: hours already worked are no hours left. Give a later --now, or "
            f"none to go on from there. If that time is wrong, correct it: fieldmon correct {file} "
            f"--inspection {number} --time HH:MM --who NAME"
        )


def _refuse_nothing_left(days: Sequence[DayPlan]) -> None:
    """Refuse a day on which every plant is known: no hours would help."""
    from fieldmon.planning.skips import nothing_left_in_words

    said = [nothing_left_in_words(today.scene) for today in days]
    if said and said[0] is not None and all(said):
        raise SettingError(said[0])


class _LeftOff(NamedTuple):
    """What is left off plans as people may not be there yet.

    Parameters
    ----------
    said
        Which plants, and until when.
    all_closed
        Whether nobody has a plant to go to for that reason.
    opens
        Whether any of it opens within the hours.
    leads_there
        Whether a route leads to such plants.
    """

    said: tuple[str, ...]
    all_closed: bool
    opens: bool
    leads_there: bool

    @classmethod
    def of(cls, season: Season, on: date, days: tuple[tuple[str, DayPlan], ...]) -> _LeftOff:
        """Return it of the plans of those named."""
        from fieldmon.compute.units import Units
        from fieldmon.monitoring.treating.closures import (
            closed_in_words,
            closed_plants,
            is_all_closed,
        )

        grid = season.plot.grid
        each = [(season.closed(on, who, today.scene.seconds_left), today) for who, today in days]
        said = (said for closed, _ in each for said in closed_in_words(closed, grid, Units()))
        timely = [one for one in each if one[1].scene.seconds_left > 0]
        return cls(
            tuple(dict.fromkeys(said)),
            bool(timely) and all(is_all_closed(today.scene, closed) for closed, today in timely),
            any(one.opens for closed, _ in each for one in closed),
            any(
                closed_plants(closed, len(grid))[today.route.plant].any() for closed, today in each
            ),
        )


def _nobody_may_enter(on: date, off: _LeftOff) -> SettingError:
    later = "from a later time with --now, " if off.opens else ""
    return SettingError(
        f"People must have a plant to inspect where they may be, but none is left on {on} within "
        f"the hours. {' '.join(off.said)} Plan {later}another day with --date, or for robots with "
        "--enter-treated."
    )


def _tell_left_off(options: PlanOptions, off: _LeftOff, *, on_foot: bool) -> None:
    """Print what is left off, and what to do where no people work."""
    if options.enter_treated:
        if off.leads_there:
            typer.echo("seen: Routes lead to plants where people may not be yet.", err=True)
        return
    for said in off.said:
        typer.echo(f"seen: {said}", err=True)
    if off.said and not on_foot:
        typer.echo(
            "seen: Whether people or robots work is not known: add --enter-treated where only "
            "robots do.",
            err=True,
        )


def _tell_skipped(days: tuple[DayPlan, ...]) -> None:
    """Print how many plants are left out because nobody could inspect them."""
    from fieldmon.planning.skips import left_out_in_words

    for said in left_out_in_words(days[0].scene, *(today.route for today in days)):
        typer.echo(f"seen: {said}", err=True)


def _tell_settings_of_then(season: Season, on: date, settings: MonitoringSettings) -> None:
    """Print by what a past day is planned, where something else counts now."""
    from fieldmon.monitoring.settings.settings_words import changed

    if said := changed(settings, season.settings):
        typer.echo(
            f"seen: {on} is past and planned by what counted then: {said}. To plan it by what "
            "counts now, give --as-now.",
            err=True,
        )


def _tell_detection(season: Season, on: date) -> None:
    """Print what the season learnt that inspections find, where routes go by another value."""
    for by, told, learnt in learnt_of_each(season, on):
        if learnt != told:
            typer.echo(
                f"seen: Inspections{by} find {learnt} of what is there, as this season learnt. "
                f"Chances go by that; routes and their finds go by the {told} of who inspects.",
                err=True,
            )


def _plan_team(
    season: Season,
    options: PlanOptions,
    on: date,
    now: time | None,
    settings: MonitoringSettings,
) -> None:
    """Plan what is left of a day for each of a team; write a file for each."""
    from fieldmon.monitoring.days.day_ahead import WorkPart, by_the_clock
    from fieldmon.planning.route import with_forecast

    team = settings.team
    files = files_of_each(options.output, team)
    refuse_unrecorded(season, (file for each in files for file in each))
    refuse_too_wide(season, team)
    days = season.plan_each(on, now)
    if now is None:
        days = tuple(by_the_clock(season, on, WorkPart(name=one.name), today)
                     for one, today in zip(team, days, strict=True))  # fmt: skip
    named = tuple(zip((one.name for one in team), days, strict=True))
    off = _LeftOff.of(season, on, named)
    _tell_skipped(days)
    if not any(len(today.route) for today in days):
        if off.all_closed and not options.enter_treated:
            raise _nobody_may_enter(on, off)
        _refuse_nothing_left(days)
        _tell_left_off(options, off, on_foot=True)
        raise SettingError(
            f"Somebody must have time to reach another plant and come back, but nobody has on "
            f"{on}. Plan another day with --date."
        )
    _tell_routes(season, options, on, named)
    _tell_left_off(options, off, on_foot=all(one.robot.on_foot for one in team))
    tell_assumed(season.assumed(settings))
    _tell_detection(season, on)
    ahead = cache(lambda: season.forecast(on))
    with _kept(season, on):
        for member, today, paths in zip(team, days, files, strict=True):
            route = with_forecast(today.route, ahead)
            write_member(member.name, route, paths, season.settings.language)
        write_chance_map(options.chance_map, season.plot, season.evening(on))


def _tell_routes(
    season: Season, options: PlanOptions, on: date, named: Sequence[tuple[str, DayPlan]]
) -> None:
    """Print what was done of a day, when each of a team begins, and the bound if it is asked."""
    from fieldmon.monitoring.settings.shift_work import Besides
    from fieldmon.planning.team import bound_of_days

    names = tuple(name for name, _ in named)
    # of who is not of the team any more, too
    every: tuple[str | Besides, ...] = (Besides(names), *names)
    done = _done(*(season.work(on, who).inspections for who in every))
    typer.echo(f"{on}{f': {done} done' if done else ''}")
    for name, today in named:
        if (notes := today.route.notes) is not None and notes.start is not None:
            tell_member(name, notes.start, today.route)
    if options.bound and (said := bound_of_days([today for _, today in named])):
        typer.echo(said)
