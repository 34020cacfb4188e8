"""What each further robot saves."""

import numpy as np
import pytest

from fieldmon.simulation.team_worth import _round, marginal_gains, worth_sentence


def losses(**changes):
    rng = np.random.default_rng(1)
    insects = rng.normal(0.0, 50.0, 40)  # what differs from season to season, for all alike
    base = {1: 200.0, 2: 140.0, 3: 136.0} | changes
    return {k: value + insects + rng.normal(0.0, 3.0, 40) for k, value in base.items()}


def test_gains_are_taken_seed_by_seed():
    """The interval knows that all meet the same insects: it is that of the differences."""
    made = losses()
    second, third = marginal_gains(made)
    assert second.saved.mean == pytest.approx((made[1] - made[2]).mean())
    assert second.saved.high - second.saved.low < 4.0
    assert (second.fewer, second.robots, third.robots) == (1, 2, 3)
    assert second.known


def test_each_further_robot_is_told_with_its_interval():
    said = worth_sentence(marginal_gains(losses()))
    assert said.startswith("A second robot would save 60 (5")
    assert said.endswith(").")
    assert "; a third 4." in said
    assert said.count("infested plant-days") == 1


def test_numbers_that_do_not_follow_each_other_are_compared_as_they_are():
    made = losses()
    assert worth_sentence(marginal_gains({1: made[1], 3: made[3]})).startswith(
        "3 robots instead of 1 would save 6"
    )


def test_what_saves_nothing_is_not_known_to_save():
    made = losses()
    (gain,) = marginal_gains({1: made[1], 2: made[1].copy()})
    assert not gain.known
    assert (
        worth_sentence([gain]) == "A second robot would save 0.0 (0.0 to 0.0) infested plant-days."
    )


def test_of_one_season_there_is_no_interval_and_of_one_team_nothing_to_say():
    (gain,) = marginal_gains({1: np.array([10.0]), 2: np.array([4.0])})
    assert worth_sentence([gain]) == "A second robot would save 6.0 infested plant-days."
    assert worth_sentence(marginal_gains({1: np.array([10.0])})) == ""


def test_the_second_to_the_eighth_have_words_of_their_own_and_the_ninth_is_counted():
    said = worth_sentence(marginal_gains({k: np.array([100.0 - k]) for k in range(1, 10)}))
    words = ("second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")
    assert [said.count(word) for word in words] == [1] * 7
    assert "9 robots instead of 8" in said


def test_what_saves_little_but_surely_is_known_to_save():
    lost = np.array([10.0, 12.0, 9.0])
    (gain,) = marginal_gains({1: lost + np.array([0.4, 0.5, 0.6]), 2: lost})
    assert 0.0 < gain.saved.low < 1.0
    assert gain.known


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.04, "0.0"), (-0.04, "0.0"), (-1.0, "-1.0"), (-1.02, "-1.0"), (12.4, "12")],
)
def test_nothing_is_nothing_and_a_loss_keeps_its_sign(value, said):
    assert _round(value) == said
