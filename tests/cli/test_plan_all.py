"""`fieldmon plan --all`: the same day on every plot of a file."""

import csv
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.cli import plan_all
from fieldmon.cli.plan_all import _tell
from fieldmon.plot.field import Field
from fieldmon.plot.projection import Frame
from tests.parcels import many, write_geojson

FRAME = Frame(5.0, 45.0)
SHAPES = [
    Field("square", FRAME.geometry_lonlat(MultiPolygon([shapely.box(-30, -25, 30, 25)]))),
    Field(
        "bent",
        FRAME.geometry_lonlat(
            MultiPolygon(
                [shapely.Polygon([(0, 0), (70, 0), (70, 30), (30, 30), (30, 60), (0, 60)])]
            )
        ),
    ),
]


@pytest.fixture
def summary(tmp_path):
    def read(folder="routes"):
        with (tmp_path / folder / "summary.csv").open(encoding="utf-8-sig") as file:
            return {row["plot"]: row for row in csv.DictReader(file)}

    return read


@pytest.fixture
def parcels(tmp_path):
    """Return a file of six plots: two that say who works there, and two that cannot be planned."""
    shapes = many(SHAPES, 5)
    shapes.append(FRAME.geometry_lonlat(shapely.box(0.0, 0.0, 2.0, 2.0)))
    write_geojson(
        tmp_path / "parcels.geojson",
        shapes,
        hours=[None, "1,5", "abc", None, "3.0", 3.0],
        robot=["robot", None, "scout", "donkey", None, None],
    )
    return tmp_path / "parcels.geojson"


def properties(path):
    return json.loads(path.read_text(encoding="utf-8"))["features"][0]["properties"]


def test_every_plot_is_planned_and_those_that_cannot_be_are_named(run, parcels, summary):
    code, out, err, _ = run("plan", parcels, "--all", "-o", "routes", "--date", "2026-11-02")
    assert code == 1, err  # not all of it was done
    rows = summary()
    assert list(rows) == [f"Plot {k}" for k in range(1, 7)]
    refused = {name for name, row in rows.items() if row["state"] == "refused"}
    assert refused == {"Plot 4", "Plot 6"}
    assert "donkey" in rows["Plot 4"]["sentence"]
    assert "refused: Plot 6" in err
    assert (
        "Column 'hours' says what cannot be used, and was left aside, of 1 plot: Plot 3 ('abc')"
        in err
    )
    assert "assumed: row spacing 4 m; plant spacing 3 m; " in err
    assert "speed 2.5 km/h (3 plots: Plot 1, Plot 2, Plot 5)" in err
    assert "row spacing 4 m; plant" in rows["Plot 1"]["assumed"]
    assert "working day 4 h" in rows["Plot 3"]["assumed"]
    assert rows["Plot 3"]["sentence"] == "Column 'hours' was left aside: it says 'abc'."
    assert "working day 12 h" in rows["Plot 1"]["assumed"]
    assert "working day" not in rows["Plot 2"]["assumed"]
    assert {rows[name]["file"] for name in refused} == {""}
    assert "4 of 6 plots planned" in out
    folder = parcels.parent / "routes"
    files = {path.name for path in folder.iterdir()} - {"summary.csv"}
    assert files == {row["file"] for row in rows.values() if row["state"] == "planned"}
    for name, row in rows.items():
        if name not in refused:
            said = properties(folder / row["file"])
            assert said["plot"] == name
            assert said["stops"] == int(row["stops"]) > 0
            assert said["start"] == "2026-11-02T06:00:00"
    assert 1.0 < float(rows["Plot 2"]["hours"]) <= 1.5
    assert float(rows["Plot 1"]["hours"]) > 1.5
    # a scout looks for 30 s and stops for 5, the robot looks for 40
    seconds = properties(folder / rows["Plot 3"]["file"])["inspect_s"]
    assert seconds == pytest.approx(35.0 * int(rows["Plot 3"]["stops"]))


