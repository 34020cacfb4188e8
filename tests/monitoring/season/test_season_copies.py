"""A season that takes in what its copies hold, and says what came of it."""

import shutil
from dataclasses import replace
from datetime import timedelta

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring import Season
from tests.monitoring.merging.copies import SPRAYED, result
from tests.monitoring.seasons import BEGINS, state


def test_what_is_new_and_what_was_taken_back_are_counted_apart(path, other):
    counted = len(Season(path).history.inspections)
    theirs = Season(other)
    theirs.undo()
    gone = counted - len(theirs.history.inspections)
    theirs.record(result(9, FOUND), "taps", "Ben")
    season = Season(path)
    done = season.merge(theirs)
    assert gone > 1
    assert (done.new, done.taken_back) == (1, gone)
    assert season.log()[-1].what["new"] == 1
    again = season.merge(theirs)
    assert (again.new, again.taken_back) == (0, 0)


def test_two_people_who_worked_apart_find_both_days_in_one_season(path, other):
    Season(path).record(result(3, FOUND), "taps", "Ann")
    Season(other).record(result(9, FOUND), "taps", "Ben")
    Season(other).treat(BEGINS, 0.5)
    Season(other).plan(BEGINS)
    before = other.read_bytes()
    season = Season(path)
    done = season.merge(Season(other))
    assert (done.new, done.contradictions) == (1, ())
    assert other.read_bytes() == before
    assert state(path) == 14
    assert len(season.history.treatments) == 1
    assert [batch.who for batch in season.batches()] == ["", "Ben", "Ann", "Ann"]
    again = Season(other)
    again.merge(Season(path))
    np.testing.assert_array_equal(season.evening(BEGINS), again.evening(BEGINS))
    np.testing.assert_array_equal(season.kept_route(BEGINS), again.kept_route(BEGINS))


def test_what_the_copies_tell_differently_is_listed_and_both_are_kept(path, other):
    season, there = Season(path), Season(other)
    season.record(result(3, FOUND), "taps")
    there.record(result(3, CLEAN), "taps")
    season.change(replace(season.settings, seed=5), season.settings)
    there.change(replace(there.settings, seed=7), there.settings)
    done = season.merge(Season(other))
    assert "recorded as found, now clean" in done.contradictions[0]
    (said,) = (said for said in done.contradictions if "The setting season differs" in said)
    assert said.endswith("seed 5 here, seed 7 there. What was chosen last counts: seed 7.")
    assert season.settings.seed == 7
    assert sorted(season.history.on(1).result.tolist()) == [CLEAN, FOUND]


def test_a_spraying_undone_in_one_copy_is_named_with_the_wait_that_ends(path, other):
    here = Season(path)
    here.treat(BEGINS, 0.5, application=replace(SPRAYED, waiting_days=14))
    there = Season(shutil.copy(path, other))
    there.undo()
    done = there.merge(here)
    said = (
        f"The treatment with Acarol on {BEGINS} counted {{}}, but was undone {{}}: it does not "
        f"count, nor do its warnings and its wait (harvest from {BEGINS + timedelta(days=15)}). "
        f"If it was done, record it again: in the app, or with: fieldmon treat"
    )
    assert done.contradictions == (said.format("there", "here"),)
    n = len(there.log())
    done = here.merge(there)
    assert done.contradictions == (said.format("here", "there"),)
    assert here.treatments() == ()
    assert f"; undone there: Acarol on {BEGINS}" in here.log()[-1].sentence()
    assert (here.merge(there).contradictions, len(there.log())) == ((), n)
    here.treat(BEGINS, 0.5, application=replace(SPRAYED, waiting_days=14))
    assert there.merge(here).contradictions == ()
    assert len(there.treatments()) == 1


@pytest.mark.parametrize("way", ["here", "there"])
def test_a_spraying_that_both_recorded_is_named_where_each_undid_another_recording(
    path, other, way
):
    for copy in (path, other):
        Season(copy).treat(BEGINS, 0.5, application=SPRAYED)
    here = Season(path)
    here.merge(Season(other))
    there = Season(shutil.copy(path, other))
    first, second = sorted(one.number for one in here.batches() if one.kind == "treatment")
    here.undo(first)
    there.undo(second)
    one, another = (here, there) if way == "here" else (there, here)
    done = one.merge(another)
    said = (
        f"The treatment with Acarol on {BEGINS} counted in both, but each undid another recording "
        f"of it: it does not count, nor do its warnings. If it was done, record it again: in the "
        f"app, or with: fieldmon treat"
    )
    assert done.contradictions == (said,)
    assert f"; undone there: Acarol on {BEGINS}" in one.log()[-1].sentence()
    assert one.treatments() == ()
    one.treat(BEGINS, 0.5, application=SPRAYED)
    assert one.merge(another).contradictions == ()
    another.merge(one)
    assert (len(one.treatments()), len(another.treatments())) == (1, 1)
