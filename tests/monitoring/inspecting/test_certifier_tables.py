"""A season's record as tables."""

import csv
import io
from dataclasses import replace
from datetime import date, time

import numpy as np
import pytest

from fieldmon.compute.units import Units
from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import FOUND, SKIPPED, Inspections
from fieldmon.io.readers.inspections import read_inspections
from fieldmon.monitoring import Application, Season
from fieldmon.monitoring.inspecting.certifier_tables import (
    csv_bytes,
    inspections_table,
    log_table,
    treatments_table,
)
from fieldmon.plot.named_rows import plants_in_rows
from fieldmon.reports.certification import _inspections, _PlotRecord, certification_report
from tests.monitoring.changes.test_outside_changes import outside
from tests.monitoring.seasons import (
    BEGINS,
    a_plot,
    a_plot_with_named_rows,
    a_season,
    some_results,
)

FULL = Application("Acarol", Dose(0.4, "l/ha"), 800.0, "Ann", '=1+1 "mites"\nseen', ended=time(9))


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    made = a_season(tmp_path_factory.mktemp("tables") / "season.gpkg")
    made.record(some_results(made, n=4, found=[2]), "monday.csv", "Ann")
    made.keep_labels([ProductLabel("Acarol", waiting_days=3, reentry_hours=12.0)])
    made.treat(BEGINS, 0.8, application=FULL)
    made.keep_labels([replace(*made.labels(), irac_groups=("6",))])
    return made


def read(*tables):
    return list(csv.DictReader(io.StringIO(csv_bytes(tables).decode("utf-8-sig"), newline="")))


def test_a_treatment_has_what_a_certifier_asks_and_the_labels_wait(season):
    (one,) = read(treatments_table(season))
    assert (one["plot"], one["date"], one["ended"]) == ("מטע Paran", "2026-04-06", "09:00")
    assert (one["dose"], one["unit"], one["operator"]) == ("0.4", "l/ha", "Ann")
    assert (one["waiting_days"], one["harvest_from"]) == ("3", "2026-04-10")
    assert one["entry_from"] == "2026-04-06 21:00"
    assert float(one["area_ha"]) == pytest.approx(438 * 12.0 / 1e4, abs=1e-3)
    assert int(one["plants"]) == len(season.plot.grid)
    assert one["irac_group"] == "6"  # of a table that came later
    assert one["machinery"] == ""


def test_a_treatment_says_where_it_was_in_words_as_do_log_and_the_certifiers_report(tmp_path):
    made = a_season(tmp_path / "season.gpkg", a_plot_with_named_rows())
    grid, zone = made.plot.grid, np.zeros(len(made.plot.grid), bool)
    zone[np.flatnonzero(grid.row == 1)[:3]] = zone[np.flatnonzero(grid.row == 3)[2]] = True
    parts = [plants_in_rows(grid, rows) for rows in ("1-2", "1-2,Top", "5a,top", "2")]
    for plants in (*parts, zone, grid.row == 1, np.ones(len(grid), bool)):
        made.treat(BEGINS, 0.5, plants=plants)
    wanted = [
        "rows 1–2", "rows 1–2, 102 · Top", "rows 101 · 5A, 102 · Top", "row 2",
        "4 plants in rows 101 · 5A, 102 · Top", "row 101 · 5A", "the whole plot",
    ]  # fmt: skip
    table = treatments_table(made)
    assert [str(one) for one in table["where"]] == wanted
    assert [line["where"] for line in read(table)] == wanted
    assert [*made.to_geopandas("treatments")["where"]] == wanted
    logged = [one.sentence() for one in made.log() if one.kind == "treated"]
    assert logged[0].endswith(", 40 plants, rows 1–2, batch 1")
    assert logged[4].endswith("m², 4 plants in rows 101 · 5A, 102 · Top, batch 5")
    said = " ".join(certification_report([made], Units()).words())
    assert all(one in said for one in wanted)


def test_words_that_a_spreadsheet_would_run_stay_words(season):
    (one,) = read(treatments_table(season))
    assert one["reason"].startswith("'=1+1")


