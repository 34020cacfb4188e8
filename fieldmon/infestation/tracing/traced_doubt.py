"""How far the number of infested plants may be off that a traced map expects."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.ancestry.origins import AT_START, AT_START_ELSEWHERE, BY_ADJACENT
from fieldmon.infestation.chance_bounds import KNOWN, LEAST_CHANCE
from fieldmon.infestation.pairs.heavier_priors import IN_DOUBT, doubt_between
from fieldmon.infestation.pairs.uninspected_days import Counted
from fieldmon.infestation.plot_estimate import drawn_numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.pairs.uninspected_days import UninspectedDays
    from fieldmon.infestation.tracing.traced_map import TracedMap

    Floats = NDArray[np.float64]

# where more were infested at the start than was told, so much of that (as a logarithm) remains in
# doubt: finds beside finds are put down to clusters first (chosen on nine real maps, and on 36
# seasons with 3 to 30 % infested where 1.5 % were told)
_STILL_TOO_FEW = 0.7
# the ancestry of finds knows the number better than origins, by which it is doubted: so much of
# the doubt remains (chosen on 400 seasons of ten worlds). What was found and left sends out more
# each night at a rate that nobody knows: then it is more (chosen on 80 seasons of ten worlds)
_LESS_DOUBT, _MORE_DOUBT = 0.85, 1.2


def doubt_of_number(of: TracedMap, others: Sequence[TracedMap]) -> float:
    """Return how far the number that a map expects may be off, as a share, see `Belief`.

    As `doubt_of_rates` has it, but offspring is as doubtful as what it came from: of twice as
    many that were there at the start, there is twice as much. And as far as finds proved what
    was told of the start too low. Once the ancestry of finds has its say, it is less, or
    more where finds are left infested. `others` are the maps that are possible beside it.
    """
    brought = _brought_so_far(of)
    expected, beside = float(brought.sum()), float(brought[BY_ADJACENT])
    # what came from the plant beside it came from where that one did
    came = brought * (1.0 + beside / max(expected - beside, 1e-12))
    came[BY_ADJACENT] = beside
    start = float(of.at_start @ of.counts.scale[[AT_START, AT_START_ELSEWHERE]])
    more = max(float(np.log(start / of.at_start.sum())), 0.0)
    doubt = float(np.hypot(_by_origins(of, came, expected), _STILL_TOO_FEW * more))
    ancestry = of.ancestry
    if ancestry is not None and ancestry.knows and not ancestry.waits:
        doubt *= _MORE_DOUBT if ancestry.left.any() else _LESS_DOUBT
    return float(np.hypot(doubt, _besides(of, others)))


def doubt_of_rates(of: TracedMap, others: Sequence[TracedMap]) -> float:
    """Return how far that number may be off as rates are not known, see `Belief`.

    As far as what each origin brings is known, and as infestations that jumped come in groups.
    """
    brought = _brought_so_far(of)
    doubt = _by_origins(of, brought, float(brought.sum()))
    return float(np.hypot(doubt, _besides(of, others)))


def _brought_so_far(of: TracedMap) -> Floats:
    """Return how much of the number each origin brought, ``(N_ORIGINS,)``."""
    brought: Floats = np.einsum("i,ik->k", of.chance, of.shares, dtype=np.float64)
    return brought


def _by_origins(of: TracedMap, brought: Floats, expected: float) -> float:
    """Return the doubt of a number of which so much hangs on each origin, ``(N_ORIGINS,)``."""
    origins = float(((brought * of.counts.doubt) ** 2).sum()) / expected**2
    sent = float((of.unseen * of.chance).sum()) / expected
    relatives = 2.0 * of.jumps * float(of.beyond.sum()) * sent
    return float(np.sqrt(origins + relatives / expected))


def _besides(of: TracedMap, others: Sequence[TracedMap]) -> float:
    """Return how far the number may be off yet of days without inspections before the last one.

    And as another share than was told may be infested.
    """
    left = float(np.sqrt(of.uninspected.left))
    if of.is_heavier:
        left = float(np.hypot(left, IN_DOUBT))
    if not others:
        return left
    likely, expected = np.array([(one.likely, float(one.chance.sum())) for one in (of, *others)]).T
    return float(np.hypot(left, doubt_between(likely, expected)))


def uninspected_by(
    morning: TracedMap, evening: TracedMap, others: Sequence[TracedMap], spread: Spread
) -> UninspectedDays:
    """Return the days without inspections by the next morning, if nobody inspected today.

    What is in doubt of it, after the night of a `spread`; `others` are the maps that were possible
    beside that of the `evening`.
    """
    told = evening.chance > KNOWN
    known, counted = int(np.count_nonzero(told)), evening.uninspected.counted
    if counted is not None:  # others became likely only while nobody inspected
        known = min(known, counted.known)
    # of those of which it is not certain
    before, after = (
        max(float(one.chance.sum()) - known, LEAST_CHANCE) for one in (evening, morning)
    )
    anywhere, by_edge = evening.from_outside(evening.reach, spread)
    new = float(((1.0 - evening.chance) * (anywhere + by_edge)).sum())
    sent = max(after - before - new, 0.0) * known / (known + before)
    if evening.uninspected.begins:
        pairs = evening.chance, evening.pair_chance
        drawn, none = drawn_numbers(evening.grid, pairs, ~told)
        counted = Counted(drawn / before, none, before, doubt_of_number(evening, others), known)
    return evening.uninspected.overnight(before, after, (new, sent), counted)
