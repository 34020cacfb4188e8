"""A problem is a sentence with exit code 2, and nothing is written."""

import pytest
from shapely import Point, Polygon, box

from fieldmon.cli import plan, plan_options
from tests.cli.estate import BEGINS, MITES, ZIP, square


def no_geometry(folder):
    (folder / "p.csv").write_text("name,ha\na,1\n", encoding="utf-8")
    return ["plan", "p.csv"]


def no_crs(folder):
    plot = square(geometry=box(209_000, 470_000, 209_100, 470_100))
    plot.set_crs(2039, allow_override=True).to_file(folder / "p.shp")
    (folder / "p.prj").unlink()
    return ["plan", "p.shp"]


def empty_geometry(folder):
    square(geometry=Polygon()).to_file(folder / "p.geojson")
    return ["plan", "p.geojson"]


def too_small(folder):
    square(geometry=Point(35.15, 30.36).buffer(2e-5)).to_file(folder / "p.geojson")
    return ["plan", "p.geojson"]


def records_elsewhere(folder):
    square().to_file(folder / "p.geojson")
    (folder / "r.csv").write_text("lon,lat,date,count\n8.0,49.0,2026-11-01,3\n", encoding="utf-8")
    return ["plan", "p.geojson", "--records", "r.csv"]


def nothing_at_all(_):
    return ["plan"]


def several_plots(_):
    return ["plan", ZIP]


def no_file(_):
    return ["plan", "nowhere.zip"]


def rubbish(folder):
    (folder / "p.zip").write_bytes(b"PK\x03\x04 not a zip at all")
    return ["plan", "p.zip"]


def no_folder(_):
    return ["plan", ZIP, "--feature", "Gate", "-o", "none/route.geojson"]


def no_plain_file(folder):
    (folder / "full.geojson").symlink_to("/dev/full")
    return ["plan", ZIP, "--feature", "Gate", "-o", "full.geojson"]


def bad_day(_):
    return ["plan", ZIP, "--feature", "Gate", "--date", "16.11.2026"]


def bad_gate(_):
    return ["plan", ZIP, "--feature", "Gate", "--gate", "here"]


def bad_start(_):
    return ["plan", ZIP, "--feature", "Gate", "--start", "dawn"]


def no_time(_):
    return ["plan", ZIP, "--feature", "Gate", "--hours", "0.01"]


def no_share(_):
    return ["simulate", ZIP, "--feature", "Gate", "--infested", "0"]


def no_number(_):
    return ["plan", ZIP, "--feature", "Gate", "--hours", "all day"]


def no_whole_number(_):
    return ["simulate", ZIP, "--feature", "Gate", "--days", "2.5"]


def no_robot(_):
    return ["drive", ZIP, "--feature", "Gate", "--robot", "real"]


def bad_option(_):
    return ["plan", ZIP, "--feature", "Gate", "--plot-option", "crs"]


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (no_geometry, "longitudes"),
        (no_crs, "--crs"),
        (empty_geometry, "geometry"),
        (too_small, "room for one plant"),
        (records_elsewhere, "km"),
        (nothing_at_all, "--plants FILE"),
        (several_plots, "--feature"),
        (no_file, "nowhere.zip"),
        (rubbish, "p.zip"),
        (no_folder, "folder none must exist"),
        (no_plain_file, "not a plain file"),
        (bad_day, "YYYY-MM-DD"),
        (bad_gate, "LON,LAT"),
        (bad_start, "HH:MM"),
        (no_time, "Give more --hours"),
        (no_share, "between 0 and 1"),
        (bad_option, "NAME=VALUE"),
        (no_number, "--hours must be a number, but it is 'all day'."),
        (no_whole_number, "--days must be a whole number, but it is '2.5'."),
        (no_robot, "--robot must be one of charged, mujoco, vda5050, but it is 'real'."),
    ],
)
def test_bad_input_is_a_sentence_with_exit_code_2_and_nothing_written(run, tmp_path, make, says):
    words = make(tmp_path)
    code, _, err, made = run(*words)
    assert (code, made) == (2, set())
    last = err.strip().splitlines()[-1]
    assert says in last
    assert last.endswith((".", "?"))
    assert "Traceback" not in err


def test_a_mistake_of_our_own_is_an_apology_without_traceback(run, monkeypatch):
    monkeypatch.setattr(plan_options, "day", lambda _: 1 / 0)
    code, _, err, _ = run("plan", ZIP)
    assert code == 1
    assert "Sorry" in err
    assert "FIELDMON_DEBUG" in err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["plan", "season.gpkg", "--hours", "3"], "fieldmon change"),
        (["plan", "season.gpkg", "--date", "2026-10-01"], "began on"),
        (["plan", "season.gpkg", "--now", "noon"], "HH:MM"),
        (["plan", ZIP, "--now", "11:00"], "needs a season"),
        (["plan", "season.gpkg", "--date", BEGINS, "--now", "23:00"], "long enough"),
        (["init", "season.gpkg", ZIP, "--feature", "1"], "never overwritten"),
        (["status", "none.gpkg"], "there is none"),
        (["status", MITES], "must be the file of a season"),
        (["undo", "season.gpkg"], "nothing"),
        (["undo", "season.gpkg", "--batch", "1", "--inspection", "1"], "not two"),
        (["undo", "season.gpkg", "--batch", "1", "--change"], "not two"),
        (["treat", "season.gpkg", "--efficacy", "5"], "0..1"),
        (["record", "season.gpkg", "none.csv"], "none.csv"),
        (["change", "season.gpkg", "--sampler", "best"], "one of"),
        (["salvage", "none.gpkg", "-o", "x.gpkg"], "there is none"),
    ],
)
def test_what_does_not_fit_is_a_sentence(run, season, words, says):
    before = season.read_bytes()
    code, _, err, made = run(*words)
    assert (code, made) == (2, set())
    assert says in err
    assert season.read_bytes() == before


def test_a_command_that_is_stopped_says_so(run, monkeypatch):
    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(plan, "_plan_one", stopped)
    code, out, err, made = run("plan", ZIP, "--feature", "Gate")
    assert (code, out, made) == (130, "", set())
    assert err == "Stopped; nothing was written that is not complete.\n"
