"""A plot that nobody here made goes in, a route that a robot could drive comes out."""

import json
import sys
from itertools import pairwise

import numpy as np
import pytest
import shapely
from pyproj import Geod

from fieldmon.cli import main
from fieldmon.io.options import PlotOptions, RecordOptions
from fieldmon.io.read import read_plots, read_records
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.plot import Plot
from tests.crossing import crosses_rows

GEOD = Geod(ellps="WGS84")
PARCELS = "parcels_orchards_vineyards"
PLOTS = {
    "Aveiro": (f"{PARCELS}/aveiro_vinha_olival_epsg3763.gpkg", "3"),
    "California": (f"{PARCELS}/california_tuolumne_vineyard_apple_epsg4269_Z.gpkg", "1"),
    "France": (f"{PARCELS}/france_vignes_epsg2154.gpkg", "1"),
    "Lleida": (f"{PARCELS}/lleida_apricot_orchards_epsg25831.gpkg", "14"),
    "Rhineland-Palatinate": ("parcels_rlp_vineyards/vineyards.shp", "2"),
}
BANANAS = "banana_fusarium/FusariumBanana.csv"
VINES = "riseholme_vines/riseholme_vineyard_lat_long_vines.csv"


@pytest.fixture
def plan(monkeypatch, tmp_path, capsys):
    """Run `fieldmon plan` and return the route file's features and what was printed."""

    def run(*words):
        to = tmp_path / "route.geojson"
        monkeypatch.setattr(sys, "argv", ["fieldmon", "plan", *map(str, words), "-o", str(to)])
        with pytest.raises(SystemExit) as stop:
            main.main()
        assert stop.value.code == 0
        said = capsys.readouterr().out
        return json.loads(to.read_text(encoding="utf-8"))["features"], said

    return run


def metres(line):
    """Return the length of a lon/lat line on the ellipsoid."""
    lon, lat = np.array(line["geometry"]["coordinates"]).T
    return GEOD.line_length(lon, lat)


def check_times(line, stops):
    """Check that the seconds on the file are those of its own line and stops."""
    summary = line["properties"]
    assert len(stops) == summary["stops"] > 0
    assert summary["drive_m"] == pytest.approx(metres(line), rel=1e-5, abs=0.05)
    rows_changed = sum(a["row"] != b["row"] for a, b in pairwise(stops))
    seconds = summary["drive_m"] * 3.6 / 2.5 + 41.13 * len(stops) + 9 * rows_changed
    # a row cut by a hole or a gap between parts changes aisles, but keeps its number
    assert seconds <= summary["seconds"] + 1 <= 12 * 3600 + 1
    assert summary["seconds"] <= seconds + 9 * len(stops)
    assert len({stop["plant"] for stop in stops}) == len(stops)
    assert [stop["order"] for stop in stops] == list(range(1, len(stops) + 1))


@pytest.mark.parametrize("name", PLOTS)
def test_a_route_is_planned_on_a_real_parcel(shared, plan, name):
    file, feature = PLOTS[name]
    (line, *stops), _ = plan(shared / file, "--feature", feature)
    check_times(line, [stop["properties"] for stop in stops])
    (field,) = read_plots(shared / file, PlotOptions(feature=feature)).value
    places = shapely.points([stop["geometry"]["coordinates"] for stop in stops])
    assert shapely.covers(field.boundary, places).all()


@pytest.mark.parametrize("name", PLOTS)
def test_the_line_on_a_real_parcel_crosses_no_row(shared, name):
    file, feature = PLOTS[name]
    plot = Plot.of(read_plots(shared / file, PlotOptions(feature=feature)).value[0])
    none = read_records_of_nowhere()
    route = first_day(plot, none, np.datetime64("2026-11-21"), PlanSettings()).route
    assert not crosses_rows(plot.grid, route.line_m)


def read_records_of_nowhere():
    from fieldmon.infestation.records import Records

    return Records.none()


def test_diseased_bananas_draw_the_route_to_them(shared, plan):
    corners = ["--plot-option", "where=marker=polygon", "--row-spacing", 3, "--plant-spacing", 3]
    sick = ["--records", shared / BANANAS, "--record-option", "where=marker=plantas",
            "--record-option", "columns=present="]  # fmt: skip
    (line, *stops), _ = plan(shared / BANANAS, *corners, *sick, "--hours", 3)
    check_times(line, [stop["properties"] for stop in stops])
    options = RecordOptions().choose("where", "marker=plantas").naming(present="")
    records = read_records(shared / BANANAS, options).value
    assert len(records) == 159
    chance = np.array([stop["properties"]["chance"] for stop in stops])
    lon, lat = np.array([stop["geometry"]["coordinates"] for stop in stops]).T
    nearest = [
        GEOD.inv(
            *[np.full(len(records), x) for x in (lon[k], lat[k])], *records.lonlat.T
        )[2].min()
        for k in range(len(stops))
    ]  # fmt: skip
    assert np.median(nearest) < 6.0
    assert chance.min() > 0.1


def test_the_riseholme_vines_are_visited_row_by_row(shared, plan):
    (line, *stops), said = plan("--plants", shared / VINES)
    assert "120 plants in 10 rows" in said
    assert "rows 2.50 m and plants 1.39 m apart" in said
    check_times(line, [stop["properties"] for stop in stops])
    assert len(stops) == 120
    # vine ROW01VINE01 as surveyed
    places = np.array([stop["geometry"]["coordinates"] for stop in stops])
    assert np.abs(places - [-0.52427621, 53.26818125]).max(axis=1).min() < 1e-8
