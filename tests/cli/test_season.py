"""A season from the command line, as a person works with it: plan, go out, record, plan again."""

import csv
import json
import shutil
from datetime import date, timedelta

import numpy as np
import pyogrio
import pytest
import shapely

from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring import Season
from tests.cli.test_main import run  # noqa: F401 - a fixture
from tests.paths import SAMPLE_DATA

ESTATE = SAMPLE_DATA / "paran_estate.zip"
RECORDS = ESTATE.with_name("mite_records.csv")
BEGINS = "2026-11-02"


@pytest.fixture
def season(run, tmp_path):  # noqa: F811
    code, out, err, _ = run(
        *("init", "season.gpkg", ESTATE, "--feature", "Nursery", "--observations", RECORDS),
        *("--begins", BEGINS, "--hours", "1"),
    )
    assert code == 0, err
    assert "Season begun" in out
    return tmp_path / "season.gpkg"


def filled_in(path, finds, n=None):
    """Fill in a route's CSV as a scout does: every n-th stop done, finds marked."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    done = rows[:n]
    for k, row in enumerate(done):
        row["found"] = "yes" if k in finds else "no"
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    return [int(row["plant"]) for row in done]


def test_a_day_from_plan_to_status(run, season, tmp_path):  # noqa: F811
    code, out, err, made = run("plan", season, "--date", BEGINS, "-o", "r.csv", "-o", "r.geojson")
    assert code == 0, err
    assert {path.name for path in made} == {"r.csv", "r.geojson"}
    plants = filled_in(tmp_path / "r.csv", finds={1, 4}, n=10)
    code, out, err, _ = run("record", season, "r.csv", "--date", BEGINS, "--who", "Ann")
    assert code == 0, err
    assert "10 new, 0 known" in out
    assert "2 found infested" in out
    code, out, _, _ = run("record", season, "r.csv", "--date", BEGINS, "--who", "Ben")
    assert "0 new, 10 known" in out
    history = Season(season).history
    assert sorted(history.inspections.plant) == sorted(plants)
    assert np.count_nonzero(history.inspections.result == FOUND) == 2
    code, out, _, _ = run("status", season, "--batches", "--rows")
    assert "r.csv" in out
    assert "by Ann" in out
    assert "never" in out
    assert "chance it is clean" in out


def test_half_way_the_rest_of_the_day_is_planned(run, season, tmp_path):  # noqa: F811
    run("plan", season, "--date", BEGINS, "-o", "r.csv")
    plants = filled_in(tmp_path / "r.csv", finds={0}, n=5)
    run("record", season, "r.csv", "--date", BEGINS)
    code, out, err, _ = run("plan", season, "--date", BEGINS, "--now", "06:30", "-o", "r2.geojson")
    assert code == 0, err
    assert "5 done" in out
    features = json.loads((tmp_path / "r2.geojson").read_text(encoding="utf-8"))["features"]
    assert features[0]["properties"]["start"] == f"{BEGINS}T06:30:00"
    assert not {f["properties"].get("plant") for f in features} & set(plants)


def test_undo_and_treat(run, season, tmp_path):  # noqa: F811
    run("plan", season, "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r.csv", finds={0}, n=5)
    before = Season(season).evening(date.fromisoformat(BEGINS))
    run("record", season, "r.csv", "--date", BEGINS)
    code, out, _, _ = run("undo", season)
    assert (code, "5 findings from r.csv" in out) == (0, True)
    assert np.array_equal(Season(season).evening(date.fromisoformat(BEGINS)), before)
    code, out, err, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert code == 0, err
    assert Season(season).evening(date.fromisoformat(BEGINS)) == pytest.approx(before / 2)
    code, out, _, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert "nothing changed" in out


def test_ten_days_by_command_are_ten_days_of_the_library(run, season, tmp_path):  # noqa: F811
    """The app calls the library: the same findings give the same belief and the same routes."""
    with_library = Season.create(
        tmp_path / "library.gpkg",
        Season(season).plot,
        Season(season).observations,
        Season(season).settings,
    )
    for day in range(10):
        on = date.fromisoformat(BEGINS) + timedelta(days=day)
        code, _, err, _ = run("plan", season, "--date", on, "-o", "r.csv")
        assert code == 0, err
        plants = filled_in(tmp_path / "r.csv", finds={day, day + 3}, n=12)
        code, _, err, _ = run("record", season, "r.csv", "--date", on)
        assert code == 0, err
        assert with_library.plan(on).route.plant[:12].tolist() == plants
        found = np.isin(np.arange(12), [day, day + 3])
        with_library.record(Inspections.of(np.array(plants), found, np.datetime64(on)), "app")
        assert np.array_equal(with_library.evening(on), Season(season).evening(on))
    assert len(with_library.history.inspections) == 120


def test_what_qfield_adds_to_a_copy_comes_back_and_what_was_undone_does_not(
    run,  # noqa: F811
    season,
    tmp_path,
):
    run("plan", season, "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r.csv", finds={0}, n=5)
    run("record", season, "r.csv", "--date", BEGINS)
    copy = shutil.copy(season, tmp_path / "copy.gpkg")
    grid = Season(season).plot.grid
    extra = pyogrio.read_dataframe(copy, layer="inspections").tail(1)
    extra.geometry = shapely.points(grid.lonlat(np.array([77])))
    extra[["digest", "batch", "undone", "plant", "line", "number", "day"]] = None
    extra[["result", "count"]] = ["found", 4]
    pyogrio.write_dataframe(extra, copy, layer="inspections", append=True)
    code, out, err, _ = run("record", season, copy)
    assert code == 0, err
    assert "1 new, 5 known" in out
    assert Season(season).history.inspections.plant[-1] == 77
    run("undo", season, "--batch", 1)
    copy = shutil.copy(season, tmp_path / "later.gpkg")
    code, out, err, _ = run("record", season, copy)
    assert "0 new, 1 known" in out


def test_choices_can_be_changed(run, season):  # noqa: F811
    code, _, err, _ = run("change", season, "--sampler", "snake", "--every", 2, "--hours", "0.5")
    assert code == 0, err
    setup = Season(season).settings
    assert (setup.sampler, setup.sampler_settings, setup.robot.hours) == (
        "snake",
        {"every": 2},
        0.5,
    )
    assert "Nothing" in run("change", season)[1]
    code, out, err, _ = run("undo", season, "--change")
    assert code == 0, err
    assert "adaptive, 1 h" in out
    assert Season(season).settings.robot.hours == 1.0
    code, _, err, _ = run("undo", season, "--change")
    assert (code, "there is none" in err) == (2, True)


def test_a_damaged_season_is_salvaged(run, season):  # noqa: F811
    data = season.read_bytes()
    season.write_bytes(data[: len(data) * 19 // 20])
    code, _, err, _ = run("status", season)
    if code:
        assert "salvage" in err
    code, out, err, made = run("salvage", season, "-o", "rescued.gpkg")
    assert code == 0, err
    assert {path.name for path in made} == {"rescued.gpkg"}
    assert "plants" in out


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["plan", "season.gpkg", "--hours", "3"], "fieldmon change"),
        (["plan", "season.gpkg", "--date", "2026-10-01"], "began on"),
        (["plan", "season.gpkg", "--now", "noon"], "HH:MM"),
        (["plan", str(ESTATE), "--now", "11:00"], "needs a season"),
        (["plan", "season.gpkg", "--date", BEGINS, "--now", "23:00"], "long enough"),
        (["init", "season.gpkg", str(ESTATE), "--feature", "1"], "never overwritten"),
        (["status", "none.gpkg"], "there is none"),
        (["status", str(RECORDS)], "must be the file of a season"),
        (["undo", "season.gpkg"], "nothing"),
        (["undo", "season.gpkg", "--batch", "1", "--inspection", "1"], "not two"),
        (["undo", "season.gpkg", "--batch", "1", "--change"], "not two"),
        (["treat", "season.gpkg", "--efficacy", "5"], "0..1"),
        (["record", "season.gpkg", "none.csv"], "none.csv"),
        (["change", "season.gpkg", "--sampler", "best"], "one of"),
        (["salvage", "none.gpkg", "-o", "x.gpkg"], "there is none"),
    ],
)
def test_what_does_not_fit_is_a_sentence(run, season, words, says):  # noqa: F811
    before = season.read_bytes()
    code, _, err, made = run(*words)
    assert (code, made) == (2, set())
    assert says in err
    assert season.read_bytes() == before
