"""What a season comes to."""

import numpy as np
import pytest

from fieldmon.simulation.metrics import SeasonMetrics, season_metrics
from fieldmon.simulation.season import SimulationSettings
from tests.simulation.test_season import season


def by_hand(detection):
    zeros = np.zeros(len(detection), int)
    return SeasonMetrics(np.array(detection), *[zeros] * 8, visit=zeros == 0)


@pytest.mark.parametrize(("level", "day"), [(30, 2), (50, 3), (80, None), (100, None)])
def test_d_levels_count_days_from_one(level, day):
    assert by_hand([10.0, 30.0, 55.0, 54.0]).first_day(level) == day


def test_infested_plant_days_are_counted_in_the_evening():
    days = season("naive")
    assert season_metrics(days).infested_plant_days == sum(day.left for day in days)


def test_the_columns_are_those_of_the_days():
    days = season("bouncy")
    columns = season_metrics(iter(days))
    assert columns.detection_pct.tolist() == [day.detection_pct for day in days]
    assert columns.found.sum() == days[-1].ever_found
    assert columns.new.sum() == days[-1].ever_infested


def test_no_days_have_no_figures():
    assert len(season_metrics([]).found) == 0


def test_visits_are_told_from_days():
    days = season("naive", settings=SimulationSettings(8, visit_every=7))
    weekly = season_metrics(days)
    assert weekly.visit.tolist() == [True, *[False] * 6, True]
    assert weekly.visited_each_time_pct == pytest.approx(weekly.visited_pct.sum() / 2)
    assert repr(weekly).startswith("<SeasonMetrics: 8 days with 2 visits, ")
    daily = season_metrics(season("naive"))
    assert daily.visits == 6
    assert daily.visited_each_time_pct == daily.visited_pct.mean()
    assert "visit" not in repr(daily)


def test_a_frame_has_a_line_for_each_day_and_the_columns():
    made = season_metrics(season("naive"))
    frame = made.to_pandas()
    assert frame.day.tolist() == list(range(1, len(made.left) + 1))
    assert [*frame.columns[1:]] == [*vars(made)]
    assert frame.left.sum() == made.infested_plant_days
    assert len(season_metrics([]).to_pandas()) == 0
