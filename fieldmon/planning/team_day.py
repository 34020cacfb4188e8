"""A day of a team: events in order of the clock, and finds that change what the others do."""

from __future__ import annotations

import math
from dataclasses import replace
from heapq import heappop, heappush
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from fieldmon.planning.headlands import headlands_of
from fieldmon.planning.sections import aisle_heights
from fieldmon.planning.team_news import TeamNews
from fieldmon.planning.team_sections import TeamSections
from fieldmon.planning.team_worker import NOWHERE, ROUNDING_S, StopMade, TeamWorker
from fieldmon.planning.workday import Workday, work_day
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.planning.headlands import Steps
    from fieldmon.planning.members import Teamwork
    from fieldmon.planning.team_news import Learn
    from fieldmon.planning.team_worker import Posted
    from fieldmon.samplers.base import Sampler

_NOBODY = -1


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
    return _TeamDay(team, sampler, teamwork, learn, before).run()


class _Event(Protocol):
    def __call__(self, worker: TeamWorker, now_s: float) -> None: ...


class _TeamDay:
    """A day on its way; events are calls in order of the clock."""

    def __init__(
        self,
        team: Sequence[Posted],
        sampler: Sampler,
        teamwork: Teamwork,
        learn: Learn | None,
        before: NDArray[np.int64] | None,
    ) -> None:
        self.sampler, self.teamwork = sampler, teamwork
        self.grid = team[0].scene.grid
        self.corridor = self.grid.corridor[self.grid.row]
        self.workers = [TeamWorker.of(k, post) for k, post in enumerate(team)]
        by_worth = teamwork.together and sampler.reads_chance
        self.news = TeamNews(self.workers, learn if by_worth else None)
        self.news_at: set[float] = set()
        self.events: list[tuple[float, int, int, int, _Event]] = []
        self.count = 0
        self.waiting: list[TeamWorker] = []
        self.holder = np.full(len(aisle_heights(self.grid)), _NOBODY)
        for worker in self.workers:
            if worker.at >= 0:
                worker.holds = worker.claims = int(self.corridor[worker.at])
                if self.holder[worker.holds] == _NOBODY:
                    self.holder[worker.holds] = worker.k
        self.sections = TeamSections(self.workers, teamwork, self.news, by_worth=by_worth)
        self.sections.begin(before)

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
        return tuple(worker.worked() for worker in self.workers)

    # -- events

    def _at(self, at_s: float, worker: TeamWorker, event: _Event, *, always: bool = False) -> None:
        self.count += 1
        version = _NOBODY if always else worker.version
        heappush(self.events, (at_s, self.count, version, worker.k, event))

    def _ready(self, worker: TeamWorker, now_s: float) -> None:
        """Go on from where a worker stands."""
        if worker.anew:
            self._walk(worker, now_s)
        if worker.target() < 0 and self._shared_anew(now_s):
            self._walk(worker, now_s)
        self._pass_by(worker)
        target = worker.target()
        if target >= 0 and worker.spare_s(now_s + worker.seconds(worker.at, target)) < -ROUNDING_S:
            target = worker.turn_home()
        if target < 0 and (worker.at < 0 or not worker.scene.robot.returns):
            worker.over, worker.end_s = True, now_s
            return
        aisle = int(self.corridor[target]) if target >= 0 else NOWHERE
        holds = aisle == worker.holds and aisle >= 0 and self.holder[aisle] == worker.k
        if holds and np.ptp(worker.stretch(np.array([worker.at, target]))) == 0:
            self._visit(worker, now_s + worker.seconds(worker.at, target), 0.0)
            return
        worker.claims = aisle
        worker.leg = worker.legs.leg(worker.at, target)
        way_s = worker.share_out() * worker.seconds(worker.at, target)
        self._at(now_s + way_s, worker, self._out)

    def _pass_by(self, worker: TeamWorker) -> None:
        """Leave out the next aisles if somebody stays in them for the night."""
        while (target := worker.target()) >= 0:
            holder = self.holder[self.corridor[target]]
            if holder in (_NOBODY, worker.k) or not self.workers[holder].over:
                return
            worker.next += 1

    def _out(self, worker: TeamWorker, now_s: float) -> None:
        """Leave an aisle, or the gate; wait at its end if the way is not free."""
        worker.out_s = worker.free_s = now_s
        if self._enter(worker, now_s):
            self._try_again(now_s)
            return
        self.waiting.append(worker)
        if self._wait_for_each_other(worker):
            # one of them steps out into the headland, lets the other in, and may follow at once
            left, worker.holds = worker.holds, NOWHERE
            self._release((left,), worker, now_s)
        if worker in self.waiting and worker.target() >= 0:
            last_s = now_s + worker.spare_s(now_s + worker.onward_s())
            self._at(max(last_s, now_s), worker, self._give_up)

    def _give_up(self, worker: TeamWorker, now_s: float) -> None:
        """Make no more stops, as the aisle waited for comes free too late, or not today."""
        if worker not in self.waiting or worker.target() < 0:
            return
        leg, spent_s = worker.leg, worker.post.starts_s
        worker.turn_home()
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

    def _go_at_last(self, worker: TeamWorker) -> None:
        """End a day on a way home that will not come free."""
        self.waiting.remove(worker)
        worker.over, worker.wait_home_s = True, worker.free_s - worker.out_s
        worker.end_s = worker.free_s + worker.onward_s()

    def _enter(self, worker: TeamWorker, now_s: float) -> bool:
        """Drive on to the next aisle or home, if all that is on the way is free."""
        needed, target = worker.needed(), worker.target()
        if now_s < worker.free_s or (set(self.holder[needed].tolist()) - {_NOBODY, worker.k}):
            return False
        driven = self._driven(worker, now_s)
        if driven is not None and self._meets_head_on(worker, driven):
            return False
        assert worker.leg is not None  # noqa: S101 - set on leaving
        left, worker.driven = worker.holds, driven
        worker.version += 1  # that it would have given up is void
        self.holder[needed] = worker.k
        self._free((left,) if left not in needed else (), worker)
        arrive_s = now_s + worker.onward_s()
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

    def _passed(self, worker: TeamWorker, now_s: float) -> None:
        """Give free what was driven through."""
        through, worker.through = worker.through, ()
        self._release(tuple(a for a in through if a != worker.holds), worker, now_s)

    def _release(self, aisles: tuple[int, ...], worker: TeamWorker, now_s: float) -> None:
        self._free(aisles, worker)
        self._try_again(now_s)

    def _free(self, aisles: tuple[int, ...], worker: TeamWorker) -> None:
        freed = [aisle for aisle in aisles if aisle >= 0 and self.holder[aisle] == worker.k]
        self.holder[freed] = _NOBODY

    def _try_again(self, now_s: float) -> None:
        """Let those who wait drive on, as long as one of them can."""
        while (free := next((w for w in self.waiting if self._enter(w, now_s)), None)) is not None:
            self.waiting.remove(free)

    def _wait_for_each_other(self, worker: TeamWorker) -> bool:
        """Tell whether a worker keeps the aisle that those keep waiting for whom it waits."""
        seen: set[int] = set()
        ahead = [worker]
        while ahead:
            one = ahead.pop()
            holders = set(self.holder[one.needed()].tolist()) - {_NOBODY, one.k} - seen
            if worker.k in holders:
                return True
            seen |= holders
            ahead += [self.workers[k] for k in holders if self.workers[k] in self.waiting]
        return False

    # -- headlands

    def _driven(self, worker: TeamWorker, now_s: float) -> Steps | None:
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
        times_s = now_s + left_m * (worker.onward_s() / max(left_m[-1], ROUNDING_S))
        line_m = np.vstack([here, line_m[ahead]])
        return headlands_of(self.grid).steps(line_m, (times_s, times_s))

    def _meets_head_on(self, worker: TeamWorker, driven: Steps) -> bool:
        """Tell whether somebody comes the other way where the headland does not hold both."""
        headlands = headlands_of(self.grid)
        others = [one.driven for one in self.workers if one is not worker]
        return any(
            len(headlands.meet(driven, other, self.teamwork.passing_m))
            for other in others
            if other is not None
        )

    def _visit(self, worker: TeamWorker, arrive_s: float, wait_s: float) -> None:
        """Make the stops in the stretch of aisle that a worker is in."""
        plan, first = worker.plan, worker.next
        assert plan is not None  # noqa: S101 - it has a target
        stretch = worker.stretch(plan.plant[first:])
        n = 1 if worker.anew else int(np.argmax(np.append(stretch != stretch[0], True)))
        late_s = arrive_s - worker.plan_from_s - float(plan.arrive_s[first])
        worker.visit = len(worker.done)
        for j in range(first, first + n):
            at_s = worker.plan_from_s + float(plan.arrive_s[j]) + late_s
            leave_s, plant = at_s + float(plan.stop_s[j]), int(plan.plant[j])
            if late_s > ROUNDING_S and leave_s + worker.home_s(plant) > worker.until_s:
                worker.next = len(plan)
                break
            what = plant, at_s, leave_s, bool(plan.found[j]), float(plan.detects[j])
            worker.done.append(StopMade(*what, wait_s if j == first else 0.0))
            worker.next, worker.at = j + 1, plant
            if plan.found[j]:
                self._tell(worker, leave_s)
        ready_s = worker.done[-1].leave_s if len(worker.done) > worker.visit else arrive_s
        self._at(ready_s, worker, self._ready)

    # -- what finds change

    def _tell(self, worker: TeamWorker, found_s: float) -> None:
        """Let a find be heard of, at once or at the next contact."""
        if not self.news.heard:
            return
        every_s = self.teamwork.contact_s
        heard_s = math.ceil(found_s / every_s) * every_s if every_s else found_s
        if heard_s not in self.news_at:
            self.news_at.add(heard_s)
            self._at(heard_s, worker, self._hear, always=True)

    def _hear(self, worker: TeamWorker, now_s: float) -> None:  # noqa: ARG002 - an event
        """Believe what was found so far; go elsewhere if that is worth it."""
        news = self.news.hear(now_s)
        if not self._shared_anew(now_s):
            for other in self.workers:
                near = self._adjacent([t.plant for t in news if t.found and t.k != other.k])
                if (self.sections.owner[self.corridor[near]] == other.k).any():
                    self._interrupt(other, now_s)

    def _adjacent(self, plants: list[int]) -> NDArray[np.int32]:
        start, near = self.grid.adjacent
        return np.concatenate([near[:0], *(near[start[p] : start[p + 1]] for p in plants)])

    def _interrupt(self, worker: TeamWorker, now_s: float) -> None:
        """Let a worker plan anew after the stop that it is at, or has begun to drive to."""
        if not worker.over and worker.interrupt(now_s):
            self._at(worker.done[-1].leave_s, worker, self._ready)

    def _shared_anew(self, now_s: float) -> bool:
        """Give the aisles out anew if that gains enough; tell whether it was done."""
        changed = self.sections.share_anew(now_s)
        for k in changed:
            self._interrupt(self.workers[k], now_s)
        return bool(changed)

    def _walk(self, worker: TeamWorker, now_s: float) -> None:
        """Have the sampler plan the rest of a worker's day in its section."""
        scene = worker.scene
        chance, pairs, traces = self.news.believed_by(worker, now_s)
        left_out = self.news.taken(now_s) | (self.sections.owner[self.corridor] != worker.k)
        last = np.where(left_out, scene.day, scene.last_inspected).astype(np.int32)
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
