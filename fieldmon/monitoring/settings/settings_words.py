"""What is chosen for a season in words, and what a change of it did."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from fieldmon.compute.wording import chance_figure, joined, worded, written
from fieldmon.monitoring.settings.settings import as_json, from_json
from fieldmon.monitoring.settings.settings_log import each_difference, plain_path
from fieldmon.planning.members import Teamwork
from fieldmon.plot.robot import KM_H, Robot, scout

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.settings.settings_log import Parts
    from fieldmon.planning.members import TeamMember

_NONE = worded("none")
_NAMES = {
    "sampler": worded("sampler"), "team": worded("team"), "hours": worded("hours"),
    "look": worded("look"), "speed": worded("speed"),
    "row changes, turns and stops": worded("row changes, turns and stops"),
    "width": worded("width"), "length": worded("length"),
    "turning radius": worded("turning radius"),
    "detection": worded("detection"), "detection by seconds": worded("detection by seconds"),
    "way back": worded("way back to the gate within the hours"), "on foot": worded("on foot"),
    "shared out": worded("rows shared out by what is believed"),
    "contact": worded("contact"), "least gain": worded("least gain"),
    "passing": worded("headland to pass each other"),
    "start": worded("start"), "traces": worded("traces"),
    "finds": worded("finds"), "spread": worded("spread"),
    "background": worded("infested where nothing is known"), "pest": worded("pest"),
    "weather": worded("weather"), "harvest": worded("harvest"), "language": worded("language"),
}  # fmt: skip
# by which of these a setting is said, by its path in a season's file or the beginning of that;
# one that is not here, or which words do not tell apart, is said by its path, or by its name alone
# where it is long
_SAID_BY = {
    "sampler name": "sampler", "sampler settings every": "sampler", "team members": "team",
    "robot hours": "hours", "robot look_s": "look", "robot speed_m_s": "speed",
    "robot row_change_s": "row changes, turns and stops",
    "robot turn_180_s": "row changes, turns and stops",
    "robot stop_s": "row changes, turns and stops",
    "robot width_m": "width", "robot length_m": "length",
    "robot turning_radius_m": "turning radius", "robot detection": "detection",
    "robot viewpoints": "detection by seconds", "robot returns": "way back",
    "robot on_foot": "on foot",
    "team teamwork together": "shared out", "team teamwork contact_s": "contact",
    "team teamwork least_gain": "least gain", "team teamwork passing_m": "passing",
    "season starts": "start", "season harvest": "harvest", "season language": "language",
    "beliefs traces": "traces", "beliefs treated": "finds",
    "beliefs spread rate_per_day": "spread", "prior background_chance": "background",
    "pest": "pest", "weather": "weather",
}  # fmt: skip
# it comes and goes with a team
_WITH_TEAM = "team teamwork"
_TEAMWORK = ("shared out", "contact", "least gain", "passing")


def taken_back(change: MonitoringSettings, again: MonitoringSettings) -> str:
    """Return what is taken back of a change, where something else counts `again`."""
    each = [
        worded("{name} {was} (now {now} again)", name=name, was=was, now=now) if was else name
        for name, was, now in _differing(change, again)
    ]
    what = joined(", ", each) if each else worded("it made no difference")
    return worded("The last change was taken back: {what}.", what=what)


def changed(change: MonitoringSettings, before: MonitoringSettings) -> str:
    """Return what a change chose that was otherwise before; "": it made no difference."""
    each = [
        worded("{name} {now}", name=name, now=now) if now else name
        for name, now, _ in _differing(change, before)
    ]
    return joined(", ", each) if each else ""


def differences(before: Parts, after: Parts) -> list[str]:
    """Return all that differs between two choices, from what to what; what is long by its name.

    Examples
    --------
    >>> from datetime import date
    >>> import fieldmon as fm
    >>> one = fm.MonitoringSettings(date(2026, 11, 1))
    >>> longer = replace(one, robot=fm.Robot(hours=14), harvest=date(2026, 12, 1))
    >>> differences(as_json(one), as_json(longer))
    ['hours 12 to 14', 'harvest none to 2026-12-01']
    """
    if before == after:
        return []
    if before.get("weather") == after.get("weather"):  # a year of hours takes time to read
        before, after = ({**parts, "weather": "null"} for parts in (before, after))
    each = _differing(from_json(before), from_json(after), whole=True)
    return [
        worded("{name} {was} to {now}", name=name, was=was, now=now) if was or now else name
        for name, was, now in each
    ]


def _differing(
    one: MonitoringSettings, other: MonitoringSettings, *, whole: bool = False
) -> Iterator[tuple[str, str, str]]:
    """Yield names of choices that differ, with both in words; "" where they are too long.

    Where a team comes or goes the one robot is of no interest, unless the `whole` is asked for.
    """
    this, that = _in_words(one), _in_words(other)
    differ = [name for name in _NAMES if this.get(name) != that.get(name)]
    beside_team = "team" in differ and not whole
    usual = _each_of_teamwork(Teamwork()) if whole else {}
    for name in differ:
        told = {said[name] for said in (this, that) if name in said}
        comes_with_team = name in _TEAMWORK and not (one.team and other.team)
        if comes_with_team and (not whole or told == {usual[name]}):
            continue
        if not (beside_team and name in _each_of_worker(one.robot) | _each_of_worker(other.robot)):
            yield _NAMES[name], this.get(name, _NONE), that.get(name, _NONE)
    long = set[str]()
    for path, was, now in each_difference(*_parts_of(one, other)):
        said_by = next((name for start, name in _SAID_BY.items() if _within(path, start)), None)
        if said_by in differ or path == _WITH_TEAM or (beside_team and _within(path, "robot")):
            continue
        if said_by is None or was or now:
            yield plain_path(path), was, now
        elif said_by not in long:  # alike in words, and too long to be said
            long.add(said_by)
            yield _NAMES[said_by], "", ""


def _within(path: str, start: str) -> bool:
    return f"{path} ".startswith(f"{start} ")


def _parts_of(*both: MonitoringSettings) -> tuple[dict[str, str], ...]:
    """Return both as a season's file has them, but for the weather where it is one."""
    if len({id(one.weather) for one in both}) == 1:  # a year of hours takes time to write
        both = tuple(replace(one, weather=None) for one in both)
    return tuple(as_json(one) for one in both)


