"""Replicates, measures, and the reference of the thesis's listings."""

import csv
import math

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter4.listing_errors import AS_PUBLISHED
from fieldmon.studies.thesis.chapter4.replicates import (
    NEVER,
    NoPriorRuns,
    detection_curve,
    measures,
    run_trials,
)
from fieldmon.studies.thesis.chapter4.trial import (
    TABLE_ROWS,
    NoPriorTrial,
    Prose,
    ThesisStrategy,
    table_viewpoints,
)
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS
from tests.thorough import times

LISTED = [
    NoPriorTrial(SCENARIOS[letter], strategy, table_viewpoints(strategy, AS_PUBLISHED), severity)
    for letter, severities in (("A", (0.1, 0.3, 0.5, 0.9)), ("B", (0.3,)), ("C", (0.3,)))
    for severity in severities
    for strategy in TABLE_ROWS
]


def by_hand(*days, aborted=0):
    """Return runs of one replicate: visited, found, infested, counted, true, end, left, ever."""
    table = np.array([days], dtype=float)
    return NoPriorRuns(NoPriorTrial(SCENARIOS["A"], ThesisStrategy(1)), table, np.array([aborted]))


DAYS = (
    (100, 30, 100, 20, 10, 101, 5.0, 100),
    (150, 20, 80, 0, 0, 251, 5.0, 250),
    (50, 60, 60, 4, 2, 301, 5.0, 250),
)


@pytest.mark.parametrize(
    ("measure", "value"),
    [
        ("PVV_ED2", 30.0),
        ("PCD_ED1", 30.0),
        ("PCD_ED2", 25.0),
        ("visited_all", 50.0),
        ("detected", 110),
        ("infected", 112),
        ("MD_before", 0),
        ("MD_after", 2),
        ("not_detected", 2),
        ("clear_pct", 99.6),
        ("PCD_ALL", 100.0),
        ("SumOfBugs_listed", 120),
        ("curve_listed_day2", 100 * 50 / 120),
        ("curve_true_day2", 100 * 50 / 110),
        ("D30_true", 1),
        ("D50_true", 3),
        ("D100_true", 3),
        ("D100_listed", NEVER),
        ("D50_pcd", 3),
        ("crash_share", 0),
    ],
)
def test_measures_are_what_the_thesis_defines(measure, value):
    assert measures(by_hand(*DAYS))[measure][0] == pytest.approx(value)


def test_an_aborted_run_has_no_measures():
    values = measures(by_hand(*DAYS, aborted=2))
    assert values.pop("crash_share")[0] == 1
    assert all(math.isnan(value[0]) for value in values.values())


def test_nothing_infested_is_nothing_detected_not_zero():
    clean = (10, 0, 0, 0, 0, 1, 0.0, 10)
    values = measures(by_hand(clean, clean, clean))
    assert math.isnan(values["PCD_ED1"][0])
    assert math.isnan(values["PCD_ALL"][0])
    assert values["D30_true"][0] == NEVER


@pytest.fixture(scope="module")
def listed_runs():
    return run_trials(LISTED, times(150, 400), 1)


def test_means_lie_within_three_standard_errors_of_the_reference(no_prior, listed_runs):
    with (no_prior / "reference.csv").open(encoding="utf-8", newline="") as file:
        reference = {
            (
                row["algorithm"],
                row["n"],
                row["scenario"],
                float(row["severity"]),
                row["measure"],
            ): row
            for row in csv.DictReader(file)
        }
    letters = {vineyard: letter for letter, vineyard in SCENARIOS.items()}
    cells, off = 0, []
    for runs in listed_runs:
        trial = runs.trial
        values = measures(runs)
        for measure in values.keys() - {"PCD_ALL", "MD_before", "MD_after"}:
            name = f"{measure}(4=never)" if measure.startswith("D") else measure
            key = (
                str(trial.strategy.algorithm),
                trial.strategy.n,
                letters[trial.vineyard],
                trial.severity,
                name,
            )
            theirs, ours = reference.pop(key), values[measure]
            ours = ours[~np.isnan(ours)]
            if not theirs["mean"]:
                # nothing is ever left there; three is what chance allows
                assert ours.size <= 3
                continue
            cells += 1
            mean, sd = float(theirs["mean"]), float(theirs["std"] or 0)
            if measure == "crash_share":
                sd = math.sqrt(mean * (1 - mean))
            error = math.hypot(
                ours.std(ddof=1) / math.sqrt(ours.size), sd / math.sqrt(int(theirs["replicates"]))
            )
            # the reference is printed to four decimals
            if abs(ours.mean() - mean) > 3 * error + 6e-5:
                off.append((*key, ours.mean(), mean))
    assert not reference
    assert cells > 2400
    assert len(off) <= 0.01 * cells, off


def test_every_strategy_meets_the_same_insects(listed_runs):
    in_a = [runs for runs in listed_runs if runs.trial.vineyard == SCENARIOS["A"]]
    starts = [runs.days[:, 0, 2] for runs in in_a]
    assert all((start == starts[0]).all() for start in starts)
    assert len(np.unique(starts[0])) > 20


def test_the_answer_does_not_depend_on_the_number_of_threads():
    some = [*LISTED[::9], NoPriorTrial(SCENARIOS["C"], ThesisStrategy(7, 3), rules=Prose())]
    one, four = (run_trials(some, 5, 4, threads=threads) for threads in (1, 4))
    for ours, theirs in zip(one, four, strict=True):
        assert ours.trial == theirs.trial
        assert (ours.days == theirs.days).all()


def test_seeds_matter_and_repeat():
    once, again, other = (run_trials(LISTED[:1], 5, seed)[0].days for seed in (1, 1, 2))
    assert (once == again).all()
    assert (once != other).any()


def test_progress_counts_the_trials():
    told = []
    run_trials(LISTED[:3], 2, 1, lambda done, total: told.append((done, total)))
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]


def test_a_single_replicate_is_refused_with_a_sentence():
    with pytest.raises(SettingError, match="at least 2 replicates, but there are 1"):
        run_trials(LISTED[:1], 1, 1)


def test_the_detection_curve_spans_the_working_hours_and_ends_at_what_was_found():
    trial = LISTED[10]
    hours, found = detection_curve(trial, 20, 1)
    assert (hours[0], hours[-1]) == (0, 6)
    (runs,) = run_trials([trial], 20, 1)
    assert found[-1] == pytest.approx(np.nanmean(measures(runs)["curve_listed_day3"]), abs=0.5)


def test_the_prose_draws_no_curve():
    with pytest.raises(SettingError, match="choose ListingErrors, not Prose"):
        detection_curve(NoPriorTrial(SCENARIOS["A"], ThesisStrategy(1), rules=Prose()), 2, 1)
