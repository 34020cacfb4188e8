"""People are not sent to plants where they may not be yet; robots are."""

from dataclasses import replace
from datetime import date, datetime, time, timedelta
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.compute.units import Units
from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.days.day_ahead import WorkPart, planned_again, route_ahead
from fieldmon.monitoring.days.kept_routes import closed_to_kept
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.closures import (
    closed_in_words,
    closed_on,
    closed_plants,
    entry_waits,
)
from fieldmon.planning.members import team_of
from fieldmon.planning.wishes import Wishes
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.robot import scout
from tests.monitoring.seasons import BEGINS, a_season
from tests.monitoring.treating.test_cautions import EAST, WEST, treated

ON = BEGINS + timedelta(1)
TREES = SimpleNamespace(in_rows=False)


def sprayed(season, rows, hours, at=time(9), on=BEGINS, product="Acarol"):
    """Treat rows, which then are closed for so many hours from `at` on; return their plants."""
    plants = np.isin(season.plant_numbers.line, rows)
    season.treat(on, 0.5, plants=plants, application=Application(
        product, reentry_hours=float(hours), ended=at))  # fmt: skip
    return plants


@pytest.mark.parametrize(
    ("from_h", "to_h", "closed"), [(6, 18, True), (9, 18, False), (8.99, 9.5, True)]
)
def test_plants_are_closed_to_work_that_begins_before_their_time(from_h, to_h, closed):
    waits = entry_waits([treated(0, reentry_hours=24.0)], (), TREES)
    found = closed_on(waits, date(2026, 4, 7), from_h * 3600, to_h * 3600)
    assert [(one.until, one.opens) for one in found] == (
        [(datetime(2026, 4, 7, 9), True)] if closed else []
    )


def test_a_label_counts_and_what_begins_after_the_hours_closes_nothing():
    label = ProductLabel("Acarol", reentry_hours=12.0)
    late = treated(0, began=time(18), ended=time(19))
    assert entry_waits([late], (), TREES) == ()
    waits = entry_waits([late], [label], TREES)
    assert closed_on(waits, BEGINS, 6 * 3600, 18 * 3600) == ()
    assert len(closed_on(waits, BEGINS, 6 * 3600, 19 * 3600)) == 1
    assert len(closed_on(waits, date(2026, 4, 7), 6 * 3600, 18 * 3600)) == 1


def test_what_is_left_off_is_said_once_with_its_last_time(season):
    grid, n = season.plot.grid, len(season.plot.grid)
    assert not closed_plants((), n).any()
    for wait, lines in ((24, [1, 2, 3, 7]), (72, [3, 4])):
        sprayed(season, lines, wait, product="Acarol" if wait == 24 else "")
    first, second = closed_in_words(season.closed(ON), grid, Units())
    low, high = (
        np.count_nonzero(np.isin(season.plant_numbers.line, some)) for some in ([1, 2, 7], [3, 4])
    )
    assert first == (
        "Closed until 09:00 on 2026-04-09 after a product that nobody named, so not on the route: "
        f"{high} plants in rows 3–4."
    )
    assert second == (
        "Closed until 09:00 on 2026-04-07 after Acarol, so not on the route: "
        f"{low} plants in rows 1–2, 7."
        + " A plan that begins then or later may have them."
        * (season.settings.robot.hours > 3)
    )


def test_a_plan_leaves_closed_plants_out_until_their_time(season):
    given = season.plan(ON, keep=False).route.plant
    rows = np.unique(season.plant_numbers.line[given[:40]])[:2]
    plants = sprayed(season, rows, 24, at=time(6, 30))
    left = season.plan(ON, keep=False)
    assert plants[given].any()
    assert len(left.route)
    assert not plants[left.route.plant].any()
    assert closed_plants(season.closed(ON), len(plants)).tolist() == plants.tolist()
    assert plants[season.plan(ON, time(6, 30), keep=False).route.plant].any()
    assert plants[season.plan(BEGINS + timedelta(2), keep=False).route.plant].any()
    with season.entering_treated():
        assert plants[season.plan(ON, keep=False).route.plant].any()
    assert not plants[season.plan(ON, keep=False).route.plant].any()
    season.undo()
    assert season.plan(ON, keep=False).route.plant.tolist() == given.tolist()


def test_one_plant_closes_its_row_for_the_way_to_the_others_passes_it(season):
    one = np.arange(len(season.plot.grid)) == 30
    wait = Application("soap", reentry_hours=48.0, ended=time(9))
    season.treat(BEGINS, 0.5, plants=one, application=wait)
    (closed,) = season.closed(ON)
    assert closed.plants.tolist() == (season.plot.grid.row == season.plot.grid.row[30]).tolist()


