"""Whether anything that counts was changed, whoever changed it."""

import shutil

from fieldmon.monitoring import Season
from tests.monitoring.seasons import BEGINS, some_results


def test_a_copy_that_was_brought_back_and_changed_as_often_since_is_another_file(season):
    copy = season.path.with_name("copy.gpkg")
    season.store.back_up(copy)
    season.record(some_results(season, found=[0, 1]), "wrong")
    before, counts = season.revision, season.revision.split(",")[:2]
    shutil.copyfile(copy, season.path)
    Season(season.path).record(some_results(Season(season.path), found=[2]), "right")
    assert season.revision.split(",")[:2] == counts
    assert season.revision != before
    assert season.status(BEGINS).found == 1
