"""What is chosen for a season in words, and what a change of it did."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import typer

from fieldmon.compute.wording import estimate, written
from fieldmon.plot.robot import KM_H

if TYPE_CHECKING:
    from collections.abc import Iterator
    from datetime import date

    from fieldmon.monitoring import MonitoringSettings, Season
    from fieldmon.planning.members import TeamMember
    from fieldmon.plot.robot import Robot

_NONE = "none"
# parts of the settings that are believed of the whole season
_OF_ALL_DAYS = ("prior", "beliefs", "pest", "weather")


def taken_back(change: MonitoringSettings, again: MonitoringSettings) -> str:
    """Return what is taken back of a change, where something else counts `again`."""
    was, now = _in_words(change), _in_words(again)
    if "team" in {**was, **now}:  # beside a team the one robot is of no interest
        alone = _each_of_worker(change.robot)
        was, now = ({k: v for k, v in one.items() if k not in alone} for one in (was, now))
    each = [
        f"{name} {was.get(name, _NONE)} (now {now.get(name, _NONE)} again)"
        for name in {**was, **now}
        if was.get(name) != now.get(name)
    ]
    return f"The last change was taken back: {', '.join(each) or 'it made no difference'}."


@contextmanager
def telling_anew(
    season: Season, before: MonitoringSettings, after: MonitoringSettings
) -> Iterator[None]:
    """Print what a change makes of the last day, where it makes of days past something else."""
    from fieldmon.monitoring.settings import as_json

    was, now = as_json(before), as_json(after)
    if all(was.get(name) == now.get(name) for name in _OF_ALL_DAYS):
        yield
        return
    on = season.last_date()
    told = _still_there(season, on)
    yield
    if (still := _still_there(season, on)) != told:
        typer.echo(
            f"Days past are worked out anew, too: after {on} {still} plants are expected to be "
            f"still infested; before this change it was {told}."
        )


def _still_there(season: Season, on: date) -> str:
    left = season.status(on).estimate
    return f"{estimate(left.expected)} ({left.low:,} to {left.high:,})"


def _in_words(settings: MonitoringSettings) -> dict[str, str]:
    """Return each choice in words, by its name; those not made are left out."""
    belief, every = settings.belief, settings.sampler_settings.get("every")
    words = {"sampler": settings.sampler if every is None else f"{settings.sampler} {every:g}"}
    if settings.team:
        words["team"] = "; ".join(map(worker_in_words, settings.team))
    else:
        words |= _each_of_worker(settings.robot)
    words |= {"start": f"{settings.starts:%H:%M}", "traces": "yes" if belief.traces else "no"}
    words["finds"] = "treated at once" if belief.treated else "only flagged"
    words["spread"] = written(belief.spread.rate_per_day, ".3g")
    if settings.pest is not None:
        words["pest"] = settings.pest.name
    if settings.weather is not None:
        words["weather"] = f"until {str(settings.weather.at[-1])[:10]}"
    if settings.harvest is not None:
        words["harvest"] = str(settings.harvest)
    return words | {"language": settings.language or "en"}


def _each_of_worker(robot: Robot) -> dict[str, str]:
    times = f"{robot.row_change_s:g}, {robot.turn_180_s:g} and {robot.stop_s:g} s"
    return {
        "hours": f"{robot.hours:g}",
        "look": f"{robot.look_s:g} s",
        "speed": f"{KM_H * robot.speed_m_s:.3g} km/h",
        "row changes, turns and stops": robot.times or times,
        "detection": written(robot.detects, ".0%"),
    }


def worker_in_words(member: TeamMember) -> str:
    """Return one of a team in words."""
    robot = member.robot
    return (
        f"{member.name} {robot.hours:g} h, {robot.look_s:g} s a plant, "
        f"{KM_H * robot.speed_m_s:.3g} km/h, finds {written(robot.detects, '.0%')}"
    )