def test_inspections_and_log_are_there_line_by_line(season):
    done = season.history.inspections
    lines = read(inspections_table(season))
    assert [line["result"] for line in lines].count("found") == 1
    assert len(lines) == len(done) == 4
    numbered = season.plant_numbers
    found = int(done.plant[done.result == FOUND][0])
    (here,) = (line for line in lines if line["result"] == "found")
    assert (int(here["row"]), int(here["number"])) == (numbered.line[found], numbered.number[found])
    place = [float(here["lon"]), float(here["lat"])]
    assert place == pytest.approx(season.plot.grid.lonlat(np.array([found]))[0], abs=1e-7)
    log = read(log_table(season))
    assert [line["what"] for line in log] == ["begins", "seen", "labels", "treated", "labels"]
    assert log[-1]["digest"] == season.log()[-1].digest
    assert read(log_table(season), log_table(season)) == [*log, *log]


@pytest.mark.parametrize("faces", [1, 2])
def test_inspections_read_back_are_those_that_the_season_holds(tmp_path, faces):
    made = a_season(tmp_path / "season.gpkg", a_plot(faces=faces))
    grid = made.plot.grid
    plants = np.flatnonzero(grid.twin >= 0)[-3:] if faces == 2 else np.arange(3)
    seen = {
        "second": np.array([73_831.0, 73_800.0, np.nan]),
        "count": np.array([0.0, np.nan, 2.5]),
        "notes": np.array(["=1", "two\nlines", ""], object),
        "detects": np.array([0.3, np.nan, 0.6]),
    }
    results = np.array([FOUND, SKIPPED, FOUND])
    told = Inspections.of(plants, results, np.datetime64(BEGINS), **seen)
    made.record_all([(told, "taps")], "Ann")  # a find that counts 0, as seasons of old hold
    made.undo(made.record(some_results(made, n=2), "by mistake").batch)
    done = made.history.inspections
    file = tmp_path / "e.csv"
    file.write_bytes(csv_bytes([inspections_table(made)]))
    assert [line["time"] for line in read(inspections_table(made))] == ["20:30:00", "20:30:31", ""]
    back = read_inspections(file, grid)
    assert sorted(back.value.plant.tolist()) == sorted(done.plant.tolist())
    assert dict(zip(back.value.plant, back.value.detects, strict=True)) == pytest.approx(
        dict(zip(done.plant, done.detects, strict=True)), nan_ok=True
    )
    assert "its count is 0: taken as found" in " ".join(str(one) for one in back.messages)
    told = made.record(back.value, file.name, "Dan")
    assert (told.new, told.known) == (0, 3)


def test_inspections_say_what_the_plots_file_calls_their_rows(tmp_path):
    made = a_season(tmp_path / "season.gpkg", a_plot_with_named_rows())
    made.record(Inspections.of([0, 20, 60], [0, 1, 0], BEGINS), "taps")
    lines = read(inspections_table(made))
    wanted = [("1", ""), ("101", "5A"), ("102", "Top")]
    assert [(line["row"], line["row_name"]) for line in lines] == wanted
    frame = made.to_geopandas("inspections")
    assert [*zip(frame.row.astype(str), frame.row_name, strict=True)] == wanted
    (tmp_path / "e.csv").write_bytes(csv_bytes([inspections_table(made)]))
    back = read_inspections(tmp_path / "e.csv", made.plot.grid)
    assert back.value.plant.tolist() == [0, 20, 60]


def test_a_correction_names_who_inspected_and_who_corrected(tmp_path):
    made = a_season(tmp_path / "season.gpkg")
    made.record(some_results(made, n=3), "monday.csv", "Ben")
    outside(made.path, "UPDATE inspections SET result = 'found', count = 99 WHERE fid = 2")
    season = Season(made.path)
    season.correct("Eve")
    said = [(line["result"], line["who"], line["corrected_by"])
            for line in read(inspections_table(season))]  # fmt: skip
    assert said == [("clean", "Ben", ""), ("found", "Ben", "Eve"), ("clean", "Ben", "")]
    table = next(_inspections(_PlotRecord.of(season, "North", None, Units())))
    assert table.rows[0][3] == "\u2068Ben\u2069, corrected by Eve"


def test_of_nothing_no_table_is_made():
    assert csv_bytes([]) == csv_bytes([{}]) == b""
    assert date(2026, 4, 6) == BEGINS
