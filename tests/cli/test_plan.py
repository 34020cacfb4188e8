"""`fieldmon plan` on one plot."""

import json
import re
from pathlib import Path

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
from shapely import MultiPolygon, Point, box

from tests.cli.estate import MITES, ZIP, square


def test_a_day_is_planned_and_its_route_written(run, tmp_path):
    code, out, err, made = run("plan", ZIP, "--feature", "Gate", "--records", MITES)
    assert code == 0, err
    assert made == {tmp_path / "route.geojson"}
    route = json.loads((tmp_path / "route.geojson").read_text(encoding="utf-8"))
    line, *stops = route["features"]
    assert line["properties"]["plot"] == "Gate"
    assert line["properties"]["stops"] == len(stops) > 100
    assert line["properties"]["seconds"] <= 12 * 3600
    assert f"{len(stops)} of " in out
    assert "seen:" in err


def test_a_short_day_far_below_its_bound_names_the_route_that_no_find_changes(run):
    words = ("plan", ZIP, "--feature", "Gate", "--records", MITES, "--date", "2026-11-18")
    finds = {}
    for hours, more in ((1, ()), (12, ()), (1, ("--robots", 1))):
        code, out, err, _ = run(*words, "--hours", hours, *more)
        assert code == 0, err
        assert ("--robots 1." in out) == (hours == 1 and not more)
        finds[hours, bool(more)] = float(re.search(r"([\d.]+) finds expected", out)[1])
    assert finds[1, True] > 1.05 * finds[1, False]


def test_the_day_says_what_no_other_route_can_expect_unless_it_is_switched_off(run, tmp_path):
    words = ("plan", ZIP, "--feature", "Nursery", "--hours", 1)
    _, out, _, _ = run(*words, "-o", "a.geojson")
    _, silent, _, _ = run(*words, "--no-bound", "-o", "b.geojson")
    said = next(line for line in out.splitlines() if "no route of these hours" in line)
    assert "no route of these hours" not in silent
    told, quiet = (
        json.loads((tmp_path / name).read_text(encoding="utf-8"))["features"][0]["properties"]
        for name in ("a.geojson", "b.geojson")
    )
    assert told["bound"] == said
    assert told["finds_expected"] <= told["finds_bound"]
    assert "finds_bound" not in quiet


def test_what_the_options_say_is_done(run, tmp_path):
    code, out, err, _ = run(
        *["plan", ZIP, "--feature", "Nursery", "--hours", 2, "--look", 20, "--sampler", "bouncy"],
        *["--every", 3, "--row-spacing", 4, "--plant-spacing", 2, "--headland", 3, "--bearing", 70],
        *["--gate", "35.1529,30.3525", "--date", "2026-11-02", "--start", "07:30", "-o", "r.json"],
    )
    assert code == 0, err
    assert "bearing 70.0 degrees, rows 4.00 m and plants 2.00 m apart" in out
    line, first, *_ = json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))["features"]
    assert line["properties"]["start"] == "2026-11-02T07:30:00"
    assert line["properties"]["seconds"] <= 7200
    assert first["properties"]["inspect_s"] == 20 + 1.13  # stopping for it is charged too
    assert line["geometry"]["coordinates"][0] == pytest.approx([35.1529, 30.3525], abs=1e-7)


def test_a_scout_on_foot_does_less_in_a_shorter_day(run, tmp_path):
    for words, name in (([], "robot.json"), (["--scout"], "scout.json")):
        assert run("plan", ZIP, "--feature", "Gate", "-o", name, *words)[0] == 0
    robot, scout = (
        json.loads((tmp_path / name).read_text(encoding="utf-8"))["features"][0]["properties"]
        for name in ("robot.json", "scout.json")
    )
    assert scout["seconds"] <= 4 * 3600 < robot["seconds"]


def test_measured_plants_make_a_plot_without_a_boundary(run, tmp_path):
    xy = np.array([(35.15 + 2e-5 * i, 30.36 + 4e-5 * j) for j in range(8) for i in range(20)])
    plants = gpd.GeoSeries.from_xy(*xy.T, crs=4326)
    plants.to_file(tmp_path / "plants.geojson")
    code, out, err, _ = run("plan", "--plants", "plants.geojson", "-o", "r.json")
    assert code == 0, err
    assert "160 plants in 8 rows, bearing 90.0 degrees" in out


