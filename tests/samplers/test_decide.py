"""Decide: looks are spread over the plot, denser where unforeseen, and no find draws more."""

import numpy as np
import pytest

from fieldmon.compute.jit import loop
from fieldmon.compute.random_streams import coin_table
from fieldmon.errors import SettingError
from fieldmon.infestation.pairs.pairs import Neighbourhood, pair_chances, update_neighbourhood
from fieldmon.planning.explain import explain
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.layout import rectangle
from fieldmon.plot.travel import travel_s
from fieldmon.samplers.base import NEVER
from fieldmon.samplers.decide import Decide
from tests.scenes import scene_on
from tests.thorough import seeds

GRID = rectangle(30, 40)


def scene(chance, hours=24.0, seed=0):
    plain = scene_on(GRID, hours=hours, seed=seed)
    object.__setattr__(plain, "chance", chance)
    return plain


def quarters(plants):
    """Return how many plants stand in each quarter of the plot."""
    x, y = (GRID.xy_m - np.median(GRID.xy_m, axis=0)).T
    return np.bincount((2 * (x[plants] > 0) + (y[plants] > 0)).astype(int), minlength=4)


@pytest.mark.parametrize("seed", range(4))
def test_the_first_pass_is_a_fair_picture_of_a_plot_of_which_nothing_is_known(seed):
    plants = plan_work(scene(np.full(len(GRID), 0.05), seed=seed), Decide(24)).plant
    assert quarters(plants[:24]).tolist() == pytest.approx([6] * 4, abs=2)
    # forty plants a row, two looks twenty apart: every second or third of thirty rows
    rows = np.unique(GRID.row[plants[:24]])
    assert 11 <= len(rows) <= 13
    assert np.diff(rows).max() <= 3


def test_the_next_pass_drives_other_rows_between_those_of_the_first():
    plants = plan_work(scene(np.full(len(GRID), 0.05)), Decide(24)).plant[:48]
    first, second = (np.unique(GRID.row[half]) for half in (plants[:24], plants[24:]))
    assert not set(first) & set(second)
    assert len(np.unique(np.searchsorted(first, second))) >= 10


def test_a_pass_costs_less_driving_than_a_look_in_every_row():
    at = scene(np.full(len(GRID), 0.05))
    few, all_rows = (plan_work(at, Decide(24, apart)).arrive_s[23] for apart in (20, 40))
    assert few < 0.75 * all_rows


def test_looks_are_denser_where_they_are_less_foreseen():
    chance = np.where(GRID.xy_m[:, 0] < np.median(GRID.xy_m[:, 0]), 0.16, 0.01)
    plants = plan_work(scene(chance), Decide(25)).plant[:25]
    # Neyman: as the square roots, four to one
    assert 18 <= np.count_nonzero(chance[plants] > 0.1) <= 22


def test_a_find_draws_no_more_looks_to_it():
    calm = scene(np.full(len(GRID), 0.05))
    found = np.ones(len(GRID), bool)
    stops = work_day(calm, Decide(25), found).plant[:50]
    beside = set(
        np.concatenate(
            [
                GRID.adjacent.plant[GRID.adjacent.start[i] : GRID.adjacent.start[i + 1]]
                for i in stops[:25]
            ]
        ).tolist()
    )
    assert len(beside & set(stops[25:50].tolist())) <= 4


def test_it_says_why_it_goes_where_it_goes():
    at = scene(np.full(len(GRID), 0.05), hours=1.0)
    assert "plants" in " ".join(explain(at, plan_work(at, Decide())))


def test_a_pass_has_a_look_or_more():
    with pytest.raises(SettingError, match="looks_a_pass must be 1 or more"):
        Decide(0)
    with pytest.raises(SettingError, match="apart must be 1 or more"):
        Decide(apart=0)


@loop
def learn(believed, linked, result, detects, near):
    update_neighbourhood(believed, linked, result, (detects, True), near)


