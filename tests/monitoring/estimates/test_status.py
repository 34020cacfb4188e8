"""Where a season stands on a day, worked out plant by plant."""

from datetime import timedelta

import numpy as np
import pytest

from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring.estimates.status import Status
from tests.monitoring.seasons import BEGINS, Insects, a_season


@pytest.fixture(scope="module")
def season(tmp_path_factory):
    season = a_season(tmp_path_factory.mktemp("status") / "s.gpkg")
    insects = Insects(season)
    for day, first in ((0, 0), (2, 30)):
        season.record(insects.look(day, np.arange(first, first + 60)), f"day {day}")
    return season


def test_it_counts_plants_not_inspections(season):
    status = season.status(BEGINS + timedelta(days=3))
    done = season.history.inspections
    assert (status.day, status.on) == (3, BEGINS + timedelta(days=3))
    assert status.inspected == len(set(done.plant.tolist())) == 90
    assert status.found == len(set(done.plant[done.result == FOUND].tolist()))
    assert (status.inspected_today, status.found_today) == (0, 0)
    assert status.plants == len(season.plot.grid)


def test_an_earlier_day_knows_nothing_of_later_ones(season):
    status = season.status(BEGINS)
    assert status.inspected == status.inspected_today == 60
    assert np.isnan(status.days_since).sum() > 0
    assert set(status.days_since[~np.isnan(status.days_since)]) == {0.0}


def test_the_detection_is_the_finds_among_all_that_are_or_were_infested(season):
    status = season.status(BEGINS)
    everything = status.found + status.estimate.expected
    assert status.detection_pct == pytest.approx(100 * status.found / everything)


def test_where_nothing_is_infested_all_of_it_was_found(season):
    status = season.status(BEGINS)
    clean = type(status.estimate)(0.0, 0, 0, 1.0)
    nothing = Status(**(vars(status) | {"found": 0, "estimate": clean}))
    assert nothing.detection_pct == 100.0
