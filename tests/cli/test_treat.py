"""`fieldmon treat`: a plot or a part of it was sprayed."""

from datetime import date

import geopandas as gpd
import numpy as np
import pytest
import shapely

from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS

ON = date.fromisoformat(BEGINS)


def test_the_chance_falls_by_the_efficacy_and_a_treatment_counts_once(run, season):
    before = Season(season).evening(ON)
    code, out, err, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert code == 0, err
    assert "Treatment noted as batch" in out
    assert Season(season).evening(ON) == pytest.approx(before / 2)
    _, out, _, _ = run("treat", season, "--efficacy", "0.5", "--date", BEGINS)
    assert "nothing changed" in out
    assert Season(season).evening(ON) == pytest.approx(before / 2)


def test_only_the_area_that_was_treated_is_cleaner(run, season, tmp_path):
    kept = Season(season)
    west, south, east, north = kept.plot.field.boundary.bounds
    half = shapely.box(west - 1e-4, south - 1e-4, (west + east) / 2, north + 1e-4)
    gpd.GeoDataFrame(geometry=[half], crs=4326).to_file(tmp_path / "half.geojson")
    before = kept.evening(ON)
    words = ["--efficacy", "0.8", "--area", "half.geojson", "--product", "soap"]
    code, _, err, _ = run("treat", season, *words, "--date", BEGINS)
    assert code == 0, err
    after = Season(season).evening(ON)
    inside = shapely.contains_xy(half, kept.plot.grid.lonlat())
    assert inside.any()
    assert not inside.all()
    assert after[inside] == pytest.approx(0.2 * before[inside])
    # clean neighbours may be taken for cleaner, never for less clean
    assert (after[~inside] <= before[~inside] + 1e-12).all()
    assert np.median(after[~inside] / before[~inside]) == pytest.approx(1.0, abs=0.01)
