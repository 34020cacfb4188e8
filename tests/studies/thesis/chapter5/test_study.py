"""Scenarios, sweeps and own plots, made again, and the tidy table of them."""

import csv
import io

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS
from fieldmon.studies.thesis.chapter5.published import PARTS, cases_of
from fieldmon.studies.thesis.chapter5.report import report_html
from fieldmon.studies.thesis.chapter5.sites import square
from fieldmon.studies.thesis.chapter5.study import TITLES, label_of, rows, run_prior, run_site
from fieldmon.studies.tidy_csv import csv_text


@pytest.fixture(scope="module")
def study():
    return run_prior(("spread", "A"), 3, 1)


def test_parts_stand_in_the_order_of_the_thesis_with_their_runs_and_figures(study):
    assert [(part.name, part.title) for part in study.parts] == [
        (name, TITLES[name]) for name in ("A", "spread")
    ]
    for part in study.parts:
        wanted = [case.trial(study.choices) for case in cases_of(part.name)]
        assert [runs.trial for runs in part.runs] == wanted
        assert {each.part for each in part.compared} == {part.name}
    assert {each.part for each in study.compared} == {"A", "spread"}


def test_the_tidy_table_holds_every_measure_and_day(study):
    table = list(csv.DictReader(io.StringIO(csv_text(rows(study)))))
    assert len(table) == 6 * (11 + 2 * 25)
    ends = [row for row in table if row["measure"] == "detection_end_pct"]
    last = [row for row in table if row["measure"] == "detection_pct" and row["day"] == "25"]
    assert [row["mean"] for row in ends] == [row["mean"] for row in last]
    assert {row["rate"] for row in ends if row["part"] == "spread"} == {"0.3", "0.5", "0.8"}
    for row in ends:
        assert float(row["low"]) <= float(row["mean"]) <= float(row["high"])


def test_a_stopped_study_says_so():
    def stop(done, total):  # noqa: ARG001
        raise KeyboardInterrupt

    made = run_prior(("A",), 2, 1, progress=stop)
    assert made.stopped
    assert len(made.parts) <= 1
    assert "Stopped before the end" in report_html(made)


def test_an_own_plot_is_played_by_the_same_samplers():
    made = run_site(square(1.0), 2)
    (part,) = made.parts
    assert [each.trial.sampler for each in part.runs] == list(SAMPLERS)
    assert made.compared == []
    assert report_html(made).count("<svg") == 2
    same = run_prior(("A",), 2, 1).parts[0]
    for one, other in zip(part.runs, same.runs, strict=True):
        assert np.array_equal(one.tables, other.tables, equal_nan=True)


def test_unknown_parts_are_refused():
    with pytest.raises(SettingError, match="A, B, C, size"):
        run_prior(("D",), 2)


@pytest.mark.parametrize("part", PARTS)
def test_a_part_tells_its_trials_apart(part):
    trials = [case.trial(CALIBRATED) for case in cases_of(part)]
    labels = [(label_of(part, trial), trial.hectares) for trial in trials]
    assert len(set(labels)) == len(labels)
