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
    here = np.ones(len(found), bool)
    return SimpleNamespace(detection_pct=np.array(percent), found=np.array(found), visit=here)


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


def test_a_way_of_choosing_plants_has_one_colour_on_every_page():
    one = season([10.0], [1])
    band = (np.array([1.0]),) * 3

    def colours(chart):
        scale = spec(chart)["layer"][0]["encoding"]["color"]["scale"]
        return dict(zip(scale["domain"], scale["range"], strict=True))

    samplers = ["naive", "bouncy", "dynamic"]
    days = charts.detection(dict.fromkeys("abc", one), 1, ("day", "%"), samplers)
    compared = charts.bands(
        dict.fromkeys("cad", band), ("day", "%"), ["dynamic", "naive", "dynamic"]
    )
    simulated, several = colours(days), colours(compared)
    assert {name: simulated[name] for name in "ac"} == {name: several[name] for name in "ac"}
    assert len(set(several.values())) == 3, "two of one kind stay apart"


def test_a_band_holds_mean_and_interval():
    one = tuple(np.array(values) for values in ([50.0, 60.0], [40.0, 55.0], [60.0, 65.0]))
    made = rows(charts.bands({"Naive": one}, ("day", "%")))
    assert {(row["day"], row["low"], row["mean"], row["high"]) for row in made} == {
        (1, 40.0, 50.0, 60.0), (2, 55.0, 60.0, 65.0)
    }  # fmt: skip


def test_a_day_without_work_is_a_gap_and_not_a_day_without_finds():
    idle = DayFigures(date(2026, 11, 19), 0, 0, 18.0, 10, 27, 0.01)
    clean = DayFigures(date(2026, 11, 20), 30, 0, 17.0, 10, 26, 0.01)
    chart = charts.season_days([*DAYS, idle, clean], ("day", "inspected", "found"))
    made = {row["day"]: (row["inspected"], row["found"]) for row in rows(chart)}
    nothing = (None, None)
    assert made == {"11-16": (40, 3), "11-17": nothing, "11-18": (45, 5), "11-19": nothing,
                    "11-20": (30, 0)}  # fmt: skip
    line = next(one for one in spec(chart)["layer"] if one["mark"]["type"] == "line")
    assert line["mark"]["invalid"] == "break-paths-filter-domains"


def test_every_day_stands_at_its_place_be_it_without_work_or_figures():
    last = DayFigures(date(2026, 11, 21), 0, 0, 18.0, 10, 27, 0.01)
    every = [f"11-{day}" for day in range(16, 22)]
    worked = charts.season_days([*DAYS, last], ("day", "inspected", "found"))
    left = charts.still_out([*DAYS, last], ("day", "left"))
    for chart in (worked, left):
        for one in spec(chart)["layer"]:
            assert one["encoding"]["x"]["scale"]["domain"] == every


def test_what_is_still_out_there_is_of_the_days_given():
    out = rows(charts.still_out(DAYS, ("day", "left")))
    assert {(row["expected"], row["low"], row["high"]) for row in out} == {
        (21.3, 12, 30), (19.1, 11, 28)
    }  # fmt: skip


def test_finds_are_counted_from_day_one():
    made = rows(charts.found(season([0.0, 0.0], [4, 7]), ("day", "found")))
    assert [(row["day"], row["found"]) for row in made] == [("1", 4), ("2", 7)]
    long = charts.found(season([0.0] * 60, range(60)), ("day", "found")).to_dict()
    assert len(long["encoding"]["x"]["axis"]["values"]) <= 18, "no two run into each other"


