"""Who inspects: a robot or a scout, one or a team, and how. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldmon.cli.option_ranges import of_robot, within
from fieldmon.errors import SettingError
from fieldmon.planning.members import TEAMWORK
from fieldmon.plot.robot import SAID_IN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.planning.members import TeamMember, Teamwork
    from fieldmon.plot.robot import Robot

Scout = Annotated[bool, typer.Option("--scout", help="A person on foot instead of the robot.")]
Hours = Annotated[
    float | None, typer.Option(help="Working hours per day.", callback=of_robot("hours"))
]
Look = Annotated[
    float | None,
    typer.Option("--look", help="Seconds to inspect a plant.", callback=of_robot("look_s")),
]
Speed = Annotated[
    float | None,
    typer.Option(help="Driving speed, km/h.", callback=of_robot("speed_m_s")),
]
RowChange = Annotated[
    float | None,
    typer.Option(help="Seconds added for changing rows.", callback=of_robot("row_change_s")),
]
Turn = Annotated[
    float | None,
    typer.Option(
        help="Seconds to turn to the other side of the same aisle.",
        callback=of_robot("turn_180_s"),
    ),
]
Robots = Annotated[
    str | None,
    typer.Option(
        help="How many robots, or a table of robots and scouts (CSV: name, who, hours, speed_km_h, "
        "look_s, detection, width_m and more: docs, teams). Each has a route file of its own."
    ),
]
_CONTACT = typer.Option(
    "--contact",
    help="Minutes between contacts of a team; 0, usual in a season: it learns of finds at once.",
    callback=within(0, 24 * 60, unit=" minutes"),
)
_LEAST_GAIN = typer.Option(
    "--least-gain",
    help="Least gain, in finds, for which somebody of a team is sent elsewhere; usual: 0.5.",
    callback=within(TEAMWORK["least_gain"]),
)
Contact = Annotated[float, _CONTACT]
LeastGain = Annotated[float, _LEAST_GAIN]
Passing = Annotated[
    float | None,
    typer.Option(
        help="With --robots: metres of headland that two need to pass each other; nobody meets "
        "head-on where it is narrower. 0, the usual: they may pass each other anywhere.",
        callback=within(TEAMWORK["passing_m"]),
    ),
]
Width = Annotated[
    float | None,
    typer.Option(
        help="Width of the robot, metres: it stays off canopies and out of narrow aisles.",
        callback=of_robot("width_m"),
    ),
]
Length = Annotated[
    float | None,
    typer.Option(
        help="Length of the robot, metres, for its turns; default: its width.",
        callback=of_robot("length_m"),
    ),
]
TurningRadius = Annotated[
    float | None,
    typer.Option(
        help="Radius of the sharpest turn, metres, of a robot that cannot turn on the spot: row "
        "ends without room for it are left out, and row changes take longer. Needs --width.",
        callback=of_robot("turning_radius_m"),
    ),
]
RobotTimesName = Annotated[
    str | None,
    typer.Option(
        "--robot-times",
        help="Times charged besides driving and inspecting. measured (default): 9 s a row change, "
        "1.13 s a stop, from simulated drives. thesis: 25 s a row change, 23 s a turn.",
    ),
]
Rover = Annotated[
    bool,
    typer.Option(
        "--rover",
        help="A robot 0.58 m wide and 0.8 m long, as in simulated drives (docs: drive).",
    ),
]
#: which setting of `Robot` each of the options of numbers is
OF_ROBOT = {
    "hours": "hours", "look": "look_s", "speed": "speed_m_s", "row_change": "row_change_s",
    "turn": "turn_180_s", "width": "width_m", "length": "length_m",
    "turning_radius": "turning_radius_m",
}  # fmt: skip


@dataclass(frozen=True)
class RobotOptions:
    """Who inspects, and how long, as it may be said anew."""

    hours: Hours = None
    look: Look = None
    speed: Speed = None
    row_change: RowChange = None
    turn: Turn = None
    width: Width = None
    length: Length = None
    turning_radius: TurningRadius = None
    robot_times: RobotTimesName = None

    def given(self) -> dict[str, float]:
        """Return what was said, as settings of `Robot`."""
        return {
            setting: value / SAID_IN[setting].units
            for option, setting in OF_ROBOT.items()
            if (value := getattr(self, option)) is not None
        }

    def said_of(self, robot: Robot) -> Robot:
        """Return a robot with what was said of its times and settings."""
        from dataclasses import replace

        charged = robot if self.robot_times is None else robot.with_times(self.robot_times)
        return replace(charged, **self.given())  # type: ignore[arg-type]


@dataclass(frozen=True)
class WorkerOptions(RobotOptions):
    """Who inspects from the beginning, and how long."""

    scout: Scout = False
    rover: Rover = False

    def robot(self) -> Robot:
        """Return the robot, or the scout, with what was said."""
        from fieldmon.plot import robot

        if self.scout and self.rover:
            raise SettingError("A scout is no rover: give one of --scout and --rover.")
        base = robot.scout() if self.scout else robot.rover() if self.rover else robot.Robot()
        return self.said_of(base)


@dataclass(frozen=True)
class TeamworkOptions:
    """How a season's team works together, as it may be said anew."""

    contact: Annotated[float | None, _CONTACT] = None
    least_gain: Annotated[float | None, _LEAST_GAIN] = None
    passing: Passing = None

    def said_of(self, teamwork: Teamwork, team: Sequence[TeamMember]) -> Teamwork:
        """Return how a team works together, with what was said; refuse it where nobody does."""
        from dataclasses import replace

        contact_s = None if self.contact is None else 60.0 * self.contact
        told = {"contact_s": contact_s, "least_gain": self.least_gain, "passing_m": self.passing}
        given: dict[str, Any] = {name: value for name, value in told.items() if value is not None}
        if given and not team:
            flag = next(one for one, value in vars(self).items() if value is not None)
            raise SettingError(
                f"--{flag.replace('_', '-')} goes with a team, but here one works alone. Say who "
                "works with --robots, as --robots 2."
            )
        return replace(teamwork, **given)
