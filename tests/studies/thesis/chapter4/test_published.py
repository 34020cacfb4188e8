"""What the thesis prints and the reference holds, as kept in the program."""

import csv
import math

import pytest

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
