"""A night of the listings: what each slip infects, and what it should have infected."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.studies.thesis.chapter4.nights import (
    ABORTED,
    NEIGHBOR,
    RANDOM_SNAKE,
    SNAKE,
    Night,
    spread,
)

PLANTS, SIDES = 10, 6
LISTINGS = (SNAKE, NEIGHBOR, RANDOM_SNAKE)


def night(listing, *, slips, phantoms=True, severity=1.0):
    return Night(PLANTS, SIDES, listing, severity, slips, slips, phantoms)


def reached(what, *sources):
    """Return the faces (side, plant) that sources infest when all coins succeed, and the counts."""
    infested = np.zeros(SIDES * PLANTS, bool)
    for side, plant in sources:
        infested[side * PLANTS + plant] = True
    before = infested.copy()
    counted, true = spread(what, infested, np.zeros(infested.size))
    new = {divmod(int(face), PLANTS) for face in np.flatnonzero(infested & ~before)}
    return new, counted, true


@pytest.mark.parametrize("listing", LISTINGS)
@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ((1, 4), {(1, 3), (1, 5), (2, 4)}),
        ((2, 4), {(2, 3), (2, 5), (1, 4)}),
        ((0, 0), {(0, 1)}),
        ((0, 9), {(0, 8)}),
        ((4, 0), {(4, 1), (3, 0)}),
        ((5, 9), {(5, 8)}),
    ],
)
def test_put_right_insects_reach_their_row_and_the_other_face_of_their_vine(
    listing, source, expected
):
    new, _, true = reached(night(listing, slips=False), source)
    assert new == expected
    assert true == len(expected)


def test_the_snake_slip_reaches_the_other_face_only_at_the_ends_of_a_row():
    as_listed = night(SNAKE, slips=True)
    assert reached(as_listed, (1, 4)) == ({(1, 3), (1, 5)}, 3, 2)
    assert reached(as_listed, (1, 0)) == ({(1, 1), (2, 0)}, 2, 2)
    assert reached(as_listed, (2, 4))[0] == {(2, 3), (2, 5), (1, 4)}


@pytest.mark.parametrize("listing", [NEIGHBOR, RANDOM_SNAKE])
def test_the_stuck_row_index_leads_to_the_next_side_and_never_to_the_other_face(listing):
    as_listed = night(listing, slips=True)
    assert reached(as_listed, (2, 4))[0] == {(2, 3), (2, 5)}
    assert reached(as_listed, (2, 9))[0] == {(2, 8), (3, 0)}


@pytest.mark.parametrize("listing", [NEIGHBOR, RANDOM_SNAKE])
def test_the_end_of_the_first_side_lets_the_rest_of_the_field_reach_back_a_row(listing):
    new, _, _ = reached(night(listing, slips=True), (0, 9), (3, 4))
    assert new == {(0, 8), (3, 3), (3, 5), (2, 4)}


@pytest.mark.parametrize("listing", [NEIGHBOR, RANDOM_SNAKE])
def test_the_last_face_aborts_the_listing_but_not_the_corrected_night(listing):
    assert reached(night(listing, slips=True), (5, 9))[1] == ABORTED
    assert reached(night(listing, slips=False), (5, 9))[1] != ABORTED


def test_the_random_snake_counts_faces_that_were_infested_already():
    neighbours = ((2, 4), (2, 5), (2, 6))
    _, counted, true = reached(night(RANDOM_SNAKE, slips=True), *neighbours)
    assert (counted, true) == (6, 2)
    assert reached(night(RANDOM_SNAKE, slips=True, phantoms=False), *neighbours)[1] == 2


@given(
    listing=st.sampled_from(LISTINGS),
    slips=st.booleans(),
    phantoms=st.booleans(),
    severity=st.floats(0, 1),
    seed=st.integers(0, 2**32),
)
def test_a_night_only_adds_and_counts_what_it_added(listing, slips, phantoms, severity, seed):
    rng = np.random.default_rng(seed)
    before = rng.random(SIDES * PLANTS) < 0.3
    after = before.copy()
    what = night(listing, slips=slips, phantoms=phantoms, severity=severity)
    counted, true = spread(what, after, rng.random(after.size))
    assert after[before].all()
    assert true == after.sum() - before.sum()
    if counted != ABORTED and not phantoms:
        assert counted == true


@given(listing=st.sampled_from(LISTINGS), seed=st.integers(0, 2**32))
def test_more_severity_never_infests_less(listing, seed):
    rng = np.random.default_rng(seed)
    before, coins = rng.random(SIDES * PLANTS) < 0.3, rng.random(SIDES * PLANTS)
    after = []
    for severity in (0.2, 0.7):
        infested = before.copy()
        spread(night(listing, slips=False, severity=severity), infested, coins)
        after.append(infested)
    assert (after[0] <= after[1]).all()
