"""Rows of the tidy table."""

import csv
import io
import math

import pytest

from fieldmon.studies.thesis.chapter4.listing_errors import (
    ALL_PUT_RIGHT,
    AS_PUBLISHED,
    NIGHT_CORRECTED,
)
from fieldmon.studies.thesis.chapter4.measures import (
    field_name,
    rules_name,
)
from fieldmon.studies.thesis.chapter4.study import run_no_prior
from fieldmon.studies.thesis.chapter4.trial import NoPriorTrial, Prose, ThesisStrategy
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS, Vineyard
from fieldmon.studies.tidy_csv import csv_text


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
    assert rules_name(NoPriorTrial(SCENARIOS["A"], ThesisStrategy(1), rules=rules)) == name


def test_fields_have_names():
    assert field_name(NoPriorTrial(Vineyard(67, 6, 3.0), ThesisStrategy(1))) == "B"
    assert (
        field_name(NoPriorTrial(Vineyard(70, 15, 3.0), ThesisStrategy(1)))
        == "15 rows x 70 vines, 3 m"
    )


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
