"""What a day's inspections change in traced chances, and from where each chance came."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.jit import inner_loop, loop
from fieldmon.infestation.ancestry.origins import (
    BY_ADJACENT,
    JUMPED,
    N_ORIGINS,
    OVERLOOKED,
)
from fieldmon.infestation.calibration_slope import note_inspection
from fieldmon.infestation.chance_bounds import KNOWN, lesser
from fieldmon.infestation.pairs.pairs import Neighbourhood, update_neighbourhood
from fieldmon.infestation.tracing.tracing import Raised, Traces, trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.plot.grid import Linked

    Floats = NDArray[np.float64]


class TracedDay(NamedTuple):
    """What a day's inspections say beside the chances.

    Parameters
    ----------
    shares
        ``(n, o)`` how much of each chance each origin brought.
    before
        ``(n,)`` each plant's chance before the inspection under way.
    dropped, cleared
        ``(n,)`` what clean inspections took from each plant's chance, and as a share of it.
    found, expected
        ``(o,)`` finds of each origin.
    likely
        ``(1,)`` the logarithm of how likely the inspections were.
    """

    shares: NDArray[np.float32]
    before: Floats
    dropped: Floats
    cleared: Floats
    found: Floats
    expected: Floats
    likely: Floats


class KernelRoom(NamedTuple):
    """The kernels by which insects jump ``(6, d, d)``, and room for the plants reached."""

    each: Floats
    near: Neighbourhood
    raised: Raised


@loop
def learn_day(
    believed: tuple[Floats, Floats],
    linked: Linked,
    inspections: tuple[NDArray[np.int32], NDArray[np.bool_], Floats, Floats],
    rule: tuple[bool, float],
    work: tuple[TracedDay, Traces],
    room: KernelRoom,
) -> None:
    """Learn from a day's inspections, one after the other, in place.

    `inspections` end with the share of what each leaves that was hidden, not overlooked; `rule` is
    whether finds are treated, and the chance that insects jump.
    """
    plants, found, detects, hidden = inspections
    treated, jumps = rule
    day, traces = work
    chance = believed[0]
    for k in range(plants.size):
        i = 0 + plants[k]
        p, unseen = chance[i], traces.unseen[i]
        note_inspection(traces.slope_sums, p, found[k])
        _count(day, i, found[k], detects[k] * p)
        n = update_neighbourhood(believed, linked, (i, found[k]), (detects[k], treated), room.near)
        for t in range(n):
            _share(day, chance, room.near.plant[t])
        for o in range(N_ORIGINS):
            day.shares[i, o] *= 0.0 if found[k] else hidden[k]
        day.shares[i, OVERLOOKED] += 1.0 if found[k] else 1.0 - hidden[k]
        if found[k]:
            n = trace(believed, linked, traces, (i, p, jumps), room.raised)
            for t in range(n):
                _share_traced(day, traces, room, (i, p, unseen), t)
                day.before[room.raised.plant[t]] = chance[room.raised.plant[t]]
            traces.unseen[i] = 0.0
        else:
            day.dropped[i] += p - chance[i]
            day.cleared[i] = 1.0 - chance[i] / p
            traces.unseen[i] *= 1.0 - detects[k]


@inner_loop
def _count(day: TracedDay, i: int, found: bool, expected: float) -> None:  # noqa: FBT001 - a result
    """Count what an inspection found and was expected to find, origin by origin.

    A plant known to be infested tells nothing: it may have been cleaned by now.
    """
    if day.before[i] > KNOWN:
        return
    day.likely[0] += np.log(expected if found else 1.0 - expected)
    for o in range(N_ORIGINS):
        day.found[o] += found * day.shares[i, o]
        day.expected[o] += expected * day.shares[i, o]


@inner_loop
def _share(day: TracedDay, chance: Floats, j: int) -> None:
    """Ascribe what a plant's chance has risen by to the plant beside it."""
    more = chance[j] - day.before[j]
    if more > 0.0:
        for o in range(N_ORIGINS):
            day.shares[j, o] *= day.before[j] / chance[j]
        day.shares[j, BY_ADJACENT] += more / chance[j]
    day.before[j] = chance[j]


@inner_loop
def _share_traced(
    day: TracedDay, traces: Traces, room: KernelRoom, find: tuple[int, float, float], t: int
) -> None:
    """Ascribe what a find has raised a plant by to the kernels that reach it."""
    i, p, unseen = find
    cells, each = traces.cells, room.each
    j, more = room.raised.plant[t], room.raised.by[t]
    along, h = cells.shape[1], each.shape[1] // 2
    y = cells.of_plant[j] // along - cells.of_plant[i] // along
    x = cells.of_plant[j] % along - cells.of_plant[i] % along
    q = day.before[j]
    parent = lesser(q / p, 1.0) * unseen
    total = 0.0
    for k in range(each.shape[0]):
        total += traces.unseen[j] * each[k, h + y, h + x] + parent * each[k, h - y, h - x]
    for o in range(N_ORIGINS):
        day.shares[j, o] *= q / (q + more)
    for k in range(each.shape[0]):
        own = traces.unseen[j] * each[k, h + y, h + x] + parent * each[k, h - y, h - x]
        day.shares[j, JUMPED + k] += more / (q + more) * own / total
