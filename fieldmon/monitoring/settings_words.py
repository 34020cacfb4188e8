"""What is chosen for a season in words, and what a change of it did."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from fieldmon.compute.wording import chance_figure, estimate, joined, worded, written
from fieldmon.monitoring.settings import as_json
from fieldmon.plot.robot import KM_H

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from datetime import date

    from fieldmon.monitoring import MonitoringSettings, Season
    from fieldmon.planning.members import TeamMember
    from fieldmon.plot.robot import Robot

_NONE = worded("none")
_NAMES = {
    "sampler": worded("sampler"), "team": worded("team"), "hours": worded("hours"),
    "look": worded("look"), "speed": worded("speed"),
    "row changes, turns and stops": worded("row changes, turns and stops"),
    "width": worded("width"), "length": worded("length"),
    "turning radius": worded("turning radius"),
    "detection": worded("detection"), "start": worded("start"), "traces": worded("traces"),
    "finds": worded("finds"), "spread": worded("spread"),
    "background": worded("infested where nothing is known"), "pest": worded("pest"),
    "weather": worded("weather"), "harvest": worded("harvest"), "language": worded("language"),
}  # fmt: skip
# parts of the settings that are believed of the whole season
_OF_ALL_DAYS = ("prior", "beliefs", "pest", "weather")


def taken_back(change: MonitoringSettings, again: MonitoringSettings) -> str:
    """Return what is taken back of a change, where something else counts `again`."""
    each = [
        worded("{name} {was} (now {now} again)", name=name, was=was, now=now)
        for name, was, now in _differing(change, again)
    ]
    what = joined(", ", each) if each else worded("it made no difference")
    return worded("The last change was taken back: {what}.", what=what)


def changed(change: MonitoringSettings, before: MonitoringSettings) -> str:
    """Return what a change chose that was otherwise before; "": it made no difference."""
    each = [
        worded("{name} {now}", name=name, now=now) for name, now, _ in _differing(change, before)
    ]
    return joined(", ", each) if each else ""


def _differing(
    one: MonitoringSettings, other: MonitoringSettings
) -> Iterator[tuple[str, str, str]]:
    """Yield names of choices that differ, with both in words."""
    this, that = _in_words(one), _in_words(other)
    if "team" in {**this, **that}:  # beside a team the one robot is of no interest
        alone = _each_of_worker(one.robot)
        this, that = ({k: v for k, v in each.items() if k not in alone} for each in (this, that))
    for name in {**this, **that}:
        if this.get(name) != that.get(name):
            yield _NAMES[name], this.get(name, _NONE), that.get(name, _NONE)


@contextmanager
def telling_anew(
    season: Season, before: MonitoringSettings, after: MonitoringSettings,
    tell: Callable[[str], object],
) -> Iterator[None]:  # fmt: skip
    """Tell what a change makes of the last day, where it makes of days past something else."""
    was, now = as_json(before), as_json(after)
    if all(was.get(name) == now.get(name) for name in _OF_ALL_DAYS):
        yield
        return
    on = season.day_meant()
    told = _still_there(season, on)
    yield
    if (still := _still_there(season, on)) != told:
        said = worded(
            "Days past are worked out anew, too: after {on} {still} plants are expected to be "
            "still infested; before this change it was {told}.",
            on=on,
            still=still,
            told=told,
        )
        tell(said)


def _still_there(season: Season, on: date) -> str:
    # with those found and only flagged: else a change of them would seem to find or lose plants
    left = season.still_infested(on)
    return worded(
        "{expected} ({low:,} to {high:,})",
        expected=estimate(left.expected), low=left.low, high=left.high,
    )  # fmt: skip


def _in_words(settings: MonitoringSettings) -> dict[str, str]:
    """Return each choice in words, by its name; those not made are left out."""
    belief, every = settings.belief, settings.sampler_settings.get("every")
    words = {"sampler": settings.sampler if every is None else f"{settings.sampler} {every:g}"}
    if settings.team:
        words["team"] = "; ".join(map(worker_in_words, settings.team))
    else:
        words |= _each_of_worker(settings.robot)
    words |= {
        "start": f"{settings.starts:%H:%M}",
        "traces": worded("yes") if belief.traces else worded("no"),
    }
    words["finds"] = worded("treated at once") if belief.treated else worded("only flagged")
    words["spread"] = written(belief.spread.rate_per_day, ".3g")
    words["background"] = written(settings.prior.background_chance, ".3g")
    if settings.pest is not None:
        words["pest"] = settings.pest.name
    if settings.weather is not None:
        words["weather"] = f"until {str(settings.weather.at[-1])[:10]}"
    if settings.harvest is not None:
        words["harvest"] = str(settings.harvest)
    return words | {"language": settings.language or "en"}


def _each_of_worker(robot: Robot) -> dict[str, str]:
    times = f"{robot.row_change_s:g}, {robot.turn_180_s:g} and {robot.stop_s:g} s"
    size = {
        "width": robot.width_m,
        "length": robot.length_m,
        "turning radius": robot.turning_radius_m,
    }
    return {
        "hours": f"{robot.hours:g}",
        "look": f"{robot.look_s:g} s",
        "speed": f"{KM_H * robot.speed_m_s:.3g} km/h",
        "row changes, turns and stops": robot.times or times,
        "detection": str(chance_figure(robot.detects)),
        **{name: f"{value_m:g} m" for name, value_m in size.items() if value_m is not None},
    }


def worker_in_words(member: TeamMember) -> str:
    """Return one of a team in words."""
    robot = member.robot
    return (
        f"{member.name} {robot.hours:g} h, {robot.look_s:g} s a plant, "
        f"{KM_H * robot.speed_m_s:.3g} km/h, finds {chance_figure(robot.detects)}"
    )