def test_parts_and_holes_are_planned_around(run, tmp_path):
    ring = box(35.15, 30.36, 35.152, 30.3615)
    hole = box(35.1508, 30.3605, 35.1512, 30.3609)
    shape = MultiPolygon([ring.difference(hole), box(35.1525, 30.36, 35.1532, 30.361)])
    square(geometry=shape).to_file(tmp_path / "p.gpkg")
    code, _, err, _ = run("plan", "p.gpkg", "--hours", 10)
    assert code == 0, err
    route = json.loads((tmp_path / "route.geojson").read_text(encoding="utf-8"))
    for stop in route["features"][1:]:
        assert shape.covers(Point(stop["geometry"]["coordinates"]))


def test_records_that_name_rows_and_plants_or_plots_are_taken(run, tmp_path):
    (tmp_path / "r.csv").write_text("row,plant,date,count\n3,7,2026-03-01,4\n99,1,2026-03-01,2\n")
    words = ["plan", ZIP, "--feature", "Gate", "--date", "2026-03-02", "--hours", 1]
    code, _, err, _ = run(*words, "--records", "r.csv")
    assert code == 0, err
    assert "dropped: 1 record names 1 plant not known: 99/1." in err
    (tmp_path / "p.csv").write_text("plot,date,count\nGATE,2026-03-01,4\nMoon,2026-03-01,2\n")
    code, _, err, _ = run(*words, "--records", "p.csv")
    assert code == 0, err
    assert "dropped: 1 record names 1 plot not known: Moon." in err
    assert "1 record is placed to" in err


def test_a_finding_is_printed_with_its_remedy_and_the_remedy_works(run, tmp_path):
    _, lon, lat, *_ = Path(MITES).read_text("utf-8").splitlines()[1].split(",")
    (tmp_path / "r.csv").write_text(f"lon,lat,date,eggs\n{lon},{lat},03/04/2026,4\n")
    words = ["plan", ZIP, "--feature", "Gate", "--date", "2026-05-02", "--hours", 1]
    code, _, err, _ = run(*words, "--records", "r.csv")
    assert code == 2
    assert "none was recognised among: lon, lat, date, eggs" in err
    options = ["--record-option", "columns=count=eggs"]
    code, _, err, _ = run(*words, "--records", "r.csv", *options)
    assert code == 0, err
    assert "(Read month first: --record-option date_order=mdy)" in err
    options += ["--record-option", "date_order=mdy"]
    code, _, err, _ = run(*words, "--records", "r.csv", *options)
    assert code == 0, err
    assert "guessed" not in err
    assert "Counts are in column 'eggs'" in err


def test_what_the_file_of_plants_leaves_open_is_asked_and_answered(run, tmp_path):
    xy = [(214_000 + 2 * i, 474_400 + 4 * j) for j in range(8) for i in range(20)]
    gpd.GeoSeries.from_xy(*zip(*xy, strict=True), crs=2039).to_file(tmp_path / "p.shp")
    (tmp_path / "p.prj").unlink()
    code, _, err, _ = run("plan", "--plants", "p.shp")
    assert code == 2
    assert "Answer with --plants-option crs=" in err
    code, out, err, _ = run("plan", "--plants", "p.shp", "--plants-option", "crs=EPSG:2039")
    assert code == 0, err
    assert "160 plants in 8 rows" in out


def test_a_date_that_is_none_is_said(run, tmp_path):
    square().to_file(tmp_path / "p.geojson")
    rows = "lon,lat,date,count\n35.1505,30.3605,yesterday or so,3\n"
    (tmp_path / "r.csv").write_text(rows, encoding="utf-8")
    code, _, err, _ = run("plan", "p.geojson", "--records", "r.csv")
    assert code == 0
    assert "yesterday or so" in err


@pytest.mark.parametrize("which", [["--feature", "Nursery", "-o", "r.csv"], ["--all"]])
def test_every_is_refused_where_no_plant_would_be_left_out_for_it(run, which):
    code, _, err, made = run("plan", ZIP, "--every", 3, *which)
    assert (code, made) == (2, set())
    assert "--every goes with a sampler that inspects every N-th" in err


def test_a_day_in_which_clocks_change_has_arrivals_as_they_show_them(run, tmp_path):
    words = ("plan", ZIP, "--feature", "Nursery", "--hours", "1", "-o", "r.csv", "--no-bound")
    code, _, err, _ = run(*words, "--date", "2027-03-26", "--start", "01:30")
    assert code == 0, err
    arrive = pd.read_csv(tmp_path / "r.csv")["arrive"].str[11:13]
    assert {*arrive} == {"01", "03"}
