"""How often infestations come about, by the ancestries drawn: against rates that are known."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.ancestry_rates import DrawnEvidence, Rates
from fieldmon.infestation.ancestry.drawn_ancestry import DrawnSums
from fieldmon.infestation.ancestry.infestation_course import BEFORE
from fieldmon.infestation.ancestry.origins import ARRIVE, ARRIVE_BY_EDGE
from fieldmon.infestation.insects.jump_landing import SHARES, landing_of
from fieldmon.plot.layout import rectangle

GRID = rectangle(40, 40)
N = len(GRID)
LANDING = landing_of(GRID)
FLAT = np.full(N, 0.02)
T, D = BEFORE + 11, LANDING.kernels.shape[1]
SENDS = np.r_[np.full(BEFORE, 0.4), np.full(10, 0.3), 0.0]
KERNEL = np.einsum("k,kij->ij", SHARES / SHARES.sum(), LANDING.kernels)


def evidence(drawn, seen=1.0, start=FLAT, kernel=KERNEL, unseen=None):
    """Return what ancestries have of which so much would have been seen, everywhere alike."""
    nothing = np.zeros((T, N))
    return DrawnEvidence(
        start,
        SENDS,
        kernel,
        nothing + seen,
        nothing,
        drawn,
        drawn.there,
        nothing if unseen is None else unseen,
        (ARRIVE, ARRIVE_BY_EDGE),
        np.zeros((2, 10)),
    )


def after(rates, night):
    return rates.after(night, rates.exposure(night, LANDING), LANDING)


def nothing_drawn():
    return DrawnSums.none(T, N, D)


def test_where_nothing_could_be_seen_everything_stays_as_it_was_believed():
    first = Rates.at_first()
    known = after(first, evidence(nothing_drawn(), seen=0.0))
    assert known.shares == pytest.approx(first.shares)
    assert known[1:] == pytest.approx(first[1:])
    assert repr(evidence(nothing_drawn())) == f"<Evidence of {T} mornings>"


def test_as_many_come_from_none_as_was_told_grow_to_what_was_told():
    """All of it seen: by the first morning they and their offspring are the chances' sum."""
    rates = Rates.at_first()
    roots = rates.roots(FLAT, LANDING.at_edge, T)
    there = 0.0
    for morning in range(BEFORE + 1):
        there = there * (1.0 + rates.before) + roots[morning].sum()
    assert there == pytest.approx(FLAT.sum(), rel=1e-6)
    assert roots[BEFORE + 1].sum() == pytest.approx(N * (ARRIVE + rates.by_edge))


@pytest.mark.parametrize("times", [0.3, 1.0, 4.0])
def test_the_number_at_the_start_follows_what_was_drawn(times):
    rates, drawn = Rates.at_first(), nothing_drawn()
    drawn.roots[0] = rates.roots(FLAT, LANDING.at_edge, T)[: BEFORE + 1].sum(axis=0) * times
    known = after(rates, evidence(drawn))
    told = drawn.roots.sum() / times
    # three finds, and two by the edge, are what was believed
    assert known.start + known.start_by_edge == pytest.approx(
        (told * times + 3.0) / (told + 3.0), rel=0.05
    )
    assert known.anywhere < 0.2 * rates.anywhere


def test_growth_and_the_number_at_the_start_are_known_together():
    """Few jumps before the season: there were more roots then for the same first morning."""
    rates, drawn = Rates.at_first(), nothing_drawn()
    drawn.turned[0, :300], drawn.turned[BEFORE, :300] = 1.0, -1.0
    drawn.roots[0, :300] = 0.02
    drawn.jumps[0] = KERNEL * 20.0
    known = after(rates, evidence(drawn))
    assert known.before < 0.1
    # as many roots as become all that was told, at this growth; three finds are what was believed
    told = FLAT.sum() / (1.0 + known.before) ** (0.85 * BEFORE)
    roots = known.roots(FLAT, LANDING.at_edge, T)[: BEFORE + 1].sum()
    assert roots == pytest.approx(told * (6.0 + 3.0) / (told + 3.0), rel=0.05)


def test_what_stands_by_the_edge_came_over_it():
    rates, at_edge = Rates.at_first(), LANDING.at_edge
    for when in (0, 1):
        drawn = nothing_drawn()
        drawn.roots[when] = 30.0 * at_edge**2 / (at_edge**2).sum()
        edge = after(rates, evidence(drawn))
        drawn.roots[when] = 30.0 / N
        inside = after(rates, evidence(drawn))
        k = 3 if when == 0 else 5
        assert edge[k] > 3.0 * edge[k - 1]
        assert inside[k] < edge[k] / 3.0


@pytest.mark.parametrize("k", range(8))
def test_shares_are_those_of_the_jumps_that_were_drawn(k):
    """Jumps of one kernel of ten times as many as are sent come mostly to its share."""
    rates, drawn = Rates.at_first(), nothing_drawn()
    drawn.turned[BEFORE, 820] = 1.0
    drawn.jumps[1] = LANDING.kernels[k] * 30.0
    kernel = KERNEL
    for _ in range(30):
        rates = after(rates, evidence(drawn, kernel=kernel))
        kernel = np.einsum("k,kij->ij", rates.shares, LANDING.kernels)
    assert rates.shares.sum() == pytest.approx(1.0)
    assert rates.shares.argmax() == k
    assert rates.shares[k] > 0.5


def test_who_was_never_seen_would_have_been_seen_by_what_it_sent_out():
    """So infestations of which nothing was seen lower what each is taken to send out."""
    rates, drawn, unseen = Rates.at_first(), nothing_drawn(), np.zeros((T, N))
    drawn.turned[0, 820], drawn.turned[BEFORE, 820] = 1.0, -1.0
    drawn.jumps[0] = KERNEL * 4.0
    alone = rates.exposure(evidence(drawn), LANDING)
    unseen[:BEFORE, 830] = 2.0
    both = rates.exposure(evidence(drawn, unseen=unseen), LANDING)
    assert both.before == pytest.approx(3.0 * alone.before, rel=0.05)
    assert both.by_kernel == pytest.approx(3.0 * alone.by_kernel, rel=0.05)
    fewer = rates.with_jumps(evidence(drawn), both, LANDING).before
    assert fewer < rates.with_jumps(evidence(drawn), alone, LANDING).before
    assert repr(both) == "<Exposure to 8 kernels>"
