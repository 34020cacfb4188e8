"""One inspection that several copies corrected otherwise counts once: as it was corrected last."""

import shutil
from datetime import timedelta
from itertools import permutations

import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.monitoring import Season
from tests.monitoring.merging.copies import result
from tests.monitoring.seasons import BEGINS
from tests.thorough import times


def dated(day):
    return lambda season, row: season.correct_time(row, None, "Ann", BEGINS + timedelta(days=day))


def seen(what):
    """Let another result hold in place of the one of plant 3."""
    return lambda season, _: season.record_instead(result(3, what, 0), "me", "Ben")


def counting(season):
    """Return day and result of what counts of plant 3."""
    held = season.history.inspections
    held = held.take(held.plant == 3)
    return [*zip(held.date.astype(str).tolist(), held.result.tolist(), strict=True)]


@pytest.fixture
def copies(season, tmp_path):
    """Give three copies of a season, and the number of its one inspection, a find at plant 3."""
    season.record(result(3, FOUND, 0), "monday.csv", "Ann")
    (row,) = (one.number for one in season.numbered(plant=3))
    return [shutil.copy(season.path, tmp_path / f"copy{k}.gpkg") for k in range(3)], row


DAYS = [str(BEGINS + timedelta(days=day)) for day in range(4)]


@pytest.mark.parametrize("how", [
    [(dated(1), (DAYS[1], FOUND)), (dated(2), (DAYS[2], FOUND))],
    [(dated(1), (DAYS[1], FOUND)), (seen(CLEAN), (DAYS[0], CLEAN))],
    [(seen(CLEAN), (DAYS[0], CLEAN)), (dated(1), (DAYS[1], FOUND))],
])  # fmt: skip
def test_what_was_corrected_last_holds_is_said_and_the_other_comes_back(copies, how):
    (one, other, _), row = copies
    for path, (correct, _) in zip((one, other), how, strict=True):
        correct(Season(path), row)
    whole = Season(shutil.copy(one, one.with_name("whole.gpkg")))
    done = whole.merge(Season(other))
    (_, first), (_, last) = how
    assert counting(whole) == [last]
    assert (done.new, done.taken_back) == (1, 1)
    (said,) = done.contradictions
    found = f"found at row 1, plant 4 on {DAYS[0]}"
    assert said.startswith(f"Both copies corrected one inspection: {found} is now ")
    assert "counts: the one there. If the other is right, undo inspection " in said
    assert "; Both copies corrected one inspection" in whole.log()[-1].sentence()
    assert whole.merge(Season(other)).contradictions == ()
    there = Season(other)
    assert "counts: the one here." in there.merge(Season(one)).contradictions[0]
    assert counting(there) == [last]
    # either way back, and again
    later, earlier = (one.number for one in whole.batches()[:2])
    for do, batch, counts in (
        (whole.undo, later, first),
        (whole.undo, earlier, (DAYS[0], FOUND)),
        (whole.redo, later, last),
        (whole.undo, later, (DAYS[0], FOUND)),
        (whole.redo, earlier, first),
        (whole.redo, later, last),
        (whole.undo, earlier, last),
    ):
        do(batch)
        assert counting(whole) == [counts]
    with pytest.raises(SettingError, match="Undo that first"):
        whole.redo(earlier)
    whole.undo(later)
    for batch in (earlier, later):
        whole.redo(batch)
    whole.undo(inspection=int(said.split("undo inspection ")[1].rstrip(".")))
    assert counting(whole) == [first]
    assert whole.verify() == ()


def test_three_copies_come_out_the_same_in_every_order(copies):
    paths, row = copies
    for day, path in enumerate(paths, 1):
        dated(day)(Season(path), row)
    dated(1)(Season(paths[1]), row)
    dated(0)(Season(paths[0]), row)  # as it was at first
    # half of the orders; all six with FIELDMON_EXAMPLES
    for k, order in enumerate([*permutations(paths)][: times(3, 6)]):
        whole = Season(shutil.copy(order[0], paths[0].with_name(f"whole{k}.gpkg")))
        assert [len(whole.merge(Season(path)).contradictions) for path in order[1:]] == [1, 1]
        assert counting(whole) == [(DAYS[0], FOUND)]
        assert whole.verify() == ()


def test_what_was_recorded_anew_after_a_correction_is_another_inspection(copies):
    (one, other, _), row = copies
    season = Season(one)
    dated(1)(season, row)
    season.record(result(3, FOUND, 0), "taps", "Ann")
    dated(2)(season, season.numbered(plant=3)[0].number)
    season.merge(Season(other))
    assert len(counting(season)) == 2
