"""Batches and inspections of a season taken back, and batches that count again."""

import pytest

from fieldmon.errors import SettingError
from fieldmon.monitoring.season.undoing import redo_batch, undo_with_batches
from tests.monitoring.seasons import BEGINS, some_results


def test_what_is_undone_names_the_batch_that_counts_again_once_it_is_redone(season):
    done = season.record(some_results(season, found=[0]), "x")
    believed = season.evening(BEGINS)
    undone = undo_with_batches(season, who="Ann")
    assert (undone.batch, undone.first) == (done.batch, None)
    assert len(season.inspections) == 0
    redo_batch(season, undone.batch, "Ben")
    assert (season.evening(BEGINS) == believed).all()
    assert [one.who for one in season.log()[-2:]] == ["Ann", "Ben"]
    one = season.numbered(BEGINS)[0]
    assert undo_with_batches(season, inspection=one.number).batch is None
    with pytest.raises(SettingError, match="both are given"):
        undo_with_batches(season, done.batch, one.number)
    assert season.verify() == ()
