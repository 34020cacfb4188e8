"""Results that hold in place of what they contradict, and come back when that is undone."""

import sqlite3
from contextlib import closing
from datetime import date

import numpy as np
import pytest

from fieldmon.cli.status import _contradicting
from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.inspecting.contradictions import contradicting, contradictions
from tests.monitoring.seasons import BEGINS, a_plot, a_season

DAY = np.datetime64(BEGINS)


def said(plants, results, **more):
    return Inspections.of(np.array(plants), np.array(results), DAY, **more)


@pytest.mark.parametrize("face", [0, 1, 2])
def test_the_log_names_each_correction_and_of_two_faces_which(tmp_path, face):
    season = a_season(tmp_path / "s.gpkg", plot=a_plot(faces=min(face + 1, 2)))
    grid = season.plot.grid
    plants = (grid.twin[:7] if face == 2 else np.arange(7)).astype(np.int32)
    season.record(said(plants, np.zeros(7, np.int8)), "day")
    now = said(plants, np.ones(7, np.int8))
    named = f", face {face}" if face else ""
    (first, *_) = contradictions(now, season.inspections).sentences(grid)
    assert first.startswith(f"Row 1, plant 1{named} on {BEGINS}: recorded as clean")
    season.record_instead(now)
    logged = season.log()[-1].sentence()
    for number in range(1, 8):
        assert f"clean at row 1, plant {number}{named} on {BEGINS} is now result found" in logged
    assert season.log()[-1].sentence(5).count(" is now ") == 5
    assert season.log()[-1].sentence(5).endswith("; ...")
    season.record(said(plants[:1], [CLEAN]), "again", confirmed=True)
    assert f"Row 1, plant 1{named}: found, clean" in next(_contradicting(season, BEGINS))
    assert season.undo() == f"Undone: row 1, plant 1{named} on {BEGINS} (clean)."
    season.record(said(grid.twin[[7]] if face == 2 else [7], [CLEAN]), "eighth")
    assert season.undo() == f"Undone: row 1, plant 8{named} on {BEGINS} (clean)."
    again = season.redo(season.batches()[0].number)
    assert again == f"Counts again: row 1, plant 8{named} on {BEGINS} (clean)."
    (eighth,) = season.contents([season.batches()[0].number]).values()
    assert eighth.number_on(grid) == f"8{named}"
    with closing(sqlite3.connect(season.path)) as db:
        db.execute("UPDATE inspections SET result = 'flown' WHERE undone = 0 AND number = 2")
        db.commit()
    with pytest.raises(FileProblem, match=rf"at row 1, plant 2{named} on {BEGINS}\) was changed"):
        Season(season.path).status(BEGINS)
    with pytest.raises(FileProblem, match=rf"at row 1, plant 2{named} on {BEGINS}\) was changed"):
        Season(season.path).correct("Ann")


def test_one_stop_of_a_batch_is_corrected_and_the_others_stay(season: Season):
    season.record(said([3, 4, 5], [CLEAN] * 3, second=np.array([100.0, 200.0, 300.0])), "route")
    done = season.record_instead(said([4, 6], [FOUND, CLEAN], count=np.array([7.0, np.nan])), "me")
    assert (done.new, done.known, done.corrected) == (1, 0, 1)
    held = season.history.inspections
    assert dict(zip(held.plant.tolist(), held.result.tolist(), strict=True)) == {
        3: CLEAN, 4: FOUND, 5: CLEAN, 6: CLEAN
    }  # fmt: skip
    corrected = held.take(held.plant == 4)
    assert (corrected.count.tolist(), corrected.second.tolist()) == ([7.0], [200.0])
    assert not len(contradicting(season.inspections.on(BEGINS)))
    assert season.verify() == ()
    correction = next(one for one in season.batches() if one.kind == "corrections")
    assert (correction.source, correction.rows) == ("me", 1)
    season.undo(correction.number)
    held = season.history.inspections
    assert held.result[held.plant == 4].tolist() == [CLEAN]
    assert Season(season.path).verify() == ()


def test_where_both_were_recorded_the_new_one_holds_in_place_of_each(season: Season):
    for second in (10.0, 20.0):
        season.record(said([3], [CLEAN], second=np.array([second])), "route")
    assert season.record_instead(said([3], [FOUND])).corrected == 1
    assert season.history.inspections.result.tolist() == [FOUND]
    season.undo()
    assert season.history.inspections.result.tolist() == [CLEAN, CLEAN]


def test_of_two_results_of_a_plant_brought_at_once_the_later_one_holds(season: Season):
    done = season.record_instead(said([3, 3], [CLEAN, FOUND]))
    assert (done.new, done.corrected) == (1, 1)
    assert season.history.inspections.result.tolist() == [FOUND]


def test_an_undo_names_its_day_as_a_day(season: Season):
    season.record(said([3], [FOUND]))
    assert season.undo().values["date"] == date(BEGINS.year, BEGINS.month, BEGINS.day)
