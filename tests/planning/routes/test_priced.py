"""Drives at a price: their bounds fall to one least price, and prices order time."""

import numpy as np
import pytest

from fieldmon.planning.routes.priced import Priced
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.planning.routes.tiny import ladder_below


@pytest.fixture(params=[(1, True), (2, True), (1, False), (2, False)])
def priced(request):
    faces, returns = request.param
    aisles = Aisles.of(rectangle(12, 15, Planting(faces=faces)))
    reward = np.random.default_rng(4).random(len(aisles.grid)) ** 2
    return Priced(ladder_below(aisles), reward, Robot(returns=returns))


PRICES = np.geomspace(1e-5, 0.03, 40)


def test_dearer_time_is_spent_less(priced):
    used = [priced.seconds(priced.best(price), price) for price in PRICES]
    assert (np.diff(used) <= 1e-6 * max(used)).all()


def test_a_free_drive_takes_every_plant(priced):
    assert priced.best(1e-9).reward == pytest.approx(priced.reward.sum())


def test_bounds_are_a_valley_over_the_price(priced):
    bounds = [
        priced.bound(priced.best(price), price, 3600.0) for price in np.linspace(1e-5, 0.02, 40)
    ]
    turns = np.diff(np.sign(np.diff(np.round(bounds, 9))))
    assert (turns >= 0).all()


def test_ways_that_can_be_driven_just_so_are_worth_no_more_than_those_granted(priced):
    price = 0.005
    offered = priced.ways(price)
    granted = priced.best(price)
    at = np.arange(len(granted.way)), granted.way
    worth = priced._room.worth.copy()
    granted_again = priced.best(price)
    assert granted_again.worth == granted.worth
    assert (offered.worth[at] <= priced._room.worth[at] + 1e-9).all()
    assert worth.shape == offered.worth.shape


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("row", [1, 3, 8])
def test_a_kind_of_drive_begins_and_ends_in_its_own_stretches(row, returns):
    """All that pays is in one row: whoever begins below it or ends above it gets less."""
    grid = rectangle(12, 15)
    aisles = Aisles.of(grid, gate_xy_m=(-2.0, float(np.median(grid.lane_y_m))))
    reward = np.where(grid.row == row, 1.0, 0.0)
    priced = Priced(ladder_below(aisles), reward, Robot(returns=returns))
    worth, held = priced.kinds(1e-4)
    at = np.unravel_index(np.argmax(worth), worth.shape)
    assert worth[at] == pytest.approx(priced.best(1e-4).worth)
    assert held[at] == pytest.approx(reward.sum())
    assert min(worth.shape) > 3
    below, above = worth[: at[0] + 1, at[1]], worth[at[0], at[1] :]
    # the gate may lie where an aisle ends
    for less in (np.diff(below), -np.diff(above)):
        assert (less >= 0.0).all()
        assert (less < 1e-9).sum() <= 1
    # nor does it take what lies out of its stretches
    assert (worth[at[0] + 1 :] < worth[at]).all()
    assert (worth[:, : at[1]] < worth[at]).all()
