"""The search for the open choices that fit the published figures best."""

import csv
import io

import pytest

from fieldmon.studies.thesis.chapter5 import calibrate as module
from fieldmon.studies.thesis.chapter5.calibrate import (
    SPACE,
    Effort,
    TriedChoices,
    calibrate,
    candidates_csv,
    choices_of,
    values_of,
)
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.published import PARTS


@pytest.fixture
def quick(monkeypatch):
    """Let the misfit be told from the choices alone, so that the best is known."""
    tried = []

    def off(runs, choices):  # noqa: ARG001
        tried.append(choices)
        values = values_of(choices)
        wrong = sum(values[name] != SPACE[name][0] for name in SPACE)
        parts = dict.fromkeys(PARTS, float(wrong))
        # A is met by one value of `counts`, B by the other
        parts["A"] = 0.0 if values["counts"] == "plants" else 3.0
        parts["B"] = 3.0 - parts["A"]
        return parts

    class FinishedTrials:
        runs, stopped = None, False

    monkeypatch.setattr(module, "misfit", off)
    monkeypatch.setattr(module, "run_trials", lambda *_: FinishedTrials)
    monkeypatch.setattr(module, "seed_keys", lambda *_: None)
    return tried


def test_choices_and_their_values_lead_back_to_each_other():
    values = {name: each[-1] for name, each in SPACE.items()}
    assert values_of(choices_of(values)) == values
    assert choices_of(values_of(CALIBRATED)) == CALIBRATED


def test_the_search_comes_nearer_step_by_step(quick):  # noqa: ARG001
    short = calibrate(Effort(drawn=40, kept=8, steps=0, finalists=8))
    long = calibrate(Effort(drawn=40, kept=8, steps=600, finalists=8))
    assert long.best.joint < short.best.joint


def test_the_best_are_named_jointly_and_part_by_part(quick):  # noqa: ARG001
    found = calibrate(Effort(drawn=60, kept=20, steps=50, finalists=20))
    assert found.best.joint == min(each.joint for each in found.tried)
    for part in PARTS:
        assert found.per_part[part].off[part] == min(each.off[part] for each in found.tried)


def test_parts_that_nothing_meets_together_conflict(quick):  # noqa: ARG001
    found = calibrate(Effort(drawn=60, kept=20, steps=50, finalists=20))
    assert ("A", "B", 0.0, 3.0) in found.conflicts
    assert all(both - alone >= 0.5 for *_, alone, both in found.conflicts)
    assert {"C", "size"} & {part for pair in found.conflicts for part in pair[:2]} == set()


def test_a_search_can_be_stopped(quick):  # noqa: ARG001
    def stop(done, total):  # noqa: ARG001
        if done == 45:
            raise KeyboardInterrupt

    found = calibrate(Effort(drawn=40, kept=8, steps=50, finalists=8), progress=stop)
    assert found.stopped
    assert 0 < len(found.tried) <= 8


def test_a_search_gives_the_same_again_and_fills_its_table(quick):  # noqa: ARG001
    effort = Effort(drawn=20, kept=5, steps=20, finalists=5)
    one, two = calibrate(effort, 3), calibrate(effort, 3)
    assert one.tried == two.tried
    table = list(csv.DictReader(io.StringIO(candidates_csv(one.tried))))
    assert set(table[0]) == {"joint", *PARTS, *SPACE}
    joint = [float(row["joint"]) for row in table]
    assert joint == sorted(joint)


def test_the_joint_fit_is_the_mean_over_the_parts():
    each = TriedChoices(CALIBRATED, tuple((part, float(k)) for k, part in enumerate(PARTS)))
    assert each.joint == pytest.approx(3.0)
