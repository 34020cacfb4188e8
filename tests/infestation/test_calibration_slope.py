"""How far differences between chances came true."""

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.infestation.calibration_slope import (
    _PRIOR_INFORMATION,
    no_inspections,
    note_inspection,
    proved_slope,
)

SPREAD = np.linspace(-4.0, 1.0, 60)  # logarithms of odds


@loop
def _slope(chances, found, sums):
    for k in range(chances.size):
        note_inspection(sums, chances[k], found[k])
    return proved_slope(sums)


def chances_of(said):
    return 1.0 / (1.0 + np.exp(-said))


def slope(said, found):
    return _slope(chances_of(said), found, no_inspections())


def drawn(true_slope, times, seed=1):
    said = np.tile(SPREAD, times)
    found = np.random.default_rng(seed).random(len(said)) < chances_of(-1.0 + true_slope * said)
    return said, found


def test_who_has_seen_nothing_relies_on_no_difference():
    assert slope(np.empty(0), np.empty(0, np.bool_)) == 0.0
    assert slope(SPREAD[:3], np.array([False, False, True])) == 0.0


def test_differences_that_come_true_are_relied_on_the_more_the_longer_they_do():
    slopes = [slope(*drawn(1.0, times)) for times in (1, 4, 200)]
    assert 0.0 < slopes[0] < slopes[1] < slopes[2]
    assert slopes[2] > 0.7


def test_differences_that_tell_nothing_or_the_opposite_are_not_relied_on():
    assert slope(*drawn(0.0, 200)) < 0.02
    assert slope(*drawn(-0.5, 50)) == 0.0


def test_who_says_twice_the_difference_is_relied_on_half_as_much():
    assert slope(*drawn(0.5, 400)) == pytest.approx(slope(*drawn(1.0, 400)) / 2.0, abs=0.1)


def test_the_level_does_not_matter():
    said, found = drawn(0.6, 20)
    assert slope(said - 1.5, found) == pytest.approx(slope(said, found), abs=1e-9)


def test_plants_known_to_be_infested_and_finds_everywhere_tell_no_difference():
    said, found = drawn(0.6, 20)
    known = (
        np.concatenate([said, np.full(500, 6.0)]),
        np.concatenate([found, np.ones(500, np.bool_)]),
    )
    assert slope(*known) == slope(said, found)
    assert slope(SPREAD, np.ones(60, np.bool_)) == 0.0
    assert slope(np.full(60, -1.0), SPREAD > 0.0) == 0.0


def test_what_records_say_is_relied_on_at_first_and_given_up_where_it_is_not_so():
    flat, told = np.full(100, 0.2), np.where(np.arange(100) < 30, 0.7, 0.05)
    assert no_inspections(flat)[-1] == 0.0
    first = no_inspections(told)
    assert 0.6 < first[-1] < 1.0
    nothing = np.empty(0), np.empty(0, np.bool_)
    assert _slope(*nothing, first.copy()) == first[-1]
    said, found = drawn(0.0, 20)
    assert _slope(chances_of(said), found, first.copy()) < 0.1
    said, found = drawn(1.0, 20)
    assert _slope(chances_of(said), found, first.copy()) > 0.6


@pytest.mark.parametrize("n", [1, 2, 30, 300])
@pytest.mark.parametrize("first", [0.0, 0.4, 1.0])
def test_the_slope_is_newton_s_first_step_less_what_is_not_known_of_it(n, first):
    """Of a logistic regression with a level: by its gradient and matrix of information."""
    rng = np.random.default_rng(n)
    said = rng.choice(SPREAD, n)
    found = rng.random(n) < chances_of(-1.0 + said)
    rate = found.mean()
    columns = np.column_stack([np.ones(n), said])
    gradient = columns.T @ (found - rate)
    information = rate * (1.0 - rate) * columns.T @ columns
    # what is believed before: so sure of the first slope, and of no level
    told = information[1, 1] - (information[0, 1] ** 2 / information[0, 0] if rate % 1 else 0.0)
    told += _PRIOR_INFORMATION
    slope = (gradient[1] + _PRIOR_INFORMATION * first) / told
    slope -= (1.0 - first) / np.sqrt(told)
    sums = no_inspections()
    sums[-1] = first
    expected = min(max(slope, 0.0), 1.0)
    assert _slope(chances_of(said), found, sums) == pytest.approx(expected, abs=1e-9)
