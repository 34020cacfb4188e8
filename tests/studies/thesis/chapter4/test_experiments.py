"""Which configurations chapter 4 tries."""

from collections import Counter
from itertools import pairwise

import pytest

from fieldmon.studies.thesis.chapter4 import experiments
from fieldmon.studies.thesis.chapter4.listing_errors import (
    AS_PUBLISHED,
    NAMES,
    NIGHT_CORRECTED,
    ListingErrors,
)
from fieldmon.studies.thesis.chapter4.trial import SCATTERED, TABLE_ROWS, Prose
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS

ALL = {
    "bigger": experiments.bigger_trials,
    "trend": experiments.trend_trials,
    "equal": experiments.equal_trials,
    "everywhere": experiments.everywhere_trials,
    "slip": experiments.slip_trials,
}


@pytest.mark.parametrize("name", ALL)
def test_no_configuration_is_tried_twice(name):
    trials = ALL[name]()
    assert len(set(trials)) == len(trials) > 0


@pytest.mark.parametrize("letter", SCENARIOS)
def test_a_printed_table_has_its_ten_rows_in_its_own_field(letter):
    trials = experiments.table_trials(letter)
    assert [trial.strategy for trial in trials] == list(TABLE_ROWS)
    assert {trial.vineyard for trial in trials} == {SCENARIOS[letter]}
    # the thesis's tables gave neighbor strategies one viewpoint, all others three
    assert all(trial.viewpoints == (1 if trial.strategy.neighbor else 3) for trial in trials)


@pytest.mark.parametrize("every", [1, 2, 3, 4])
def test_every_plant_has_an_algorithm_of_its_own(every):
    snake, neighbor = experiments.snake_every(every), experiments.neighbor_every(every)
    assert (snake.neighbor, neighbor.neighbor) == (False, True)
    assert snake.every == neighbor.every == every
    assert (snake.algorithm, neighbor.algorithm) == ((1, 6) if every == 1 else (2, 4))


def test_pairs_at_equal_viewpoint_time_differ_in_the_strategy_alone():
    trials = experiments.equal_trials()
    for snake, neighbor in zip(trials[::2], trials[1::2], strict=True):
        assert (snake.strategy.neighbor, neighbor.strategy.neighbor) == (False, True)
        assert snake.strategy.every == neighbor.strategy.every
        for same in ("vineyard", "viewpoints", "severity", "rules", "hours"):
            assert getattr(snake, same) == getattr(neighbor, same)
    assert Counter(trial.rules for trial in trials) == dict.fromkeys(
        (AS_PUBLISHED, NIGHT_CORRECTED, Prose()), 3 * 3 * 4 * 2
    )


def test_every_slip_is_put_right_alone_once_for_each_row():
    by_rules = Counter(trial.rules for trial in experiments.slip_trials())
    assert set(by_rules.values()) == {len(TABLE_ROWS)}
    assert {AS_PUBLISHED.without(name) for name in NAMES} <= set(by_rules)
    assert len(by_rules) == len(NAMES) + 3


def test_algorithm_7_is_tried_as_described_alone():
    scattered = [t for t in experiments.bigger_trials() if t.strategy.algorithm == SCATTERED]
    assert {trial.strategy.every for trial in scattered} == {2, 3, 4}
    assert all(trial.rules == Prose() and trial.viewpoints == 3 for trial in scattered)


def test_bigger_fields_are_those_of_the_thesis():
    fields = list(dict.fromkeys(trial.vineyard for trial in experiments.bigger_trials()))
    assert len(fields) == len(experiments.BIGGER)
    for field, (row_m, dunam) in zip(fields, experiments.BIGGER, strict=True):
        assert field.plants * experiments.BETWEEN_PLANTS_M == pytest.approx(row_m, abs=2)
        # as many rows as the area has room for, to half a row
        rows = 1000 * dunam / (row_m * experiments.BETWEEN_ROWS_M)
        assert abs(field.vine_rows - rows) <= 0.5


def test_the_trend_goes_over_fields_of_rising_size_with_an_aisle_each():
    trials = experiments.trend_trials()
    fields = list(dict.fromkeys(trial.vineyard for trial in trials))
    assert all(field.vine_rows >= 2 for field in fields)
    assert all(isinstance(trial.rules, ListingErrors) for trial in trials)
    faces = sorted(field.faces for field in fields)
    assert faces[-1] > 4 * faces[0]
    by_row = [[f.faces for f in fields if f.plants == p] for p in {f.plants for f in fields}]
    assert all(small < big for sizes in by_row for small, big in pairwise(sizes))
