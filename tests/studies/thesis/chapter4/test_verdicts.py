"""Verdicts: when a cell is equal, near, misprinted or different."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.studies.thesis.chapter4.measures import NoPriorMeasure
from fieldmon.studies.thesis.chapter4.published import Reference
from fieldmon.studies.thesis.chapter4.verdicts import (
    judged_by_table_5,
    judged_by_tables_2_to_4,
    reference_verdict,
    thesis_verdict,
)

CELL = NoPriorMeasure(
    table="2",
    field="A",
    faces=500,
    algorithm=1,
    n="1",
    strategy="snake, every plant",
    severity=0.3,
    viewpoints=3,
    rules="as published",
    measure="PVV_ED1",
    mean=53.0,
    low=53.0,
    high=53.0,
    sd=0.0,
    q05=53.0,
    q95=53.0,
    replicates=400,
    aborted=0.0,
)


@pytest.mark.parametrize(
    ("mean", "sd", "printed", "verdict"),
    [
        (52.84, 0.0, 52.8, "equal"),
        (36.866, 0.0, 36.8, "equal"),  # cut, not rounded
        (36.866, 0.0, 36.9, "equal"),
        (52.8, 0.0, 52.9, "near"),
        (23.9, 0.0, 24.1, "differs"),
        (60.0, 2.0, 63.9, "near"),
        (60.0, 2.0, 64.1, "differs"),
        (60.0, 2.0, 60.04, "equal"),
        (60.0, 2.0, math.nan, ""),
    ],
)
def test_a_printed_cell_gets_its_verdict(mean, sd, printed, verdict):
    cell = replace(CELL, mean=mean, sd=sd)
    assert thesis_verdict(cell, printed, misprinted=False) == verdict


def test_only_a_cell_that_differs_is_called_a_misprint():
    assert thesis_verdict(replace(CELL, mean=37.8), 53.0, misprinted=True) == "misprint"
    assert thesis_verdict(CELL, 53.0, misprinted=True) == "equal"


@pytest.mark.parametrize(
    ("mean", "verdict"),
    [(102.1, "agrees"), (97.9, "agrees"), (102.2, "differs"), (97.8, "differs")],
)
def test_the_reference_agrees_within_three_errors_of_the_difference(mean, verdict):
    """10 / sqrt(400) on both sides: one error of the difference is 0.707, three are 2.12."""
    cell = replace(CELL, mean=mean, sd=10.0)
    assert reference_verdict(cell, Reference(100.0, 10.0, 400)) == verdict


def test_nothing_is_said_where_one_side_has_no_value():
    assert reference_verdict(replace(CELL, replicates=1), Reference(53.0, 0.0, 400)) == ""
    assert reference_verdict(CELL, Reference(math.nan, math.nan, 0)) == ""


def test_a_cell_stands_beside_the_printed_table_and_the_reference():
    cell = judged_by_tables_2_to_4(CELL)
    assert (cell.thesis, cell.reference) == (53.0, 53.0)
    assert (cell.thesis_verdict, cell.reference_verdict) == ("equal", "agrees")


def test_a_known_misprint_is_named():
    cell = judged_by_tables_2_to_4(
        replace(CELL, field="A", algorithm=6, measure="PVV_ED2", mean=64.0)
    )
    assert (cell.thesis, cell.thesis_verdict) == (82.0, "misprint")
    assert "64.0 %" in cell.note


def test_other_severities_have_a_reference_and_no_printed_cell():
    cell = judged_by_tables_2_to_4(replace(CELL, severity=0.9))
    assert math.isnan(cell.thesis)
    assert cell.reference_verdict == "agrees"


def test_days_go_by_the_most_likely_one_and_tell_their_shares():
    days = np.array([1.0] * 73 + [2.0] * 27 + [math.nan])
    cell = replace(CELL, measure="D50", mean=1.27, sd=0.446, replicates=100)
    found = judged_by_table_5(cell, days)
    assert (found.thesis, found.thesis_verdict) == (1.0, "equal")
    assert found.note == "day 1 73%, day 2 27%"
    assert found.reference == pytest.approx(0.728 + 2 * 0.273)
    assert found.reference_verdict == "agrees"
    assert judged_by_table_5(cell, 3 - days).thesis_verdict == "near"
    assert judged_by_table_5(cell, days * 0 + 4).thesis_verdict == "differs"