def test_a_plot_planned_in_the_crowd_is_planned_as_it_is_alone(run, parcels, summary):
    words = ["plan", parcels, "--date", "2026-11-02"]
    assert run(*words, "--all", "-o", "routes", "--hours", 2)[0] == 1  # two of the six are refused
    assert run(*words, "--feature", "Plot 5", "-o", "one.geojson", "--hours", 2)[0] == 0
    together = parcels.parent / "routes" / summary()["Plot 5"]["file"]
    assert together.read_bytes() == (parcels.parent / "one.geojson").read_bytes()


def test_what_is_finished_is_not_planned_again_unless_something_changed(run, parcels, summary):
    words = ["plan", parcels, "--all", "-o", "routes", "--hours", 2]
    run(*words)
    first = summary()
    files = [parcels.parent / "routes" / first[name]["file"] for name in ("Plot 1", "Plot 2")]
    files[0].unlink()
    files[1].write_text("left alone")
    assert "5 of 6 plots were planned already" in run(*words)[1]
    assert summary() == first
    assert properties(files[0])["plot"] == "Plot 1"
    assert files[1].read_text() == "left alone"
    assert "already" not in run(*words[:-1], 3)[1]
    assert properties(files[1])["plot"] == "Plot 2"
    (parcels.parent / "routes" / "summary.csv").write_bytes(b"\xff")
    assert "not: it is no text in UTF-8. Delete it" in " ".join(run(*words)[2].split())


def test_no_name_in_the_summary_is_run_by_a_spreadsheet(run, tmp_path, summary):
    write_geojson(tmp_path / "evil.geojson", many(SHAPES, 2), name=['=HYPERLINK("x")', "+cmd"])
    words = "plan", tmp_path / "evil.geojson", "--all", "-o", "routes", "--date", "2026-11-02"
    assert run(*words)[0] == 0
    before = summary()
    assert list(before) == ['\'=HYPERLINK("x")', "'+cmd"]
    assert "2 of 2 plots were planned already" in run(*words)[1]
    assert summary() == before


def test_a_day_that_starts_later_is_planned_again_with_its_own_times(run, parcels, summary):
    words = ["plan", parcels, "--all", "-o", "routes", "--hours", 2, "--date", "2026-11-02"]
    run(*words)
    said = run(*words, "--start", "08:00")[1]
    assert "already" not in said
    route = properties(parcels.parent / "routes" / summary()["Plot 1"]["file"])
    assert route["start"] == "2026-11-02T08:00:00"


@pytest.mark.parametrize("words", [["--robot-times", "thesis"], ["--rover"]])
def test_a_robot_in_the_crowd_is_the_one_that_was_said(run, parcels, summary, words):
    words = ["plan", parcels, "--date", "2026-11-02", "--hours", 2, "--half-canopy", 0.2, *words]
    assert run(*words, "--all", "-o", "routes")[0] == 1  # two are refused
    assert run(*words, "--feature", "Plot 5", "-o", "one.geojson")[0] == 0
    crowd = parcels.parent / "routes" / summary()["Plot 5"]["file"]
    assert crowd.read_bytes() == (parcels.parent / "one.geojson").read_bytes()


def test_a_plot_is_not_refused_for_what_was_found_next_to_it(run, parcels, summary):
    shape = shapely.from_geojson(parcels.read_text(encoding="utf-8")).geoms[0]
    frame = Frame(*shape.centroid.coords[0])
    east_m = frame.geometry_m(shape).bounds[2]
    ((lon, lat),) = frame.lonlat(np.array([[east_m + 60.0, 0.0]]))
    found = f"date,longitude,latitude,count\n2026-11-01,{lon:.7f},{lat:.7f},9\n"
    (parcels.parent / "r.csv").write_text(found)
    words = ["--records", "r.csv", "--date", "2026-11-02", "--hours", 1]
    assert run("plan", parcels, "--all", "-o", "routes", *words)[0] == 1  # two are refused
    assert summary()["Plot 1"]["state"] == "planned"
    code, _, err, _ = run("plan", parcels, "--feature", "Plot 1", "-o", "one.geojson", *words)
    assert code == 0, err
    assert "It counts for plants nearby, if there are any" in err


