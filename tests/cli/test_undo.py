"""`fieldmon undo`: what was recorded is taken back."""

from datetime import date, time

import numpy as np

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from tests.cli.estate import BEGINS, filled_in

ON = date.fromisoformat(BEGINS)


def test_what_was_recorded_last_is_as_if_it_had_not_been(run, season, tmp_path):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")
    filled_in(tmp_path / "r.csv", finds={0}, n=5)
    before = Season(season).evening(ON)
    run("record", season, "r.csv", "--date", BEGINS)
    assert not np.array_equal(Season(season).evening(ON), before)
    code, out, _, _ = run("undo", season)
    assert (code, "5 inspections from r.csv" in out) == (0, True)
    assert np.array_equal(Season(season).evening(ON), before)
    assert out.splitlines()[1] == f"To let it count again: fieldmon undo {season} --redo 1"
    assert run("undo", season, "--redo", 1)[:2] == (0, "Batch 1 counts again: 5 inspections.\n")
    assert not np.array_equal(Season(season).evening(ON), before)
    code, _, err, _ = run("undo", season, "--redo", 1)
    assert (code, "must have been undone, but batch 1 was not" in err) == (2, True)
    assert "Batch 1 counts again" in run("log", season)[1]


def test_one_inspection_alone_is_taken_back(run, season, tmp_path):
    run("plan", season, "--no-bound", "--date", BEGINS, "-o", "r.csv")
    plants = filled_in(tmp_path / "r.csv", finds={0}, n=3)
    run("record", season, "r.csv", "--date", BEGINS)
    code, out, err, _ = run("undo", season, "--inspection", 2)
    assert code == 0, err
    assert out.splitlines()[1] == "This cannot be redone. If it was right, record it again."
    left = Season(season).history.inspections.plant.tolist()
    assert len(left) == 2
    assert set(left) < set(plants)
    run("record", season, "r.csv", "--date", BEGINS)
    assert set(Season(season).history.inspections.plant.tolist()) == set(plants)
    # the only one left of its batch leads to a batch that can be redone
    out = run("undo", season, "--inspection", 4)[1]
    assert out.splitlines()[1] == f"To let it count again: fieldmon undo {season} --redo 2"
    assert "Counts again" in run("undo", season, "--redo", 2)[1]


def test_a_correction_of_a_batch_that_was_undone_is_redone_after_that(run, season):
    kept = Season(season)
    for k, plants in enumerate(([0, 1, 2], [3])):
        kept.record(Inspections.of(np.array(plants), np.zeros(len(plants), int), BEGINS), f"f{k}")
    number = kept.numbered(plant=1)[0].number
    kept.correct_time(number, time(7), "Ann")
    kept.correct_time(kept.numbered(plant=3)[0].number, time(7), "Ann")
    stays = " stays as it was corrected since."
    out = run("undo", season, "--batch", "1")[1]
    assert "Batch 1 was undone: 2 inspections from f0. 1 inspection" + stays in out
    assert (
        "Batch 2 was undone: 0 inspections from f1. 1 inspection" + stays
        in run("undo", season, "--batch", "2")[1]
    )
    assert sorted(Season(season).history.inspections.plant.tolist()) == [1, 3]
    again = "fieldmon undo {} --redo {}".format
    out = run("undo", season, "--batch", "3")[1]
    both = f"To let it count again: {again(season, 1)}, and then: {again(season, 3)}\n"
    assert out.endswith(both)
    code, _, err, _ = run("undo", season, "--redo", "3")
    assert (code, "To let it" in err, "batch 1" in err) == (2, False, True)
    assert "Batch 1 counts again: 3 inspections." in run("undo", season, "--redo", "1")[1]
    assert run("undo", season, "--redo", "3")[0] == 0
    assert kept.numbered(plant=1)[0].second == 7 * 3600
    # that one alone stands again: its batch counts but for it
    run("undo", season, "--batch", "1")
    assert "Batch 1 counts again: 2 inspections." in run("undo", season, "--redo", "1")[1]
    assert Season(season).verify() == ()


def test_a_plant_that_is_gone_is_called_so(run, season):
    notes = np.array(["gone"], object)
    Season(season).record(Inspections.of(np.array([1]), np.array([2]), BEGINS, notes=notes), "me")
    assert "row 1, plant 2: gone" in run("status", season, "--batches")[1]
    assert f"row 1, plant 2 on {BEGINS} (gone)." in run("undo", season)[1]
    assert f"row 1, plant 2 on {BEGINS} (gone)." in run("undo", season, "--redo", "1")[1]
    assert f"row 1, plant 2 on {BEGINS} (gone)." in run("undo", season, "--inspection", "1")[1]


def test_a_change_to_an_earlier_value_is_taken_back_and_no_other(run, season):
    for hours in ("4", "3", "4"):
        run("change", season, "--hours", hours)
    run("change", season, "--harvest", "2026-12-10")
    run("change", season, "--hours", "3")
    run("change", season, "--hours", "4")
    code, out, _, _ = run("undo", season, "--change")
    assert (code, out.splitlines()[0]) == (
        0, "The last change was taken back: hours 4 (now 3 again).",
    )  # fmt: skip
    assert "the last change taken back: hours 4 to 3" in run("log", season)[1]
