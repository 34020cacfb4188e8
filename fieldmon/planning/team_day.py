"""A day of a team: events in order of the clock, and finds that change what the others do."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from heapq import heappop, heappush
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from fieldmon.planning.headlands import Steps, headlands_of
from fieldmon.planning.sections import (
    aisle_heights,
    aisle_worth,
    best_sections,
    even_sections,
    worth_together,
)
from fieldmon.planning.workday import Workday, work_day
from fieldmon.plot.passing import legs_of
from fieldmon.plot.travel import GATE, travel_s

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.tracing import Traces
    from fieldmon.planning.members import Teamwork
    from fieldmon.planning.sections import AisleWorth
    from fieldmon.plot.passing import Leg, Legs
    from fieldmon.samplers.base import Sampler, Scene, WouldFind

    #: chances of plants and of pairs, and how far insects jump
    _Believed = tuple[NDArray[np.float64], NDArray[np.float64] | None, Traces | None]
    #: what is believed after inspections: plants, whether each was a find, and its detection
    Learn = Callable[[NDArray[np.int32], NDArray[np.bool_], NDArray[np.float64]], Belief]

_NOBODY = _NOWHERE = -1
_ROUNDING_S = 1e-6


class Posted(NamedTuple):
    """One of a team on its day.

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


def team_day(
    team: Sequence[Posted],
    sampler: Sampler,
    teamwork: Teamwork,
    learn: Learn | None = None,
    before: NDArray[np.int64] | None = None,
) -> tuple[Workday, ...]:
    """Return the rest of a day of each of a team, given what inspections would find.

    Each has aisles of its own, in which its sampler decides. No two are in one aisle at once, and
    none meet head-on in a headland that is narrower than `Teamwork.passing_m`: who comes second
    waits at the end of its own aisle, or at the gate. Who has begun to drive to a plant inspects
    it, whatever is heard on the way.

    Parameters
    ----------
    team
        Who works, all on the same plants.
    sampler
        Who decides which plants come next, for each of them.
    teamwork
        How aisles are given out, and when finds are heard of.
    learn
        What is believed after inspections of this day, in order of the clock; None: finds change
        nothing for the others.
    before
        ``(a,)`` who has each aisle so far today, -1: nobody; None: they are yet to be given out.

    Returns
    -------
    tuple of Workday
        Seconds count from each one's own start.
    """
    if len(team) == 1:
        (alone,) = team
        return (work_day(alone.scene, sampler, alone.would_find),)
    return _Day(team, sampler, teamwork, learn, before).run()


class _Done(NamedTuple):
    """A stop that was made."""

    plant: int
    arrive_s: float
    leave_s: float
    found: bool
    detects: float
    wait_s: float


class _Told(NamedTuple):
    """A stop that all know of."""

    leave_s: float
    k: int
    plant: int
    found: bool
    detects: float


class _Event(Protocol):
    def __call__(self, worker: _Worker, now_s: float) -> None: ...


@dataclass(eq=False)
class _Worker:
    """One of the team, as its day goes."""

    k: int
    post: Posted
    legs: Legs
    at: int
    plan: Workday | None = None
    plan_from_s: float = 0.0
    next: int = 0
    done: list[_Done] = field(default_factory=list)
    visit: int = 0
    begun: int = 0
    told: int = 0
    version: int = 0
    anew: bool = True
    over: bool = False
    holds: int = _NOWHERE
    claims: int = _NOWHERE
    through: tuple[int, ...] = ()
    leg: Leg | None = None
    out_s: float = 0.0
    free_s: float = 0.0
    driven: Steps | None = None
    end_s: float = 0.0
    wait_home_s: float = 0.0

    @property
    def scene(self) -> Scene:
        return self.post.scene

    @property
    def until_s(self) -> float:
        return self.post.starts_s + self.scene.seconds_left

    def seconds(self, i: int, j: int) -> float:
        return float(travel_s(self.scene.aisles.travel, self.scene.clock, i, j))

    def home_s(self, plant: int) -> float:
        return self.seconds(plant, GATE) if self.scene.robot.returns else 0.0

    def spare_s(self, arrive_s: float) -> float:
        """Return how much later it could come to its next plant and still be home in time."""
        plan, plant = self.plan, self.target()
        assert plan is not None  # noqa: S101 - it has a target
        return self.until_s - arrive_s - float(plan.stop_s[self.next]) - self.home_s(plant)

    def under_way(self, now_s: float) -> int:
        """Return how many of its stops it has made, or begun to drive to."""
        for k in range(self.visit + 1, len(self.done)):
            if self.done[k - 1].leave_s > now_s + _ROUNDING_S:
                return k
        return len(self.done)

    def share_out(self) -> float:
        """Return how much of the way to its next plant, or home, is driven in its own aisle."""
        leg = self.leg
        assert leg is not None  # noqa: S101 - set on leaving
        return leg.out_m / leg.length_m if leg.length_m > 0 else 0.0

    def target(self) -> int:
        """Return the plant it goes to next, -1 for home."""
        if self.plan is None or self.next >= len(self.plan):
            return GATE
        return int(self.plan.plant[self.next])


