"""A file is merged whole or not at all, and told before as it is merged."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.io.options import Upload
from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.season.copies_to_merge import merge_ahead, merge_file
from tests.monitoring.seasons import BEGINS
from tests.paths import ROOT

OLD = ROOT / "tests" / "monitoring" / "seasons_of_old"


@pytest.fixture
def copy(path, tmp_path):
    """Return a copy in which two people found something, and somebody sprayed."""
    other = Season(shutil.copy(path, tmp_path / "copy.gpkg"))
    for who, plants in (("Ben", [40, 41]), ("Ada", [41, 42, 43]), ("", [44])):
        found = np.full(len(plants), FOUND)
        other.record(Inspections.of(plants, found, np.datetime64(BEGINS)), "taps", who)
    other.treat(BEGINS, 0.5)
    return other


def test_what_merging_would_bring_is_what_it_brings_and_is_not_written(path, copy):
    season, before = Season(path), path.read_bytes()
    ahead = merge_ahead(season, copy.path)
    assert path.read_bytes() == before
    upload = Upload("copy.gpkg", copy.path.read_bytes())
    assert merge_ahead(season, upload) == ahead == merge_file(season, upload)
    merged = ahead.merged
    assert (merged.new, merged.treatments, merged.changed) == (5, 1, True)
    assert merged.of_new.by == (("Ada", 2), ("Ben", 2), ("", 1))
    assert (merged.of_new.plants, merged.of_new.found) == (5, 5)
    assert merged.of_new.days == (str(BEGINS),)
    assert merged.treated == (f"a product that nobody named on {BEGINS}",)
    again = merge_file(season, upload).merged
    assert (again.changed, again.new, again.entries) == (False, 0, 0)


def test_a_merge_that_fails_at_its_end_leaves_the_season_as_it_was(path, copy, monkeypatch):
    season, before = Season(path), len(Season(path).log())

    def fails(*_):
        raise FileProblem("full")

    monkeypatch.setattr(scouts, "overlaps", fails)
    with pytest.raises(FileProblem, match="full"):
        merge_file(season, copy.path)
    monkeypatch.undo()
    assert (len(Season(path).inspections), len(Season(path).log())) == (12, before)
    assert merge_file(season, copy.path).merged.new == 5


def test_a_copy_of_an_earlier_version_is_merged_and_stays_as_it_is(tmp_path):
    old = Path(shutil.copy(OLD / "of_format_11.gpkg", tmp_path / "old.gpkg"))
    before = old.read_bytes()
    season = Season(shutil.copy(old, tmp_path / "season.gpkg"))
    n = len(season.inspections)
    season.undo(inspection=1)
    merged = merge_file(season, old).merged
    assert (merged.new, len(season.inspections)) == (0, n - 1)
    assert old.read_bytes() == before
    assert not [*tmp_path.glob("old.gpkg.*")]


@pytest.mark.parametrize("name", ["..", "", "x" * 300, "a\0b"])
def test_an_upload_may_have_a_name_that_no_file_can_have(path, copy, name):
    assert merge_ahead(Season(path), Upload(name, copy.path.read_bytes())).merged.new == 5
