"""Parts of a plot that hang on a ladder as one place of it, each with a ladder of its own.

A part that lies beside another is a place of that one's ladder: driving there, through it and back
is worth what the best drive in it is. The way to it is paid in full, however long it is, and the
ladder that it hangs on keeps its lengths. How that bounds every route is in
``docs/route_bound.md``.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.planning.routes.aisle_ways import IMPOSSIBLE
from fieldmon.planning.routes.frontier import END_LEFT, END_RIGHT, FROM_LEFT, FROM_RIGHT
from fieldmon.planning.routes.ladders import Rungs
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.stops import stops_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fieldmon.planning.routes.ladders import Ladder, Ladders
    from fieldmon.planning.routes.priced import Drawn
    from fieldmon.plot.robot import Robot

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_LESS = 1.0 - 1e-9
# drives are told apart by whether they visit so many of the parts farthest from where they hang
_TOLD_APART = 2
# what a part that must be visited brings besides, so many times all rewards and the seconds of all
# ways: more than it costs to visit, whatever else a kind of drive must do
_BONUS = 4.0


class PendantPart(NamedTuple):
    """A part that hangs on a ladder: best drives in it, back to its place, and ending in it.

    It is so many metres away from that place, and known by a number.
    """

    back: LadderWithParts
    ends: LadderWithParts | None
    away_m: float
    number: int

    def __repr__(self) -> str:
        return f"<PendantPart of {len(self.back.reward)} plants>"

    def stops(self, price: float, *, ends: bool) -> Int:
        """Return the plants of the best drive in it at a price, in order."""
        priced = self.ends if ends and self.ends is not None else self.back
        drawn = priced.best(price)
        prices = np.full(len(drawn.way), price)
        return stops_of(priced, drawn, prices, replace(priced.robot, returns=not ends))


class LadderWithParts(Priced):
    """Best drives on a ladder on which parts hang, at any price."""

    def __init__(
        self, ladder: Ladder, reward: Float, robot: Robot, parts: dict[int, PendantPart]
    ) -> None:
        super().__init__(ladder, reward, robot)
        self.robot = robot
        self.parts: dict[int, PendantPart] = parts
        self._bonus = 0.0
        self._must: dict[int, bool] = {}

    @property
    def how(self) -> str:
        """Say what it is."""
        n = sum(1 for _ in self._all_parts())
        return f"price of time on a ladder on which other parts of the plot hang ({n})"

    def _all_parts(self) -> Iterator[PendantPart]:
        for part in self.parts.values():
            yield part
            yield from part.back._all_parts()  # noqa: SLF001 - of its kind

    def kinds(self, price: float) -> tuple[Float, Float]:
        """Return worth and reward of the best drive of each kind at a price, ``(2^f, g, h)``.

        Drives are also told apart by which of the f farthest parts they visit.
        """
        far = sorted(self._all_parts(), key=lambda part: -part.away_m)[:_TOLD_APART]
        bonus = _BONUS * (float(self.of_all.sum()) + price * self._all_s())
        found = []
        for chosen in product((False, True), repeat=len(far)):
            self._ask(dict(zip((part.number for part in far), chosen, strict=True)), bonus)
            worth, reward = super().kinds(price)
            worth -= sum(chosen) * bonus
            # none of that kind comes by all that it must
            worth[worth < -0.5 * bonus] = IMPOSSIBLE
            found.append((worth, reward))
        self._ask({}, 0.0)
        worths, rewards = zip(*found, strict=True)
        return np.array(worths), np.array(rewards)

    def _all_s(self) -> float:
        """Return the seconds of all ways there and back, and of what a kind must do in an aisle."""
        ladder, costs = self.ladder, self.costs
        across_m = np.delete(ladder.across_m, ladder.gate)
        own_m = 2.0 * float(ladder.up_m.sum() + ladder.stub_m.sum() + across_m.sum())
        own_s = own_m * costs.metre_s + 2.0 * (costs.stop_s + costs.change_s + costs.turn_s)
        for part in self.parts.values():
            own_s += 2.0 * part.away_m * costs.metre_s + part.back._all_s()  # noqa: SLF001 - of its kind
        return own_s

    def _ask(self, must: dict[int, bool], bonus: float) -> None:
        """Ask that parts be visited for so much more, or not, from now on."""
        self._must, self._bonus = must, bonus
        for part in self.parts.values():
            for priced in (part.back, part.ends):
                if priced is not None:
                    priced._ask(must, bonus)  # noqa: SLF001 - of its kind

    def _value_rest(self, price: float) -> None:
        """Let each part be worth what the best drive in it is."""
        super()._value_rest(price)
        for k, part in self.parts.items():
            left = self.ladder.hangs[k] == 1
            way = price * self.costs.metre_s * part.away_m
            back = part.back.best(price)
            self._offer((k, FROM_LEFT if left else FROM_RIGHT), part, back, 2.0 * way)
            if part.ends is not None:
                ends = part.ends.best(price)
                self._offer((k, END_LEFT if left else END_RIGHT), part, ends, way)

    def _offer(self, at: tuple[int, int], part: PendantPart, drawn: Drawn, less: float) -> None:
        """Put in what a part is worth, if it may be visited and that is worth it, or must be."""
        must, worth = self._must.get(part.number), drawn.worth - less
        if must or (must is None and worth > 0.0):
            self._room.worth[at] = worth + (self._bonus if must else 0.0)
            self._room.reward[at] = drawn.reward


def ladder_with_parts(ladders: Ladders, block: Int, reward: Float, robot: Robot) -> LadderWithParts:
    """Return the ladder of the block of aisles ``(k,)`` at the gate; all others hang on it.

    Each hangs on the one that it lies nearest to, towards the gate. The farthest is taken first:
    from then on it is one place for the others. Of the way from its end f to an end e outside,
    t(f) is driven in the part and the rest on the ladder that it hangs on: t(f) is by how much f
    is farther from what is outside than the nearest end of the part, and the rest is the least
    left of any way from e into the part. So none is longer than it truly is.
    """
    order, onto = _tree(ladders.rungs, block)
    members = {b: np.flatnonzero(block == b) for b in order}
    made: dict[int, dict[int, PendantPart]] = {b: {} for b in order}
    open_ = np.ones(len(block), np.bool_)
    for b in order[:0:-1]:
        inside = members[b]
        open_[inside] = False
        ladders, into_m, away_m = _with_place(ladders, inside, np.flatnonzero(open_))
        up = float(ladders.rungs.up[inside[np.argmin(into_m.min(axis=0))]])
        ladder = ladders.among(inside, (into_m, up), hanging=True)
        place, parts = len(open_), _at(ladder, made[b])
        closed = {k: part._replace(ends=None) for k, part in parts.items()}
        back = LadderWithParts(ladder, reward, replace(robot, returns=True), closed)
        ends = None if robot.returns else LadderWithParts(ladder, reward, robot, parts)
        open_ = np.append(open_, True)
        members[onto[b]] = np.append(members[onto[b]], place)
        made[onto[b]][place] = PendantPart(back, ends, away_m, place)
    inside = members[order[0]]
    gate = ladders.rungs.apart_m[:, 0, inside, -1], float(ladders.aisles.gate_m[1])
    ladder = ladders.among(inside, gate, hanging=True)
    return LadderWithParts(ladder, reward, robot, _at(ladder, made[order[0]]))


def _tree(rungs: Rungs, block: Int) -> tuple[list[int], dict[int, int]]:
    """Return the blocks, nearest to the gate first, and which of those before each hangs on."""
    n = int(block.max()) + 1
    apart_m = rungs.apart_m[:, :, :-1, :-1].min(axis=(0, 1))
    to_gate = rungs.apart_m[:, 0, :-1, -1].min(axis=0)
    first = int(block[np.argmin(to_gate)])
    order, onto = [first], {first: first}
    while len(order) < n:
        known = np.isin(block, order)
        ways = np.where(known[:, None] & ~known, np.minimum(apart_m, apart_m.T), np.inf)
        a, b = (int(k) for k in np.unravel_index(np.argmin(ways), ways.shape))
        order.append(int(block[b]))
        onto[int(block[b])] = int(block[a])
    return order, onto


def _with_place(ladders: Ladders, inside: Int, outside: Int) -> tuple[Ladders, Float, float]:
    """Return ladders with a part as one more place, the last; metres in the part, and to it.

    Those in the part ``(2, p)`` are from its nearest end to the ends of its p rungs; those to it
    from the place on the headland, whichever end is nearest.
    """
    rungs, others = ladders.rungs, np.append(outside, -1)
    there_m, back_m = rungs.apart_m, rungs.apart_m.transpose(1, 0, 3, 2)
    ways = np.minimum(*(m[:, :, inside][:, :, :, others] for m in (there_m, back_m)))
    nearest = ways.min(axis=(1, 3))
    into_m = np.maximum(_LESS * (nearest - nearest.min()), 0.0)
    left_m = np.maximum(_LESS * (ways - into_m[:, None, :, None]).min(axis=(0, 2)), 0.0)
    away_m = float(left_m.min())
    return ladders.of(_and_place(rungs, outside, left_m - away_m)), into_m, away_m


def _and_place(rungs: Rungs, outside: Int, left_m: Float) -> Rungs:
    """Return rungs and a place, given the metres ``(2, o + 1)`` to it from o of them and the gate.

    It stands on the headland, and at the height, of the end that is nearest.
    """
    k = len(rungs.low)
    apart_m = np.full((2, 2, k + 2, k + 2), np.inf)
    kept = np.append(np.arange(k), k + 1)
    apart_m[:, :, kept[:, None], kept] = rungs.apart_m
    for side in range(2):
        apart_m[side, :, outside, k] = left_m[side, :-1, None]
        apart_m[:, side, k, outside] = left_m[side, :-1]
    apart_m[:, :, k, -1] = apart_m[:, :, -1, k] = left_m[:, -1].min()
    end, at = np.unravel_index(np.argmin(left_m[:, :-1]), (2, len(outside)))
    near = outside[at]
    x = (rungs.low, rungs.high)[end][near]
    return Rungs(
        np.append(rungs.low, x),
        np.append(rungs.high, x),
        np.append(rungs.up, rungs.up[near]),
        apart_m,
        np.append(rungs.part, end + 1),
    )


def _at(ladder: Ladder, parts: dict[int, PendantPart]) -> dict[int, PendantPart]:
    """Return parts, known by their rungs, by the elements of a ladder."""
    element = {int(rung): k for k, rung in enumerate(ladder.rung.tolist()) if rung >= 0}
    return {element[rung]: part for rung, part in parts.items()}
