"""What is said of a bound is never less than it is."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.compute.wording import estimate
from fieldmon.planning.bound_wording import bound_sentence, share_above, sound_bound


def test_it_says_what_is_expected_what_is_the_most_and_the_share():
    said = bound_sentence(42.31, 42.97)
    assert said == "42 finds expected; no route of these hours can expect more than 43 (1.6 %)."


def test_where_the_bound_is_met_nothing_more_is_said():
    assert (
        bound_sentence(20.0, 20.0) == "20 finds expected; no route of these hours can expect more."
    )


def test_below_ten_there_is_a_tenth():
    said = bound_sentence(9.42, 10.31)
    assert said.startswith("9.4 finds expected; no route of these hours can expect more than 10.4 ")


def test_the_figures_do_not_belie_their_share():
    few = bound_sentence(11.0, 11.02)
    assert few == "11 finds expected; no route of these hours can expect over 0.2 % more."
    assert "12.4 finds expected; no route of these hours can expect more than 12.6 (1.7 %)" in (
        bound_sentence(12.4, 12.6)
    )


def test_few_finds_have_two_digits():
    assert bound_sentence(0.0123, 0.0145).startswith("0.012 finds expected; ")


def test_where_nothing_can_be_found_that_is_the_bound():
    said = bound_sentence(0.0, 0.0)
    assert said == "0.0 finds expected; no route of these hours can expect more."


def test_of_nothing_no_share_is_said():
    assert share_above(0.0, 0.5) == math.inf
    assert bound_sentence(0.0, 0.5).endswith("more than 0.50.")


def test_a_bound_below_what_a_route_holds_is_none_and_is_warned_of_unless_it_is_rounding():
    assert sound_bound(5.0, 5.0 - 1e-9) == 5.0
    assert sound_bound(5.0, 5.5) == 5.5
    with pytest.warns(
        RuntimeWarning, match=r"but it is 4\.9 where one holds 5: a fault of fieldmon"
    ):
        assert sound_bound(5.0, 4.9) == math.inf


@pytest.mark.parametrize("bound", [math.inf, 4.9])
def test_of_a_bound_that_is_none_nothing_is_said(bound):
    assert share_above(5.0, bound) == math.inf
    assert bound_sentence(5.0, bound) == (
        "5.0 finds expected; what other routes can expect at most is not known."
    )


@given(st.floats(1.0, 1e5))
def test_finds_are_said_as_every_estimate_is(held):
    assert bound_sentence(held, held).startswith(f"{estimate(held)} finds expected; ")


@given(st.floats(1e-4, 1e5), st.floats(1e-5, 1.0))
def test_the_bound_and_the_share_are_rounded_up(held, gap):
    bound = held * (1.0 + gap)
    said = bound_sentence(held, bound)
    share = float(re.search(r"([\d.]+) %", said)[1])
    assert share >= 100 * gap * (1 - 1e-6)
    if gap >= 0.0101:
        told = [float(n.replace(",", "")) for n in re.findall(r"[\d.,]*\d", said)]
        assert told[1] >= bound * (1 - 1e-8)
        assert told[1] <= told[0] * (1 + 2.001 * gap)