def test_a_plot_that_is_wholly_closed_has_an_empty_route(season):
    sprayed(season, np.unique(season.plant_numbers.line), 48)
    assert len(season.plan(ON).route) == 0
    assert len(route_ahead(season, ON, WorkPart(name="Ann"))) == 0


@pytest.mark.parametrize(
    "part", [WorkPart(), WorkPart(name="Ann"), WorkPart((1, 6), "Ann"), WorkPart((1, 6))]
)
def test_a_route_kept_of_before_is_planned_anew_and_the_rest_goes_elsewhere(season, part):
    given = route_ahead(season, ON, part).plant
    plants = sprayed(season, [int(season.plant_numbers.line[given[0]])], 48)
    ahead = route_ahead(season, ON, part).plant
    assert len(ahead)
    assert not plants[ahead].any()
    assert route_ahead(season, ON, part).plant.tolist() == ahead.tolist()
    assert not plants[planned_again(season, ON, part, 3000.0).plant].any()


def test_nobody_of_a_team_is_sent_there(season):
    before = season.settings
    walk = tuple(replace(one, robot=scout()) for one in team_of(2))
    season.change(replace(before, team=walk), before)
    plants = sprayed(season, [1, 2, 3], 48)
    days = season.plan_each(ON)
    assert all(len(one.route) for one in days)
    assert not any(plants[one.route.plant].any() for one in days)
    assert not plants[season.scene(ON, who="robot-2").last_inspected != 1].any()


def it_is(monkeypatch, season, at):
    moment = local_clock(season.plot.field).moment(ON, at)
    monkeypatch.setattr("fieldmon.plot.local_clock.utc_now", lambda: moment)


def test_rows_that_opened_since_are_closed_to_a_plan_whose_times_begin_before(season, monkeypatch):
    plants = sprayed(season, [1, 2], 22)  # until 07:00, and work begins at 06:00
    it_is(monkeypatch, season, time(10))
    assert not plants[season.plan(ON, keep=False).route.plant].any()
    assert plants[season.plan(ON, time(7), keep=False).route.plant].any()


def test_what_is_closed_now_is_closed_to_a_plan_whose_times_are_over(season, monkeypatch):
    plants = np.isin(season.plant_numbers.line, [1, 2])
    late = Application("Soap", reentry_hours=5.0, began=time(20), ended=time(20, 30))
    season.treat(ON, 0.1, plants=plants, application=late)
    assert season.closed(ON) == ()
    it_is(monkeypatch, season, time(21))
    assert len(season.closed(ON)) == 1


@pytest.mark.parametrize("part", [WorkPart(), WorkPart(name="Ann")])
def test_a_plan_kept_from_a_later_time_on_is_held_to_its_own_begin(season, part, monkeypatch):
    plants = sprayed(season, [1, 2], 22)  # until 07:00, and work begins at 06:00
    kept = season.plan(ON, time(7)).route.plant
    assert plants[kept].any()
    assert route_ahead(season, ON, part).plant.tolist() == kept.tolist()
    early = np.array([6.1 * 3600])
    season.record(Inspections.of(kept[:1], np.zeros(1, np.int8), ON, second=early), "f", "Ann")
    assert not plants[route_ahead(season, ON, part).plant].any()
    it_is(monkeypatch, season, time(7, 10))  # who is out goes on now
    assert season.closed(ON)
    assert closed_to_kept(season, ON) == ()


def test_east_and_west_are_closed_each_until_their_time():
    done = [treated(0, EAST, reentry_hours=24.0), treated(0, WEST, reentry_hours=48.0)]
    closed = closed_on(entry_waits(done, (), TREES), date(2026, 4, 7), 9 * 3600, 12 * 3600)
    assert closed_plants(closed, 20).tolist() == WEST.tolist()


def test_one_row_is_a_row(season):
    sprayed(season, [3], 24)
    (said,) = closed_in_words(season.closed(ON), season.plot.grid, Units())
    assert "plants in row 3." in said


def test_a_wish_opens_no_closed_plant_that_was_found_and_only_flagged(tmp_path):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    row = season.plant_numbers.line == 2
    found, sprayed_plant = np.flatnonzero(row)[[3, 10]]
    season.record(Inspections.of([found], [1], np.datetime64(BEGINS)), "a.csv", "Ann")
    only = np.arange(len(row)) == sprayed_plant
    season.treat(BEGINS, 0.5, plants=only, application=Application(
        "Acarol", reentry_hours=72.0, ended=time(18)))  # fmt: skip
    scene = season.scene(ON)
    assert scene.flagged is None or not scene.flagged[row].any()
    wished = season.plan(ON, keep=False, wishes=Wishes((int(found),)))
    assert found not in wished.route.plant
