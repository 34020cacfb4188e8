"""Who inspects: a robot, or a scout on foot, as the numbers that cost time and find insects."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from types import NoneType
from typing import Any, NamedTuple

from fieldmon.compute.arguments import must_be
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.ranges import CHANCE, AllowedRange, broken_setting
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

#: people say speeds in km/h
KM_H = 3.6
THESIS_VIEWPOINTS = ((20.0, 0.50), (25.0, 0.60), (30.0, 0.69), (35.0, 0.77), (40.0, 0.84))
THESIS_LONGER = 0.90
# a day has 86 400 s
_SECONDS, _SIZE = (
    AllowedRange(0.0, 86_400.0),
    AllowedRange(0.05, 10.0, said=worded("0.05 to 10 metres")),
)
#: a study of what driving costs has a robot that is everywhere at once: no other is as quick
EVERYWHERE_M_S = 1e6
_ALLOWED = {
    "hours": AllowedRange(0.0, 24.0, above=True),
    # at 108 km/h nobody drives along plants
    "speed_m_s": AllowedRange(0.0, 30.0, above=True),
    "look_s": replace(_SECONDS, above=True),
    "detection": CHANCE,
    "width_m": _SIZE,
    "length_m": _SIZE,
    "turning_radius_m": AllowedRange(0.1, 20.0, said=worded("0.1 to 20 metres")),
    "row_change_s": _SECONDS,
    "turn_180_s": _SECONDS,
    "stop_s": _SECONDS,
}
_ALLOWED_EVERYWHERE = {name: one for name, one in _ALLOWED.items() if name != "speed_m_s"}


class SaidIn(NamedTuple):
    """How a person says a setting of `Robot` that is a number.

    Parameters
    ----------
    column
        What it is called in a table.
    unit
        What it is in; empty: nothing.
    units
        How many of these make one of the setting's.
    most
        The most that it may be, in these.
    """

    column: str
    unit: str
    units: float
    most: float


def _said_in(name: str) -> SaidIn:
    most = _ALLOWED[name].most
    if name == "speed_m_s":
        return SaidIn("speed_km_h", "km/h", KM_H, most * KM_H)
    unit = {"hours": "h", "detection": ""}.get(name, name.rpartition("_")[2])
    return SaidIn(name, unit, 1.0, most)


#: the settings of `Robot` that are numbers, as tables and options have them
SAID_IN = {name: _said_in(name) for name in _ALLOWED}


@checked
@dataclass(frozen=True)
class Viewpoints:
    """How likely an infested plant is seen to be infested, by seconds spent looking at it.

    The defaults are the table of A. Yehoshua's thesis (2023, chapter 5): 20 s 50 %, 25 s 60 %,
    30 s 69 %, 35 s 77 %, 40 s 84 %, longer 90 %; under 20 s nothing is detected.

    Parameters
    ----------
    steps
        ``(seconds, chance)`` pairs, rising in both: from so many seconds on, that chance.
    longer
        Chance for any time longer than the last step.

    Raises
    ------
    SettingError
        If there is no step, seconds are not above 0 and rising, or a chance falls or is above 1.

    Examples
    --------
    >>> import fieldmon as fm
    >>> quick = fm.Viewpoints(steps=((10.0, 0.4), (20.0, 0.7)), longer=0.8)
    >>> quick.detection(15.0), quick.detection(60.0)
    (0.4, 0.8)
    """

    steps: tuple[tuple[float, float], ...] = THESIS_VIEWPOINTS
    longer: float = THESIS_LONGER

    def __post_init__(self) -> None:
        must_hold_kinds(self, "Viewpoints'")
        ladder = (*self.steps, (math.inf, self.longer))
        rising = all(low[0] < high[0] and low[1] <= high[1] for low, high in pairwise(ladder))
        if not (self.steps and rising and self.steps[0][0] > 0 and self.steps[0][1] >= 0):
            raise SettingError(
                worded(
                    "Viewpoints must be pairs of seconds and chance, both rising, from above 0 s, "
                    "but they are {steps} and {longer} for longer.",
                    steps=self.steps,
                    longer=self.longer,
                )
            )
        if self.longer > 1:
            raise SettingError(
                worded(
                    "A chance must be in 0..1, but 'longer' is {longer}.",
                    longer=self.longer,
                )
            )

    def detection(self, seconds: float) -> float:
        """Return the chance that `seconds` of looking find what is on an infested plant."""
        if seconds > self.steps[-1][0]:
            return self.longer
        return max((chance for least_s, chance in self.steps if seconds >= least_s), default=0.0)


class RobotTimes(NamedTuple):
    """What a robot's ways cost beside driving and looking, in seconds; see `Robot`.

    Parameters
    ----------
    row_change_s, turn_180_s, stop_s
        Settings of `Robot` of the same names.
    """

    row_change_s: float
    turn_180_s: float
    stop_s: float


#: those of days driven in a physical simulation (docs/physical_simulation), of a robot with two
#: driven wheels whose mast looks to both sides, so that it need not turn in an aisle; and those of
#: the thesis
ROBOT_TIMES = {"measured": RobotTimes(9.0, 0.0, 1.13), "thesis": RobotTimes(25.0, 23.0, 0.0)}
USUAL_TIMES = "measured"
#: our choice
SCOUT_TIMES = RobotTimes(3.0, 2.0, 5.0)


@checked
@dataclass(frozen=True)
class Robot:
    """Speed, turning, looking and working time of whoever inspects.

    The defaults are the thesis's robot (2.5 km/h, 40 s a plant, 12 h a day), but for its row
    changes, turns and stops: those are what simulated drives took, and the thesis's are
    ``with_times("thesis")``. A scout on foot is a robot that walks, with other numbers, see
    :func:`scout`.

    Parameters
    ----------
    speed_m_s
        Driving speed.
    row_change_s
        Added once whenever the robot leaves one aisle for another, beside the driving itself.
    turn_180_s
        Added when the next plant is on the other side of the same aisle.
    stop_s
        Added at every stop, beside looking: stopping, turning to the plant and back.
    look_s
        Seconds spent looking at a plant.
    hours
        Working day.
    viewpoints
        Seconds of looking -> chance of detection.
    detection
        Chance of detection given outright; None takes it from `viewpoints` and `look_s`.
    returns
        Whether the day's hours must also cover the way back to the gate.
    width_m, length_m
        Size over everything. With a width, ways keep half of it off the canopies of plants, and
        aisles and row ends that are too narrow are not driven; see `Aisles.for_robot`. Without
        one, as in the thesis, ways keep 0.3 m off the middle of plants. A length of None is as
        long as wide.
    turning_radius_m
        Of its least turn, at the middle of its rear axle, if it cannot turn on the spot. Row ends
        without room for its arcs and shunts are not driven, and a row change is charged what they
        take on the plot, unless its seconds are said; see `Aisles.worked_by`. None: it turns on
        the spot. Needs a width.
    on_foot
        Whether it is a person who walks, whatever the numbers: nobody is sent where people may not
        be yet, as after spraying, and `fieldmon drive` drives no person.

    Raises
    ------
    SettingError
        If speed, looking or hours are not above 0, speed above 30, hours above 24, seconds below 0,
        `detection` no chance, or there is a length or turning radius without a width.

    Examples
    --------
    >>> import fieldmon as fm
    >>> robot = fm.Robot(hours=4, look_s=30)
    >>> robot.detects, robot.visit_s
    (0.69, 31.13)
    >>> try:
    ...     fm.Robot(turning_radius_m=2.0)
    ... except fm.SettingError as problem:
    ...     print(problem)
    A robot whose turning radius is known must have a width too. Give both.
    """

    speed_m_s: float = 2.5 / 3.6
    row_change_s: float = ROBOT_TIMES[USUAL_TIMES].row_change_s
    turn_180_s: float = ROBOT_TIMES[USUAL_TIMES].turn_180_s
    stop_s: float = ROBOT_TIMES[USUAL_TIMES].stop_s
    look_s: float = 40.0
    hours: float = 12.0
    viewpoints: Viewpoints = Viewpoints()
    detection: float | None = None
    returns: bool = True
    width_m: float | None = None
    length_m: float | None = None
    turning_radius_m: float | None = None
    on_foot: bool = False

    def __post_init__(self) -> None:
        must_hold_kinds(self, "The robot's")
        everywhere = self.speed_m_s == EVERYWHERE_M_S
        if broken := broken_setting(self, _ALLOWED_EVERYWHERE if everywhere else _ALLOWED):
            raise SettingError(worded("The robot's {name} must be {rule}, not {value}.", **broken))
        if self.length_m is not None and self.width_m is None:
            raise SettingError(
                worded("A robot whose length is known must have a width too. Give both.")
            )
        if self.turning_radius_m is not None and self.width_m is None:
            raise SettingError(
                worded("A robot whose turning radius is known must have a width too. Give both.")
            )

    @property
    def day_s(self) -> float:
        """Return the seconds of a working day."""
        return self.hours * 3600.0

    @property
    def visit_s(self) -> float:
        """Return the seconds that one stop takes."""
        return self.stop_s + self.look_s

    @property
    def detects(self) -> float:
        """Return the chance that an infested plant is found when it is inspected."""
        return self.viewpoints.detection(self.look_s) if self.detection is None else self.detection

    @property
    def turning_m(self) -> float | None:
        """Return how wide it is while it turns on the spot: its diagonal. None: not known."""
        if self.width_m is None:
            return None
        return math.hypot(self.width_m, self.length_m or self.width_m)

    @property
    def times(self) -> str | None:
        """Return which of `ROBOT_TIMES` are charged; None: others."""
        own = RobotTimes(self.row_change_s, self.turn_180_s, self.stop_s)
        return next((name for name, times in ROBOT_TIMES.items() if times == own), None)

    @property
    def on_foot_by_times(self) -> bool:
        """Return whether it is charged what a scout usually is: one walked where nobody said."""
        return (self.row_change_s, self.turn_180_s, self.stop_s) == SCOUT_TIMES

    def with_times(self, name: str) -> Robot:
        """Return the same robot charged other times.

        Parameters
        ----------
        name
            ``"measured"``, in simulated drives, or ``"thesis"``.

        Raises
        ------
        SettingError
            If there are no times of that name, or a scout is meant.

        Examples
        --------
        >>> import fieldmon as fm
        >>> fm.Robot().row_change_s, fm.Robot().with_times("thesis").row_change_s
        (9.0, 25.0)
        """
        if self.on_foot:
            raise SettingError(worded("A scout has times of its own: leave a robot's out."))
        if name not in ROBOT_TIMES:
            raise SettingError(
                worded(
                    "Times must be {names}, but they are {name!r}.",
                    names=" or ".join(ROBOT_TIMES),
                    name=name,
                )
            )
        return replace(self, **ROBOT_TIMES[name]._asdict())

    def with_hours(self, hours: float) -> Robot:
        """Return the same robot with a working day of so many `hours`.

        Raise `SettingError` if they are not above 0 and 24 at most.
        """
        return replace(self, hours=hours)


def scout(**fields: Any) -> Robot:  # noqa: ANN401 - of `Robot`
    """Return a person on foot with a hand lens.

    The numbers are our choice: 4 km/h, 30 s at a plant (69 % of what is there is found), 5 s for
    each stop, 3 s for another row, 2 s to turn about, 4 h a day.

    Parameters
    ----------
    **fields
        What is otherwise, by the names of `Robot`: ``hours=2``.

    Returns
    -------
    Robot
        With the numbers of a scout; it is `on_foot`.

    Raises
    ------
    SettingError
        If a field cannot hold what is given.

    Examples
    --------
    >>> import fieldmon as fm
    >>> ann = fm.scout(hours=2)
    >>> ann.day_s, ann.visit_s, ann.detects
    (7200.0, 35.0, 0.69)
    >>> fm.scout(stop_s=8).on_foot
    True
    """
    walks = Robot(4.0 / 3.6, *SCOUT_TIMES, look_s=30.0, hours=4.0, on_foot=True)
    return replace(walks, **fields)


def rover(**fields: Any) -> Robot:  # noqa: ANN401 - as above
    """Return a small robot with two driven wheels: the usual one, with its size.

    It is the robot of `fieldmon drive --robot mujoco`; docs/physical_simulation
    tells how its times were found.
    Its mast looks to both sides, and it drives as well backwards: it need not turn in an aisle.

    Parameters
    ----------
    **fields
        What is otherwise, by the names of `Robot`: ``hours=2``.

    Returns
    -------
    Robot
        The usual numbers, 0.58 m wide and 0.8 m long: aisles too narrow for it are not driven.

    Raises
    ------
    SettingError
        If a field cannot hold what is given.

    Examples
    --------
    >>> import fieldmon as fm
    >>> small = fm.rover(hours=6)
    >>> small.width_m, small.length_m, small.hours
    (0.58, 0.8, 6)
    """
    return replace(Robot(width_m=0.58, length_m=0.8), **fields)


def must_be_robot(given: object) -> None:
    """Raise `SettingError` unless this is a `Robot`, or None: the usual one."""
    must_be(
        "Who inspects must be a Robot", given, (Robot, NoneType),
        "Give Robot(hours=4), or scout() for a person on foot.",
    )  # fmt: skip


def broken_rule(name: str, value: float, *, with_unit: bool = False) -> str:
    """Return what a setting that a person gives must be and is not; empty where it may be so.

    Parameters
    ----------
    name
        Of a setting that is a number.
    value
        What it is to be, in the units of `SAID_IN`.
    with_unit
        Whether the unit stands behind a limit that says none itself.

    Examples
    --------
    >>> broken_rule("speed_m_s", -1.0), broken_rule("speed_m_s", 200.0, with_unit=True)
    ('above 0', '108 km/h at most')
    >>> broken_rule("look_s", 40.0)
    ''
    """
    said = SAID_IN[name]
    unit = f" {said.unit}" if with_unit and said.unit else ""
    return replace(_ALLOWED[name], most=said.most, unit=unit).broken(value)
