"""What is known on the chosen day."""

from datetime import date, datetime, timedelta

import numpy as np
import pytest

from app.show.day import reasons
from app.state import chosen_day
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.figures_of_day import day_figures
from tests.app.chosen import DAY, a_plot, chosen, in_season, records_at
from tests.app.driving import map_of
from tests.monitoring.seasons import BEGINS, Insects, a_season


def test_records_of_later_days_make_no_hot_spot_yet(app):
    assert "hot" in {one["id"] for one in map_of(app)["layers"]}
    app.date_input[0].set_value(date(2026, 1, 1)).run()
    assert "hot" not in {one["id"] for one in map_of(app)["layers"]}


@pytest.fixture(scope="module")
def worked(tmp_path_factory):
    """Return a season of which two days were worked."""
    season = a_season(tmp_path_factory.mktemp("worked") / "s.gpkg")
    insects = Insects(season)
    for day in (0, 2):
        plants = season.plan(BEGINS + timedelta(days=day)).route.plant[:20]
        season.record(insects.look(day, plants), f"day {day}")
    return season


def on(season, day):
    return in_season(season, BEGINS + timedelta(days=day))


def test_a_day_that_is_planned_starts_with_the_work_and_later_once_something_is_done(worked):
    morning, begun = on(worked, 1), on(worked, 2)
    starts = worked.settings.starts
    assert chosen_day.starts(morning, morning.plan()) == datetime.combine(morning.on, starts)
    assert chosen_day.starts(begun, begun.plan()) > datetime.combine(begun.on, starts)
    plot = a_plot()
    alone = chosen(plot)
    assert chosen_day.starts(alone, alone.plan()).time() == chosen_day.STARTS


def test_the_route_of_a_day_behind_is_as_it_was_worked_of_the_last_as_it_is_planned(worked):
    before, last = on(worked, 0), on(worked, 2)
    done = worked.history.on(0).plant
    assert chosen_day.route(before).route.plant.tolist() == done.tolist()
    assert chosen_day.route(last).route.plant.tolist() == last.plan().route.plant.tolist()
    idle = on(worked, 1)
    assert chosen_day.route(idle).route.plant.tolist() == idle.plan().route.plant.tolist()


def test_what_is_known_is_what_the_season_says(worked):
    for day in range(4):
        choices = on(worked, day)
        status = worked.status(choices.on)
        assert chosen_day.chance(choices).tolist() == worked.evening(choices.on).tolist()
        state = chosen_day.states(choices)
        inspected = worked.history.states(day)
        assert (inspected >= 0).sum() == status.inspected
        assert (inspected == 1).sum() == status.found
        assert state.tolist() == np.maximum(inspected, worked.history.recorded).tolist()
        assert chosen_day.progress(choices).found_today == status.found_today
        assert chosen_day.figures(choices, choices.day) == day_figures(worked, choices.on)
        assert len(chosen_day.found(choices)) == status.found_today
        undated = 60
        aged = np.delete(chosen_day.ages(choices) >= 0, undated)
        assert aged.tolist() == np.delete(state >= 0, undated).tolist()
        assert len(chosen_day.hot_spots(choices)) == len(status.hot_spots)


def test_ages_count_from_the_last_inspection(worked):
    choices = on(worked, 5)
    ages = chosen_day.ages(choices)
    done = worked.history.inspections
    for plant in np.unique(done.plant):  # others may have a record, which ages as well
        assert ages[plant] == 5 - worked.settings.day(done.date[done.plant == plant].max().item())


def test_figures_so_far_are_those_kept_up_to_the_day_and_that_day(worked):
    assert [one.on for one in chosen_day.figures_so_far(on(worked, 1))] == [
        BEGINS, BEGINS + timedelta(days=1)
    ]  # fmt: skip
    assert len(chosen_day.figures_so_far(on(worked, 2))) == 2


def test_the_days_of_a_season_go_up_to_the_last_one_worked_or_the_one_chosen(worked):
    iso = [str(BEGINS + timedelta(days=day)) for day in range(6)]
    assert chosen_day.season_days(on(worked, 0)) == iso[:3]
    assert chosen_day.season_days(on(worked, 5)) == iso


def test_without_a_season_records_say_what_is_known():
    plot = a_plot()
    choices = chosen(plot, records_at(plot, [7, 9, 30], [1, 0, 1]))
    state = chosen_day.states(choices)
    assert (state[7], state[9], state[30]) == (1, 0, 1)
    assert (state >= 0).sum() == 3
    ages = chosen_day.ages(choices)
    assert (ages[7], ages[9], ages[30]) == (6, 6, 6)
    assert (ages >= 0).sum() == 3
    assert len(chosen_day.found(choices)) == 0
    assert chosen_day.messages_on_records(choices) == []
    early = chosen(plot, records_at(plot, [7], [1], day="2027-01-01"))
    assert set(chosen_day.states(early).tolist()) == {-1}
    assert chosen_day.messages_on_records(early) != []


def test_what_is_known_is_the_same_before_and_after_a_season_begins(tmp_path):
    plot = a_plot()
    close = plot.grid.tree.query(plot.grid.xy_m[40], k=6)[1]
    others = np.setdiff1d(np.arange(0, len(plot.grid), 3), close)
    records = records_at(
        plot, np.append(close, others), np.repeat([1, 0], [len(close), len(others)])
    )
    before = chosen(plot, records)
    season = Season.create(tmp_path / "s.gpkg", plot, records, begins=DAY)
    after = in_season(season, DAY)
    assert len(chosen_day.hot_spots(before)) > 0
    for known in (chosen_day.states, chosen_day.ages, lambda c: chosen_day.hot_spots(c).of_plant):
        assert known(after).tolist() == known(before).tolist()
    assert len(season.status(DAY).hot_spots) == len(chosen_day.hot_spots(before))
    why = reasons(after, after.plan())
    assert any("known from records only" in sentence for sentence in why)
