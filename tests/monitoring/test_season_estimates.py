"""What a season knows follows from what was recorded."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.monitoring.history import BeliefSettings
from tests.monitoring.seasons import (
    BEGINS,
    a_season,
    on,
    some_results,
)


def test_a_find_raises_its_neighbours_and_a_clean_look_lowers(season):
    grid, find, clean = season.plot.grid, 100, 300
    (start, plant), on_day = grid.adjacent, np.datetime64(BEGINS, "D")
    beside_find, beside_clean = (plant[start[one] : start[one + 1]] for one in (find, clean))
    before = season.evening(BEGINS)
    season.record(Inspections.of(np.array([clean]), np.array([0]), on_day), "first")
    between = season.evening(BEGINS)
    assert between[clean] < before[clean]
    assert (between[beside_clean] <= before[beside_clean]).all()
    season.record(Inspections.of(np.array([find]), np.array([FOUND]), on_day), "second")
    after = season.evening(BEGINS)
    assert (after[beside_find] > 2 * between[beside_find]).all()
    assert after[find] < 1e-3  # treated


def test_finds_that_are_only_flagged_stay_infested(tmp_path):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    results = some_results(season, found=[0])
    season.record(results, "x")
    assert season.evening(BEGINS)[results.plant[0]] > 0.99
    status = season.status(BEGINS)
    assert status.found == 1
    assert status.estimate.expected < season.evening(BEGINS).sum() - 0.9  # found is not out there


def test_the_status_counts(season):
    season.record(some_results(season, n=6, found=[0, 1]), "x")
    season.record(some_results(season, n=4, day=2), "y")
    status = season.status(on(2))
    assert (status.day, status.inspected_today, status.found_today) == (2, 4, 0)
    assert status.found == 2
    assert status.plants == len(season.plot.grid)
    assert status.estimate.low <= status.estimate.expected <= status.estimate.high
    assert status.detection_pct == pytest.approx(100 * 2 / (2 + status.estimate.expected))
    rows = season.plot.grid.row
    done = season.history.inspections
    assert status.days_since[rows[done.plant[-1]]] == 0
    assert np.isnan(status.days_since).sum() == season.plot.grid.n_rows - len(
        set(rows[done.plant].tolist())
    )


def test_advice_is_asked_with_settings_or_a_sentence(season):
    with pytest.raises(SettingError, match=r"must be AdviceSettings, but it is 0\.05"):
        season.advice(BEGINS, 0.05)