def _in_words(settings: MonitoringSettings) -> dict[str, str]:
    """Return each choice in words, by its name; those not made are left out."""
    belief, every = settings.belief, settings.sampler_settings.get("every")
    words = {"sampler": settings.sampler if every is None else f"{settings.sampler} {every:g}"}
    if settings.team:
        words["team"] = joined("; ", map(worker_in_words, settings.team))
        words |= _each_of_teamwork(settings.teamwork)
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


def _each_of_teamwork(teamwork: Teamwork) -> dict[str, str]:
    n = teamwork.contact_s / 60
    metres = f"{teamwork.passing_m:g} m"
    return {
        "shared out": worded("yes") if teamwork.together else worded("no"),
        "contact": worded("every {n:g} min", n=n) if n else worded("at once"),
        "least gain": written(teamwork.least_gain, ".3g"),
        "passing": metres if teamwork.passing_m else worded("any"),
    }


def _each_of_worker(robot: Robot) -> dict[str, str]:
    times = f"{robot.row_change_s:g}, {robot.turn_180_s:g} and {robot.stop_s:g} s"
    size = {
        "width": robot.width_m,
        "length": robot.length_m,
        "turning radius": robot.turning_radius_m,
    }
    (first_s, least), (last_s, _) = robot.viewpoints.steps[0], robot.viewpoints.steps[-1]
    return {
        "hours": f"{robot.hours:g}",
        "look": f"{robot.look_s:g} s",
        "speed": f"{KM_H * robot.speed_m_s:.3g} km/h",
        "row changes, turns and stops": robot.times or times,
        "detection": str(chance_figure(robot.detects)),
        # the ends of the ladder
        "detection by seconds": worded(
            "{low} in {first:g} s to {high} in over {last:g} s",
            low=chance_figure(least),
            first=first_s,
            high=chance_figure(robot.viewpoints.longer),
            last=last_s,
        ),
        "way back": worded("yes") if robot.returns else worded("no"),
        "on foot": worded("yes") if robot.on_foot else worded("no"),
        **{name: f"{value_m:g} m" for name, value_m in size.items() if value_m is not None},
    }


def worker_in_words(member: TeamMember) -> Worded:
    """Return one of a team in words: the usual of everybody, and what else is not usual."""
    robot = member.robot
    first = worded(
        "{name} {hours:g} h, {look:g} s a plant, {speed:.3g} km/h, finds {detects}",
        name=member.name, hours=robot.hours, look=robot.look_s, speed=KM_H * robot.speed_m_s,
        detects=chance_figure(robot.detects),
    )  # fmt: skip
    said = [first, *_unusual(robot)]
    if member.starts_s:
        said.append(worded("begins {n:g} min later", n=member.starts_s / 60))
    return joined(", ", [*said, *_gate(member)])


def besides_in_words(member: TeamMember) -> Worded:
    """Return the same of one of a team but for what its boxes say: name, hours, look and start."""
    robot = member.robot
    first = worded(
        "{speed:.3g} km/h, finds {detects}",
        speed=KM_H * robot.speed_m_s, detects=chance_figure(robot.detects),
    )  # fmt: skip
    return joined(", ", [first, *_unusual(robot), *_gate(member)])


def _unusual(robot: Robot) -> list[Worded]:
    """Return what is not usual of one who works, beside hours, look, speed and detection."""
    usual = _each_of_worker(scout() if robot.on_foot else Robot())
    if robot.on_foot != robot.on_foot_by_times:
        del usual["on foot"]  # its times do not tell
    return [
        worded("{name} {now}", name=_NAMES[name], now=now)
        for name, now in _each_of_worker(robot).items()
        if name not in {"hours", "look", "speed", "detection"} and now != usual.get(name)
    ]


def _gate(member: TeamMember) -> list[Worded]:
    if member.gate is None:
        return []
    lon, lat = member.gate
    return [worded("gate {lon:.6f}, {lat:.6f}", lon=lon, lat=lat)]
