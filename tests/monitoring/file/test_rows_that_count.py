"""What stands back for another row counts again once that one is taken back."""

import shutil

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.verifying import check_against_log
from tests.monitoring.seasons import BEGINS


def result(plants, what, day=1):
    plants = np.array(plants)
    return Inspections.of(plants, np.full(len(plants), what), np.datetime64(BEGINS) + day)


@pytest.fixture
def merged(path, tmp_path):
    """Return a season in which Ann inspected plants 3 to 5, and Ben in a copy 5 to 8."""
    other = shutil.copy(path, tmp_path / "other.gpkg")
    season, theirs = Season(path), Season(other)
    season.record(result([3, 4, 5], FOUND), "ann.csv", "Ann")
    theirs.record(result([5, 6, 7, 8], FOUND), "ben.csv", "Ben")
    season.merge(theirs)
    return season


def number(season, who):
    return next(batch.number for batch in season.batches() if batch.who == who)


@pytest.mark.parametrize(("who", "left"), [("Ann", [5, 6, 7, 8]), ("Ben", [3, 4, 5])])
def test_undoing_ones_file_leaves_what_the_other_recorded_too(merged, who, left):
    said = merged.undo(number(merged, who))
    assert said.endswith("1 of the same results counts still: another recording holds it, too.")
    assert merged.history.on(1).plant.tolist() == left
    assert merged.verify() == ()
    assert check_against_log(merged) == ()
    other = {"Ann": "Ben", "Ben": "Ann"}[who]
    assert "still" not in merged.undo(number(merged, other))
    assert merged.history.on(1).plant.tolist() == []


def test_one_inspection_undone_leaves_that_of_another(merged):
    with merged.store.reading() as db:
        (row,) = db.execute(
            "SELECT fid FROM inspections WHERE plant = 5 AND day = 1 AND undone = 0"
        ).fetchone()
    assert "still" in merged.undo(inspection=row)
    assert merged.history.on(1).plant.tolist() == [3, 4, 5, 6, 7, 8]
    with merged.store.reading() as db:
        (row,) = db.execute(
            "SELECT fid FROM inspections WHERE plant = 5 AND day = 1 AND undone = 0"
        ).fetchone()
    assert "still" not in merged.undo(inspection=row)
    assert merged.history.on(1).plant.tolist() == [3, 4, 6, 7, 8]


def test_a_treatment_that_both_recorded_stays_until_both_are_undone(path, tmp_path):
    season = Season(path)
    theirs = Season(shutil.copy(path, tmp_path / "other.gpkg"))
    for one in (season, theirs):
        one.treat(BEGINS, 0.5)
    season.merge(theirs)
    assert "still" in season.undo()
    assert len(season.treatments()) == 1
    season.undo()
    assert len(season.treatments()) == 0


def test_what_was_undone_before_it_was_recorded_again_stays_so(path):
    season = Season(path)
    season.record(result([3], CLEAN), "ann.csv")
    season.undo()
    season.record(result([3], CLEAN), "again.csv")
    assert "still" not in season.undo()
    assert len(season.history.on(1)) == 0
