"""One of a team on its day: what it has done, where it goes next, which aisles it needs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.planning.workday import Workday
from fieldmon.plot.passing import legs_of
from fieldmon.plot.travel import GATE, travel_s

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.planning.headlands import Steps
    from fieldmon.plot.passing import Leg, Legs
    from fieldmon.samplers.base import Scene, WouldFind

NOWHERE = -1
#: seconds that rounding may make of none
ROUNDING_S = 1e-6


class Posted(NamedTuple):
    """One of a team as its day begins.

    Parameters
    ----------
    scene
        Where it begins, and what is believed then; the plants of all are open in it.
    starts_s
        Seconds after the team's day began at which it does.
    would_find
        ``(n,)`` what its inspection of each plant would find, see `Sampler.walk`.
    """

    scene: Scene
    starts_s: float
    would_find: WouldFind


class StopMade(NamedTuple):
    """A stop that was made; seconds since the team's day began."""

    plant: int
    arrive_s: float
    leave_s: float
    found: bool
    detects: float
    wait_s: float


@dataclass(eq=False)
class TeamWorker:
    """One of the team, as its day goes. Seconds count from the start of the team's day.

    Parameters
    ----------
    k
        Its number in the team.
    post
        How its day began.
    legs
        What is driven in which aisle between two plants.
    at
        The plant where it stands; -1: the gate.
    plan, plan_from_s, next
        The rest of its day as planned, when that began, and which of its stops comes next.
    done, visit, begun, told
        The stops that it made; which of them is the first in this aisle; how many count as begun,
        and how many all know of.
    version
        Events of earlier ones are void.
    anew, over
        Whether it plans anew before it goes on, and whether its day is over.
    holds, claims, through
        The aisle that it is in, the one where it goes, and those that it drives through.
    leg, driven
        Its way to the next plant or home, and the steps of it in headlands.
    out_s, free_s, end_s, wait_home_s
        When it came out of its aisle, from when it may drive on, when its day ended, and how long
        it waited on the way home.
    """

    k: int
    post: Posted
    legs: Legs
    at: int
    plan: Workday | None = None
    plan_from_s: float = 0.0
    next: int = 0
    done: list[StopMade] = field(default_factory=list)
    visit: int = 0
    begun: int = 0
    told: int = 0
    version: int = 0
    anew: bool = True
    over: bool = False
    holds: int = NOWHERE
    claims: int = NOWHERE
    through: tuple[int, ...] = ()
    leg: Leg | None = None
    driven: Steps | None = None
    out_s: float = 0.0
    free_s: float = 0.0
    end_s: float = 0.0
    wait_home_s: float = 0.0

    @classmethod
    def of(cls, k: int, post: Posted) -> TeamWorker:
        """Return one as its day begins."""
        return cls(k, post, legs_of(post.scene.aisles), post.scene.at)

    @property
    def scene(self) -> Scene:
        """What it knew as its day began."""
        return self.post.scene

    def stretch(self, plants: NDArray[np.integer]) -> NDArray[np.int32]:
        """Return from which stretches of aisles it inspects plants ``(k,)``."""
        travel = self.scene.aisles.travel
        stretch: NDArray[np.int32] = travel.corridor[travel.row[plants]]
        return stretch

    @property
    def until_s(self) -> float:
        """When its hours end."""
        return self.post.starts_s + self.scene.seconds_left

    def seconds(self, i: int, j: int) -> float:
        """Return what it takes from one plant to another."""
        return float(travel_s(self.scene.aisles.travel, self.scene.clock, i, j))

    def home_s(self, plant: int) -> float:
        """Return what it takes from a plant to the gate, nothing where it stays out."""
        return self.seconds(plant, GATE) if self.scene.robot.returns else 0.0

    def spare_s(self, arrive_s: float) -> float:
        """Return how much later it could come to its next plant and still be home in time."""
        plan, plant = self.plan, self.target()
        assert plan is not None  # noqa: S101 - it has a target
        return self.until_s - arrive_s - float(plan.stop_s[self.next]) - self.home_s(plant)

    def under_way(self, now_s: float) -> int:
        """Return how many of its stops it has made, or begun to drive to."""
        for k in range(self.visit + 1, len(self.done)):
            if self.done[k - 1].leave_s > now_s + ROUNDING_S:
                return k
        return len(self.done)

    def leaves_s(self, now_s: float) -> float:
        """Return when it is done with the stop that it is at, or has begun to drive to."""
        return min((stop.leave_s for stop in self.done[self.visit :] if stop.leave_s > now_s),
                   default=max(now_s, self.post.starts_s))  # fmt: skip

    def left_s(self, now_s: float) -> float:
        """Return the seconds that it has left after what it has begun."""
        return 0.0 if self.over else self.until_s - self.leaves_s(now_s)

    def share_out(self) -> float:
        """Return how much of the way to its next plant, or home, is driven in its own aisle."""
        leg = self.leg
        assert leg is not None  # noqa: S101 - set on leaving
        return leg.out_m / leg.length_m if leg.length_m > 0 else 0.0

    def onward_s(self) -> float:
        """Return the seconds from the end of its aisle to the next plant, or home."""
        return (1.0 - self.share_out()) * self.seconds(self.at, self.target())

    def target(self) -> int:
        """Return the plant it goes to next, -1 for home."""
        if self.plan is None or self.next >= len(self.plan):
            return GATE
        return int(self.plan.plant[self.next])

    def needed(self) -> list[int]:
        """Return the aisles that it drives through next, and the one where it goes."""
        assert self.leg is not None  # noqa: S101 - set on leaving
        return [*self.leg.through, *([self.claims] if self.target() >= 0 else [])]

    def turn_home(self) -> int:
        """Make no more stops; return where it goes."""
        if self.plan is not None:
            self.next = len(self.plan)
        self.claims = NOWHERE
        return GATE

    def interrupt(self, now_s: float) -> bool:
        """Plan anew after what is begun; tell whether stops were dropped that were not."""
        self.anew = True
        k = self.under_way(now_s)
        if k == len(self.done):
            return False
        del self.done[k:]
        self.at = self.done[-1].plant
        self.version += 1
        return True

    def worked(self) -> Workday:
        """Return its day; seconds since it began."""
        begin = self.post.starts_s
        columns = list(zip(*self.done, strict=True)) or [()] * len(StopMade._fields)
        plant, arrive_s, leave_s, found, detects, wait_s = (np.array(c) for c in columns)
        return Workday(
            plant.astype(np.int32),
            arrive_s.astype(np.float64) - begin,
            found.astype(np.bool_),
            (leave_s - arrive_s).astype(np.float64),
            detects.astype(np.float64),
            self.end_s - begin,
            np.append(wait_s, self.wait_home_s).astype(np.float64),
        )
