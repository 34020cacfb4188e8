"""Decide: looks are spread over the plot, denser where unforeseen, and no find draws more."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.planning.explain import explain
from fieldmon.planning.workday import plan_work, work_day
from fieldmon.plot.layout import rectangle
from fieldmon.samplers.decide import Decide
from tests.scenes import scene_on

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