def test_a_row_never_inspected_is_told_from_one_inspected_today():
    since = np.array([3.0, 1.0, np.nan, 5.0, 0.0, np.nan])
    line = np.array([1, 1, 2, 3, 4, 4])
    chart = charts.row_ages(since, line, ("row", "days"))
    seen, today, never = (rows_of(chart, k) for k in range(3))
    assert [(row["sign"], row["high"], row["said"]) for row in seen] == [
        ("1", 1.0, "1"), ("3", 5.0, "5"), ("4", 0.0, "today")
    ]  # fmt: skip
    assert [row["sign"] for row in today] == ["4"]
    assert [(row["sign"], row["said"]) for row in never] == [("2", "never")]
    bar = spec(chart)["layer"][2]["mark"]
    assert (bar["type"], bar["filled"]) == ("bar", False)
    for layer in spec(chart)["layer"]:
        assert layer["encoding"]["x"]["scale"]["domain"] == ["1", "2", "3", "4"]


def test_rows_that_are_numbered_with_gaps_or_named_stand_beside_each_other():
    line = np.array([*range(1, 11), *range(21, 31), 101])
    chart = charts.row_ages(np.ones(21), line, ("row", "days"), {101: "101 · 5A"})
    x = spec(chart)["layer"][0]["encoding"]["x"]
    assert x["scale"]["domain"] == [*map(str, line[:-1]), "101 · 5A"]
    assert x["axis"]["values"] == [
        "1", "2", "4", "6", "8", "10", "22", "24", "26", "28", "101 · 5A"
    ]  # fmt: skip


def test_a_plot_of_which_nothing_was_inspected_has_hollow_bars_only():
    chart = charts.row_ages(np.full(3, np.nan), np.arange(3), ("row", "days"))
    assert len(rows_of(chart, 0)) == 3
    assert len(spec(chart)["layer"]) == 1
    assert spec(chart)["layer"][0]["mark"]["filled"] is False


def rows_of(chart, number):
    """Return the rows of data of one layer."""
    made = spec(chart)
    name = made["layer"][number].get("data", made.get("data"))["name"]
    return made["datasets"][name]


def test_days_of_two_years_stay_in_their_order_and_are_named_as_told():
    days = [DayFigures(date(2026, 12, 31), 4, 1, 9.0, 1, 20, 0.0),
            DayFigures(date(2027, 1, 1), 4, 0, 8.0, 1, 19, 0.0)]  # fmt: skip
    chart = charts.still_out(days, ("day", "left"), lambda on: f"{on:%d.%m}")
    assert [row["day"] for row in rows(chart)] == ["31.12", "01.01"]
    scale = spec(chart)["layer"][0]["encoding"]["x"]["scale"]
    assert scale["domain"] == ["31.12", "01.01"]


@pytest.mark.parametrize(("name", "most"), [("{} Nov", 6), ("{} בנוב׳", 4), ("{} نوفمبر", 4)])
def test_dates_of_a_long_season_stand_apart_in_any_language(name, most):
    labels = [name.format(k) for k in range(1, 26)]
    shown = charts._days(labels, "day").to_dict()["axis"]["values"]
    assert len(shown) <= most
    assert shown[0] == labels[0]
    assert charts._days(labels[:3], "day").to_dict()["axis"]["values"] == labels[:3]


def test_only_days_of_visits_have_a_dot():
    level = np.zeros(5)
    made = charts.bands({"one": (level, level, level)}, ("day", "found"), visit_every=2)
    lines = made.to_dict()["layer"][1]
    assert [one["mark"]["type"] for one in lines["layer"]] == ["line", "point"]
    assert lines["layer"][1]["transform"] == [{"filter": "datum.visit"}]


@pytest.mark.parametrize(
    ("found", "most"), [([0, 0], 1), ([0, 3], 3), ([0, 1200], 1200)], ids=["none", "few", "many"]
)
def test_plants_are_counted_in_whole_numbers_from_none_also_where_none_was_found(found, most):
    days = [DayFigures(date(2026, 11, 16 + k), 40, n, 21.3, 12, 30, 0.0)
            for k, n in enumerate(found)]  # fmt: skip
    for one in spec(charts.season_days(days, ("day", "inspected", "found")))["layer"]:
        y = one["encoding"]["y"]
        end = most if y["field"] == "found" else 40
        assert y["scale"] == {"domain": [0, end], "nice": True}
        assert (y["axis"]["tickMinStep"], y["axis"]["format"]) == (1, ",d")
