"""Several robots in one day: one fleet control, one season, each robot its own order."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from fieldmon.drive.day import drive_day
from fieldmon.drive.vda5050.fleet import live_robot
from fieldmon.drive.vda5050.wire import RobotName
from fieldmon.errors import FieldmonError
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fieldmon.drive.day import DrivenDay
    from fieldmon.drive.recording import Recording
    from fieldmon.drive.team_season import TeamSeason
    from fieldmon.drive.vda5050.wire import Broker
    from fieldmon.planning.members import TeamMember


#: a day as it was driven, or why it was not
TeamDays = dict[str, "DrivenDay | FieldmonError"]


def drive_team(
    day: TeamSeason,
    broker: Broker,
    names: RobotName,
    say: Callable[[str], None] = lambda _: None,
    recordings: Mapping[str, Recording] | None = None,
) -> TeamDays:
    """Drive what is left of a team's day; return each robot's day by its name.

    A find by one is planned for by all. No two are in one aisle at once: who comes second waits at
    the end of its own. A robot that never comes, or whose day breaks off, takes nothing from the
    others, and has the error instead of a day. People of the team are left out.

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
    """

    def one(member: TeamMember) -> DrivenDay | FieldmonError:
        own, noted = day.member(member.name), (recordings or {}).get(member.name)
        robot = RobotName(names.manufacturer, member.name, names.version)

        def tell(told: str) -> None:
            say(f"{member.name}: {told}")

        watch = None if noted is None else noted.note
        try:
            with live_robot(broker, robot, str(day.on), tell, day.keeper) as live:
                return drive_day(own, own.aisles, (member.robot, live), watch)
        except FieldmonError as error:
            tell(str(error))
            if own.at == GATE:
                day.keeper.keep_only(member.name, [])
            return error
        finally:
            # it stays where it is: at the gate, or in its aisle
            day.keeper.end(member.name)
            own.leave()

    with ThreadPoolExecutor(len(day.robots), "robot") as threads:
        running = {member.name: threads.submit(one, member) for member in day.robots}
        try:
            return {name: each.result() for name, each in running.items()}
        except KeyboardInterrupt:
            day.stopped = True
            say("Stopping: each robot ends the plant in hand and drives home.")
            return {name: each.result() for name, each in running.items()}
