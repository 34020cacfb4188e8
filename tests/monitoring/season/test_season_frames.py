"""A season as frames: what the file says, line by line, and where."""

from datetime import time, timedelta

import numpy as np
import pandas as pd
import pytest
import shapely

from fieldmon.decisions.labels import ProductLabel
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.infestation.tracing.traced_pairs import in_sight
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import Application
from fieldmon.monitoring.estimates.figures_of_day import believed
from fieldmon.monitoring.estimates.last_days import default_date
from fieldmon.monitoring.inspecting.certifier_tables import (
    csv_bytes,
    inspections_table,
    treatments_table,
)
from tests.monitoring.seasons import BEGINS, a_season, some_results


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    made = a_season(tmp_path_factory.mktemp("frames") / "season.gpkg")
    made.record(some_results(made, n=4, found=[2]), "monday.csv", "Ann")
    made.record(
        Inspections.of(
            [7], [FOUND], BEGINS + timedelta(1), count=[3.0], second=[25200.0], who=["B"]
        )
    )
    made.keep_labels([ProductLabel("Acarol", waiting_days=3, reentry_hours=12.0)])
    made.treat(BEGINS, 0.8, application=Application("Acarol", ended=time(9)))
    return made


def test_inspections_stand_at_their_plants_in_degrees(season):
    frame, done = season.to_geopandas("inspections"), season.inspections
    assert frame.crs == "EPSG:4326"
    assert frame.plant.tolist() == done.plant.tolist()
    at = np.column_stack([frame.geometry.x, frame.geometry.y])
    np.testing.assert_allclose(at, season.plot.grid.lonlat(done.plant))
    last = frame.iloc[-1]
    assert (last.result, last["count"], last.who, last.time) == ("found", 3.0, "B", "07:00:00")
    assert last.date == pd.Timestamp(BEGINS + timedelta(1))
    assert np.isnan(frame["count"].iloc[0])


def test_they_are_the_lines_that_the_command_exports(season):
    frame, table = season.to_geopandas("inspections"), inspections_table(season)
    for name in ("row", "number", "result", "who", "notes", "corrected_by"):
        assert frame[name].tolist() == table[name]
    frame, table = season.to_geopandas("treatments"), treatments_table(season)
    assert [*frame.columns] == [*table, "geometry"]
    assert frame["product"].tolist() == table["product"] == ["Acarol"]


def test_a_treatment_has_its_outline_and_days_that_can_be_reckoned_with(season):
    (one,) = season.to_geopandas("treatments").itertuples()
    (kept,) = season.treatments()
    assert shapely.equals_exact(one.geometry, kept.place.area)
    assert one.harvest_from - one.date == pd.Timedelta(days=4)
    assert one.entry_from == pd.Timestamp(BEGINS) + pd.Timedelta(hours=21)


def test_every_plant_has_its_chance_on_the_morning_and_in_the_evening(season):
    frame = season.to_geopandas("plants", BEGINS)
    np.testing.assert_array_equal(frame.morning, season.morning(BEGINS))
    np.testing.assert_array_equal(frame.evening, season.evening(BEGINS))
    meant = season.to_geopandas("plants")
    np.testing.assert_array_equal(meant.evening, season.evening(default_date(season)))


def test_days_are_those_of_which_there_are_figures(season):
    frame, days = season.to_pandas(), season.days()
    assert frame.date.dt.date.tolist() == [day.on for day in days]
    of_day = {"inspected": "inspected_today", "found": "found_today"}
    for name in ("inspected", "found", "expected", "low", "high", "chance_clean"):
        assert frame[name].tolist() == [getattr(day, of_day.get(name, name)) for day in days]


def test_a_season_of_nothing_has_frames_without_lines(tmp_path, season):
    empty = a_season(tmp_path / "season.gpkg")
    for of in ("inspections", "treatments"):
        frame = empty.to_geopandas(of)
        assert len(frame) == 0
        assert frame.crs == "EPSG:4326"
        assert [*frame.columns] == [*season.to_geopandas(of).columns]
    assert empty.to_geopandas("treatments").harvest_from.dtype.kind == "M"
    assert csv_bytes([treatments_table(empty)]) == b""
    assert empty.to_geopandas("inspections").date.dtype.kind == "M"
    assert empty.to_pandas().inspected.tolist() == [0]


def test_what_is_no_frame_and_a_day_before_the_season_are_refused(season):
    with pytest.raises(SettingError, match="one of 'inspections', 'treatments', 'plants'"):
        season.to_geopandas("labels")
    with pytest.raises(SettingError):
        season.to_geopandas("plants", BEGINS - timedelta(1))


def test_a_days_chances_are_of_what_can_be_seen_and_a_seasons_of_all(tmp_path):
    made = a_season(tmp_path / "season.gpkg", pest=shipped_pest("spider-mite"))
    on = BEGINS + timedelta(3)
    of_day = made.plan(on).plants.chance
    of_all = made.to_geopandas("plants", on).morning
    assert of_day.tolist() == in_sight(believed(made, on).morning).chance.tolist()
    assert of_day.sum() < of_all.sum()
