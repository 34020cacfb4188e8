"""What the thesis's chapter 5 leaves open, as named settings, and what it states."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Literal

from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.robot import Robot

if TYPE_CHECKING:
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather

SCENARIOS = {"A": 1.0, "B": 5.0, "C": 10.0}
"""Hectares of the thesis's scenarios: 784, 4 096 and 8 281 plants."""

SAMPLERS = ("dynamic", "naive", "bouncy")
SIZES_HA = (1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 14.0, 20.0)
SPREAD_RATES = (0.3, 0.5, 0.8)
LOOKS_S = (20.0, 25.0, 30.0, 35.0, 40.0)
DETECTIONS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
TIME_HA = 6.0
"""The thesis varies the inspection time on 6 ha."""

ROWS_M, PLANTS_M = 4.0, 3.0
N_DAYS = 25


def side_of(hectares: float) -> int:
    """Return how many rows of as many plants stand on a square: 28, 64, 91 on 1, 5, 10 ha."""
    return math.floor(math.sqrt(1e4 * hectares / (ROWS_M * PLANTS_M)))


@dataclass(frozen=True)
class StartUp:
    """Which plants are infested on the first morning, and how much of it is known.

    Parameters
    ----------
    share
        Infested plants of all plants.
    margin_share
        Share of the clusters that entered from the plot's edge or a path; the others begin
        anywhere.
    depth_m
        Depth over which entering falls to 1/e.
    cluster_size
        Mean number of plants of a cluster, each grown from plant to adjacent plant; 1: scattered.
    recorded_share
        Share of the infested plants that a record points to: the prior information.
    """

    share: float = 0.02
    margin_share: float = 0.5
    depth_m: float = 10.0
    cluster_size: float = 4.0
    recorded_share: float = 0.5

    def __post_init__(self) -> None:
        for name in ("margin_share", "recorded_share"):
            _must(name, getattr(self, name), "a share in 0..1", 0 <= getattr(self, name) <= 1)
        _must("share", self.share, "above 0 and 0.5 at most", 0 < self.share <= 0.5)
        _must("depth_m", self.depth_m, "above 0", 0 < self.depth_m < math.inf)
        _must("cluster_size", self.cluster_size, "1 or more", 1 <= self.cluster_size < math.inf)


@dataclass(frozen=True)
class OpenChoices:
    """Every assumption that the text of chapter 5 leaves open.

    Parameters
    ----------
    start
        Which plants are infested at first.
    spread
        Chance a night, and who infects whom: ``each`` neighbour (per pair), ``one`` neighbour or
        ``all`` of them (per plant).
    sources
        Whether all infested plants that are ``left`` spread at night, or only those that were
        inspected that day and ``missed`` ("a missed one may spread").
    missed_known
        Whether Dynamic knows next morning which plants it missed.
    map_follows
        Whether the chance map that makes plants suspicious follows the nights' spread; if not, it
        only learns: it falls where a look was clean, and rises beside finds.
    bouncy_rests
        Whether Bouncy ends a day after one pass over the plot (half of the plants), or goes on
        with the plants it left out.
    counts
        Detection in percent of ``infestations`` (a plant infested again counts again) or of
        ``plants`` (each once).
    ends
        Whether work goes on for the whole ``season``, or ends with the last ``find`` when nobody
        is infested any more; the visited share is the mean over the days worked.
    stop_s, row_change_s
        Turning to a plant and back at every stop; changing rows, beside the driving itself.
    pest
        The pest that lives on the plots instead of the thesis's rule, which `spread` and `sources`
        say; None: that rule.
    """

    start: StartUp = field(default_factory=StartUp)
    spread: Spread = field(default_factory=Spread)
    sources: Literal["left", "missed"] = "left"
    missed_known: bool = False
    map_follows: bool = True
    bouncy_rests: bool = False
    counts: Literal["infestations", "plants"] = "infestations"
    ends: Literal["season", "find"] = "find"
    stop_s: float = 25.0
    row_change_s: float = 25.0
    pest: PestInWeather | None = None

    def __post_init__(self) -> None:
        for name, known in (
            ("sources", ("left", "missed")),
            ("counts", ("infestations", "plants")),
            ("ends", ("season", "find")),
        ):
            value = getattr(self, name)
            _must(name, value, f"{known[0]!r} or {known[1]!r}", value in known)

    def robot(self, look_s: float = 40.0, detection: float | None = None) -> Robot:
        """Return the thesis's robot: 12 h a day at 2.5 km/h, detection by its viewpoint table."""
        robot = Robot(look_s=look_s, detection=detection).with_times("thesis")
        robot = replace(robot, row_change_s=self.row_change_s, stop_s=self.stop_s)
        if self.pest is None or detection is not None:
            return robot
        return self.pest.pest.seen_by(robot)

    def sentences(self) -> tuple[str, ...]:
        """Return each choice as ``name: value``, nested ones with their group's name."""
        said = []
        for each in fields(self):
            value = getattr(self, each.name)
            if isinstance(value, (StartUp, Spread)):
                said += [
                    f"{each.name} {inner.name}: {_plain(getattr(value, inner.name))}"
                    for inner in fields(value)
                ]
            elif each.name == "pest":
                said += [] if self.pest is None else [f"pest: {self.pest.pest.name}"]
            else:
                said.append(f"{each.name}: {_plain(value)}")
        return tuple(said)


def _plain(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _must(name: str, value: object, rule: str, holds: bool) -> None:  # noqa: FBT001 - one check
    if not holds:
        raise SettingError(f"The start or rule {name!r} must be {rule}, but it is {value}.")
