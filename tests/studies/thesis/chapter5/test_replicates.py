"""Many paired seasons of chapter 5, what they come to, and the published figures beside them."""

import math
from itertools import pairwise

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS, OpenChoices
from fieldmon.studies.thesis.chapter5.published import FIGURES, PARTS, Case, cases_of
from fieldmon.studies.thesis.chapter5.replicates import run_trials, seed_keys
from fieldmon.studies.thesis.chapter5.report import charts, report_html
from fieldmon.studies.thesis.chapter5.seasons import PriorTrial
from fieldmon.studies.thesis.chapter5.study import run_prior
from tests.studies.thesis.chapter5.made_up_runs import made_up_runs

TRIALS = [PriorTrial(name, OpenChoices(), 1.0) for name in SAMPLERS]


@pytest.fixture(scope="module")
def study():
    return run_prior(("A", "spread"), 3, 1)


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
    season = made_up_runs(
        [[30, 50, 100], [0, 10, 20]], visited=[[100, 50, np.nan], [100, 200, 300]]
    )
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


def test_sizes_grow():
    sizes = list(dict.fromkeys(case.hectares for case in cases_of("size")))
    assert all(small < big for small, big in pairwise(sizes))
    assert (sizes[0], sizes[-1]) == (1.0, 20.0)
