"""The listings' way round the field, whatever the field and whichever slips are put right."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.studies.thesis.chapter4 import listings
from fieldmon.studies.thesis.chapter4.listing_errors import AS_PUBLISHED, NAMES
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, ThesisStrategy, night_of, walk_of
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS, Hours, Vineyard

strategies = st.one_of(
    st.builds(ThesisStrategy, st.sampled_from([2, 4]), st.integers(1, 5)),
    st.builds(ThesisStrategy, st.sampled_from([1, 3, 5, 6])),
)
vineyards = st.builds(Vineyard, st.integers(6, 40), st.integers(2, 9), st.floats(0.5, 6))
slips = st.sets(st.sampled_from(NAMES)).map(lambda names: AS_PUBLISHED.without(*names))
trials = st.builds(
    NoPriorTrial, vineyards, strategies, st.sampled_from([1, 2, 3]), st.floats(0, 1), slips
)


def go(trial, seed=0, *, start=0.3, spare=0.5, curve=0):
    """Return a run on random numbers of a seed, its curve and the night of its abortion."""
    field, rng = trial.vineyard, np.random.default_rng(seed)
    walk = walk_of(trial, trial.rules)
    steps = np.concatenate([rng.random(listings.most_draws(walk)), np.full(500, spare)])
    infested = rng.random(field.faces) < start
    coins = rng.random((trial.hours.days, field.faces))
    trace = np.zeros((curve, 2))
    table, points, aborted = listings.run(
        walk, night_of(trial, trial.rules), infested, coins, steps, trace
    )
    return table, trace[:points], aborted


@given(trial=trials, seed=st.integers(0, 1000))
def test_insects_are_conserved(trial, seed):
    table, _, aborted = go(trial, seed)
    days = aborted or len(table)
    for day in range(days):
        assert 0 <= table[day, listings.FOUND] <= table[day, listings.INFESTED]
    for day in range(days - 1):
        left = table[day, listings.INFESTED] - table[day, listings.FOUND]
        assert table[day + 1, listings.INFESTED] == left + table[day, listings.NEW_TRUE]


@given(trial=trials, seed=st.integers(0, 1000))
def test_the_way_does_not_depend_on_the_insects(trial, seed):
    """Nothing is learnt: END and VISITED are the same in a clean and in a full field."""
    clean, _, _ = go(trial, seed, start=0.0)
    full, _, aborted = go(trial, seed, start=1.0)
    days = aborted or len(full)
    for column in (listings.END, listings.VISITED, listings.EVER, listings.LEFT_S):
        assert (clean[:days, column] == full[:days, column]).all()


@given(trial=trials, seed=st.integers(0, 1000))
def test_a_run_draws_no_more_than_it_says(trial, seed):
    low, high = go(trial, seed, spare=0.0)[0], go(trial, seed, spare=0.99)[0]
    assert (low == high).all()


@given(trial=trials, seed=st.integers(0, 1000))
def test_faces_are_counted_once_and_the_day_is_used_up_to_a_row_change(trial, seed):
    table, _, aborted = go(trial, seed)
    table = table[: aborted or len(table)]
    faces = trial.vineyard.faces
    assert (table[:, listings.VISITED] <= faces).all()
    assert (np.diff(table[:, listings.EVER]) >= 0).all()
    assert (table[:, listings.EVER] <= faces).all()
    # the listings look before they drive to a stop, not before they change the row
    assert (table[:, listings.LEFT_S] > -2 * trial.hours.row_change_s).all()


@given(trial=trials, seed=st.integers(0, 200))
def test_no_run_is_aborted_once_the_row_index_is_right(trial, seed):
    right = replace(trial, rules=trial.rules.without("night_row_index"))
    assert go(right, seed)[2] == 0


@given(seed=st.integers(0, 50), strategy=strategies)
def test_the_curve_rises_through_a_day_and_ends_at_what_was_found(seed, strategy):
    trial = NoPriorTrial(SCENARIOS["B"], strategy, rules=AS_PUBLISHED.without("night_row_index"))
    table, curve, _ = go(trial, seed, curve=2000)
    assert (np.diff(curve[:, 0]) > 0).all()
    assert curve[0].tolist() == [0.0, 0.0]
    known = table[0, listings.INFESTED] + table[:-1, listings.NEW_COUNTED].sum()
    assert curve[-1, 1] == pytest.approx(100 * table[:, listings.FOUND].sum() / known, abs=2)


def first_day(strategy, viewpoints=3, **changes):
    trial = NoPriorTrial(SCENARIOS["A"], strategy, viewpoints, rules=AS_PUBLISHED, **changes)
    return go(trial, start=0.0)[0][0]


@pytest.mark.parametrize(("slip", "every"), [("travel_once", 4), ("row_change_by_counter", 2)])
def test_a_snake_that_pays_its_way_gets_less_far(slip, every):
    hours = Hours(days=1)
    listed = NoPriorTrial(SCENARIOS["A"], ThesisStrategy(2, every), hours=hours)
    right = replace(listed, rules=AS_PUBLISHED.without(slip))
    visited = [go(trial)[0][0, listings.VISITED] for trial in (listed, right)]
    assert visited[1] < visited[0]


def test_a_stop_of_the_snake_costs_one_vine_and_one_look():
    """10 stops at 2.88 s + 23.74 s; the listing wants a little more than that."""
    hours = Hours(day_s=10 * (2.88 + 23.74) + 0.5, days=1)
    day = first_day(ThesisStrategy(1), hours=hours)
    assert day[listings.VISITED] == 10
    assert day[listings.LEFT_S] == pytest.approx(0.5)


def test_a_stop_of_the_neighbor_strategy_costs_two_looks_and_a_turn():
    hours = Hours(day_s=10 * (2.88 + 2 * 4.34 + 23) + 0.5, days=1)
    day = first_day(ThesisStrategy(6), 1, hours=hours)
    assert day[listings.VISITED] == 20
    assert day[listings.LEFT_S] == pytest.approx(0.5)


def test_rows_walked_to_and_fro_are_met_in_the_other_order():
    """Half a side into side 1: as listed its first vines are visited, put right its last."""
    hours = Hours(day_s=76 * (2.88 + 23.74), days=1)
    listed = NoPriorTrial(SCENARIOS["A"], ThesisStrategy(1), hours=hours, severity=0.0)
    for rules, first in ((AS_PUBLISHED, True), (AS_PUBLISHED.without("one_way_rows"), False)):
        trial = replace(listed, rules=rules)
        walk = walk_of(trial, rules)
        infested = np.zeros(500, bool)
        infested[50:60] = True
        coins = np.ones((1, 500))
        table, _, _ = listings.run(
            walk, night_of(trial, rules), infested, coins, np.zeros(0), np.zeros((0, 2))
        )
        assert (table[0, listings.FOUND] == 10) == first
