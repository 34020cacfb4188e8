"""Rasters on the command line, on the made-up estate."""

import json
import re
import warnings
from datetime import date
from pathlib import Path

import numpy as np
import pytest
import rasterio
from rasterio.transform import from_origin

from fieldmon.io.writers.chance_raster import write_chance_raster
from tests.paths import SAMPLE_DATA

ESTATE = SAMPLE_DATA
PLAN = ["plan", ESTATE / "paran_estate.zip", "--feature", "Nursery", "--date", "2026-11-18"]


def covariate(path, low=0.0, high=1.0, bands=1):
    """Write a raster of the estate: low west of the Nursery's middle, high east of it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with rasterio.open(ESTATE / "backdrop.tif") as tif:
            crs, bounds = tif.crs, tif.bounds
        from fieldmon.io.options import PlotOptions
        from fieldmon.io.parse.crs import system, transformation_from
        from fieldmon.io.rasters.values import projected
        from fieldmon.io.read import read_plots

        (nursery,) = read_plots(ESTATE / "paran_estate.zip", PlotOptions(feature="Nursery")).value
        middle = np.array([[nursery.boundary.centroid.x, nursery.boundary.centroid.y]])
        grid = transformation_from(system(crs.to_wkt()), (bounds.left, bounds.bottom))
        x = float(projected(grid, middle)[0, 0])
        values = np.full((bands, 993, 1093), low, "float32")
        values[..., int(x - bounds.left) :] = high
        with rasterio.open(
            path, "w", driver="GTiff", count=bands, height=993, width=1093, dtype="float32",
            crs=crs, transform=from_origin(bounds.left, bounds.top, 1, 1),
        ) as tif:  # fmt: skip
            tif.write(values)
    return path


def chances(path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with rasterio.open(path) as tif:
            band = tif.read(1, masked=True)
    columns = np.flatnonzero((~band.mask).any(axis=0))
    middle = int(columns.mean())
    return band[:, : middle - 8].mean(), band[:, middle + 8 :].mean()


def chance_of(risk):
    return ["--risk", risk, "--risk-option", "meaning=chance"]


def test_a_risk_raster_raises_the_chance_where_it_says_so(run, tmp_path):
    risk = covariate(tmp_path / "risk.tif", 0.0, 0.3)
    code, out, err, _ = run(*PLAN, "--chance-map", "before.tif")
    assert code == 0, err
    assert "Chance map written to before.tif" in out
    code, out, err, _ = run(*PLAN, *chance_of(risk), "--chance-map", "after.tif")
    assert code == 0, err
    assert "seen: Risk by chance: 0 to 0.3" in err
    (west_before, east_before), (west, east) = chances("before.tif"), chances("after.tif")
    assert west == pytest.approx(west_before, abs=1e-6)
    assert east == pytest.approx(1 - (1 - east_before) * 0.7, abs=0.01)


def test_what_a_risk_raster_means_is_an_option(run, tmp_path):
    risk = covariate(tmp_path / "ndvi.tif", 0.8, 0.3)
    code, _, err, _ = run(*PLAN, "--risk", risk)
    assert code == 2
    assert 'Answer with --risk-option meaning="rank", for instance.' in err
    code, _, err, _ = run(*PLAN, "--risk", risk, "--risk-option", "mean_share=0.02")
    assert code == 2
    assert "Add --risk-option meaning=rank or meaning=score" in err
    code, _, err, _ = run(*PLAN, "--risk", risk, "--risk-option", "meaning=rank")
    assert code == 2
    assert "mean_share" in err
    code, _, err, _ = run(
        *[*PLAN, "--risk", risk, "--risk-option", "meaning=score", "--risk-option", "how=nearest"],
        *["--risk-option", "mean_share=0.04", "--risk-option", "low_is_risky=yes"],
        *["--chance-map", "c.tif"],
    )
    assert code == 0, err
    assert "0.04 on average" in err
    west, east = chances("c.tif")
    assert east > west + 0.01


def test_plants_under_a_low_canopy_are_not_planned_for(run, tmp_path):
    canopy = covariate(tmp_path / "canopy.tif", 0.2, 1.5)
    _, out, _, _ = run(*PLAN)
    all_plants = re.search(r"of ([\d,]+) plants in", out)[1].replace(",", "")
    code, out, err, _ = run(
        *[*PLAN, "--canopy", canopy, "--canopy-below", 0.5, "--canopy-option", "how=nearest"]
    )
    assert code == 0, err
    missing, of = re.search(r"(\d+) of (\d+) plants are missing", err).groups()
    left = re.search(r"of ([\d,]+) plants in", out)[1].replace(",", "")
    assert of == all_plants
    assert int(left) == int(all_plants) - int(missing)
    assert 0.3 < int(missing) / int(all_plants) < 0.7
    stops = json.loads((tmp_path / "route.geojson").read_text(encoding="utf-8"))["features"][1:]
    lon = [stop["geometry"]["coordinates"][0] for stop in stops]
    code, _, _, _ = run(*PLAN)
    stops = json.loads((tmp_path / "route.geojson").read_text(encoding="utf-8"))["features"][1:]
    everywhere = [stop["geometry"]["coordinates"][0] for stop in stops]
    assert min(lon) > min(everywhere) + 2e-4


def test_what_was_guessed_is_said_with_the_option_that_undoes_it(run, tmp_path):
    risk = covariate(tmp_path / "risk.tif", -9999.0, 0.3)
    code, _, err, _ = run(*PLAN, *chance_of(risk))
    assert code == 0, err
    assert "(They are values: --risk-option nodata=none)" in err
    assert "have no value on the raster" in err
    code, _, err, _ = run(*PLAN, *chance_of(risk), "--risk-option", "nodata=none")
    assert code == 2
    assert "must hold values in 0..1" in err


def test_a_season_begins_with_rasters_and_maps_its_days(run, tmp_path):
    risk = covariate(tmp_path / "risk.tif", 0.0, 0.3)
    plot = [ESTATE / "paran_estate.zip", "--feature", "Nursery"]
    day = ["--begins", "2026-11-18"]
    code, out, err, _ = run("init", "plain.gpkg", *plot, *day)
    assert code == 0, err
    code, out, err, _ = run(
        *["init", "season.gpkg", *plot, *day, *chance_of(risk)],
        *["--canopy", risk, "--canopy-below", "-1"],
    )
    assert code == 0, err
    assert "seen: 0 of" in err
    day = ["--date", "2026-11-18"]
    for season in ("plain", "season"):
        code, out, err, _ = run("plan", f"{season}.gpkg", *day, "--chance-map", f"{season}.tif")
        assert code == 0, err
        assert f"Chance map written to {season}.tif" in out
    (_, plain_east), (_, east) = chances("plain.tif"), chances("season.tif")
    assert east > plain_east + 0.2
    from fieldmon.infestation.tracing.traced_pairs import in_sight
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.estimates.figures_of_day import believed

    # as the season has them, also those that hide
    kept, tomorrow = Season("season.gpkg"), date(2026, 11, 19)
    run("plan", "season.gpkg", "--date", tomorrow, "--chance-map", "season.tif")
    planned_by = in_sight(believed(kept, tomorrow).morning).chance
    for chance, same in ((kept.evening(tomorrow), True), (planned_by, False)):
        write_chance_raster(kept.plot.grid, chance, Path("own.tif"))
        with rasterio.open("season.tif") as season, rasterio.open("own.tif") as own:
            assert np.array_equal(season.read(1), own.read(1)) is same
    said = [remark.sentence for remark in Season("season.gpkg").messages()]
    assert any("Risk by chance" in sentence for sentence in said)
    code, _, err, _ = run("plan", "season.gpkg", *day, "--risk", risk)
    assert code == 2
    assert "--risk" in err


def test_a_simulated_season_starts_from_the_risk_and_without_missing_plants(run, tmp_path):
    canopy = covariate(tmp_path / "canopy.tif", 0.2, 0.9)
    words = ["simulate", *PLAN[1:], "--sampler", "naive", "--days", 1, "--infested", 0.1]
    code, _, err, _ = run(
        *[*words, *chance_of(canopy), "--risk-option", "how=highest"],
        *["--canopy", canopy, "--canopy-below", 0.5],
    )
    assert code == 0, err
    assert "plants are missing (canopy below 0.5)" in err
    assert "Risk by chance: 0.9 to 0.9" in err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--canopy", "x.tif"], "give both"),
        (["--canopy-below", "1"], "give both"),
        (["--risk-option", "meaning=rank"], "with --risk FILE"),
        (["--risk", "x.tif"], "there is none"),
        (["--risk", "three.tif"], '--risk-option band="1"'),
        (["--risk", "three.tif", "--risk-option", "band"], "must be NAME=VALUE"),
        (["--risk", "three.tif", "--risk-option", "bond=1"], "no option 'bond'"),
        (["--risk", "three.tif", "--risk-option", "mean_share=few"], "'few'"),
        (
            ["--canopy", "three.tif", "--canopy-below", "9", "--canopy-option", "band=1"],
            "all were marked as missing",
        ),
    ],
)
def test_what_cannot_be_done_is_said(run, tmp_path, words, said):
    covariate(tmp_path / "three.tif", bands=3)
    code, _, err, _ = run(*PLAN, *words)
    assert code == 2
    assert said in err
    assert not (tmp_path / "route.geojson").exists()
