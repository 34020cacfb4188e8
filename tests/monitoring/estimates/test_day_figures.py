"""A season's days in figures: as its status says, kept or worked out."""

from datetime import timedelta

import numpy as np
import pytest

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.day_figures import DayFigures, Progress, flagged_said
from fieldmon.monitoring.estimates.figures_of_day import day_figures, progress
from tests.monitoring.seasons import BEGINS, Insects, a_plot, a_season


@pytest.fixture(scope="module")
def worked(tmp_path_factory):
    """Work three of five days; a plant found on the first is inspected again on the last."""
    season = a_season(tmp_path_factory.mktemp("worked") / "s.gpkg", a_plot())
    insects = Insects(season)
    for day, plants in ((0, range(60)), (2, range(30, 90)), (4, range(0, 200, 3))):
        season.record(insects.look(day, np.array(plants)), f"day {day}")
    return season


def dates(season):
    return [figures.on for figures in season.days()]


def test_the_days_kept_are_those_on_which_something_happened(worked):
    assert dates(worked) == [BEGINS + timedelta(days=day) for day in (0, 2, 4)]


@pytest.mark.parametrize("day", range(7))
def test_a_day_in_figures_is_what_its_status_says_kept_or_worked_out(worked, day):
    on = BEGINS + timedelta(days=day)
    now, figures = worked.status(on), day_figures(worked, on)
    estimate = now.estimate
    assert figures == DayFigures(
        on, now.inspected_today, now.found_today, pytest.approx(estimate.expected, rel=1e-12),
        estimate.low, estimate.high, pytest.approx(estimate.chance_clean, rel=1e-12),
    )  # fmt: skip


def test_kept_figures_are_those_worked_out_anew_by_another_program(worked):
    again = Season(worked.path)
    for kept in worked.days():
        day = again.settings.day(kept.on)
        assert Progress.of(again.history, day).inspected_today == kept.inspected_today
        assert day_figures(again, kept.on) == kept


def test_progress_counts_every_plant_once_and_finds_for_good(worked):
    for day in range(6):
        so_far, on_day = worked.history.until(day), worked.history.on(day)
        now = progress(worked, BEGINS + timedelta(days=day))
        assert now.inspected == len(set(so_far.plant.tolist()))
        assert now.found == len(set(so_far.plant[so_far.result == 1].tolist()))
        assert now.inspected_today == len(on_day)
        assert now.found_today == np.count_nonzero(on_day.result == 1)


def test_days_since_a_row_was_inspected_are_counted_from_its_latest_plant(worked):
    done, row = worked.history.inspections, worked.plot.grid.row
    since = progress(worked, BEGINS + timedelta(days=6)).days_since
    for r, days in enumerate(since.tolist()):
        own = worked.history.days[row[done.plant] == r]
        assert (6 - own.max() == days) if own.size else np.isnan(days)
    assert np.isnan(progress(worked, BEGINS).days_since).any()


def test_the_revision_changes_with_what_is_recorded_and_with_nothing_else(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    before = season.revision
    season.status(BEGINS)
    season.plan(BEGINS, keep=False)
    assert season.revision == before
    insects = Insects(season)
    season.record(insects.look(0, np.arange(5)), "test")
    recorded = season.revision
    assert recorded != before
    season.undo()
    assert season.revision not in {before, recorded}


def test_the_days_finds_sum_to_all_finds_though_plants_are_found_again(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    for day, plants in ((0, [1, 2, 3]), (1, [2, 3, 4]), (3, [3])):
        on = np.datetime64(BEGINS + timedelta(days=day))
        season.record(Inspections.of(np.array(plants), np.ones(len(plants), int), on), f"{day}")
    # once more in the same day, at another time
    season.record(Inspections.of(np.array([3]), np.array([1]), on, second=np.array([5e4])), "again")
    now = season.status(BEGINS + timedelta(days=3))
    assert (now.found, now.finds) == (4, 7)
    assert now.inspected_today == now.found_today == 1
    assert sum(one.found_today for one in season.days()) == now.finds


def test_the_share_found_is_least_where_most_is_left():
    figures = DayFigures(BEGINS, 9, 4, 36.0, 6, 156, 0.0)
    assert figures.share_found_pct(4) == pytest.approx((10.0, 2.5, 40.0))
    assert DayFigures(BEGINS, 9, 0, 0.0, 0, 0, 1.0).share_found_pct(0) == (100.0,) * 3


def test_flagged_plants_are_said_beside_those_not_found_where_there_are_any():
    left = DayFigures(BEGINS, 9, 4, 2345.6, 1006, 3156, 0.0)
    assert flagged_said(left, 0.0) == flagged_said(left.estimate, 0.04) == []
    (said,) = flagged_said(left, 1207.6)
    assert said == (
        "Of those still infested, about 2,346 (1,006 to 3,156) are not found yet, and 1,208 were "
        "found and only flagged."
    )
