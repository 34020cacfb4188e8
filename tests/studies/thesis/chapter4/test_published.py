"""What the thesis prints and the reference holds, as kept in the program."""

import csv
import math
import re

import pytest

from fieldmon.io.packaged import packaged_text
from fieldmon.studies.thesis.chapter4 import published


def rows(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_cells_are_those_of_the_reference_file(no_prior):
    thesis, reference = published.thesis_cells(), published.reference_cells()
    met = 0
    for row in rows(no_prior / "reference.csv"):
        if row["measure"] not in published.MEASURES:
            continue
        key = (row["scenario"], float(row["severity"]), row["algorithm"], row["n"], row["measure"])
        cell = reference[key]
        assert cell.replicates == int(row["replicates"])
        # kept to six digits, and five
        for ours, theirs, digits in ((cell.mean, row["mean"], 6), (cell.sd, row["std"], 5)):
            if theirs:
                assert ours == pytest.approx(float(theirs), rel=5.1 * 10**-digits)
            else:
                assert math.isnan(ours)
        if row["severity"] == "0.3":
            value = thesis[key[0], *key[2:]]
            assert (
                math.isnan(value)
                if not row["thesis_value"]
                else value == float(row["thesis_value"])
            )
        met += 1
    assert met == len(reference) == 60 * len(published.MEASURES)


def test_the_days_are_those_of_table_5(no_prior):
    thesis, shares = published.thesis_cells(), published.reference_days()
    listed = [row for row in rows(no_prior / "table5.csv") if row["definition"] == "true"]
    for row in listed:
        key = (row["scenario"], row["algorithm"], row["n"], row["threshold"])
        assert thesis[key] == float(row["thesis"])
        columns = ("share_day1", "share_day2", "share_day3", "share_never")
        assert shares[key] == tuple(float(row[column]) for column in columns)
    assert len(listed) == len(shares) == 120


def test_every_known_misprint_names_a_printed_cell():
    cells = published.thesis_cells()
    for scenario, algorithm, n, measure in published.MISPRINTS:
        assert (scenario, algorithm, n, measure or "PVV_ED1") in cells


def test_lost_first_digits_are_the_sum_of_what_stands_beside_them():
    cells = published.thesis_cells()
    for n, whole in (("2", 459), ("4", 518)):
        key = ("B", "2", n)
        assert cells[*key, "detected"] + cells[*key, "not_detected"] == whole
        assert str(whole)[1:] == f"{cells[*key, 'infected']:.0f}"[1:]


def test_what_the_thesis_prints_and_its_listings_gave_is_kept_digit_by_digit():
    """Pinned by hand from tables 2 to 5 and from the reference's runs."""
    thesis = published.thesis_cells()
    assert [thesis["A", "2", "3", measure] for measure in published.MEASURES] == [
        52.8, 53.7, 52.6, 65.6, 52.4, 50.9, 100, 334, 240, 94, 81.2,
    ]  # fmt: skip
    assert thesis["B", "2", "2", "infected"] == 259  # printed so; 266 + 193 are 459
    assert thesis["C", "5", "R", "PCD_ED3"] == 4.6
    assert math.isnan(thesis["A", "6", "1", "PCD_ED3"])
    assert [thesis["C", "6", "1", f"D{k}"] for k in published.THRESHOLDS] == [1, 2, 3, 3]
    reference = published.reference_cells()
    assert reference["A", 0.3, "2", "2", "PCD_ED2"] == (64.4415, 4.3313, 400)
    assert reference["A", 0.9, "6", "1", "PCD_ED3"].replicates == 0
    assert reference["C", 0.3, "4", "2", "infected"] == (471.826, 38.048, 374)
    assert published.reference_days()["A", "3", "R", "D80"] == (0, 0, 0.207, 0.793)
    assert published.MISPRINTS["B", "1", "1", None] == "scenario A's row, printed again"


def test_the_tables_are_full():
    thesis, reference = published.thesis_cells(), published.reference_cells()
    rows = {key[:3] for key in thesis}
    assert len(rows) == 30
    assert len(thesis) == 30 * (len(published.MEASURES) + len(published.THRESHOLDS))
    assert {(key[0], *key[2:4]) for key in reference if key[1] == 0.3} == rows
    assert {key[1] for key in reference if key[0] == "A"} == {0.1, 0.3, 0.5, 0.9}
    assert {key[:3] for key in published.reference_days()} == rows


def test_shares_of_days_are_shares_of_all_replicates():
    for shares in published.reference_days().values():
        assert sum(shares) == pytest.approx(1.0, abs=0.002)  # three digits each


def test_every_table_says_where_its_figures_come_from():
    for name in ("tables_2_to_4", "table_5", "reference", "reference_days", "misprints"):
        text = packaged_text(f"fieldmon/studies/thesis/chapter4/data/{name}.csv")
        assert text.startswith("# ")
        assert re.search(r"tables? [2-5]|appendix A", text)