def told_by_look(p, detects):
    """Return how far a look at a plant tells whether it is infested: the deviation it explains."""
    states = [(infested, found) for infested in (0, 1) for found in (0, 1)]
    given = {(1, 1): p * detects, (1, 0): p * (1 - detects), (0, 1): 0.0, (0, 0): 1 - p}
    both = sum(given[one] * one[0] * one[1] for one in states)
    found = sum(given[one] * one[1] for one in states)
    return abs(both - p * found) / np.sqrt(found * (1 - found))


def evenly(weights, n, place):
    """Return which of some weights, laid end to end, hold the places (k + place) / n of all."""
    at = (np.arange(n) + place) * weights.sum() / n
    return set(np.searchsorted(np.cumsum(weights), at, "right").tolist()) - {len(weights)}


def pass_told(grid, weight, looks, rows, place):
    """Return the plants of a pass: rows by what they weigh, then plants, both evenly."""
    of_row = np.bincount(grid.row, weight, grid.n_rows)
    driven = evenly(of_row, rows, place)
    order = [i for i in grid.snake.tolist() if grid.row[i] in driven and weight[i] > 0]
    share = np.array([weight[i] / of_row[grid.row[i]] for i in order])
    return [order[k] for k in sorted(evenly(share, looks, place))]


@pytest.mark.parametrize("seed", seeds(6, 18))
def test_every_look_follows_from_the_words_of_the_sampler(seed):
    """Passes that are drawn evenly by what looks tell, begun at the nearer end, while they fit."""
    rng, grid = np.random.default_rng(seed), rectangle(*[(5, 6), (3, 9), (1, 12)][seed % 3])
    sampler = Decide(looks_a_pass=int(rng.integers(1, 9)), apart=int(rng.integers(1, 5)))
    n, hours = len(grid), float(rng.choice([rng.uniform(0.02, 0.3), 2.0], p=[0.8, 0.2]))
    seen, found = rng.random(n) < 0.2, rng.random(n) < 0.3
    given = {"at": int(rng.integers(-1, n)), "last_inspected": np.where(seen, 0, NEVER)}
    at = scene_on(grid, hours=hours, seed=seed, **given)
    work = work_day(at, sampler, found)
    travel, clock, detects = at.aisles.travel, at.clock, at.robot.detects
    usual = max(1.0, n / grid.n_rows / sampler.apart)
    rows = max(1, min(round(sampler.looks_a_pass / usual), grid.n_rows))
    chance, pair_chance = at.chance.copy(), pair_chances(at.chance, grid)
    morning, near = chance.copy(), Neighbourhood.of(n)
    place, now_s, here, stops, in_vain = coin_table(at.key, 1)[0], 0.0, at.at, [], 0
    while in_vain < 3:
        known = np.minimum(chance, morning)
        weight = np.where(seen, 0.0, [told_by_look(p, detects) for p in known])
        looks = pass_told(grid, weight, sampler.looks_a_pass, rows, place)
        if not looks:
            break
        first_s, last_s = (travel_s(travel, clock, here, looks[end]) for end in (0, -1))
        n_before = len(stops)
        for plant in looks if first_s <= last_s else looks[::-1]:
            arrive_s = now_s + travel_s(travel, clock, here, plant)
            home_s = travel_s(travel, clock, plant, -1) if at.robot.returns else 0.0
            if arrive_s + at.robot.visit_s + home_s <= at.seconds_left:
                stops.append((plant, arrive_s))
                here, now_s, seen[plant] = plant, arrive_s + at.robot.visit_s, True
                learn((chance, pair_chance), grid.linked, (plant, found[plant]), detects, near)
        in_vain = in_vain + 1 if len(stops) == n_before else 0
        place = (place + (np.sqrt(5) - 1) / 2) % 1.0
    assert work.plant.tolist() == [plant for plant, _ in stops]
    assert work.arrive_s == pytest.approx([arrive_s for _, arrive_s in stops])
