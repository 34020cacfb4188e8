"""Drives that fill the hours: what they hold is what their ways hold, at several budgets."""

import numpy as np
import pytest

from fieldmon.planning.routes.binned import _Offers, _sweep, proposals
from fieldmon.planning.routes.priced import Priced
from fieldmon.planning.routes.stops import stops_of
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.planning.routes.test_improve import used_s
from tests.planning.routes.tiny import ladder_below

AISLES = Aisles.of(rectangle(10, 9))
REWARD = np.random.default_rng(3).random(90) ** 2


def priced_by(robot, aisles=AISLES, reward=REWARD):
    return Priced(ladder_below(aisles), reward, robot)


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("seconds", [1200.0, 2400.0, 3600.0])
def test_a_proposal_holds_what_its_stops_hold_and_takes_about_the_hours(returns, seconds):
    robot = Robot(returns=returns)
    priced = priced_by(robot)
    made = [*proposals(priced, 0.006, seconds)]
    assert made
    for drawn, prices in made:
        stops = stops_of(priced, drawn, prices, robot)
        assert len(set(stops.tolist())) == len(stops)
        assert REWARD[stops].sum() == pytest.approx(drawn.reward)
        assert used_s(AISLES, robot, stops) <= 1.15 * seconds


@pytest.mark.parametrize("returns", [True, False])
def test_proposals_are_for_a_little_more_than_the_hours_for_them_and_for_a_little_less(returns):
    """The time that their ways are charged, but for half a step of each that was rounded."""
    seconds, priced = 1500.0, priced_by(Robot(returns=returns))
    made = [*proposals(priced, 0.006, seconds)]
    used_s = []
    for drawn, prices in made:
        at_s = float((drawn.passes[:-1] * priced.ladder.up_m).sum() * priced.costs.metre_s)
        offers = {price: priced.ways(price) for price in set(prices.tolist())}
        for k, price in enumerate(prices.tolist()):
            offered, way = offers[price], drawn.way[k]
            at_s += (offered.reward[k, way] - offered.worth[k, way]) / price
        used_s.append(at_s)
    rounded_s = 2 * len(priced.ladder.across_m) * 1.02 * seconds / 2500
    shares = np.array([1.02, 1.0, 0.98])
    assert len(made) == 3
    assert (np.array(used_s) <= shares * seconds + rounded_s).all()
    assert (np.array(used_s) >= (shares - 0.05) * seconds - rounded_s).all()
    assert used_s[0] > used_s[1] > used_s[2]


def test_more_hours_hold_more():
    priced = priced_by(Robot())
    held = [max(drawn.reward for drawn, _ in proposals(priced, 0.006, seconds))
            for seconds in (900.0, 1800.0, 2700.0, 3600.0)]  # fmt: skip
    assert (np.diff(held) > 0).all()


def test_between_two_prices_it_fills_hours_that_neither_price_does():
    """At one price the best drive may be too short, and at the next lower one too long."""
    robot, seconds = Robot(), 2400.0
    priced = priced_by(robot)
    fitting = []
    for price in np.geomspace(1e-4, 0.02, 60):
        drawn = priced.best(price)
        if priced.seconds(drawn, price) <= seconds:
            fitting.append(drawn.reward)
    proposed = []
    for drawn, prices in proposals(priced, 0.006, seconds):
        if used_s(AISLES, robot, stops_of(priced, drawn, prices, robot)) <= 1.02 * seconds:
            proposed.append(drawn.reward)
    assert max(proposed, default=0.0) >= 0.97 * max(fitting)


@pytest.mark.parametrize("times", [0.125, 8.0])
def test_where_all_takes_so_many_times_as_long_the_same_is_proposed_for_so_many_hours(times):
    """A second is worth as many times less; seconds are put into steps all the same."""
    usual = Robot()
    other = Robot(
        speed_m_s=usual.speed_m_s / times, row_change_s=usual.row_change_s * times,
        turn_180_s=usual.turn_180_s * times, stop_s=usual.stop_s * times,
        look_s=usual.look_s * times, detection=usual.detects,
    )  # fmt: skip
    made = proposals(priced_by(usual), 0.006, 2400.0)
    again = proposals(priced_by(other), 0.006 / times, 2400.0 * times)
    for (drawn, prices), (drawn_so, prices_so) in zip(made, again, strict=True):
        assert drawn_so.reward == pytest.approx(drawn.reward)
        assert drawn_so.way.tolist() == drawn.way.tolist()
        assert drawn_so.passes.tolist() == drawn.passes.tolist()
        assert prices_so * times == pytest.approx(prices)


def test_prices_in_aisles_are_about_the_one_it_was_told():
    for _, prices in proposals(priced_by(Robot()), 0.006, 2000.0):
        assert ((prices >= 0.6 * 0.006 - 1e-12) & (prices <= 1.6 * 0.006 + 1e-12)).all()


def test_where_nothing_is_to_be_gained_nothing_is_proposed():
    aisles = Aisles.of(rectangle(4, 4, Planting(faces=2)))
    nothing = np.zeros(len(aisles.grid))
    assert [*proposals(priced_by(Robot(), aisles, nothing), 0.006, 2000.0)] == []


