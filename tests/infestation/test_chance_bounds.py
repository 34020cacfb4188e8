"""No evidence is so strong that other evidence could not undo it."""

from hypothesis import given
from hypothesis import strategies as st

from fieldmon.infestation.chance_bounds import (
    LEAST_CHANCE,
    MOST_CHANCE,
    bounded_chance,
    bounded_pair_chance,
    greater,
    lesser,
)

numbers = st.floats(1e-9, 1.0 - 1e-9)


@given(numbers, numbers)
def test_lesser_and_greater_are_those_of_python(a, b):
    assert (lesser(a, b), greater(a, b)) == (min(a, b), max(a, b))


@given(st.floats(-2.0, 2.0))
def test_no_chance_is_certain(chance):
    assert 0.0 < LEAST_CHANCE <= bounded_chance(chance) <= MOST_CHANCE < 1.0
    if LEAST_CHANCE < chance < MOST_CHANCE:
        assert bounded_chance(chance) == chance


@given(st.floats(0.0, 1.0), numbers, numbers)
def test_the_chance_of_both_leaves_room_for_each_alone_and_for_neither(pair_chance, p, q):
    both = bounded_pair_chance(pair_chance, p, q)
    assert max(0.0, p + q - 1.0) <= both <= min(p, q) + 1e-15
    if both < pair_chance:  # only what is more dependent than any pair may be is cut
        assert pair_chance > p * q
