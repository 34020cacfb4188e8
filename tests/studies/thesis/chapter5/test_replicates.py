"""Many paired seasons of chapter 5, what they come to, and the published figures beside them."""

import csv
import io
import math
from itertools import pairwise

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter5 import replicates, verdicts
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS, OpenChoices
from fieldmon.studies.thesis.chapter5.published import FIGURES, PARTS, Case, Published, cases_of
from fieldmon.studies.thesis.chapter5.replicates import run_trials, seed_keys
from fieldmon.studies.thesis.chapter5.report import charts, report_html
from fieldmon.studies.thesis.chapter5.seasons import PriorTrial
from fieldmon.studies.thesis.chapter5.sites import square
from fieldmon.studies.thesis.chapter5.study import rows, run_prior, run_site
from fieldmon.studies.thesis.chapter5.verdicts import compare, misfit
from fieldmon.studies.tidy_csv import csv_text

TRIALS = [PriorTrial(name, OpenChoices(), 1.0) for name in SAMPLERS]


@pytest.fixture(scope="module")
def study():
    return run_prior(("A", "spread"), 3, 1)


def fake(detection, visited=()):
    """Return runs whose finds make given detection curves, of 100 insects on 1000 plants."""
    detection = np.asarray(detection, float)
    tables = np.zeros((*detection.shape, 9))
    tables[..., 1] = np.diff(detection, axis=1, prepend=0)
    tables[:, 0, 3] = 100
    tables[..., 0] = visited if len(visited) else 10
    return replicates.PriorRuns(TRIALS[0], 1000, tables)


def test_the_answer_does_not_depend_on_threads():
    coins = seed_keys(3)
    one, two = run_trials(TRIALS, coins, threads=1), run_trials(TRIALS, coins, threads=3)
    for trial in TRIALS:
        assert np.array_equal(one.runs[trial].tables, two.runs[trial].tables, equal_nan=True)


def test_more_seeds_begin_with_the_same_seasons():
    few, many = (run_trials(TRIALS[:1], seed_keys(n)).runs[TRIALS[0]].tables for n in (2, 4))
    assert np.array_equal(few, many[:2], equal_nan=True)


def test_stopping_keeps_what_is_done():
    def stop(done, total):
        assert total == 3
        if done == 2:
            raise KeyboardInterrupt

    made = run_trials(TRIALS, seed_keys(2), stop)
    assert made.stopped
    assert len(made.runs) == 2


def test_measures_are_read_off_the_curves():
    season = fake([[30, 50, 100], [0, 10, 20]], visited=[[100, 50, np.nan], [100, 200, 300]])
    assert season.first_day(50).tolist() == [2, 4]
    assert season.first_day(100).tolist() == [3, 4]
    assert season.end_pct.tolist() == [100, 20]
    assert season.visited_a_day_pct.tolist() == [7.5, 20]


def test_one_seed_has_no_interval_and_is_refused():
    with pytest.raises(SettingError, match="2 seeds"):
        seed_keys(1)


def test_every_part_has_figures_and_plays_what_they_need():
    played = {case for part in PARTS for case in cases_of(part)}
    for figure in FIGURES:
        assert figure.part in PARTS
        assert set(figure.cases) <= played | {Case("dynamic", 5.0), Case("dynamic", 6.0)}
    assert {figure.part for figure in FIGURES if figure.fitted} == set(PARTS)
    text = {(f.part, f.value) for f in FIGURES}
    assert {("B", 84.0), ("B", 68.0), ("B", 46.0), ("C", 49.0), ("C", 34.0), ("C", 22.0)} <= text
    assert {("A", 67.0), ("A", 53.0), ("A", 47.0), ("C", 80.0), ("time", 21.0)} <= text


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
    season = fake(np.stack([np.zeros(3), np.asarray(ends, float)], axis=1))
    (ours,) = compare({case.trial(CALIBRATED): season}, CALIBRATED)
    assert (ours.verdict, ours.seeds) == (verdict, 3)
    assert ours.difference == pytest.approx(difference)
    assert misfit({case.trial(CALIBRATED): season}, CALIBRATED)["A"] == pytest.approx(
        min(abs(difference) / 5, 6)
    )


def test_figures_without_their_seasons_are_left_out(study):
    assert {each.part for each in study.compared} == {"A", "spread"}
    assert compare({}, CALIBRATED) == []


def test_the_tidy_table_holds_every_measure_and_day(study):
    table = list(csv.DictReader(io.StringIO(csv_text(rows(study)))))
    assert len(table) == 6 * (11 + 2 * 25)
    ends = [row for row in table if row["measure"] == "detection_end_pct"]
    last = [row for row in table if row["measure"] == "detection_pct" and row["day"] == "25"]
    assert [row["mean"] for row in ends] == [row["mean"] for row in last]
    assert {row["rate"] for row in ends if row["part"] == "spread"} == {"0.3", "0.5", "0.8"}
    for row in ends:
        assert float(row["low"]) <= float(row["mean"]) <= float(row["high"])


def test_the_report_shows_every_figure_with_plots_and_asks_the_world_nothing(study):
    page = report_html(study)
    assert "Figure 20" in page
    assert "Figure 27" in page
    assert page.count("<svg") == 3
    assert 'class="band' in page
    assert "//" not in page.replace("</", "")
    for each in study.compared:
        assert each.verdict in page
    assert math.isfinite(sum(len(chart) for part in study.parts for chart in charts(part)))


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


def test_sizes_grow():
    sizes = list(dict.fromkeys(case.hectares for case in cases_of("size")))
    assert all(small < big for small, big in pairwise(sizes))
    assert (sizes[0], sizes[-1]) == (1.0, 20.0)