@pytest.mark.parametrize("seed", range(4))
def test_the_sweep_finds_the_most_of_all_offers_at_every_number_of_steps(seed):
    """Against the same walk up the ladder with every offer tried, whatever its neighbours take."""
    rng, never = np.random.default_rng(seed), -np.inf
    # from the first row, or from the middle of the plot
    grid = rectangle(4, 3)
    gate = (-2.0, float(np.median(grid.lane_y_m))) if seed % 2 else None
    priced = priced_by(Robot(), Aisles.of(grid, gate_xy_m=gate), rng.random(12))
    ladder, tables, n_steps, n_prices = priced.ladder, priced.tables, 40, 4
    assert (ladder.gate > 0) == bool(seed % 2)
    n, n_states = len(ladder.across_m), len(tables.passes)
    n_ways = 1 + max(int(tables.aisle[:, 1].max()), int(tables.gate[:, 1].max()))
    # dearer drives hold and take less; some take as much as the next, some are not possible
    steps = -np.sort(-rng.integers(0, 6, (n, n_ways, n_prices)), axis=2)
    steps[rng.random((n, n_ways)) < 0.2] = -1
    steps[ladder.gate, 0] = 0
    reward = -np.sort(-rng.random((n, n_ways, n_prices)), axis=2)
    up = rng.integers(0, 3, (3, n, 2))
    room = np.empty((2, n_states, n_steps + 1)), np.full((n, n_states, n_steps + 1), -1, np.int32)
    ends = np.full(n_steps + 1, never)
    _sweep(ladder, tables, _Offers(reward, steps.astype(np.int64)), up, (*room, ends))
    most = np.full((n_states, n_steps + 1), never)
    most[0, 0] = 0.0
    for k in range(n):
        after_k = np.full_like(most, never)
        for before, way, after in tables.gate if k == ladder.gate else tables.aisle:
            if (after == 1 and k < ladder.gate) or (k + 1 == n and after != 1):
                continue
            on = int(up[tables.passes[after], k, [0, 1]].sum())
            for by, held in zip(steps[k, way], reward[k, way], strict=True):
                if by >= 0 and by + on <= n_steps:
                    moved = most[before, : n_steps + 1 - by - on] + held
                    after_k[after, by + on :] = np.maximum(after_k[after, by + on :], moved)
        most = after_k
    reached = most[1] > never
    assert reached.any()
    np.testing.assert_allclose(ends[reached], most[1][reached])
    assert (ends[~reached] < -1e200).all()
    # what was chosen leads back to the beginning, and holds that much in so many steps
    for b in np.flatnonzero(reached):
        after, left, held = 1, int(b), 0.0
        for k in range(n - 1, -1, -1):
            t, p = divmod(int(room[1][k, after, left]), n_prices)
            before, way, to = (tables.gate if k == ladder.gate else tables.aisle)[t]
            assert to == after
            held += reward[k, way, p]
            left -= steps[k, way, p] + int(up[tables.passes[after], k, [0, 1]].sum())
            after = before
        assert (after, held) == (0, pytest.approx(ends[b]))
        assert left >= 0


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("gate_row", [0, 5])
def test_a_proposal_goes_on_from_aisle_to_aisle_and_fills_its_steps_just(returns, gate_row):
    """Each way is charged as offered at its price; headlands as places rounded, not as steps."""
    robot, seconds, price = Robot(returns=returns), 1300.0, 0.006
    gate = (-2.0, float(np.sort(AISLES.grid.lane_y_m)[gate_row]))
    priced = priced_by(robot, Aisles.of(rectangle(10, 9), gate_xy_m=gate))
    ladder, tables = priced.ladder, priced.tables
    passes_of = [tuple(each) for each in tables.passes.tolist()]
    step_s = 1.02 * seconds / 2500
    place_s = np.vstack([np.zeros(2), np.cumsum(ladder.up_m, axis=0)]) * priced.costs.metre_s
    offers = {price * share: priced.ways(price * share) for share in (0.6, 0.8, 1.0, 1.25, 1.6)}
    for (drawn, prices), share in zip(proposals(priced, price, seconds), (1.02, 1.0, 0.98),
                                      strict=True):  # fmt: skip
        states, used, held = {0}, 0, 0.0
        for k, way in enumerate(drawn.way.tolist()):
            ways = tables.gate if k == ladder.gate else tables.aisle
            states = {after for before, one, after in ways.tolist() if before in states
                      and one == way and passes_of[after] == tuple(drawn.passes[k])}  # fmt: skip
            assert states
            offered = offers[prices[k]]
            taken_s = (offered.reward[k, way] - offered.worth[k, way]) / prices[k]
            used += round(taken_s / step_s)
            held += offered.reward[k, way]
            assert drawn.cut[k].tolist() == offered.cut[k, way].tolist()
            for side in range(2) if k + 1 < len(drawn.way) else ():
                up = drawn.passes[k, side] * place_s[k : k + 2, side] / step_s
                used += round(up[1]) - round(up[0])
        assert 1 in states
        assert (drawn.passes[-1] == 0).all()
        assert drawn.reward == pytest.approx(held)
        # no further than so many steps, and near it, as more time always pays here
        assert 0.97 * 2500 * share / 1.02 <= used <= 2500 * share / 1.02
