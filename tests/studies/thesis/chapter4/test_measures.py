"""Rows of the tidy table."""

import csv
import io
import math

import numpy as np
import pytest
from scipy import stats

from fieldmon.studies.thesis.chapter4.listing_errors import (
    ALL_PUT_RIGHT,
    AS_PUBLISHED,
    NIGHT_CORRECTED,
)
from fieldmon.studies.thesis.chapter4.measures import csv_text, field_name, rules_name, spread_of
from fieldmon.studies.thesis.chapter4.study import run_no_prior
from fieldmon.studies.thesis.chapter4.trial import Prose, Strategy, Trial
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS, Vineyard


def test_the_interval_is_students():
    values = np.array([3.0, 5.0, 4.0, 9.0, math.nan, 2.0])
    spread = spread_of(values)
    known = values[~np.isnan(values)]
    low, high = stats.t.interval(0.95, 4, known.mean(), stats.sem(known))
    assert (spread.low, spread.high) == pytest.approx((low, high))
    assert spread.replicates == 5


def test_one_value_has_no_interval_none_has_no_mean_and_equal_ones_no_spread():
    assert math.isnan(spread_of(np.array([3.0, math.nan])).low)
    assert math.isnan(spread_of(np.array([math.nan])).mean)
    tenths = spread_of(np.full(400, 52.8))
    assert (tenths.mean, tenths.sd, tenths.low) == (52.8, 0.0, 52.8)


@pytest.mark.parametrize(
    ("rules", "name"),
    [
        (AS_PUBLISHED, "as published"),
        (NIGHT_CORRECTED, "night corrected"),
        (ALL_PUT_RIGHT, "all slips put right"),
        (AS_PUBLISHED.without("travel_once"), "without travel_once"),
        (Prose(), "as described"),
        (Prose(reenter_anywhere=True), "as described, reenter_anywhere"),
    ],
)
def test_rules_have_names(rules, name):
    assert rules_name(Trial(SCENARIOS["A"], Strategy(1), rules=rules)) == name


def test_fields_have_names():
    assert field_name(Trial(Vineyard(67, 6, 3.0), Strategy(1))) == "B"
    assert field_name(Trial(Vineyard(70, 15, 3.0), Strategy(1))) == "15 rows x 70 vines, 3 m"


def test_the_csv_holds_every_cell_and_leaves_unknown_values_empty():
    cells = run_no_prior("2", 2).cells
    rows = list(csv.DictReader(io.StringIO(csv_text(cells))))
    assert len(rows) == len(cells)
    for row, cell in zip(rows, cells, strict=True):
        assert (row["measure"], row["strategy"]) == (cell.measure, cell.strategy)
        if math.isnan(cell.thesis):
            assert row["thesis"] == ""
        else:
            assert float(row["thesis"]) == cell.thesis
    assert "nan" not in csv_text(cells).lower()
