"""An estate's day as files: names in any script, and a table that tells them."""

import csv
import io
from dataclasses import replace
from datetime import datetime

from fieldmon.monitoring.estate_routes import EstateRoute, plan_table, stems
from tests.monitoring.seasons import a_plot

SIX = datetime(2026, 4, 6, 6)


def a_route(plot):
    return EstateRoute(plot, "Ann", SIX, SevenStops(), "adaptive")


class SevenStops:
    end_s, expected_found, aisles = 3600.4, 1.234, a_plot().aisles

    def __len__(self):
        return 7


def test_plots_of_one_name_have_files_of_their_own():
    assert [*stems([a_route("a/b"), a_route("a/b"), a_route("מטע")])] == [
        "01-a_b", "02-a_b", "03-מטע",
    ]  # fmt: skip


def test_the_table_tells_each_route_once_and_all_its_files():
    data = plan_table({"01-a.geojson 01-a.gpx": a_route("a, b"), "02-מטע.kml": a_route("מטע")})
    first, second = csv.DictReader(io.StringIO(data.decode("utf-8-sig")))
    assert (first["plot"], first["from"], first["to"]) == (
        "a, b", "2026-04-06T06:00:00", "2026-04-06T07:00:00",
    )  # fmt: skip
    assert (second["plants"], second["finds_expected"]) == ("7", "1.23")


def test_the_table_tells_where_nobody_goes_and_who_goes_nowhere():
    data = plan_table({"01-a.gpx": a_route("a")}, {"b": (), "c": ["Closed until 06:30."]}, ["Bo"])
    rows = [*csv.DictReader(io.StringIO(data.decode("utf-8-sig")))]
    assert [(one["plot"], one["who"], one["file"]) for one in rows] == [
        ("a", "Ann", "01-a.gpx"), ("b", "", ""), ("c", "", ""), ("", "Bo", ""),
    ]  # fmt: skip
    assert rows[2]["closed"] == "Closed until 06:30."


def test_no_name_in_the_table_is_run_by_a_spreadsheet():
    named = replace(a_route("=1+1"), who="+cmd", closed=["@a is closed."])
    data = plan_table({"01-a.gpx": named}, {"-b": ("=c is closed.",)}, ["\t=d"])
    rows = [*csv.DictReader(io.StringIO(data.decode("utf-8-sig")))]
    assert [(one["plot"], one["who"], one["closed"]) for one in rows] == [
        ("'=1+1", "'+cmd", "'@a is closed."), ("'-b", "", "'=c is closed."), ("", "'\t=d", ""),
    ]  # fmt: skip


def test_a_turn_over_a_change_of_clocks_ends_when_the_clock_says():
    late = replace(a_route("a"), begins=datetime(2027, 3, 26, 1, 30))
    (row,) = csv.DictReader(io.StringIO(plan_table({"a.gpx": late}).decode("utf-8-sig")))
    assert (row["from"], row["to"]) == ("2027-03-26T01:30:00", "2027-03-26T03:30:00")
