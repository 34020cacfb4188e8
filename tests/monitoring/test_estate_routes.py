"""An estate's day as files: names in any script, and a table that tells them."""

import csv
import io
from datetime import datetime

from fieldmon.monitoring.estate_routes import EstateRoute, files_named, plan_table, stems

SIX = datetime(2026, 4, 6, 6)


def a_route(plot):
    return EstateRoute(plot, "Ann", SIX, SevenStops(), "adaptive")


class SevenStops:
    end_s, expected_found = 3600.4, 1.234

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
    assert files_named(data) == ["01-a.geojson", "01-a.gpx", "02-מטע.kml"]


def test_another_table_names_no_file():
    for other in (b"plot,who\na,b\n", b"\xff\xfe\x00", b""):
        assert files_named(other) == []
