"""Several robots in one day: one fleet control, one season, each robot its own order."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from fieldmon.drive.day import DrivenDay, drive_day
from fieldmon.drive.vda5050.fleet import live_robot
from fieldmon.drive.vda5050.mqtt import RobotName
from fieldmon.errors import FieldmonError
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from concurrent.futures import Future

    from fieldmon.drive.recording import Recording
    from fieldmon.drive.team_season import TeamSeason
    from fieldmon.drive.vda5050.mqtt import Broker
    from fieldmon.planning.members import TeamMember

#: said at the first and the second Ctrl-C
_STOPPING = (
    (
        "Stopping: each robot ends the plant in hand and drives home. Ctrl-C again ends at once. "
        "Waited for: {names}."
    ),
    "Ending at once: what is recorded is kept.",
)


def drive_team(
    day: TeamSeason,
    broker: Broker,
    names: RobotName,
    say: Callable[[str], None] = lambda _: None,
    recordings: Mapping[str, Recording] | None = None,
    begun: dict[str, DrivenDay] | None = None,
) -> dict[str, DrivenDay]:
    """Drive what is left of a team's day; return each robot's day by its name.

    A find by one is planned for by all. No two are in one aisle at once: who comes second waits at
    the end of its own. A robot that never comes, or whose day breaks off, takes nothing from the
    others; its day says why. People of the team are left out.

    At Ctrl-C each ends the plant in hand and drives home, and who has no order is not waited for;
    at a second one nobody is. Who is not heard is waited for, until a time that is said.

    Parameters
    ----------
    day
        The season's day.
    broker
        Where messages are exchanged.
    names
        Manufacturer and version of all; each one's serial number is its name in the team.
    say
        Told what people should know, with whose robot it is.
    recordings
        What each one's day is noted in.
    begun
        Gets the day of each robot that is there, as it is driven: whatever ends it.
    """

    def one(member: TeamMember) -> DrivenDay:
        driven = DrivenDay()
        own, noted = day.member(member.name), (recordings or {}).get(member.name)
        robot = RobotName(names.manufacturer, member.name, names.version)

        def tell(told: str) -> None:
            say(f"{member.name}: {told}")

        watch = None if noted is None else noted.note
        try:
            with live_robot(broker, robot, str(day.on), tell, day.keeper) as live:
                live.stops = lambda: day.stops
                if begun is not None:
                    begun[member.name] = driven
                drive_day(own, own.aisles, (member.robot, live), watch, driven)
        except FieldmonError as error:
            driven.broken = str(error)
            tell(driven.broken)
            if own.at == GATE:
                day.keeper.keep_only(member.name, [])
        finally:
            # it stays where it is: at the gate, or in its aisle
            day.keeper.end(member.name)
            own.leave()
        return driven

    with ThreadPoolExecutor(len(day.robots), "robot") as threads:
        running = {member.name: threads.submit(one, member) for member in day.robots}
        for told in _STOPPING:
            try:
                return _results(running)
            except KeyboardInterrupt:
                day.stops += 1
                out = [name for name, each in running.items() if not each.done()]
                say(told.format(names=", ".join(out)))
        return _results(running)


def _results(running: Mapping[str, Future[DrivenDay]]) -> dict[str, DrivenDay]:
    return {name: each.result() for name, each in running.items()}
