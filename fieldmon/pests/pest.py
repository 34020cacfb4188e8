"""A pest as data: how it develops, multiplies, moves, enters, and how it is seen."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from fieldmon.compute.arguments import is_one_of, shown
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.plot.assumed import Assumed

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.robot import Robot, Viewpoints

    Floats = NDArray[np.float64]

#: chance a night to infest each neighbour where nobody said it: our choice, four times of which
#: double the infested plants in nine days
USUAL_PER_DAY = 0.02
#: how far a jump goes is drawn from these
KernelName = Literal["adjacent", "exponential", "cauchy"]
#: what happens to development above the upper threshold
Cutoff = Literal["horizontal", "vertical", "intermediate"]
# nothing that lives on plants begins to develop above, or dies of warmth below
_THRESHOLDS_C = (-10.0, 45.0)
_TABLE_C = (-40.0, 60.0)
# beyond them nothing on a plot is told apart: ten years, ten thousand warm days, a hundred km
_MOST_DAYS, _MOST_DEGREE_DAYS, _MOST_M, _MOST_PER_DAY = 3650.0, 100_000.0, 100_000.0, 1e6


@dataclass(frozen=True)
class Citation:
    """Where the figures of a part of a pest come from.

    Parameters
    ----------
    part
        Which part: ``"stages"``, ``"increase"``, ``"movement"``, ...
    source
        Who published them; or that they are our choice, where nothing was found.
    doubt
        Why they should be doubted; empty: no more than usual.

    Examples
    --------
    >>> import fieldmon as fm
    >>> mite = fm.read_pest("spider-mite")
    >>> isinstance(mite.citations[0], fm.Citation)
    True
    """

    part: str
    source: str
    doubt: str = ""

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A citation's")


@dataclass(frozen=True)
class Stage:
    """A stage of life: what it needs to pass, whether it is seen, whether it moves.

    Parameters
    ----------
    name
        ``"egg"``, ``"adult before eggs"``.
    threshold_c
        Lower development threshold.
    degree_days
        Above the threshold, from entering the stage to leaving it.
    upper_c
        Upper threshold; None: none was published.
    visible, mobile
        Whether an inspection can see it, and whether it goes to other plants.

    Examples
    --------
    >>> import fieldmon as fm
    >>> egg = fm.Stage("egg", threshold_c=12.0, degree_days=60.0, visible=False, mobile=False)
    >>> egg.upper_c is None
    True
    """

    name: str
    threshold_c: float
    degree_days: float
    upper_c: float | None = None
    visible: bool = True
    mobile: bool = True

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A stage's")
        low, high = _THRESHOLDS_C
        _must(
            self.name, "threshold_c", self.threshold_c, f"{low:g} to {high:g} °C",
            low <= self.threshold_c <= high,
        )  # fmt: skip
        _must(self.name, "degree_days", self.degree_days, "above 0", self.degree_days > 0)
        _at_most(self.name, "degree_days", self.degree_days, _MOST_DEGREE_DAYS)
        if self.upper_c is not None:
            above = self.threshold_c < self.upper_c <= _TABLE_C[1]
            _must(self.name, "upper_c", self.upper_c, "above threshold_c, 60 °C at most", above)


@dataclass(frozen=True)
class Increase:
    """Daily rate of increase against temperature: straight lines between published points.

    Parameters
    ----------
    at_c
        Temperatures, rising.
    per_day
        Intrinsic rate of increase r at each: numbers grow e^r times in a day. Outside the
        temperatures it is as at the nearest.

    Examples
    --------
    >>> import fieldmon as fm
    >>> float(fm.Increase(at_c=(10.0, 30.0), per_day=(0.0, 0.3)).at(20.0))
    0.15
    """

    at_c: tuple[float, ...]
    per_day: tuple[float, ...]

    def __post_init__(self) -> None:
        must_hold_kinds(self, "An increase's")
        if not self.at_c or len(self.at_c) != len(self.per_day):
            raise SettingError(
                worded(
                    "An increase must have as many rates per_day as temperatures at_c, "
                    "one or more, but it has {rates} and {temperatures}.",
                    rates=len(self.per_day),
                    temperatures=len(self.at_c),
                )
            )
        if any(a >= b for a, b in pairwise(self.at_c)):
            raise SettingError(
                worded(
                    "Temperatures at_c must rise, but they are {temperatures}.",
                    temperatures=list(self.at_c),
                )
            )
        for value in self.at_c:
            within = _TABLE_C[0] <= value <= _TABLE_C[1]
            _must("increase", "at_c", value, "-40 to 60 °C", within)
        for rate in self.per_day:
            _must("increase", "per_day", rate, "0 to 2", 0 <= rate <= 2)

    def at(self, temperature_c: float | Floats) -> Floats:
        """Return the rate per day at temperatures, of their shape.

        Parameters
        ----------
        temperature_c
            One, or an array of any shape, degrees Celsius.
        """
        return np.asarray(np.interp(temperature_c, self.at_c, self.per_day))


@dataclass(frozen=True)
class Movement:
    """How a pest comes from plant to plant.

    Parameters
    ----------
    kernel
        ``"adjacent"``: to the plants next to it. ``"exponential"`` or ``"cauchy"``: in an even
        direction (but for `along_over_across` and `wind`), so far as drawn from that distribution.
    reach_m
        How far: the mean jump of the exponential, the median jump of the Cauchy. Without meaning
        for ``"adjacent"``. Jumps onto the plant itself are drawn anew, so those to other plants go
        farther on average: 8.3 m where it is 6 m and plants stand 3 m apart.
    share_of_long_jumps
        How many of the jumps land anywhere on the plot instead.
    along_over_across
        How many times as far a jump goes along the rows as across them.
    wind
        ``"with"``: jumps go with the wind. ``"none"``: it does not matter.
    hours
        Local hours of the day between which it moves; past midnight where the second is smaller.
    per_day
        ``"adjacent"``: chance in 0..1 a day that an infested plant infests each plant next to it.
        Otherwise: new infestations a day that an infested plant sends out. None, of ``"adjacent"``
        only: nobody said it, and a season's usual 0.02 holds.
    at_c
        Temperature at which `per_day` holds; at others it goes with the pest's rate of increase,
        which must be above 0 there. None: at any.
    by_hour
        Whether it is simulated by the hour rather than by the night.
    least_rain_mm
        It moves only on days with so much rain or more, whenever it falls, or `by_hour` in hours
        with so much; 0: whatever the weather.

    Examples
    --------
    >>> import fieldmon as fm
    >>> flies = fm.Movement("exponential", per_day=0.1, reach_m=8.0, wind="with")
    >>> fm.Pest("whitefly of ours", movement=flies).movement.rate_per_day
    0.1
    """

    kernel: KernelName = "adjacent"
    per_day: float | None = None
    reach_m: float | None = None
    share_of_long_jumps: float = 0.0
    along_over_across: float = 1.0
    wind: Literal["none", "with"] = "none"
    hours: tuple[float, float] = (0.0, 24.0)
    at_c: float | None = None
    by_hour: bool = False
    least_rain_mm: float = 0.0

    def __post_init__(self) -> None:
        if not is_one_of(self.kernel, get_args(KernelName)):
            raise SettingError(
                worded(
                    "A kernel must be one of {names}, but it is {kernel!r}.",
                    names=", ".join(get_args(KernelName)),
                    kernel=self.kernel,
                )
            )
        if not is_one_of(self.wind, ("none", "with")):
            raise SettingError(
                worded("The wind must be 'none' or 'with', but it is {wind!r}.", wind=self.wind)
            )
        must_hold_kinds(self, "A movement's")
        adjacent = self.kernel == "adjacent"
        for name in ("reach_m", "per_day"):
            if not adjacent and getattr(self, name) is None:
                raise SettingError(
                    worded(
                        "A kernel that is {kernel} must have a {name}. Add it.",
                        kernel=self.kernel,
                        name=name,
                    )
                )
        rule = "a chance in 0..1 where the kernel is adjacent" if adjacent else "0 or more"
        most = 1.0 if adjacent else math.inf
        if self.per_day is not None:
            _must("movement", "per_day", self.per_day, rule, 0 <= self.per_day <= most)
            _at_most("movement", "per_day", self.per_day, _MOST_PER_DAY)
        if self.reach_m is not None:
            _must("movement", "reach_m", self.reach_m, "above 0", self.reach_m > 0)
            _at_most("movement", "reach_m", self.reach_m, _MOST_M)
        share = self.share_of_long_jumps
        _must("movement", "share_of_long_jumps", share, "in 0..1", 0 <= share <= 1)
        _must("movement", "least_rain_mm", self.least_rain_mm, "0 or more", self.least_rain_mm >= 0)
        ratio = self.along_over_across
        _must("movement", "along_over_across", ratio, "0.01 to 100", 0.01 <= ratio <= 100)
        if not isinstance(self.hours, tuple | list) or len(self.hours) != 2:
            raise SettingError(
                worded(
                    "Hours of movement must be two, as 20 and 6, but they are {hours}.",
                    hours=shown(self.hours),
                )
            )
        for hour in self.hours:
            _must("movement", "hours", hour, "0 to 24", 0 <= hour <= 24)

    @property
    def rate_per_day(self) -> float:
        """`per_day`, or where nobody said it the usual."""
        return USUAL_PER_DAY if self.per_day is None else self.per_day


@dataclass(frozen=True)
class Entry:
    """Where a pest comes in from outside, as chances a day that a clean plant is infested.

    Parameters
    ----------
    edge_per_day, paths_per_day
        Of plants at the plot's edge and beside a path; 1/e of it `depth_m` further in.
    anywhere_per_day
        Of every plant.
    depth_m
        How deep edges and paths let it in.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Pest("from the road", entry=fm.Entry(paths_per_day=0.01)).entry.depth_m
    10.0
    """

    edge_per_day: float = 0.0
    paths_per_day: float = 0.0
    anywhere_per_day: float = 0.0
    depth_m: float = 10.0

    def __post_init__(self) -> None:
        must_hold_kinds(self, "An entry's")
        for name in ("edge_per_day", "paths_per_day", "anywhere_per_day"):
            value = getattr(self, name)
            _must("entry", name, value, "a chance in 0..1", 0 <= value <= 1)
        _must("entry", "depth_m", self.depth_m, "above 0", self.depth_m > 0)
        _at_most("entry", "depth_m", self.depth_m, _MOST_M)


@checked
@dataclass(frozen=True)
class Pest:
    """A pest: what was published of it, and what we had to choose.

    Parameters
    ----------
    name
        By which it is asked for: ``"spider-mite"``.
    title, species
        In words, and in Latin.
    stages
        From the egg to the adult that lays the next; empty: its development is not known.
    cutoff
        What happens to development above a stage's upper threshold.
    increase
        Daily rate of increase; None: not known.
    movement
        How it comes from plant to plant.
    entry
        How it comes in from outside.
    viewpoints
        Seconds of looking -> chance of detection; None: as the robot's.
    detection
        That chance given outright; None: by `viewpoints`.
    latency_days
        From infection until a plant infects others.
    hidden_days
        From infestation until an inspection can see it. What is on the plot on the first morning
        is older, in all stages: it can be seen from then on.
    mortality_per_day
        Chance that a plant's infestation ends of itself.
    count_means
        What one that is counted is: ``"mites on a leaf"``.
    generation
        A whole generation in one, where that was published beside its stages; None: their sum.
    not_found
        What was looked for and not found, in words.
    citations
        Where each part comes from.

    Examples
    --------
    >>> import fieldmon as fm
    >>> pest = fm.read_pest("spider-mite")
    >>> pest.species, pest.seen_by(fm.Robot()).detects
    ('Tetranychus urticae', 0.84)
    """

    name: str
    title: str = ""
    species: str = ""
    stages: tuple[Stage, ...] = ()
    cutoff: Cutoff = "horizontal"
    increase: Increase | None = None
    movement: Movement = field(default_factory=Movement)
    entry: Entry = field(default_factory=Entry)
    viewpoints: Viewpoints | None = None
    detection: float | None = None
    latency_days: float = 0.0
    hidden_days: float = 0.0
    mortality_per_day: float = 0.0
    count_means: str = ""
    generation: Stage | None = None
    not_found: str = ""
    citations: tuple[Citation, ...] = ()

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A pest's")
        if not self.name:
            raise SettingError(worded("A pest must have a name, but it is empty."))
        if not is_one_of(self.cutoff, get_args(Cutoff)):
            raise SettingError(
                worded(
                    "A cutoff must be one of {names}, but it is {cutoff!r}.",
                    names=", ".join(get_args(Cutoff)),
                    cutoff=self.cutoff,
                )
            )
        for name in ("latency_days", "hidden_days"):
            _must("pest", name, getattr(self, name), "0 or more", getattr(self, name) >= 0)
            _at_most("pest", name, getattr(self, name), _MOST_DAYS)
        for name in ("detection", "mortality_per_day"):
            value = getattr(self, name)
            if value is not None:
                _must("pest", name, value, "a chance in 0..1", 0 <= value <= 1)
        self._must_go_with_increase()

    def _must_go_with_increase(self) -> None:
        """Raise `SettingError` unless movement can be told at every temperature."""
        at_c = self.movement.at_c
        if self.increase is None or at_c is None:
            return
        if not float(self.increase.at(at_c)) > 0.0:
            raise SettingError(
                worded(
                    "The at_c of movement must be a temperature at which the pest increases, but "
                    "at {at_c:g} °C its rate is 0, and at others it moves by how many times that "
                    "rate theirs is. Give the per_day of a warmer day.",
                    at_c=at_c,
                )
            )
        if self.movement.kernel != "adjacent":
            most = float(np.max(self.infests_per_day(np.array(self.increase.at_c))))
            rule = f"{_MOST_PER_DAY:.0f} at most where the pest increases fastest"
            _must("movement", "per_day", most, rule, most <= _MOST_PER_DAY)

    @property
    def assumed(self) -> tuple[Assumed, ...]:
        """What its nights rest on though nobody said it: the usual rate, if it has none."""
        if self.movement.per_day is not None:
            return ()
        return (Assumed("rate_per_day", USUAL_PER_DAY),)

    def infests_per_day(self, temperature_c: float | Floats | None = None) -> Floats:
        """Return `movement.rate_per_day` at `temperature_c`, °C, of its shape; None: as it is.

        It goes with the rate of increase, where both are known with the temperature. A chance
        stays one: it follows 1 - (1 - per_day)^ratio.
        """
        usual = self.movement.rate_per_day
        if temperature_c is None or self.increase is None or self.movement.at_c is None:
            return np.full(np.shape(temperature_c) if temperature_c is not None else (), usual)
        at_usual = float(self.increase.at(self.movement.at_c))
        ratio = self.increase.at(temperature_c) / at_usual
        if self.movement.kernel != "adjacent":
            return np.asarray(usual * ratio)
        return np.asarray(1.0 - (1.0 - usual) ** ratio)

    def seen_by(self, robot: Robot) -> Robot:
        """Return the robot with this pest's chance of detection, if it has one of its own."""
        own: dict[str, Any] = {}
        if self.viewpoints is not None:
            own = {"viewpoints": self.viewpoints, "detection": None}
        if self.detection is not None:
            own["detection"] = self.detection
        return replace(robot, **own)

    def source(self, part: str) -> Citation | None:
        """Return where a part comes from; None: the file does not speak of it."""
        return next((one for one in self.citations if one.part == part), None)


def tells_detection(robot: Robot) -> bool:
    """Tell whether somebody chose how a robot detects."""
    usual = type(robot)()
    return (robot.detection, robot.viewpoints) != (usual.detection, usual.viewpoints)


def seen_by_pest(robot: Robot, pest: Pest | None, before: Pest | None = None) -> Robot:
    """Return the robot with the chance of detection that the pest says, if one does.

    Where another pest was looked for `before`, what that one said holds no more.
    """
    if before is not None and before != pest and before.seen_by(robot) == robot:
        usual = type(robot)()
        if before.viewpoints is not None:
            robot = replace(robot, viewpoints=usual.viewpoints)
        if before.detection is not None:
            robot = replace(robot, detection=usual.detection)
    return robot if pest is None else pest.seen_by(robot)


def _at_most(of: str, name: str, value: float, most: float) -> None:
    _must(of, name, value, f"{most:.0f} at most", value <= most)


def _must(of: str, name: str, value: float, rule: str, holds: bool) -> None:  # noqa: FBT001
    if not (holds and math.isfinite(value)):
        raise SettingError(
            worded(
                "The {name} of {of} must be {rule}, but it is {value:g}.",
                name=name,
                of=of,
                rule=rule,
                value=value,
            )
        )
