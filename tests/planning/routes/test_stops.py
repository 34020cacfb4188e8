"""From drives on a ladder to stops: on a plain plot they take what the ladder says."""

import numpy as np
import pytest

from fieldmon.planning.routes.binned import proposals
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.stops import stops_of
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.planning.routes.test_improve import used_s
from tests.planning.routes.tiny import ladder_below


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("price", [0.0005, 0.003, 0.006, 0.009])
def test_on_a_plain_plot_a_drive_takes_the_ladders_time_and_reward(returns, price):
    aisles, robot = Aisles.of(rectangle(14, 11)), Robot(returns=returns)
    reward = np.random.default_rng(8).random(len(aisles.grid)) ** 2
    priced = Priced(ladder_below(aisles), reward, robot)
    drawn = priced.best(price)
    stops = stops_of(priced, drawn, np.full(len(drawn.way), price), robot)
    assert len(np.unique(stops)) == len(stops)
    assert reward[stops].sum() == pytest.approx(drawn.reward)
    took_s = used_s(aisles, robot, stops)
    # one of the ways to drive it may come by an aisle twice
    assert priced.seconds(drawn, price) - 1e-3 <= took_s
    assert took_s <= 1.05 * priced.seconds(drawn, price) + 2 * robot.row_change_s


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("price", [0.003, 0.006, 0.009])
def test_from_a_gate_in_the_middle_the_lowest_aisle_s_plants_are_taken_too(returns, price):
    grid, robot = rectangle(9, 11), Robot(returns=returns)
    aisles = Aisles.of(grid, gate_xy_m=(-4.0, float(np.median(grid.lane_y_m))))
    # in the lowest row only plants near its ends, so that it is not driven through
    reward = np.random.default_rng(8).random(len(grid)) ** 2
    reward[2:9] = 0.0
    reward[[0, 1, 9, 10]] = 0.9
    priced = Priced(ladder_below(aisles), reward, robot)
    assert priced.ladder.gate > 0
    drawn = priced.best(price)
    stops = stops_of(priced, drawn, np.full(len(drawn.way), price), robot)
    assert reward[stops].sum() == pytest.approx(drawn.reward)
    assert {0, 1, 9, 10} <= set(stops.tolist())


@pytest.mark.parametrize("returns", [True, False])
def test_proposals_take_about_the_hours(returns):
    aisles, robot = Aisles.of(rectangle(14, 11)), Robot(returns=returns)
    reward = np.random.default_rng(8).random(len(aisles.grid)) ** 2
    priced = Priced(ladder_below(aisles), reward, robot)
    made = list(proposals(priced, 0.006, 2500.0))
    assert made
    for drawn, prices in made:
        stops = stops_of(priced, drawn, prices, robot)
        assert reward[stops].sum() == pytest.approx(drawn.reward)
        assert used_s(aisles, robot, stops) == pytest.approx(2500.0, rel=0.15)
