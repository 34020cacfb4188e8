"""The tables made again."""

import math

import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter4 import published
from fieldmon.studies.thesis.chapter4.listing_errors import NAMES
from fieldmon.studies.thesis.chapter4.study import run_no_prior, table_names


def table(study, name):
    return next(table for table in study.tables if table.name == name)


def test_there_is_a_table_for_every_question(everything):
    assert tuple(made.name for made in everything.tables) == table_names()
    assert all(made.cells and made.summary for made in everything.tables)
    assert len(everything.cells) == sum(len(made.cells) for made in everything.tables)


def test_tables_2_to_5_hold_every_printed_cell_beside_ours(everything):
    thesis = published.thesis_cells()
    seen = set()
    for number in ("2", "3", "4", "5"):
        for cell in table(everything, number).cells:
            key = (cell.field, str(cell.algorithm), cell.n, cell.measure)
            if key in thesis:
                seen.add(key)
                known = not math.isnan(thesis[key]) and cell.replicates > 0
                assert (cell.thesis_verdict != "") == known
    assert seen == thesis.keys()


def test_88_of_the_96_cells_that_leave_nothing_to_chance_are_equal_to_the_digit(everything):
    cells = [
        cell
        for number in ("2", "3", "4")
        for cell in table(everything, number).cells
        if cell.measure in ("PVV_ED1", "PVV_ED2", "PVV_ED3", "visited_all") and cell.n != "R"
    ]
    assert len(cells) == 96
    assert all(cell.sd == 0 for cell in cells)
    assert sum(cell.thesis_verdict == "equal" for cell in cells) == 88


def test_the_known_misprints_are_named(everything):
    told = {
        (cell.field, str(cell.algorithm), cell.n, cell.measure)
        for cell in everything.cells
        if cell.thesis_verdict == "misprint" and cell.note
    }
    whole_cells = {key for key in published.MISPRINTS if key[3]}
    assert whole_cells - {("B", "6", "1", "not_detected")} <= told
    assert {key for key in told if key[:3] == ("B", "1", "1")}


def test_the_snake_is_ahead_at_equal_viewpoint_time_on_days_1_and_2_by_the_listings(everything):
    for day in (1, 2):
        pairs = [
            cell
            for cell in table(everything, "equal").cells
            if cell.measure == f"snake - neighbor, found_day{day}" and cell.rules == "as published"
        ]
        assert len(pairs) == 36
        assert all(cell.mean >= 0 for cell in pairs)


def test_with_the_night_put_right_algorithm_6_no_longer_finds_all_in_scenario_c(everything):
    found = {
        cell.rules: cell.mean
        for cell in table(everything, "everywhere").cells
        if cell.field == "C" and cell.measure == "PCD_ED3"
    }
    assert found["as published"] == pytest.approx(99.4, abs=0.5)
    assert found["night corrected"] == pytest.approx(81, abs=2)
    assert found["as described"] == pytest.approx(81, abs=2)


def test_every_slip_has_its_row(everything):
    rules = {cell.rules for cell in table(everything, "slips").cells}
    assert {f"without {name}" for name in NAMES} <= rules
    assert {"as published", "night corrected", "all slips put right"} <= rules


def test_detection_curves_come_with_the_tables_of_scenarios(everything):
    for number in ("2", "3", "4"):
        curves = table(everything, number).curves
        assert len(curves) == 10
        assert all(hours.shape == found.shape for _, hours, found in curves)


def test_one_table_alone_is_the_same_as_among_all(everything):
    alone = run_no_prior("everywhere", everything.replicates, 1)
    assert [repr(cell) for cell in alone.cells] == [
        repr(cell) for cell in table(everything, "everywhere").cells
    ]


def test_progress_is_told():
    told = []
    run_no_prior("2", 2, 1, lambda done, total: told.append((done, total)))
    assert told[-1] == (10, 10)


def test_the_four_printed_tables_share_their_runs():
    told = []
    study = run_no_prior("2-5", 2, 1, lambda _, total: told.append(total))
    assert [made.name for made in study.tables] == ["2", "3", "4", "5"]
    assert set(told) == {30}


def test_an_unknown_table_is_refused_with_the_names_there_are():
    with pytest.raises(SettingError, match=r"one of 2, 3, 4, 5, .* or all, but it is '9'"):
        run_no_prior("9")
