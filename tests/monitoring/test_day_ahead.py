"""What is left of a day, for whoever leaves now."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.day_ahead import Part, inside, planned_again, route_ahead, work_left_s
from fieldmon.planning.members import team_of
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture
def season(path):
    return Season(path)


def test_it_is_the_route_given_out_without_what_was_done(season):
    given = season.kept_route(BEGINS)
    done = season.history.inspections.plant
    assert route_ahead(season, BEGINS).plant.tolist() == [p for p in given if p not in done]


def test_where_none_was_given_out_one_is(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    route = route_ahead(fresh, BEGINS)
    assert len(route) > 20
    assert fresh.kept_route(BEGINS).tolist() == route.plant.tolist()
    again = route_ahead(fresh, BEGINS)
    assert again.plant.tolist() == route.plant.tolist()
    # the same way costs the same, planned or given out
    assert again.arrive_s == pytest.approx(route.arrive_s, abs=1e-6)
    assert again.end_s == pytest.approx(route.end_s, abs=1e-6)


def test_a_part_has_stops_in_its_rows_only_and_is_given_out_to_nobody_else(season):
    given = season.kept_route(BEGINS)
    route = planned_again(season, BEGINS, Part((1, 3)))
    assert inside(season, (1, 3))[route.plant].all()
    assert len(route)
    assert season.kept_route(BEGINS).tolist() == given.tolist()
    ahead = route_ahead(season, BEGINS, Part((1, 3)))
    assert inside(season, (1, 3))[ahead.plant].all()


def test_a_part_is_all_plants_of_its_rows_and_no_others(season):
    line = season.label.line.tolist()
    for rows in ((1, 3), (2, 2), (4, 400), (3, 2)):
        wanted = [rows[0] <= one <= rows[1] for one in line]
        assert inside(season, rows).tolist() == wanted
    assert inside(season, None).all()


def test_the_rest_planned_again_fits_what_is_left_of_the_hours(season):
    done = season.history.inspections.plant
    short = planned_again(season, BEGINS, seconds_left=900)
    assert 0 < short.end_s <= 900
    assert not np.isin(short.plant, done).any()
    assert len(planned_again(season, BEGINS, seconds_left=0)) == 0


def test_the_hours_of_each_run_from_the_first_inspection_of_that_person(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    day_s, plants = fresh.settings.robot.day_s, fresh.plan(BEGINS).route.plant
    late = np.array([15.5, 16.5]) * 3600.0
    fresh.record(Inspections.of(plants[:2], np.zeros(2, np.int8), BEGINS, second=late), "f", "Ann")
    assert work_left_s(fresh, BEGINS, Part(name="Ann")) == day_s - 3600
    assert work_left_s(fresh, BEGINS, Part(name="Ben")) == day_s
    assert work_left_s(fresh, BEGINS, Part()) == fresh.scene(BEGINS).seconds_left
    fresh.record(Inspections.of(plants[2:3], np.zeros(1, np.int8), BEGINS), "f", "Cem")
    assert work_left_s(fresh, BEGINS, Part(name="Cem")) == fresh.scene(BEGINS).seconds_left
    assert len(planned_again(fresh, BEGINS, Part((1, 3), "Ben"), day_s)), "though it is evening"


def test_nothing_is_left_where_all_was_inspected(season):
    everything = np.arange(len(season.plot.grid))
    season.record(
        Inspections.of(everything, np.zeros(len(everything), np.int8), BEGINS), confirmed=True
    )
    assert len(route_ahead(season, BEGINS)) == 0


def test_each_of_a_team_has_the_route_that_the_teams_plan_gives(tmp_path):
    fresh = a_season(tmp_path / "fresh.gpkg")
    alone = fresh.settings
    team = tuple(
        replace(one, name=name)
        for one, name in zip(team_of(2, alone.robot), ("Ann", "Ben"), strict=True)
    )
    fresh.change(replace(alone, team=team), alone)
    ann, ben = (route_ahead(fresh, BEGINS, Part(name=name)) for name in ("ann", "Ben"))
    assert len(ann)
    assert len(ben)
    assert not set(ann.plant) & set(ben.plant)
    short = planned_again(fresh, BEGINS, Part(name="Ben"), seconds_left=1200)
    assert 0 < short.end_s <= 1200
