"""Who is in a team, and how they work together."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.ranges import AllowedRange, broken_setting
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError, SettingError
from fieldmon.plot.positions import lonlat_of
from fieldmon.plot.robot import Robot

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.travel import Aisles

# our choice: no plot has so many aisles that they would not meet
_MOST_MEMBERS = 1000
#: what settings of `Teamwork` may be
TEAMWORK = {
    "contact_s": AllowedRange(0.0, 86_400.0),
    "least_gain": AllowedRange(0.0, 1e9),
    "passing_m": AllowedRange(0.0, 1000.0),
}


@dataclass(frozen=True)
class TeamMember:
    """One of a team.

    Parameters
    ----------
    name
        What it is called, for people and in file names.
    robot
        Its speed, hours, inspection and detection.
    gate
        ``(lon, lat)`` where its day starts and ends; None: the plot's gate.
    starts_s
        Seconds after the team's day begins at which its own does.

    Examples
    --------
    >>> import fieldmon as fm
    >>> late = fm.TeamMember("Ann", fm.scout(), starts_s=3600.0)
    >>> late.name, late.robot.hours
    ('Ann', 4.0)
    """

    name: str
    robot: Robot = field(default_factory=Robot)
    gate: tuple[float, float] | None = None
    starts_s: float = 0.0

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A team member's")
        if not self.name.strip():
            raise SettingError(
                worded("A team member must have a name, but this one has none. Call it robot-1.")
            )
        if self.gate is not None:
            lonlat_of(f"The gate of {self.name}", [self.gate])
        if not 0.0 <= self.starts_s < 24 * 3600.0:
            raise SettingError(
                worded(
                    "{name} must start within a day, but it is {starts_s} s after the first.",
                    name=self.name,
                    starts_s=self.starts_s,
                )
            )


@dataclass(frozen=True)
class Teamwork:
    """How several work together.

    Parameters
    ----------
    together
        Whether aisles are given out by what is believed, each morning and after finds; if not,
        each has the same even section of rows every day, and nobody hears of the others' finds
        before the evening.
    contact_s
        How often they are in contact: a find is known to all at the next multiple of so many
        seconds since the day began; 0: at once.
    least_gain
        Finds that must be expected beyond those of going on as before, for aisles to be given out
        anew during a day: nobody is sent back and forth for less.
    passing_m
        Metres of headland that two need to pass each other: where it is narrower nobody meets
        another head-on, but waits in its aisle. 0: they pass each other anywhere.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Teamwork(contact_s=600.0).least_gain
    0.5
    """

    together: bool = True
    contact_s: float = 0.0
    least_gain: float = 0.5
    passing_m: float = 0.0

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A team's")
        if broken := broken_setting(self, TEAMWORK):
            raise SettingError(
                worded("A team's {name} must be {rule}, but it is {value:g}.", **broken)
            )


@checked
def team_of(n: int, robot: Robot | None = None) -> tuple[TeamMember, ...]:
    """Return n robots of one kind, each called ``robot-1`` and so on.

    Parameters
    ----------
    n
        How many: 1 to 1000.
    robot
        What each is; None: the usual `Robot`.

    Returns
    -------
    tuple of TeamMember
        For `plan_team`, or as the ``team`` of `MonitoringSettings`.

    Raises
    ------
    SettingError
        If there are none, or too many.

    Examples
    --------
    >>> import fieldmon as fm
    >>> [member.name for member in fm.team_of(3)]
    ['robot-1', 'robot-2', 'robot-3']
    """
    if n < 1:
        raise SettingError(
            worded(
                "A team must have 1 member or more, but it has {n}.",
                n=n,
            )
        )
    refuse_too_many(n)
    return tuple(TeamMember(f"robot-{k}", robot or Robot()) for k in range(1, n + 1))


def refuse_too_many(n: int) -> None:
    """Raise `SettingError` where a team has more than 1000 members."""
    if n > _MOST_MEMBERS:
        raise SettingError(
            worded(
                "A team must have {most} members at most, but their number is {n}.",
                most=_MOST_MEMBERS,
                n=n,
            )
        )


def person_key(name: str) -> str:
    """Return what tells people apart: a name without its capitals and the spaces around it.

    Examples
    --------
    >>> person_key("Ann ") == person_key("ann")
    True
    """
    return name.strip().casefold()


def refuse_far_gates(team: Iterable[TeamMember], plot: Field) -> None:
    """Raise `SettingError` where a member's gate lies where nobody drives from in a day."""
    from fieldmon.io.prepare import refuse_far_gate  # noqa: PLC0415 - a team is told without it

    for member in team:
        try:
            refuse_far_gate(member.gate, plot)
        except SettingError as error:
            raise SettingError(
                worded("{name}: {problem}", name=member.name, problem=error.args[0])
            ) from None


def ways_of(robot: Robot, aisles: Aisles, name: str = "") -> Aisles:
    """Return the ways that a robot can drive; raise `SettingError` with its name if there are none.

    So it is where all aisles are too narrow for it, or no row end leaves it room to turn.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> ways_of(fm.Robot(), plot.aisles) is plot.aisles
    True
    """
    try:
        return aisles.for_robot(robot)
    except PlotError as error:
        problem = error.args[0]
        named = worded("{name}: {problem}", name=name, problem=problem) if name else problem
        raise SettingError(named) from None


def refuse_too_wide(team: Iterable[TeamMember], plot: Plot) -> None:
    """Raise `SettingError` where a member whose width is known can drive nowhere on a plot."""
    for one in team:
        if one.robot.width_m is not None:
            aisles = plot.aisles if one.gate is None else plot.with_gate(one.gate).aisles
            ways_of(one.robot, aisles, one.name)


def must_differ(names: Sequence[str], where: Sequence[str] = ()) -> None:
    """Refuse a team of none, or one in which two share a name; of a table say `where` they do."""
    if not names:
        raise SettingError(
            worded("A team must have 1 member or more, but it has none. Give one: team_of(1).")
        )
    known: dict[str, int] = {}
    for k, name in enumerate(names):
        if (first := known.setdefault(person_key(name), k)) == k:
            continue
        if where:
            raise SettingError(
                worded(
                    "{where}: members of a team must have names of their own, but {name} is that "
                    "of {first} too. Change one.",
                    where=where[k],
                    name=name,
                    first=where[first],
                )
            )
        raise SettingError(
            worded(
                "A team must have members of different names, but they are {names}.",
                names=", ".join(names),
            )
        )
