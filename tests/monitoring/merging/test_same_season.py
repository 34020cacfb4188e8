"""Whether two files are copies of one season."""

import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from datetime import timedelta

import pytest

from fieldmon.errors import FileProblem
from fieldmon.monitoring import Season
from fieldmon.monitoring.merging import same_season
from fieldmon.monitoring.merging.merge import merge_copies
from tests.monitoring.changes.test_outside_changes import outside
from tests.monitoring.merging.copies import begun_again, copied, copies_of, looks_for
from tests.monitoring.seasons import BEGINS, a_plot, a_season


def test_seasons_begun_apart_are_none_and_copies_of_another_pest_are_not_merged():
    one, other = copies_of(2)
    same_season.refuse_strangers(one, other)
    begun_again("2026-04-05T06:00:00.000000Z", one, other)
    apart = r"the other on 2026-04-05 06:00:00.000000 UTC: they are two seasons\. Leave each in its"
    with pytest.raises(FileProblem, match=apart):
        merge_copies(one, other)
    one, other = copies_of(2)
    looks_for(one, "mites")
    merge_copies(copied(one), other)  # one named its pest later
    looks_for(other, "flies")
    same_season.refuse_strangers(one, other)
    wrong = "looks for mites and the other for flies: finds would become those of another pest"
    with pytest.raises(FileProblem, match=wrong):
        merge_copies(one, other)
    begun_again("", one, other)
    with pytest.raises(FileProblem, match=wrong):
        same_season.refuse_strangers(one, other)


def test_another_season_is_no_copy_of_this_one(path, tmp_path):
    stranger = a_season(tmp_path / "stranger.gpkg", a_plot(width=0.0009))
    before = path.read_bytes()
    with pytest.raises(FileProblem, match="one is of another plot than the other") as refused:
        Season(path).merge(stranger)
    advice = str(refused.value).partition("planting. ")[2]
    other = shutil.copy(stranger.path, tmp_path / "named.gpkg")
    outside(other, "UPDATE plots SET name = 'Gate'", "DELETE FROM outside_changes")
    with pytest.raises(FileProblem, match="one is of the plot מטע Paran and the other of Gate"):
        Season(path).merge(Season(other))
    here = Season(path)
    begins = replace(here.settings, begins=BEGINS + timedelta(1))
    later = Season.create(tmp_path / "later.gpkg", here.plot, here.records, begins)
    with pytest.raises(FileProblem, match="other on 2026-04-07: they are two seasons") as refused:
        Season(path).merge(later)
    assert str(refused.value).endswith(advice), "what is done about it is the same"
    with closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA quick_check").fetchone() == ("ok",)
    assert path.read_bytes() == before
