"""What a table comes to, in sentences with numbers."""

from dataclasses import replace

import pytest

from fieldmon.studies.thesis.chapter4 import summaries
from fieldmon.studies.thesis.chapter4.verdicts import AGREES, DIFFERS, EQUAL, MISPRINT, NEAR
from tests.studies.thesis.chapter4.test_verdicts import CELL


def measured(**changes):
    return replace(CELL, **changes)


def test_verdicts_are_counted():
    cells = [
        measured(thesis_verdict=EQUAL),
        measured(thesis_verdict=EQUAL, sd=2.0),
        measured(thesis_verdict=NEAR, measure="PCD_ED1", sd=2.0),
        measured(thesis_verdict=MISPRINT),
        measured(thesis_verdict=DIFFERS, sd=1.0),
        measured(),
        measured(reference_verdict=AGREES),
        measured(reference_verdict=DIFFERS),
    ]
    printed, fixed, reference = summaries.say_verdicts(cells)
    assert printed.startswith("Of 5 printed cells 2 are equal to our mean, as printed; 1 are near")
    assert "1 are known misprints and 1 differ." in printed
    assert "Of the 2 cells of faces visited in which nothing is random, 1 are equal" in fixed
    assert "agree with the reference in 1 of 2 cells" in reference


def test_table_5_goes_by_the_most_likely_day():
    (said,) = summaries.say_verdicts([measured(measure="D50", thesis_verdict=EQUAL, sd=1.0)])
    assert "equal to our most likely day" in said


def test_nothing_compared_is_nothing_said():
    assert summaries.say_verdicts([measured()]) == ()


def test_pairs_are_counted_day_by_day_under_each_set_of_rules():
    cells = [
        measured(measure=f"snake - neighbor, found_day{day}", rules=rules, mean=mean, high=high)
        for rules, day, mean, high in (
            ("as published", 1, 3.0, 4.0),
            ("as published", 1, 0.0, 1.0),
            ("as published", 2, -1.0, 0.5),
            ("as described", 1, -5.0, -2.0),
            ("as described", 1, -1.0, 2.0),
        )
    ]
    published, described = summaries.say_pairs(cells)
    assert "as published" in published
    assert published.endswith("strategy in: day 1: 2 of 2; day 2: 0 of 1.")
    assert described.endswith("day 1: 0 of 2 (beyond chance less in 1).")


def test_what_algorithm_6_finds_is_said_field_by_field():
    cells = [
        measured(measure="PCD_ED3", field="C", rules="as published", mean=99.44),
        measured(measure="PCD_ED3", field="C", rules="night corrected", mean=81.0),
        measured(measure="PCD_ED3", field="15 rows x 70 vines, 3 m", replicates=0),
        measured(measure="PCD_ED2", field="A"),
    ]
    scenario, other = summaries.say_everywhere(cells)
    what = "of the faces infested on the third morning"
    found = "algorithm 6 finds 99.4 % as published, 81.0 % night corrected"
    assert scenario == f"Scenario C: {what} {found}."
    assert other == f"15 rows x 70 vines, 3 m: {what} there are none left to find."


def test_the_trend_goes_from_the_smallest_plot_to_the_biggest():
    cells = [
        measured(measure="PCD_ALL", faces=faces, mean=mean)
        for faces, mean in ((900, 50.0), (300, 90.4), (600, 70.0))
    ]
    (said,) = summaries.say_trend(cells)
    assert said == (
        "From 300 to 900 faces the share detected in three days falls: algorithm 1 (N = 1) 90 to "
        "50 %."
    )


def test_bigger_fields_are_told_with_n_where_it_is_no_draw():
    cells = [
        measured(measure="PCD_ALL", field="B", algorithm=3, n="R", mean=12.4),
        measured(measure="PCD_ALL", field="B", algorithm=7, n="2", mean=30.0),
    ]
    (said,) = summaries.say_bigger(cells)
    assert said.startswith("Scenario B, 500 faces, as published, detected in three days: ")
    assert said.endswith(": algorithm 3 12 %, algorithm 7, N = 2 30 %.")


@pytest.mark.parametrize(
    ("measure", "words"),
    [
        ("PCD_ALL", "detected in three days changes by up to -20.0 points (algorithm 2, N = 3)"),
        ("curve_listed_day3", "what the listing says is detected changes by up to -20.0 points"),
    ],
)
def test_the_strategy_that_a_slip_changes_most_is_named(measure, words):
    cells = [
        measured(measure=name, algorithm=algorithm, n=n, rules=rules,
                 mean=mean if name == measure else 50.0)
        for name in ("PCD_ALL", "curve_listed_day3")
        for algorithm, n, rules, mean in (
            (1, "1", "as published", 50.0), (1, "1", "without travel_once", 55.0),
            (2, "3", "as published", 50.0), (2, "3", "without travel_once", 30.0),
        )
    ]  # fmt: skip
    (said,) = summaries.say_slips(cells)
    assert said.startswith("Without travel_once: ")
    assert words in said
