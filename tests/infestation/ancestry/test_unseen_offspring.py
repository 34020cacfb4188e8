"""What was never seen: against sums by hand and simulated plots."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.infestation_course import Course
from fieldmon.infestation.ancestry.unseen_offspring import stays_unseen, unseen_now
from tests.infestation.insects.landing_by_hand import LANDING, SHARES, N, by_hand

# one that begins on the second of three mornings sends nothing out in the night after
AT_ONCE = Course.that_may_hide(3, np.eye(4)[0])
GROWING = AT_ONCE._replace(grown=np.array([0, 2, 2]), grown_by=np.array([0, 0, 2]))


def test_nothing_is_seen_of_an_infestation_with_the_chance_of_a_branching_process():
    """Two nights, worked out plant by plant."""
    rng = np.random.default_rng(3)
    alone = rng.uniform(0.2, 1.0, (3, N))
    alone[:, 5] = 0.0
    taken, sends, lands = rng.random((3, N)) * 0.5, np.array([0.7, 0.4, 0.0]), by_hand(SHARES)
    unseen = stays_unseen(alone, taken, (sends, SHARES), LANDING, AT_ONCE)
    last = alone[2]
    second_night = np.exp(-0.4 * lands @ ((1.0 - last) * (1.0 - taken[2])))
    second = alone[1] * second_night
    first_night = np.exp(-0.7 * lands @ ((1.0 - second) * (1.0 - taken[1])))
    first = alone[0] * first_night * second_night
    assert unseen.chance == pytest.approx(np.array([first, second, last]))
    assert (unseen.chance[:, 5] == 0.0).all()
    assert repr(unseen) == "<Unseen on 3 mornings>"


@pytest.mark.parametrize("course", [AT_ONCE, GROWING])
def test_as_many_are_unseen_as_on_simulated_plots_of_which_nothing_was_seen(course):
    """Few come from none, so that no plant is infested twice."""
    rng = np.random.default_rng(4)
    looks = np.zeros((3, N), bool)
    looks[1, : N // 2] = looks[2, ::3] = True
    missed, sends = 0.3, np.array([0.6, 0.6, 0.0])
    roots, lands = np.zeros((3, N)), by_hand(SHARES)
    roots[0], roots[1] = 0.004, 0.002
    alone = np.cumprod(np.where(looks, missed, 1.0)[::-1], axis=0)[::-1]
    unseen = stays_unseen(alone, np.zeros((3, N)), (sends, SHARES), LANDING, course)
    active = np.zeros((3, N))
    active[0, 30] = 1.0
    so_far = unseen_now(unseen, active, roots, (sends, SHARES), LANDING, course)
    grows = np.append(course.grown, 3)
    plots = 12_000, N
    infested, since = np.zeros(plots, bool), np.full(plots, 3)
    shown, numbers = np.zeros(len(infested), bool), []
    for morning in range(3):
        new = rng.random(plots) < roots[morning]
        if morning:
            senders = (infested & (grows[since] < morning)).astype(float)
            senders[:, 30] += active[morning - 1, 30]
            new |= rng.random(plots) < -np.expm1(-sends[morning - 1] * (senders @ lands))
        since[new & ~infested] = morning
        infested |= new
        numbers.append(infested.sum(axis=1))
        shown |= (infested & looks[morning] & (rng.random(plots) > missed)).any(axis=1)
    assert np.count_nonzero(~shown) > 4_000
    expected, there = so_far[-1], infested[~shown].mean(axis=0)
    assert expected.sum() == pytest.approx(there.sum(), rel=0.05)
    assert expected == pytest.approx(there, abs=0.012)
    on = np.array(numbers)[:, ~shown].mean(axis=1)
    assert so_far.sum(axis=1) == pytest.approx(on, rel=0.06)
