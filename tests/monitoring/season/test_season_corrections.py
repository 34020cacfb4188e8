"""What was recorded wrong is corrected by somebody with a name; undoing brings back what was."""

import shutil
from datetime import time

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.merging.other_seasons import brought_season
from tests.monitoring.changes.test_outside_changes import outside
from tests.monitoring.seasons import BEGINS, a_season


def test_corrections_have_an_author(path, tmp_path):
    copy = shutil.copy(path, tmp_path / "copy.gpkg")
    outside(copy, "DELETE FROM inspections WHERE fid = 3")
    with pytest.raises(SettingError, match="--who"):
        Season(path).take_corrections(copy, "copy.gpkg", " ")


def test_a_file_that_is_no_copy_of_the_season_has_none(path, tmp_path):
    other = a_season(tmp_path / "other.gpkg")
    held = brought_season(Season(path), other.path, "other.gpkg")
    assert (held.is_copy, held.corrections) == (False, ())
    assert other.status(BEGINS).found == 0


def test_undoing_one_that_was_corrected_says_that_it_counts_again_as_it_was(season):
    plants, on = np.arange(2), np.datetime64(BEGINS)
    season.record(Inspections.of(plants, np.array([CLEAN, FOUND]), on, second=[100, 200]), "taps")
    season.correct_time(2, time(7), "Ann")
    said = season.undo(inspection=2)
    assert said.startswith("Undone: the correction of row 1, plant 2 on 2026-04-06. As it was ")
    assert "it counts again (found)" in said
    assert season.history.inspections.second.tolist() == [100, 200]
    assert season.undo(inspection=2) == "Undone: row 1, plant 2 on 2026-04-06 (found)."
    assert season.history.inspections.second.tolist() == [100]