@pytest.mark.parametrize("words", [["--rover"], ["--robot-times", "thesis"]])
def test_a_scout_is_no_robot_on_any_plot(run, parcels, words):
    code, _, err, made = run("plan", parcels, "--all", "--scout", *words)
    assert (code, made) == (2, set())
    assert "scout" in err


def test_a_run_that_is_stopped_keeps_what_is_finished_and_goes_on(
    run, tmp_path, summary, monkeypatch
):
    shapes = many(SHAPES, 12)
    write_geojson(tmp_path / "parcels.geojson", shapes)
    # whoever runs the tests in the background has children that do not hear Ctrl-C
    hears = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    code = f"{hears}from fieldmon.cli.main import main; main()"
    words = [sys.executable, "-c", code, "plan", "parcels.geojson", "--all", "-o", "r"]
    command = subprocess.Popen(
        words, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    until = time.monotonic() + 200
    while not list((tmp_path / "r").glob("*.geojson")) and time.monotonic() < until:
        time.sleep(0.02)
    os.kill(command.pid, signal.SIGINT)
    _, complaint = command.communicate(timeout=100)
    assert command.returncode == 130, complaint
    assert "Traceback" not in complaint
    half = [name for name, row in summary("r").items() if row["state"] == "planned"]
    assert 0 < len(half) < 12 == len(summary("r"))
    said = f"{len(half)} of 12 plots planned; the same command goes on from there.\n"
    assert complaint.endswith(said)
    # as the stopped run did, but here: starting workers again takes longer than the plots do
    monkeypatch.setattr(plan_all, "_FEW", 12)
    code, said, err, _ = run("plan", "parcels.geojson", "--all", "-o", "r")
    assert code == 0, err
    assert f"{len(half)} of 12 plots were planned already" in said
    assert len(summary("r")) == 12
    assert all(row["state"] == "planned" for row in summary("r").values())


def test_who_stops_another_day_reads_which_routes_are_of_the_day_before(
    run, parcels, summary, monkeypatch
):
    words = ["plan", parcels, "--all", "-o", "routes", "--hours", 1, "--no-bound", "--date"]
    assert run(*words, "2026-11-02")[0] == 1  # two are refused
    before = {name: row["file"] for name, row in summary().items()}
    work, left = plan_all._work, iter([True] * 2)

    def stopped(*task):
        if not next(left, False):
            raise KeyboardInterrupt
        return work(*task)

    monkeypatch.setattr(plan_all, "_work", stopped)
    code, _, err, _ = run(*words, "2026-11-03")
    assert code == 130
    assert "2 of 6 plots planned; the same command goes on from there." in err
    files = f"{before['Plot 3']}, {before['Plot 5']}."
    assert f"Of an earlier run there are 2 routes still in routes: {files}" in " ".join(err.split())
    assert "nothing was written" not in err
    assert [row["state"] for row in summary().values()] == ["planned"] * 2 + ["not planned"] * 4
    assert {row["file"] for row in summary().values()} == {before["Plot 1"], before["Plot 2"], ""}
    monkeypatch.setattr(plan_all, "_work", work)
    # the routes of the day before that are gone are not taken for those
    assert "already" not in run(*words, "2026-11-02")[1]


@pytest.mark.parametrize("words", [["--feature", "1"], ["--gate", "5,45"]])
def test_what_is_of_one_plot_only_is_refused(run, parcels, words):
    code, _, err, made = run("plan", parcels, "--all", *words)
    assert (code, made) == (2, set())
    assert "--all plans every plot" in err


def test_hours_of_all_plots_are_told_to_the_tenth(capsys, tmp_path):
    rows = {
        name: {"plot": name, "state": "planned", "stops": 250, "hours": hours}
        for name, hours in (("one", 2.7), ("two", 2.7))
    }
    _tell(rows, tmp_path)
    assert "500 plants in 5.4 h." in capsys.readouterr().out
