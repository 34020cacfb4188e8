"""Single figures of a day of a season are those of its status."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.monitoring.estimates import figures_of_day
from tests.monitoring.seasons import on, some_results


@pytest.mark.parametrize("treated", [True, False])
def test_single_figures_of_a_day_are_those_of_its_status(season, treated):
    first = season.settings
    season.change(replace(first, belief=replace(first.belief, treated=treated)), first)
    season.record(some_results(season, found=[0, 2]), "x")
    now = season.status(on(1))
    progress = figures_of_day.progress(season, on(1))
    assert (progress.found, progress.inspected) == (now.found, now.inspected) == (2, 5)
    assert np.array_equal(progress.days_since, now.days_since, equal_nan=True)
    figures = figures_of_day.day_figures(season, on(0))
    assert figures == season.days()[0]
    assert figures.expected == pytest.approx(season.status(on(0)).estimate.expected)
    assert figures_of_day.flagged(season, on(1)) == now.flagged
    assert (now.flagged > 1.0) is not treated
    still = figures_of_day.still_infested(season, on(1))
    assert still.expected == pytest.approx(now.infested.expected)
    assert figures_of_day.found_again(season, on(1)) is None
