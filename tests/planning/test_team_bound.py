"""What no routes of a team can hold together: by prices of plants, and by one with all hours."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from fieldmon.planning import team_bound as team_bounds
from fieldmon.planning.routes import bound
from fieldmon.planning.routes.best_route import Bounded
from fieldmon.planning.team_bound import MemberTask, _by_prices, team_bound
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles


def test_a_bound_of_two_gates_holds_what_only_the_farther_gate_can_reach():
    grid = rectangle(30, 15)
    low, high = grid.xy_m.min(axis=0) - 3.0, grid.xy_m.max(axis=0) + 3.0
    at_low, at_high = (Aisles.of(grid, (float(at[0]), float(at[1]))) for at in (low, high))
    worth = np.zeros(len(grid))
    worth[np.argmin(np.hypot(*(grid.xy_m - high).T))] = 1.0
    robot = Robot(hours=0.04)
    assert team_bound([MemberTask(at_high, robot, worth)]) == pytest.approx(1.0)
    assert (
        team_bound([MemberTask(at_low, robot, worth), MemberTask(at_high, robot, worth)])
        >= 1.0 - 1e-9
    )


def test_with_time_for_all_a_team_is_bound_by_what_all_plants_hold_from_whatever_gates():
    """Each of two could visit all alone: only a price of plants tells that nobody need do both."""
    grid = rectangle(6, 8)
    low, high = grid.xy_m.min(axis=0) - 3.0, grid.xy_m.max(axis=0) + 3.0
    gates = [Aisles.of(grid, (float(at[0]), float(at[1]))) for at in (low, high)]
    worth = np.random.default_rng(3).random(len(grid))
    whole = [MemberTask(at, Robot(hours=3.0), worth) for at in gates]
    assert team_bound(whole) == pytest.approx(worth.sum(), rel=0.02)


def test_a_bound_of_one_gate_is_that_of_one_with_the_hours_of_all(monkeypatch):
    """It changes aisles once more between two of them: as quick and sharp-eyed as any is."""
    monkeypatch.setattr(team_bounds, "_by_prices", lambda *_: np.inf)
    aisles = Aisles.of(rectangle(8, 8))
    value = np.random.default_rng(1).random(64)
    quick = Robot(hours=0.1, speed_m_s=1.2, row_change_s=4.0, turn_180_s=9.0, look_s=50.0)
    slow = Robot(hours=0.2, speed_m_s=0.4, row_change_s=20.0, turn_180_s=3.0, look_s=30.0)
    for team in ((quick,), (quick, slow), (slow, quick, quick)):
        tasks = [MemberTask(aisles, robot, value * share) for robot, share in
                 zip(team, (0.5, 0.9, 0.7), strict=False)]  # fmt: skip
        most = np.max([task.value for task in tasks], axis=0)
        best_of_all = Robot(
            speed_m_s=max(one.speed_m_s for one in team),
            row_change_s=min(one.row_change_s for one in team),
            turn_180_s=min(one.turn_180_s for one in team),
            stop_s=0.0, look_s=min(one.visit_s for one in team),
        )  # fmt: skip
        seconds = sum(one.day_s for one in team)
        seconds += (len(team) - 1) * best_of_all.row_change_s
        expected = bound(aisles, most, best_of_all, seconds)
        assert team_bound(tasks) == pytest.approx(expected, rel=1e-6)
        # from gates of their own, or where one stays out, it says nothing
        other = replace(team[-1], returns=False)
        assert team_bound([*tasks[:-1], tasks[-1]._replace(robot=other)]) == np.inf


def days_of(k, n=10, n_days=7):
    """Return the plants of each of a member's days, at random."""
    rng = np.random.default_rng(k)
    return [rng.permutation(n)[:4] for _ in range(n_days)]


def bounded_alone(member, reward, _robot):
    """Return what the best of a member's days holds, and which plants that visits."""
    days = days_of(member)
    best_day = max(days, key=lambda day: reward[day].sum())
    visits = np.zeros(len(reward))
    visits[best_day] = 1.0
    return Bounded(float(reward[best_day].sum()), visits)


def dual(values):
    """Return the least bound of all prices of plants, by a linear program."""
    m, n = values.shape
    rows, least = [], []
    # one column a plant's price, one a member's best, and one a plant and member: what it is above
    cost = np.concatenate([np.ones(n + m), np.zeros(m * n)])
    for k, i in np.ndindex(m, n):
        row = np.zeros(len(cost))
        row[i] = row[n + m + k * n + i] = -1.0
        rows.append(row)
        least.append(-values[k, i])
    for k in range(m):
        for day in days_of(k, n):
            row = np.zeros(len(cost))
            row[n + k], row[n + m + k * n + day] = -1.0, 1.0
            rows.append(row)
            least.append(0.0)
    return float(linprog(cost, np.array(rows), np.array(least)).fun)


@pytest.mark.parametrize("m", [1, 2, 3, 4])
@pytest.mark.parametrize("scale", [1e-5, 1.0])
def test_prices_of_plants_come_near_the_least_bound_that_any_have(monkeypatch, m, scale):
    monkeypatch.setattr(team_bounds, "bounded", bounded_alone)
    values = scale * np.random.default_rng(m).uniform(0.2, 1.0, (m, 10))
    tasks = [MemberTask(k, Robot(), value) for k, value in enumerate(values)]
    least, most = dual(values), values.max(axis=0)
    first = sum(bounded_alone(k, value, None).value for k, value in enumerate(values))
    # most of the way from no prices to the best, the more so the better it is known what is held
    for held, left in ((0.97 * least, 0.25), (0.8 * least, 0.25), (0.0, 0.4)):
        found = _by_prices(tasks, most, held)
        assert found >= least * (1.0 - 1e-9)
        assert found - least <= left * (first - least) + 1e-9 * least
    # where a bound is held already, nothing better is looked for
    assert _by_prices(tasks, most, 2.0 * first) == pytest.approx(first)
