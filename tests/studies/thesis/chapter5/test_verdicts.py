"""Published figures beside ours: when they agree, are near, differ; when an ordering holds."""

import numpy as np
import pytest

from fieldmon.studies.thesis.chapter5 import verdicts
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.published import Case, Published
from fieldmon.studies.thesis.chapter5.verdicts import compare, misfit
from tests.studies.thesis.chapter5.made_up_runs import made_up_runs

CASE = Case("dynamic", 1.0)


def ends(*values):
    """Return the runs of the case whose seasons end at so many percent."""
    runs = made_up_runs(np.stack([np.zeros(len(values)), np.asarray(values, float)], axis=1))
    return {CASE.trial(CALIBRATED): runs}


def figure(kind="is", value=50.0, part="A", **more):
    return Published(part, "it", kind, value, 5.0, (CASE,), lambda runs: runs.end_pct, **more)


@pytest.mark.parametrize(
    ("kind", "value", "ends", "verdict", "difference"),
    [
        ("is", 50.0, [48, 51, 50], verdicts.AGREES, -1 / 3),
        ("is", 50.0, [58, 60, 59], verdicts.NEAR, 9.0),
        ("is", 50.0, [0, 60, 0], verdicts.DIFFERS, -30.0),
        ("least", 90.0, [95, 96, 97], verdicts.AGREES, 0.0),
        ("least", 90.0, [85, 84, 83], verdicts.NEAR, -6.0),
        ("above", 0.0, [5, 6, 7], verdicts.HOLDS, 6.0),
        ("above", 0.0, [-5, 6, 2], verdicts.OPEN, 1.0),
        ("above", 0.0, [0, 0, 0], verdicts.FAILS, 0.0),
    ],
)
def test_verdicts_go_by_difference_and_orderings_by_interval(
    monkeypatch, kind, value, ends, verdict, difference
):
    case = Case("dynamic", 1.0)
    figure = Published("A", "it", kind, value, 5.0, (case,), lambda season: season.end_pct)
    monkeypatch.setattr(verdicts, "FIGURES", (figure,))
    season = made_up_runs(np.stack([np.zeros(3), np.asarray(ends, float)], axis=1))
    (ours,) = compare({case.trial(CALIBRATED): season}, CALIBRATED)
    assert (ours.verdict, ours.seeds) == (verdict, 3)
    assert ours.difference == pytest.approx(difference)
    assert misfit({case.trial(CALIBRATED): season}, CALIBRATED)["A"] == pytest.approx(
        min(abs(difference) / 5, 6)
    )


def test_what_is_published_is_said_with_its_kind(monkeypatch):
    kinds = {"is": "50", "least": "50 or more", "above": "more than 50"}
    monkeypatch.setattr(verdicts, "FIGURES", [figure(kind) for kind in kinds])
    assert [each.published for each in compare(ends(40, 60), CALIBRATED)] == list(kinds.values())


def test_interval_and_seeds_are_those_of_the_runs(monkeypatch):
    monkeypatch.setattr(verdicts, "FIGURES", [figure()])
    (ours,) = compare(ends(40, 60, 50, 50), CALIBRATED)
    assert (ours.ours, ours.seeds, ours.difference) == (50.0, 4, 0.0)
    assert ours.low == pytest.approx(50 - 3.1824463 * np.std([40, 60, 50, 50], ddof=1) / 2)
    assert ours.high - 50 == pytest.approx(50 - ours.low)


def test_a_misfit_is_a_mean_over_what_is_fitted_and_nothing_counts_more_than_six(monkeypatch):
    figures = [figure(value=60.0), figure(value=40.0), figure(value=1000.0)]
    monkeypatch.setattr(verdicts, "FIGURES", [*figures, figure(value=0.0, fitted=False)])
    assert misfit(ends(45, 55), CALIBRATED) == {"A": pytest.approx((2 + 2 + 6) / 3)}


def test_figures_without_their_seasons_and_of_other_parts_are_left_out(monkeypatch):
    monkeypatch.setattr(verdicts, "FIGURES", [figure(part="A"), figure(part="B")])
    assert compare({}, CALIBRATED) == []
    assert misfit({}, CALIBRATED) == {}
    assert [each.part for each in compare(ends(1, 2), CALIBRATED, ["B"])] == ["B"]
