"""How far all chances may be off together."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import expit, logit

from fieldmon.errors import SettingError
from fieldmon.infestation.level_range import LevelRange, first_level_range, level_range
from fieldmon.infestation.plot_estimate import doubted_level, estimate_plot
from fieldmon.infestation.prior.prior import scaled
from fieldmon.plot.layout import rectangle

GRID = rectangle(20, 20)
CHANCE = np.random.default_rng(5).beta(0.5, 8.0, 400)


def doubting(chance, doubt, pest=None):
    return SimpleNamespace(chance=chance, doubt=doubt, since_inspected=None, pest=pest)


def test_odds_are_multiplied_by_one_number_at_which_the_chances_sum_up_to_the_ends():
    found = level_range(doubting(CHANCE, 0.4))
    for chance, factor in zip(found.of(CHANCE), (found.low, found.high), strict=True):
        assert logit(chance) - logit(CHANCE) == pytest.approx(np.full(400, np.log(factor)))
        by_hand = brentq(lambda s, c=chance: expit(logit(CHANCE) + s).sum() - c.sum(), -9, 9)
        assert np.exp(by_hand) == pytest.approx(factor)
        assert chance == pytest.approx(scaled(CHANCE, float(chance.mean())))


def test_its_ends_are_those_of_the_plot_s_interval_where_chance_adds_nothing():
    # of very many plants, what single ones happen to be is lost in what is not known of the level
    grid = rectangle(150, 150)
    chance = np.full(len(grid), 0.02)
    low, high = (float(end.sum()) for end in level_range(doubting(chance, 0.6)).of(chance))
    plot = estimate_plot(grid, chance, np.repeat(4e-4, len(grid.adjacent.plant)), doubt=0.6)
    assert low == pytest.approx(plot.low, rel=0.05)
    assert high == pytest.approx(plot.high, rel=0.05)


def test_more_doubt_and_more_certainty_are_wider_and_hold_the_chance():
    widths = []
    for doubt, sure in ((0.2, 0.5), (0.2, 0.9), (0.6, 0.9), (3.0, 0.9)):
        found = level_range(doubting(CHANCE, doubt), sure)
        low, high = found.of(CHANCE)
        assert ((low >= 0.0) & (low < CHANCE) & (high > CHANCE) & (high <= 1.0)).all()
        widths.append(found.high / found.low)
    assert widths == sorted(widths)


@pytest.mark.parametrize(
    ("chance", "doubt"), [(CHANCE, 0.0), (np.zeros(400), 0.5), (np.ones(400), 0.5)]
)
def test_where_nothing_is_doubted_or_all_is_certain_there_is_no_interval(chance, doubt):
    assert level_range(doubting(chance, doubt)) == LevelRange(1.0, 1.0)
    assert np.array(LevelRange().of(chance)) == pytest.approx(np.array([chance, chance]))


def test_what_is_certain_stays_and_a_plot_never_holds_more_than_its_plants():
    chance = np.concatenate([[0.0, 1.0], np.full(50, 0.9)])
    low, high = level_range(doubting(chance, 2.0)).of(chance)
    assert low[:2].tolist() == high[:2].tolist() == [0.0, 1.0]
    assert (high[2:] < 1.0).all()
    assert (low[2:] > 0.0).all()


def test_on_a_first_day_it_is_wide_for_nothing_is_known_of_the_level():
    first = first_level_range(GRID, CHANCE)
    later = level_range(doubting(CHANCE, 0.4))
    assert first.low < later.low < 1.0 < later.high < first.high


def test_no_chance_is_no_interval():
    with pytest.raises(SettingError, match="'sure' must be a chance between 0 and 1"):
        level_range(doubting(CHANCE, 0.4), sure=1.0)


def test_however_few_there_may_be_what_is_certain_is_and_the_others_keep_a_thousandth():
    chance = np.concatenate([np.ones(30), np.full(10, 0.02)])
    low, _ = level_range(doubting(chance, 5.0)).of(chance)
    assert (low[:30] == 1.0).all()
    assert low[30:] == pytest.approx(2e-5, rel=1e-3)


@pytest.mark.parametrize("share", [0.02, 0.4, 0.9])
def test_of_a_flat_map_the_odds_are_doubted_as_much_whatever_share_it_has(share):
    found = level_range(doubting(np.full(400, share), 0.4, "a pest"), 0.8)
    told = np.quantile(doubted_level(0.4), [0.1, 0.9])
    assert [found.low, found.high] == pytest.approx(told)
