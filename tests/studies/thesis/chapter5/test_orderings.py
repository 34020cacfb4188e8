"""What chapter 5 concludes, over paired seeds with 95 % intervals, under the calibrated rules.

Where the thesis's conclusion does not hold with ours, the test says what does; docs/chapter5 gives
both numbers.

On 1 ha, where a fraction of a day decides, there are 100 seeds, as on that page. What is concluded
of larger plots is sure with 20, and of the rate of spread with 40; FIELDMON_SEEDS=100 tries it with
as many as there.
"""

import os

import numpy as np
import pytest

from fieldmon.simulation.statistics import summary_statistics
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import SAMPLERS, SCENARIOS, SIZES_HA
from fieldmon.studies.thesis.chapter5.published import Case
from fieldmon.studies.thesis.chapter5.replicates import run_trials, seed_keys
from fieldmon.studies.thesis.chapter5.verdicts import HOLDS, compare

# 260 seasons for the first tests: seconds on a free machine, minutes on a busy one
pytestmark = pytest.mark.timeout(900)

CASES = [
    *(Case(name, ha) for ha in SCENARIOS.values() for name in SAMPLERS),
    *(Case("dynamic", ha) for ha in SIZES_HA),
    *(Case("dynamic", 6.0, look_s=look_s) for look_s in (20.0, 40.0)),
]
RATES = [Case("dynamic", 5.0, rate=rate) for rate in (0.3, 0.8)]

SEEDS = int(os.environ.get("FIELDMON_SEEDS", "20"))


def runs_of(cases, n_seeds):
    return run_trials([case.trial(CALIBRATED) for case in cases], seed_keys(n_seeds)).runs


@pytest.fixture(scope="module")
def runs():
    return runs_of(CASES, SEEDS)


@pytest.fixture(scope="module")
def on_1_ha():
    return runs_of([Case(name, 1.0) for name in SAMPLERS], 100)


@pytest.fixture(scope="module")
def of(runs):
    return lambda *case, **more: runs[Case(*case, **more).trial(CALIBRATED)]


def orderings(runs, part):
    return [
        each
        for each in compare(runs, CALIBRATED, [part])
        if each.published == "more than 0" and not each.what.startswith("The fall")
    ]


@pytest.mark.parametrize("part", ["B", "C"])
def test_dynamic_finds_more_than_naive_and_naive_more_than_bouncy(runs, part):
    both = orderings(runs, part)
    assert len(both) == 2
    assert {each.verdict for each in both} == {HOLDS}


def test_on_1_ha_dynamic_finds_half_most_and_all_sooner(on_1_ha):
    said = orderings(on_1_ha, "A")
    assert len(said) == 6
    assert {each.verdict for each in said} == {HOLDS}


def test_detection_never_rises_with_field_size_and_falls_from_7_to_14_ha(runs, of):
    steps = orderings(runs, "size")
    assert len(steps) == len(SIZES_HA) - 1
    assert all(step.high >= 0 for step in steps)
    ends = {ha: of("dynamic", ha).end_pct for ha in SIZES_HA}
    for small, big in ((5.0, 10.0), (7.0, 10.0), (10.0, 14.0)):
        assert summary_statistics(ends[small] - ends[big]).low > 0
    (fall,) = (c for c in compare(runs, CALIBRATED, ["size"]) if c.what.startswith("The fall"))
    assert fall.verdict == HOLDS


def test_the_rate_of_spread_hardly_matters_at_the_end():
    slow, fast = runs_of(RATES, max(SEEDS, 40)).values()
    end = summary_statistics(slow.end_pct - fast.end_pct)
    early = summary_statistics((slow.detection_pct - fast.detection_pct)[:, :3].mean(axis=1))
    assert -5 < end.low <= end.high < 5
    assert 0 < early.low <= early.high < 10


def test_longer_inspection_helps_on_day_1(runs):
    (said,) = orderings(runs, "time")
    assert said.verdict == HOLDS


def test_every_sampler_clears_1_ha(on_1_ha):
    ends = {name: on_1_ha[Case(name, 1.0).trial(CALIBRATED)].end_pct for name in SAMPLERS}
    assert np.all(ends["dynamic"] == 100)
    assert np.mean(ends["naive"]) == pytest.approx(100, abs=0.5)
    # the thesis's Bouncy clears it too, after 4 days
    assert 94 < np.mean(ends["bouncy"]) <= 100
