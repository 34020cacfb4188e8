"""What was recorded, so that a person can tell one batch from the others."""

import shutil
from datetime import date

import numpy as np
from shapely import MultiPolygon, box

from app.show.recorded_batches import counts_again, in_short, last, line, source, undone
from fieldmon.infestation.inspections import CLEAN, FOUND, RESULT_NAMES, SKIPPED, Inspections
from fieldmon.monitoring import Application, Season
from fieldmon.plot.grid import plant_numbers
from tests.app.chosen import in_season
from tests.app.driving import apart, go
from tests.monitoring.seasons import BEGINS, a_plot, a_season

DAY = np.datetime64("2026-11-16")


def test_each_batch_is_told_by_what_it_says(season_app, season):
    kept = season()
    one = plant_numbers(kept.plot.grid, np.array([5, 6]))
    first, second = (f"row {one.line[k]}, plant {one.number[k]}" for k in range(2))
    kept.record(Inspections.of(np.array([5]), np.array([FOUND]), DAY), "typed in")
    kept.record(Inspections.of(np.array([6]), np.array([SKIPPED]), DAY), "typed in", "Ann")
    counted = Inspections.of(np.array([5]), np.array([FOUND]), DAY + 1, count=np.array([7.0]))
    kept.record(counted, "typed in")
    many = Inspections.of(np.arange(10, 14), np.array([0, FOUND, FOUND, 0]), DAY)
    kept.record(many, "day.csv")
    kept.undo()
    go(season_app, "record")
    lines = [one.value for one in season_app.markdown if "\u2068" in one.value]
    said = [line.replace("\u2068", "").replace("\u2069", "").split(" · ", 1)[1] for line in lines]
    # recorded today, and of a day that is not
    assert said[0] == "day.csv · 4 plants, 2 found · inspected Mon 16 Nov · undone"
    assert said[1] == f"typed in · {first}: found, count 7 · inspected Tue 17 Nov"
    assert said[2] == f"typed in · {second}: could not inspect · inspected Mon 16 Nov · Ann"
    assert said[3] == f"typed in · {first}: found · inspected Mon 16 Nov"
    assert {one.help for one in season_app.button if one.label == "Undo"} == {*lines[1:4]}


def test_a_plant_of_two_faces_is_told_with_the_one_that_was_inspected(tmp_path, speaking):
    kept = a_season(tmp_path / "s.gpkg", plot=a_plot(faces=2))
    grid = kept.plot.grid
    (face_2,) = np.flatnonzero(grid.vine == grid.vine[0])[1:]
    kept.record(Inspections.of(face_2[None], np.array([FOUND]), np.datetime64(BEGINS)), "typed in")
    (batch,), here = kept.batches(), in_season(kept, BEGINS)
    said = kept.contents([batch.number])[batch.number]
    assert f"plant {said.plant}, face 2: found" in line(here, batch, said)
    two = Inspections.of(np.array([1, 2]), np.array([0, 0]), np.datetime64(BEGINS))
    file = kept.record(two, "day.csv").batch
    # the number of the batch is for commands
    assert undone(kept.undo(file)) == "Undone: 2 inspections from \u2068day.csv\u2069."
    assert counts_again(kept.redo(file)) == "Counts again: 2 inspections."
    speaking("he")
    assert all(f"{said.plant}, צד 2:" in one for one in (line(here, batch, said), last(here, said)))


def test_what_counts_in_another_recording_is_told_from_what_counts(season_app, season, tmp_path):
    kept = season()
    other = Season(shutil.copy(kept.path, tmp_path / "other.gpkg"))
    for one in (kept, other):
        one.treat(date(2026, 11, 16), 0.5, product="Oil")
    kept.merge(other)
    go(season_app, "record")
    lines = [one.value for one in season_app.markdown if "Oil" in one.value and " · " in one.value]
    assert [line.endswith("counts in another recording") for line in lines] == [True, False]


def test_a_correction_says_what_it_is_of_and_what_was_corrected_is_no_other_recording(tmp_path):
    kept = a_season(tmp_path / "s.gpkg")
    on, plant = np.datetime64(BEGINS), np.array([5])
    kept.record(Inspections.of(plant, np.array([FOUND]), on, count=np.array([2.0])), "typed in")
    kept.record_instead(Inspections.of(plant, np.array([CLEAN]), on), "typed in")
    here, batches = in_season(kept, BEGINS), kept.batches()
    contents = kept.contents([one.number for one in batches])
    corrections, before = (line(here, one, contents[one.number]) for one in batches)
    assert "corrections: \u2068typed in\u2069 · row 1, plant 6: clean" in corrections
    assert before.endswith("plant 6: found, count 2 · inspected Mon 6 Apr · corrected since")
    kept.undo()
    (_, before) = batches = kept.batches()
    assert "corrected" not in line(here, before, kept.contents([before.number])[before.number])


def test_ways_to_record_are_said_in_the_language_of_the_page_and_files_by_their_names(speaking):
    assert source("typed in") == "typed in"
    speaking("he")
    assert [source(name) for name in ("typed in", "day.csv")] == ["הוקלד", "day.csv"]


def test_a_treatment_is_told_by_how_many_plants_were_treated_and_when(season_app, season):
    kept = season()
    kept.treat(date(2026, 11, 16), 0.8, application=Application("soap"))
    west, south, east, north = kept.plot.field.boundary.bounds
    half = MultiPolygon([box(west, south, east, (south + north) / 2)])
    kept.treat(date(2026, 11, 16), 0.8, half, application=Application("oil"))
    every, some = (int(one.place.plants.sum()) for one in kept.treatments())
    assert some < every == len(kept.plot.grid)
    go(season_app, "record")
    lines = [apart(one.value) for one in season_app.markdown if "treatment" in one.value]
    said = [one.replace(",", "") for one in lines]
    assert f"treatment \u2068oil\u2069 · {some} plants · efficacy 80 % · Mon 16 Nov" in said[0]
    assert f"treatment \u2068soap\u2069 · {every} plants · efficacy 80 % · Mon 16 Nov" in said[1]


def test_every_result_has_its_word():
    assert len({in_short(name) for name in RESULT_NAMES.values()}) == len(RESULT_NAMES)
    # another program wrote it
    assert "eaten" in in_short("eaten")
