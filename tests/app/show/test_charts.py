"""Charts hold the numbers they are given, by names that stay apart."""

import json
from datetime import date
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from app.show import charts
from fieldmon.monitoring import DayFigures


def spec(chart):
    return json.loads(chart.to_json())


def rows(chart):
    """Return every row of data in a chart."""
    return [row for data in spec(chart)["datasets"].values() for row in data]


def season(percent, found):
    return SimpleNamespace(detection_pct=np.array(percent), found=np.array(found))


DAYS = [DayFigures(date(2026, 11, 16), 40, 3, 21.3, 12, 30, 0.0),
        DayFigures(date(2026, 11, 18), 45, 5, 19.1, 11, 28, 0.01)]  # fmt: skip


def test_detection_is_a_line_a_sampler_and_a_rule_at_the_day_shown():
    chart = charts.detection(
        {"Naive": season([10.0, 20.0], [1, 1]), "Dynamic": season([30.0, 60.0], [3, 3])}, 2,
        ("day", "found"),
    )  # fmt: skip
    lines = [row for row in rows(chart) if "strategy" in row]
    assert {(row["strategy"], row["day"], row["mean"]) for row in lines} == {
        ("Naive", 1, 10.0), ("Naive", 2, 20.0), ("Dynamic", 1, 30.0), ("Dynamic", 2, 60.0)
    }  # fmt: skip
    assert [row for row in rows(chart) if "strategy" not in row] == [{"day": 2}]


def test_curves_count_days_from_the_index():
    table = pd.DataFrame({"a": [1.0, 2.0]}, index=[1, 2])
    assert {(row["day"], row["mean"]) for row in rows(charts.curves(table, ("day", "%")))} == {
        (1, 1.0), (2, 2.0)
    }  # fmt: skip


@pytest.mark.parametrize("n", [1, 7, 8, 20])
def test_lines_are_told_apart_by_colour_and_dashes_together(n):
    table = pd.DataFrame({f"line {k}": [1.0, 2.0] for k in range(n)}, index=[1, 2])
    encoding = spec(charts.curves(table, ("day", "%")))["encoding"]
    colours, dashes = (encoding[name]["scale"]["range"] for name in ("color", "strokeDash"))
    pens = {(colour, tuple(dash)) for colour, dash in zip(colours, dashes, strict=True)}
    assert len(pens) == n


def test_a_band_holds_mean_and_interval():
    one = tuple(np.array(values) for values in ([50.0, 60.0], [40.0, 55.0], [60.0, 65.0]))
    made = rows(charts.bands({"Naive": one}, ("day", "%")))
    assert {(row["day"], row["low"], row["mean"], row["high"]) for row in made} == {
        (1, 40.0, 50.0, 60.0), (2, 55.0, 60.0, 65.0)
    }  # fmt: skip


def test_days_of_a_season_are_those_given():
    made = rows(charts.season_days(DAYS, ("day", "inspected", "found")))
    assert {(row["day"], row["inspected"], row["found"]) for row in made} == {
        ("11-16", 40, 3), ("11-18", 45, 5)
    }  # fmt: skip
    out = rows(charts.still_out(DAYS, ("day", "left")))
    assert {(row["expected"], row["low"], row["high"]) for row in out} == {
        (21.3, 12, 30), (19.1, 11, 28)
    }  # fmt: skip


def test_finds_are_counted_from_day_one():
    made = rows(charts.found(season([0.0, 0.0], [4, 7]), ("day", "found")))
    assert [(row["day"], row["found"]) for row in made] == [(1, 4), (2, 7)]


def test_a_row_in_parts_was_last_inspected_when_its_latest_part_was_and_unseen_rows_are_left_out():
    since = np.array([3.0, 1.0, np.nan, 5.0])
    line = np.array([1, 1, 2, 3])
    made = rows(charts.row_ages(since, line, ("row", "days")))
    assert [(row["row"], row["days"]) for row in made] == [(1, 1.0), (3, 5.0)]
