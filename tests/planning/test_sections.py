"""Who of a team works in which aisles."""

from itertools import product

import numpy as np
import pytest

from fieldmon.planning.sections import (
    aisle_heights,
    aisle_worth,
    best_sections,
    even_sections,
    worth_together,
)
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.base import NEVER, Scene

AISLES = Aisles.of(rectangle(12, 20))
GRID = AISLES.grid
ROBOT = Robot(hours=1.0, detection=1.0)
HEIGHTS = aisle_heights(GRID)
UP = np.arange(2)


def beside_each_other(section):
    """Tell whether everybody's aisles follow each other up the plot."""
    in_order = section[np.argsort(HEIGHTS, kind="stable")]
    return np.count_nonzero(np.diff(in_order)) == len(np.unique(section)) - 1


@pytest.mark.parametrize("shares", [[1, 1], [1, 1, 1], [2, 1], [5, 1]])
def test_even_sections_hold_plants_as_the_shares_say(shares):
    shares = np.array(shares, float)
    section = even_sections(GRID, shares)
    assert beside_each_other(section)
    plants = np.bincount(section[GRID.corridor[GRID.row]], minlength=len(shares))
    expected = shares / shares.sum() * len(GRID)
    assert np.abs(plants - expected).max() <= 20


def test_faces_of_one_aisle_are_never_given_to_two():
    grid = rectangle(6, 10, Planting(faces=2))
    assert len(even_sections(grid, np.ones(2))) == grid.corridor.max() + 1


def uneven(seed=1):
    return np.random.default_rng(seed).beta(0.3, 3.0, len(GRID))


def one_by_one(chance, price, row):
    """Return the best drive alone in a row, of all in and out, and through: by trying each."""
    clock = Scene(AISLES, ROBOT, chance, np.full(len(GRID), NEVER, np.int32)).clock
    plants = np.flatnonzero(GRID.row == row)
    pays = [p for p in plants if chance[p] > price * clock.visit_s]
    low, high = GRID.lane_x_m[row]
    drives = [(high - low, pays)]
    drives += [(2 * (GRID.along_m[p] - low), [q for q in pays if q <= p]) for p in pays]
    drives += [(2 * (high - GRID.along_m[p]), [q for q in pays if q >= p]) for p in pays]
    made = [(0.0, 0.0)]
    for way_m, stops in drives if pays else []:
        spent_s = clock.row_change_s + len(stops) * clock.visit_s + way_m / clock.speed_m_s
        made.append((float(chance[stops].sum()) - price * spent_s, spent_s))
    return max(made)


def test_an_aisle_is_worth_its_best_drive():
    chance = uneven()
    worth = aisle_worth(AISLES, [ROBOT], chance)
    assert (np.diff(worth.price) < 0).all()
    for p, row in product((0, 5, 10, 15), range(GRID.n_rows)):
        net, seconds = one_by_one(chance, worth.price[p], row)
        assert worth.net[p, 0, GRID.corridor[row]] == pytest.approx(net)
        assert worth.seconds[p, 0, GRID.corridor[row]] == pytest.approx(seconds)


@pytest.mark.parametrize("price", [12, 15])
def test_a_row_that_pays_at_both_ends_is_driven_through(price):
    """Where a second is cheap: in and out from one end, as far as the other, is twice as far."""
    chance = np.where((GRID.row == 4) & np.isin(np.arange(len(GRID)) % 20, [0, 19]), 0.9, 0.0)
    worth = aisle_worth(AISLES, [ROBOT], chance)
    clock = Scene(AISLES, ROBOT, chance, np.full(len(GRID), NEVER, np.int32)).clock
    low, high = GRID.lane_x_m[4]
    spent_s = clock.row_change_s + 2 * clock.visit_s + (high - low) / clock.speed_m_s
    at = GRID.corridor[4]
    assert worth.seconds[price, 0, at] == pytest.approx(spent_s)
    assert worth.net[price, 0, at] == pytest.approx(1.8 - worth.price[price] * spent_s)


def test_what_is_worth_more_is_shared_among_more():
    chance = np.where(GRID.row < 3, 0.4, 0.01)
    worth = aisle_worth(AISLES, [ROBOT, ROBOT], chance)
    left_s = np.full(2, 1500.0)
    section = best_sections(worth, HEIGHTS, left_s, UP)
    assert beside_each_other(section)
    # the rows that matter are cut between them, though they are a quarter of the plot
    assert len(np.unique(section[:3])) == 2
    even = even_sections(GRID, np.ones(2))
    assert worth_together(worth, section, left_s) > 1.2 * worth_together(worth, even, left_s)


def test_who_has_no_time_left_is_given_nothing_to_speak_of():
    worth = aisle_worth(AISLES, [ROBOT, ROBOT], uneven())
    section = best_sections(worth, HEIGHTS, np.array([3600.0, 0.0]), UP)
    assert (section == 0).sum() >= 11


def test_members_have_sections_in_the_order_in_which_they_stand():
    worth = aisle_worth(AISLES, [ROBOT, ROBOT], uneven())
    left_s = np.full(2, 1800.0)
    one, other = (best_sections(worth, HEIGHTS, left_s, up) for up in (UP, UP[::-1]))
    assert (one == 1 - other).all()


def test_inspected_plants_are_worth_nothing():
    worth = aisle_worth(AISLES, [ROBOT], np.zeros(len(GRID)))
    assert worth_together(worth, np.zeros(12, np.int64), np.full(1, 3600.0)) < 1e-6
