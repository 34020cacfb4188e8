"""Inspections exported from a season, changed in another program, are corrected only when told."""

import shutil

import numpy as np
import pandas as pd
import pyogrio
import pytest

from fieldmon.errors import FieldmonError, FileProblem, ObservationError
from fieldmon.infestation.inspections import Inspections
from fieldmon.io.readers.inspection_options import InspectionOptions
from fieldmon.monitoring import Season
from fieldmon.monitoring.exported_inspections import edited_copy
from fieldmon.monitoring.inspection_import import read_brought
from tests.monitoring.seasons import BEGINS

OPTIONS = InspectionOptions()


@pytest.fixture
def season(path):
    season = Season(path)
    season.record(
        Inspections.of(
            np.array([300, 301]), np.array([0, 1]), BEGINS, second=[np.nan, 30_000],
            count=[np.nan, 2.0], who=["Ann", "Ben"], notes=["", "below, left"], detects=[0.4, 0.3],
        ),
        "more",
    )  # fmt: skip
    return season


def exported(season):
    """Return the layer of inspections as QGIS exports it."""
    return pyogrio.read_dataframe(season.path, layer="inspections")


def brought(season, layer, folder, name="edited.gpkg"):
    """Return how many corrections a changed layer brings."""
    shutil.rmtree(folder / name, ignore_errors=True)
    (folder / name).mkdir()
    file = folder / name / name
    if name.endswith(".csv"):
        pd.DataFrame(layer.drop(columns="geometry")).to_csv(file, index=False)
    else:
        pyogrio.write_dataframe(layer, file)
    edited = edited_copy(season, file, OPTIONS, folder / name)
    return season.take_corrections(edited.path, name, "Cid"), edited.n_added


@pytest.mark.parametrize("name", ["edited.gpkg", "edited.geojson", "edited.csv"])
def test_what_an_export_says_otherwise_is_corrected_and_undone(season, tmp_path, name):
    layer = exported(season)
    assert brought(season, layer, tmp_path, name) == (0, 0)  # what says the same is no correction
    held = season.history.inspections
    layer.loc[layer["plant"] == 301, ["result", "count", "who"]] = ["clean", None, "Dan"]
    layer.loc[layer["plant"] == 300, "date"] = "2026-04-07"
    layer = layer[::-1].iloc[:-3]  # in another order, and a selection only
    added = layer[layer["plant"] == 300].copy()
    added["digest"] = None
    assert brought(season, pd.concat([layer, added]), tmp_path, name) == (2, 1)
    now = season.history.inspections
    assert len(now) == len(held)
    (k,) = np.flatnonzero(now.plant == 301)
    assert (now.result[k], now.who[k], now.second[k]) == (0, "Dan", 30_000)
    assert np.isnan(now.count[k])
    assert str(now.date[now.plant == 300][0]) == "2026-04-07"
    assert season.verify() == ()
    assert season.batches()[0].who == "Cid"
    assert brought(season, layer, tmp_path, name) == (0, 0)  # twice is once
    season.undo()
    assert season.history.inspections.result.tolist() == held.result.tolist()


def test_what_an_export_does_not_say_or_nobody_can_read_erases_nothing(season, tmp_path):
    layer, held = exported(season), season.history.inspections
    mine = layer["plant"] == 301
    some = layer[["plant", "date", "result", "digest", "undone", "geometry"]].copy()
    assert brought(season, some, tmp_path, "some.csv") == (0, 0)
    some.loc[layer["plant"] == 300, "result"] = "found"
    assert brought(season, some, tmp_path) == (1, 0)
    now = season.history.inspections
    assert np.array_equal(now.count, held.count, equal_nan=True)
    assert now.who.tolist() == held.who.tolist()
    season.undo()
    for column, value in [("result", None), ("result", "maybe"), ("count", "abc"), ("count", "-3"),
                          ("time", "25:00"), ("time", "7h15")]:  # fmt: skip
        wrong = layer.astype({column: object})
        wrong.loc[mine, column] = value
        if column == "result":
            wrong.loc[mine, "count"] = None
        with pytest.raises(ObservationError, match="must be read for certain"):
            brought(season, wrong, tmp_path, "wrong.csv")
    ahead = layer.copy()
    ahead.loc[mine, "date"] = "2199-04-07"
    with pytest.raises(FieldmonError, match="2199"):
        brought(season, ahead, tmp_path)
    pasted = layer[mine].copy()
    pasted["result"], pasted["count"] = "clean", None
    with pytest.raises(ObservationError, match="stands there twice"):
        brought(season, pd.concat([layer, pasted]), tmp_path)
    assert season.history.inspections.result.tolist() == held.result.tolist()


def test_an_export_that_is_no_longer_or_nowhere_of_the_season_is_refused(season, tmp_path):
    layer = exported(season)
    mine = layer["plant"] == 301
    with pytest.raises(ObservationError, match="must hold inspections exported"):
        brought(season, layer.drop(columns="digest"), tmp_path)
    moved = layer.copy()
    moved.loc[mine, "geometry"] = moved[layer["plant"] == 300].geometry.to_numpy()
    with pytest.raises(ObservationError, match="elsewhere than its plant"):
        brought(season, moved, tmp_path)
    layer.loc[mine, "result"] = "clean"
    with pytest.raises(ObservationError, match="result and its count contradict each other"):
        brought(season, layer, tmp_path)
    layer.loc[mine, "count"] = None
    season.undo()
    with pytest.raises(FileProblem, match=r"1 inspection of .* is not in it"):
        brought(season, layer, tmp_path)


def test_a_changed_export_is_told_from_plants_inspected_anew_on_another_day(season, tmp_path):
    layer = exported(season)
    layer.loc[layer["plant"] == 301, "count"] = 5
    layer.loc[layer["plant"] == 300, ["date", "result"]] = ["2026-04-07", "found"]
    layer.loc[layer["plant"] == 301, "notes"] = "anew"
    pyogrio.write_dataframe(layer, tmp_path / "edited.gpkg")
    (tmp_path / "new").mkdir()
    read = read_brought(season, tmp_path / "edited.gpkg", OPTIONS, tmp_path / "new")
    assert read.changed == 1
    assert "1 inspection was exported from this season and changed" in read.messages[-1].sentence
    layer.loc[layer["plant"] == 300, "geometry"] = layer.geometry.iloc[0]
    pyogrio.write_dataframe(layer, tmp_path / "moved.gpkg")
    (tmp_path / "moved").mkdir()
    read = read_brought(season, tmp_path / "moved.gpkg", OPTIONS, tmp_path / "moved")
    assert read.changed == 2