class _Day:
    """A day on its way; events are calls in order of the clock."""

    def __init__(
        self,
        team: Sequence[Posted],
        sampler: Sampler,
        teamwork: Teamwork,
        learn: Learn | None,
        before: NDArray[np.int64] | None,
    ) -> None:
        self.sampler, self.teamwork, self.learn = sampler, teamwork, learn
        self.grid = team[0].scene.grid
        self.corridor = self.grid.corridor[self.grid.row]
        self.heights = aisle_heights(self.grid)
        self.workers = [
            _Worker(k, post, legs_of(post.scene.aisles), post.scene.at)
            for k, post in enumerate(team)
        ]
        first = team[0].scene
        self.today: NDArray[np.bool_] = first.last_inspected == first.day
        self.believed: _Believed = first.chance, first.pair_chance, first.traces
        self.known: list[_Told] = []
        self.valued: tuple[tuple[float, int], AisleWorth] | None = None
        self.events: list[tuple[float, int, int, int, _Event]] = []
        self.count = 0
        self.waiting: list[_Worker] = []
        self.news_at: set[float] = set()
        self.holder = np.full(len(self.heights), _NOBODY)
        for worker in self.workers:
            if worker.at >= 0:
                worker.holds = worker.claims = int(self.corridor[worker.at])
                if self.holder[worker.holds] == _NOBODY:
                    self.holder[worker.holds] = worker.k
        self.section = self._first_sections(before)

    def run(self) -> tuple[Workday, ...]:
        for worker in self.workers:
            self._at(worker.post.starts_s, worker, self._ready)
        while self.events or self.waiting:
            if not self.events:
                # somebody stays there for the night
                self._go_at_last(self.waiting[0])
                continue
            now_s, _, version, k, event = heappop(self.events)
            worker = self.workers[k]
            if version in (worker.version, _NOBODY):
                event(worker, now_s)
        return tuple(self._worked(worker) for worker in self.workers)

    # -- events

    def _at(self, at_s: float, worker: _Worker, event: _Event, *, always: bool = False) -> None:
        self.count += 1
        version = _NOBODY if always else worker.version
        heappush(self.events, (at_s, self.count, version, worker.k, event))

    def _ready(self, worker: _Worker, now_s: float) -> None:
        """Go on from where a worker stands."""
        if worker.anew:
            self._walk(worker, now_s)
        if worker.target() < 0 and self._shared_anew(now_s):
            self._walk(worker, now_s)
        self._pass_by(worker)
        target = worker.target()
        if target >= 0 and worker.spare_s(now_s + worker.seconds(worker.at, target)) < -_ROUNDING_S:
            target = self._homeward(worker)
        if target < 0 and (worker.at < 0 or not worker.scene.robot.returns):
            worker.over, worker.end_s = True, now_s
            return
        aisle = int(self.corridor[target]) if target >= 0 else _NOWHERE
        if aisle == worker.holds and aisle >= 0 and self.holder[aisle] == worker.k:
            self._visit(worker, now_s + worker.seconds(worker.at, target), 0.0)
            return
        worker.claims = aisle
        worker.leg = worker.legs.leg(worker.at, target)
        way_s = worker.share_out() * worker.seconds(worker.at, target)
        self._at(now_s + way_s, worker, self._out)

    def _pass_by(self, worker: _Worker) -> None:
        """Leave out the next aisles if somebody stays in them for the night."""
        while (target := worker.target()) >= 0:
            holder = self.holder[self.corridor[target]]
            if holder in (_NOBODY, worker.k) or not self.workers[holder].over:
                return
            worker.next += 1

    def _out(self, worker: _Worker, now_s: float) -> None:
        """Leave an aisle, or the gate; wait at its end if the way is not free."""
        worker.out_s = worker.free_s = now_s
        if self._enter(worker, now_s):
            self._try_again(now_s)
            return
        self.waiting.append(worker)
        if self._wait_for_each_other(worker):
            # one of them steps out into the headland, and lets the other in
            self._release((worker.holds,), worker, now_s)
            worker.holds = _NOWHERE
        if worker.target() >= 0:
            last_s = now_s + worker.spare_s(now_s + self._onward_s(worker))
            self._at(max(last_s, now_s), worker, self._give_up)

    def _give_up(self, worker: _Worker, now_s: float) -> None:
        """Make no more stops, as the aisle waited for comes free too late, or not today."""
        if worker not in self.waiting or worker.target() < 0:
            return
        leg, spent_s = worker.leg, worker.post.starts_s
        self._homeward(worker)
        if worker.done:
            spent_s = worker.done[-1].leave_s
        if not worker.scene.robot.returns or worker.at < 0 or leg is None:
            self.waiting.remove(worker)
            worker.over, worker.end_s = True, spent_s
            return
        worker.leg = worker.legs.leg(worker.at, GATE)
        worker.out_s = spent_s + worker.share_out() * worker.seconds(worker.at, GATE)
        # it may have to drive back to the other end of its aisle
        back_m = leg.out_m + worker.leg.out_m if leg.end != worker.leg.end else 0.0
        worker.free_s = max(now_s + back_m / worker.scene.clock.speed_m_s, worker.out_s)
        self._at(worker.free_s, worker, self._passed, always=True)

    def _go_at_last(self, worker: _Worker) -> None:
        """End a day on a way home that will not come free."""
        self.waiting.remove(worker)
        worker.over, worker.wait_home_s = True, worker.free_s - worker.out_s
        worker.end_s = worker.free_s + self._onward_s(worker)

    def _homeward(self, worker: _Worker) -> int:
        """Let a worker make no more stops; return where it goes."""
        if worker.plan is not None:
            worker.next = len(worker.plan)
        worker.claims = _NOWHERE
        return GATE

    def _onward_s(self, worker: _Worker) -> float:
        """Return the seconds from the end of an aisle to the next plant, or home."""
        return (1.0 - worker.share_out()) * worker.seconds(worker.at, worker.target())

    def _needed(self, worker: _Worker) -> list[int]:
        """Return the aisles that a worker drives through next, and the one where it goes."""
        assert worker.leg is not None  # noqa: S101 - set on leaving
        return [*worker.leg.through, *([worker.claims] if worker.target() >= 0 else [])]

    def _enter(self, worker: _Worker, now_s: float) -> bool:
        """Drive on to the next aisle or home, if all that is on the way is free."""
        needed, target = self._needed(worker), worker.target()
        if now_s < worker.free_s or (set(self.holder[needed].tolist()) - {_NOBODY, worker.k}):
            return False
        driven = self._driven(worker, now_s)
        if driven is not None and self._meets_head_on(worker, driven):
            return False
        assert worker.leg is not None  # noqa: S101 - set on leaving
        left, worker.driven = worker.holds, driven
        self.holder[needed] = worker.k
        self._free((left,) if left not in needed else (), worker)
        arrive_s = now_s + self._onward_s(worker)
        worker.through = worker.leg.through
        if worker.through or driven is not None:
            self._at(arrive_s, worker, self._passed, always=True)
        wait_s = now_s - worker.out_s
        worker.holds = worker.claims
        if target < 0:
            worker.over, worker.end_s, worker.wait_home_s = True, arrive_s, wait_s
        else:
            self._visit(worker, arrive_s, wait_s)
        return True

    def _passed(self, worker: _Worker, now_s: float) -> None:
        """Give free what was driven through."""
        through, worker.through = worker.through, ()
        self._release(tuple(a for a in through if a != worker.holds), worker, now_s)

    def _release(self, aisles: tuple[int, ...], worker: _Worker, now_s: float) -> None:
        self._free(aisles, worker)
        self._try_again(now_s)

    def _free(self, aisles: tuple[int, ...], worker: _Worker) -> None:
        freed = [aisle for aisle in aisles if aisle >= 0 and self.holder[aisle] == worker.k]
        self.holder[freed] = _NOBODY

    def _try_again(self, now_s: float) -> None:
        """Let those who wait drive on, as long as one of them can."""
        while (free := next((w for w in self.waiting if self._enter(w, now_s)), None)) is not None:
            self.waiting.remove(free)

    def _wait_for_each_other(self, worker: _Worker) -> bool:
        """Tell whether a worker keeps the aisle that those keep waiting for whom it waits."""
        seen: set[int] = set()
        ahead = [worker]
        while ahead:
            one = ahead.pop()
            holders = set(self.holder[self._needed(one)].tolist()) - {_NOBODY, one.k} - seen
            if worker.k in holders:
                return True
            seen |= holders
            ahead += [self.workers[k] for k in holders if self.workers[k] in self.waiting]
        return False

    # -- headlands

    def _driven(self, worker: _Worker, now_s: float) -> Steps | None:
        """Return the steps in headlands from an aisle's end on; None where all can pass."""
        if not self.teamwork.passing_m:
            return None
        assert worker.leg is not None  # noqa: S101 - set on leaving
        places = np.array([worker.at, worker.target()], np.int64)
        line_m = worker.scene.aisles.line(places)[0]
        way_m = np.append(0.0, np.cumsum(np.hypot(*np.diff(line_m, axis=0).T)))
        out_m = worker.leg.out_m
        ahead = way_m > out_m
        here = [np.interp(out_m, way_m, line_m[:, k]) for k in range(2)]
        left_m = np.append(0.0, way_m[ahead] - out_m)
        times_s = now_s + left_m * (self._onward_s(worker) / max(left_m[-1], _ROUNDING_S))
        line_m = np.vstack([here, line_m[ahead]])
        return headlands_of(self.grid).steps(line_m, (times_s, times_s))

    def _meets_head_on(self, worker: _Worker, driven: Steps) -> bool:
        """Tell whether somebody comes the other way where the headland does not hold both."""
        headlands = headlands_of(self.grid)
        others = [one.driven for one in self.workers if one is not worker]
        return any(
            len(headlands.meet(driven, other, self.teamwork.passing_m))
            for other in others
            if other is not None
        )

    def _visit(self, worker: _Worker, arrive_s: float, wait_s: float) -> None:
        """Make the stops in the aisle that a worker is in."""
        plan, first = worker.plan, worker.next
        assert plan is not None  # noqa: S101 - it has a target
        aisle = self.corridor[plan.plant[first:]]
        n = 1 if worker.anew else int(np.argmax(np.append(aisle != aisle[0], True)))
        late_s = arrive_s - worker.plan_from_s - float(plan.arrive_s[first])
        worker.visit = len(worker.done)
        for j in range(first, first + n):
            at_s = worker.plan_from_s + float(plan.arrive_s[j]) + late_s
            leave_s, plant = at_s + float(plan.stop_s[j]), int(plan.plant[j])
            if late_s > _ROUNDING_S and leave_s + worker.home_s(plant) > worker.until_s:
                worker.next = len(plan)
                break
            what = plant, at_s, leave_s, bool(plan.found[j]), float(plan.detects[j])
            worker.done.append(_Done(*what, wait_s if j == first else 0.0))
            worker.next, worker.at = j + 1, plant
            if plan.found[j]:
                self._tell(worker, leave_s)
        ready_s = worker.done[-1].leave_s if len(worker.done) > worker.visit else arrive_s
        self._at(ready_s, worker, self._ready)

    # -- what finds change

    def _tell(self, worker: _Worker, found_s: float) -> None:
        """Let a find be heard of, at once or at the next contact."""
        if not self._hears():
            return
        every_s = self.teamwork.contact_s
        heard_s = math.ceil(found_s / every_s) * every_s if every_s else found_s
        if heard_s not in self.news_at:
            self.news_at.add(heard_s)
            self._at(heard_s, worker, self._hear, always=True)

    def _hear(self, worker: _Worker, now_s: float) -> None:  # noqa: ARG002 - an event
        """Believe what was found so far; go elsewhere if that is worth it."""
        news = sorted(told for each in self.workers for told in self._untold(each, now_s))
        for told in news:
            self.workers[told.k].told += 1
        self.known += news
        self.believed = self._after(self.known)
        if not self._shared_anew(now_s):
            for other in self.workers:
                near = self._beside([t.plant for t in news if t.found and t.k != other.k])
                if (self.section[self.corridor[near]] == other.k).any():
                    self._interrupt(other, now_s)

    def _untold(self, worker: _Worker, now_s: float) -> list[_Told]:
        """Return the stops that a worker has made and not told of."""
        return [
            _Told(stop.leave_s, worker.k, stop.plant, stop.found, stop.detects)
            for stop in worker.done[worker.told :]
            if stop.leave_s <= now_s + _ROUNDING_S
        ]

    def _after(self, told: list[_Told]) -> _Believed:
        """Return what is believed after some stops, in order of the clock."""
        assert self.learn is not None  # noqa: S101 - asked before
        _, _, plants, found, detects = (np.array(column) for column in zip(*told, strict=True))
        belief = self.learn(plants.astype(np.int32), found, detects)
        return belief.chance, belief.pair_chance, belief.traces

    def _beside(self, plants: list[int]) -> NDArray[np.int32]:
        start, near = self.grid.adjacent
        return np.concatenate([near[:0], *(near[start[p] : start[p + 1]] for p in plants)])

    def _interrupt(self, worker: _Worker, now_s: float) -> None:
        """Let a worker plan anew after the stop that it is at, or has begun to drive to."""
        if worker.over:
            return
        worker.anew = True
        k = worker.under_way(now_s)
        if k < len(worker.done):
            del worker.done[k:]
            worker.at = worker.done[-1].plant
            worker.version += 1
            self._at(worker.done[-1].leave_s, worker, self._ready)

    # -- who goes where

    def _first_sections(self, before: NDArray[np.int64] | None) -> NDArray[np.int64]:
        """Return who has each aisle; what is given out stays so, if no other way gains enough."""
        if self._by_worth():
            best = self._proposed(-np.inf)
        else:
            shares = np.array([worker.scene.robot.day_s for worker in self.workers])
            best = self._with_claims(even_sections(self.grid, shares))
        if before is None:
            return best
        kept = self._with_claims(np.where(before >= 0, before, best))
        if self._by_worth() and self._gain(best, kept, -np.inf) >= self.teamwork.least_gain:
            return best
        return kept

    def _by_worth(self) -> bool:
        return self.teamwork.together and self.sampler.reads_chance

    def _hears(self) -> bool:
        return self._by_worth() and self.learn is not None

    def _shared_anew(self, now_s: float) -> bool:
        """Give the aisles out anew if that gains enough; tell whether it was done."""
        if not self._hears():
            return False
        section = self._proposed(now_s)
        if self._gain(section, self.section, now_s) < max(self.teamwork.least_gain, _ROUNDING_S):
            return False
        other = section != self.section
        changed = {*section[other].tolist(), *self.section[other].tolist()}
        self.section = section
        for k in sorted(changed):
            self._interrupt(self.workers[k], now_s)
        return True

    def _proposed(self, now_s: float) -> NDArray[np.int64]:
        """Return the best sections for the seconds left."""
        up = np.argsort(self._stands(), kind="stable")
        worth, left_s = self._worth(now_s), self._left_s(now_s)
        return self._with_claims(best_sections(worth, self.heights, left_s, up))

    def _gain(self, section: NDArray[np.int64], other: NDArray[np.int64], now_s: float) -> float:
        """Return how many more finds are expected with some sections than with others."""
        worth, left_s, stands = self._worth(now_s), self._left_s(now_s), self._stands()
        held, less = (
            worth_together(worth, one, left_s - self._way_s(one, stands))
            for one in (section, other)
        )
        return held - less

    def _worth(self, now_s: float) -> AisleWorth:
        """Return what aisles hold now; worked out once for a moment."""
        key = now_s, len(self.known)
        if self.valued is None or self.valued[0] != key:
            robots = [worker.scene.robot for worker in self.workers]
            chance = np.where(self._closed(now_s), 0.0, self.believed[0])
            self.valued = key, aisle_worth(self.workers[0].scene.aisles, robots, chance)
        return self.valued[1]

    def _left_s(self, now_s: float) -> NDArray[np.float64]:
        """Return the seconds that each has left after what it has begun, ``(m,)``."""
        left = (0.0 if w.over else w.until_s - self._free_s(w, now_s) for w in self.workers)
        return np.array([*left])

    def _stands(self) -> NDArray[np.float64]:
        """Return where across the plot each is, ``(m,)`` metres; at the gate below all."""
        lane_m, row = self.grid.lane_y_m, self.grid.row
        return np.array([lane_m[row[w.at]] if w.at >= 0 else -np.inf for w in self.workers])

    def _way_s(
        self, section: NDArray[np.int64], stands: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return about how long each takes to the nearest of its aisles, ``(m,)``."""
        way_s = np.zeros(len(self.workers))
        for k, worker in enumerate(self.workers):
            own = self.heights[section == k]
            if len(own) and np.isfinite(stands[k]):
                way_s[k] = np.abs(own - stands[k]).min() / worker.scene.robot.speed_m_s
        return way_s

    def _with_claims(self, section: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return sections in which each keeps the aisle that it is in, or about to enter."""
        for worker in self.workers:
            if worker.claims >= 0:
                section[worker.claims] = worker.k
        return section

    def _free_s(self, worker: _Worker, now_s: float) -> float:
        """Return when a worker is done with the stop it is at, or has begun to drive to."""
        return min((s.leave_s for s in worker.done[worker.visit :] if s.leave_s > now_s),
                   default=max(now_s, worker.post.starts_s))  # fmt: skip

    def _closed(self, now_s: float) -> NDArray[np.bool_]:
        """Return ``(n,)`` the plants inspected today, and those that somebody drives to.

        Stops that others are yet to make in their aisles hang on what they will find.
        """
        for worker in self.workers:
            n = worker.under_way(now_s)
            self.today[[stop.plant for stop in worker.done[worker.begun : n]]] = True
            worker.begun = max(worker.begun, n)
        return self.today

    def _walk(self, worker: _Worker, now_s: float) -> None:
        """Have the sampler plan the rest of a worker's day in its section."""
        scene, believed = worker.scene, self.believed
        if own := self._untold(worker, now_s) if self._hears() else []:
            believed = self._after(sorted([*self.known, *own]))
        shut = self._closed(now_s) | (self.section[self.corridor] != worker.k)
        last = np.where(shut, scene.day, scene.last_inspected).astype(np.int32)
        chance, pairs, traces = believed
        scene = replace(
            scene,
            chance=chance,
            pair_chance=pairs,
            traces=traces,
            last_inspected=last,
            at=worker.at,
            seconds_left=worker.until_s - now_s,
        )
        worker.plan = work_day(scene, self.sampler, worker.post.would_find)
        worker.plan_from_s, worker.next, worker.anew = now_s, 0, False

    def _worked(self, worker: _Worker) -> Workday:
        done, begin = worker.done, worker.post.starts_s
        columns = list(zip(*done, strict=True)) or [()] * len(_Done._fields)
        plant, arrive_s, leave_s, found, detects, wait_s = (np.array(c) for c in columns)
        return Workday(
            plant.astype(np.int32),
            arrive_s.astype(np.float64) - begin,
            found.astype(np.bool_),
            (leave_s - arrive_s).astype(np.float64),
            detects.astype(np.float64),
            worker.end_s - begin,
            np.append(wait_s, worker.wait_home_s).astype(np.float64),
        )


def merged(works: Sequence[Workday], starts_s: Sequence[float]) -> Workday:
    """Return the days of a team as one: stops in order of the clock since the team's day began.

    Examples
    --------
    >>> import numpy as np
    >>> one, other = (
    ...     Workday(np.array([p], np.int32), *(np.ones(1),) * 4, 1.0) for p in (7, 3)
    ... )
    >>> merged([one, other], [10.0, 0.0]).plant.tolist()
    [3, 7]
    """

    def column(name: str) -> NDArray[Any]:
        return np.concatenate([getattr(work, name) for work in works])

    arrive_s = np.concatenate([w.arrive_s + s for w, s in zip(works, starts_s, strict=True)])
    stop_s = column("stop_s")
    order = np.argsort(arrive_s + stop_s, kind="stable")
    return Workday(
        column("plant")[order],
        arrive_s[order],
        column("found")[order],
        stop_s[order],
        column("detects")[order],
        max(work.end_s + start_s for work, start_s in zip(works, starts_s, strict=True)),
    )
