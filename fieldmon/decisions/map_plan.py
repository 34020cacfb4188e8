"""Wald's test on a chance map: each look weighs by how much it was to be expected."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.arrays import read_only
from fieldmon.compute.jit import loop
from fieldmon.compute.wording import worded
from fieldmon.decisions.sequential import INSPECT_MORE, LEAVE, TREAT
from fieldmon.errors import SettingError
from fieldmon.infestation.pairs.pairs import Neighbourhood, pair_chances, update_neighbourhood
from fieldmon.infestation.prior.prior import scaled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.decisions.sequential import Verdict
    from fieldmon.plot.grid import Linked, PlantGrid

    Floats = NDArray[np.float64]

# finds that are no news at all overstep nothing
_LEAST_JUMP = 1e-4


class Evidence(NamedTuple):
    """What looks have said, ``(k,)`` after 1, 2, ...

    Parameters
    ----------
    log_ratio
        Logarithm of the ratio of likelihoods.
    overstep
        How far a find that ends the looks carries it beyond the line, as a logarithm.
    """

    log_ratio: Floats
    overstep: Floats

    def __repr__(self) -> str:
        return f"<Evidence: {len(self.log_ratio)} looks>"


@dataclass(frozen=True)
class MapPlan:
    """Wald's test of whether a plot is infested as much as `high`, or as little as `low`.

    The map says where insects are rather than elsewhere, not how many: its odds are raised and
    lowered until it holds the one share or the other. A clean look where many were to be expected
    then says more than one where none were. What the looks before say of a plant's neighbours is
    taken out: a second find beside the first is no news about the plot.

    Looks may be chosen by those before them: a ratio of likelihoods minds no such choice.

    Wald's lines are for evidence that grows evenly. A find makes it jump beyond the line, so fewer
    plots are treated wrongly than tolerated, after more looks than needed. The line for treating is
    therefore lowered by what a find oversteps it (`overstep`); clean looks hardly overstep theirs.

    Parameters
    ----------
    low, high
        Surely no treatment at this share of the plants; surely one at that.
    treats_wrongly, leaves_wrongly
        Tolerated chances of the two mistakes, at `low` and at `high`.

    Raises
    ------
    SettingError
        If the shares or the chances cannot be.
    """

    low: float
    high: float
    treats_wrongly: float = 0.1
    leaves_wrongly: float = 0.1

    def __post_init__(self) -> None:
        if not 0.0 < self.low < self.high < 1.0:
            raise SettingError(
                worded(
                    "The shares of a plan must rise from above 0 to below 1, but they are {low:g} "
                    "and {high:g}.",
                    low=self.low,
                    high=self.high,
                )
            )
        for chance in (self.treats_wrongly, self.leaves_wrongly):
            if not 0.0 < chance < 0.5:
                raise SettingError(
                    worded(
                        "The chance that a plan is wrong must lie between 0 and 0.5, but it is "
                        "{chance:g}.",
                        chance=chance,
                    )
                )

    @classmethod
    def about(cls, level: float, apart: float = 2.0, wrong: float = 0.1) -> MapPlan:
        """Return the plan whose shares are `apart` times below and above a threshold."""
        return cls(level / apart, min(level * apart, (1.0 + level) / 2.0), wrong, wrong)

    def evidence(
        self,
        grid: PlantGrid,
        morning: Floats,
        looks: tuple[NDArray[np.int32], NDArray[np.bool_]],
        detects: float,
        pair_chance: Floats | None = None,
    ) -> Evidence:
        """Return what the looks say, one after the other.

        Parameters
        ----------
        grid
            The plants.
        morning
            ``(n,)`` chance of each before the first look.
        looks
            Plants ``(k,)`` in the order in which they were seen, and whether each was infested.
        detects
            Chance that a look finds what is there.
        pair_chance
            ``(e,)`` of two neighbours; None: as records have it.
        """
        plants, found = looks
        pairs = pair_chances(morning, grid) if pair_chance is None else pair_chance.copy()
        low, high = (scaled(morning, share)[plants] for share in (self.low, self.high))
        now = np.empty(len(plants))
        chances = np.ascontiguousarray(morning).copy(), pairs
        room = now, Neighbourhood.of(len(morning))
        _chances_met(chances, grid.linked, (plants, found), detects, room)
        # what neighbours say beside what the map said in the morning: none of it, or more
        told = np.clip((1.0 - now) / np.maximum(1.0 - morning[plants], 1e-9), 0.0, None)
        lowered = np.minimum(now / np.maximum(morning[plants], 1e-12), 1.0)
        q_low, q_high = (
            detects * (1.0 - (1.0 - p * lowered) * np.minimum(told, 1.0)) for p in (low, high)
        )
        step = np.where(found, np.log(q_high / q_low), np.log((1.0 - q_high) / (1.0 - q_low)))
        return Evidence(read_only(np.cumsum(step)), read_only(overstep(q_low, q_high)))

    def verdicts(self, evidence: Evidence) -> tuple[Verdict, int]:
        """Return the first verdict on the evidence, and after how many looks it came."""
        below = np.log(self.leaves_wrongly / (1.0 - self.treats_wrongly))
        above = np.log((1.0 - self.leaves_wrongly) / self.treats_wrongly)
        so_far = evidence.log_ratio
        clear = np.flatnonzero((so_far <= below) | (so_far >= above - evidence.overstep))
        if not clear.size:
            return INSPECT_MORE, len(so_far)
        first = int(clear[0])
        return (TREAT if so_far[first] > 0.0 else LEAVE), first + 1


def overstep(q_low: Floats, q_high: Floats) -> Floats:
    """Return how far a find that ends the looks carries the evidence beyond the line, ``(k,)``.

    As -log E exp(-overshoot), which is what the chance of a mistake falls by. The evidence sinks
    with clean looks and jumps with finds, as the reserve of an insurer does with claims: of its
    jumps over a line it is known how far they go (Cramer & Lundberg; Asmussen & Albrecher 2010,
    Ruin Probabilities, IV.5). Exact for rare finds; tests hold it up to a threshold of 45 %.

    Parameters
    ----------
    q_low, q_high
        ``(k,)`` chance that a look finds something, at the two shares of a plan.

    Examples
    --------
    >>> overstep(np.array([0.02]), np.array([0.08])).round(3)
    array([0.455])
    """
    jump = np.maximum(np.log(q_high / q_low), _LEAST_JUMP)
    grown = np.exp(jump)
    under = np.cumsum(q_low * (grown - 1.0 - jump))
    over = np.cumsum(q_low * (jump * grown - grown + 1.0))
    beyond: Floats = np.log(over / under)
    return beyond


@loop
def _chances_met(
    believed: tuple[Floats, Floats],
    linked: Linked,
    looks: tuple[NDArray[np.int32], NDArray[np.bool_]],
    detects: float,
    room: tuple[Floats, Neighbourhood],
) -> None:
    """Write the chance of each plant just before it was looked at, given the looks before."""
    plants, found = looks
    now, near = room
    for k in range(plants.size):
        i = 0 + plants[k]
        now[k] = believed[0][i]
        update_neighbourhood(believed, linked, (i, found[k]), (detects, False), near)
