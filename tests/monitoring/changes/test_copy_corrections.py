"""A finding corrected or deleted in a copy comes into the season, with its author."""

import shutil
from datetime import UTC, datetime

import pytest

from fieldmon.errors import ContradictionError, FileProblem
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring import Season
from tests.monitoring.changes.test_outside_changes import moved_to, outside
from tests.monitoring.seasons import three_results


@pytest.fixture
def copy(path, tmp_path):
    (tmp_path / "field").mkdir()
    return shutil.copy(path, tmp_path / "field" / "copy.gpkg")


def test_a_corrected_finding_is_corrected_in_the_season_by_its_author(path, copy):
    outside(copy, "UPDATE inspections SET result = 'found', who = 'Bo' WHERE fid = 1")
    season = Season(path)
    season.record(three_results(), "tuesday.csv")  # the season went on meanwhile
    plant = int(season.history.inspections.plant[0])
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 1
    assert season.history.states(0)[plant] == FOUND
    last = season.batches()[0]
    assert (last.kind, last.who, last.rows) == ("corrections", "Ann", 1)
    assert last.source == "changed in copy.gpkg"
    assert season.log()[-1].kind == "corrected"
    assert season.verify() == ()
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 0  # twice is once
    assert len(season.history.inspections) == 15


def test_corrections_of_a_copy_that_contradict_what_is_recorded_are_to_be_confirmed(path, copy):
    season = Season(path)
    held, before = season.history.inspections, len(season.log())
    outside(copy, moved_to(season.plot.grid.lonlat(held.plant[:1])[0], 3))
    with pytest.raises(ContradictionError, match="Corrections must not contradict"):
        season.take_corrections(copy, "copy.gpkg", "Ann")
    with pytest.raises(ContradictionError, match="Corrections must not contradict"):
        season.record_all([(held.take([]), "copy.gpkg")], "Ann", copies=[copy])
    assert len(season.log()) == before
    assert season.take_corrections(copy, "copy.gpkg", "Ann", confirmed=True) == 1
    assert season.verify() == ()


def test_a_finding_corrected_to_gone_is_taken_once(path, copy):
    outside(copy, "UPDATE inspections SET result = 'gone' WHERE fid = 1")
    season = Season(path)
    plant = int(season.history.inspections.plant[0])
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 1
    assert season.history.gone(0).nonzero()[0].tolist() == [plant]
    assert season.verify() == ()
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 0


def test_a_finding_moved_or_cleared_of_its_count_in_a_copy_is_so_in_the_season(path, tmp_path):
    outside(path, "UPDATE inspections SET count = 2 WHERE fid = 3")
    season = Season(path)
    season.correct("Ann")
    copy = shutil.copy(path, tmp_path / "copy.gpkg")
    outside(copy, moved_to(season.plot.grid.lonlat()[301]),
            "UPDATE inspections SET result = 'clean' WHERE fid = 3")  # fmt: skip
    plants = season.history.inspections.plant
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 2
    states = season.history.states(0)
    assert states[[301, plants[0], plants[2]]].tolist() == [CLEAN, -1, CLEAN]
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 0
    assert season.verify() == ()


def test_a_deleted_finding_counts_no_more_and_is_kept(path, copy):
    outside(copy, "DELETE FROM inspections WHERE fid = 3")
    season = Season(path)
    plant = int(season.history.inspections.plant[2])
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 1
    assert season.history.states(0)[plant] == -1
    with season.store.reading() as db:
        assert db.execute("SELECT undone FROM inspections WHERE fid = 3").fetchone() != (0,)
    assert season.verify() == ()
    assert season.take_corrections(copy, "copy.gpkg", "Ann") == 0


def test_a_deleted_finding_is_found_where_the_season_has_other_numbers_by_now(path, tmp_path):
    season, there = Season(path), Season(shutil.copy(path, tmp_path / "there.gpkg"))
    there.record(three_results().take(slice(1)), "theirs", "Ben")
    there.undo()
    season.record(three_results().take(slice(1, 2)), "ours", "Ann")
    brought = shutil.copy(path, tmp_path / "brought.gpkg")
    season.merge(there)  # Ben's, which was taken back, has the number that Ann's had
    outside(brought, "DELETE FROM inspections WHERE plant = 101")
    assert season.take_corrections(brought, "brought.gpkg", "Ann") == 1
    assert 101 not in season.history.inspections.plant
    assert season.take_corrections(brought, "brought.gpkg", "Ann") == 0


def test_what_makes_no_sense_or_is_not_here_is_refused_whole(path, copy, monkeypatch):
    monkeypatch.setattr(
        "fieldmon.plot.local_clock.utc_now", lambda: datetime(2026, 11, 5, 12, tzinfo=UTC)
    )
    outside(copy, "DELETE FROM inspections WHERE fid = 2",
            "UPDATE inspections SET result = 'maybe' WHERE fid = 1")  # fmt: skip
    season = Season(path)
    with pytest.raises(FileProblem, match="maybe"):
        season.take_corrections(copy, "copy.gpkg", "Ann")
    assert len(season.history.inspections) == 12
    outside(copy, "UPDATE inspections SET result = 'found', date = '2026-11-06' WHERE fid = 1")
    with pytest.raises(FileProblem, match="2026-11-06, has not come"):
        season.take_corrections(copy, "copy.gpkg", "Ann")
    outside(copy, "UPDATE inspections SET date = '2026-04-06' WHERE fid = 1")
    season.undo()
    with pytest.raises(FileProblem, match="no longer"):
        season.take_corrections(copy, "copy.gpkg", "Ann")
