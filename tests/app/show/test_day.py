"""A day in figures and words."""

import re
from dataclasses import replace
from datetime import date, datetime, timedelta

import numpy as np
import pandas as pd
import pytest

from app.show import day
from app.state import chosen_day
from app.state.chosen_day import DayRoute
from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.estimates.figures_of_day import day_figures, still_infested
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.grid import plant_numbers
from tests.app.chosen import a_plot, chosen, in_season, records_at
from tests.app.driving import apart, go, row_box, tap, texts_of
from tests.monitoring.seasons import BEGINS, Insects, a_season


def test_too_short_a_day_is_said_in_a_sentence(app):
    go(app, "plot")
    row_box(app, "headland").set_value(40.0).run()
    app.slider(key="hours Robot").set_value(0.5).run()
    assert not app.exception


def test_today_says_why_it_goes_where_it_goes(season_app):
    assert "never inspected yet" in texts_of(season_app)
    go(season_app, "scout")
    place = next(m.value for m in season_app.markdown if m.value.startswith("## ")).lower()
    tap(season_app, "scout_found")
    go(season_app, "today")
    why = next(m.value for m in season_app.markdown if "around today's find" in m.value)
    row, plant = (int(n) for n in re.findall(r"find in row (\d+), plant (\d+)", why)[0])
    assert f"row {row} · plant {plant}" in place


@pytest.fixture(scope="module")
def worked(tmp_path_factory):
    """Return a season of which two days were worked."""
    season = a_season(tmp_path_factory.mktemp("worked") / "s.gpkg")
    insects = Insects(season)
    for number in (0, 1):
        plants = season.plan(BEGINS + timedelta(days=number)).route.plant[:40]
        season.record(insects.look(number, plants), f"day {number}")
    return season


def on(season, number):
    return in_season(season, BEGINS + timedelta(days=number))


def test_where_both_faces_are_inspected_a_stop_is_a_face():
    choices = chosen(a_plot(faces=2))
    plan = choices.plan()
    assert f"Inspect {len(plan.route)} faces in rows " in apart(day.headline(choices, plan))
    assert day.plan_in_short(plan).startswith(f"{len(plan.route)} faces")
    assert day.in_short(a_plot().grid, 7, 1.0).startswith("7 plants")


def test_the_headline_says_the_year_of_a_day_that_is_far_off():
    for said, ends in (("2026-11-18", "Wed 18 Nov"), ("2027-11-16", "Tue 16 Nov 2027")):
        choices = chosen(a_plot(), day=said, today=date(2026, 11, 16))
        assert f" on {ends}, " in apart(day.headline(choices, choices.plan()))


def test_stops_are_the_route_s_in_order_with_the_times_of_their_arrival():
    plot = a_plot()
    choices = chosen(plot, records_at(plot, [50], [1]))
    plan = choices.plan()
    table = day.stops(choices, DayRoute(plan.route, chosen_day.starts(choices, plan)))
    numbered = plant_numbers(plot.grid, plan.route.plant)
    assert table["row"].tolist() == numbered.line.tolist()
    assert table["plant"].tolist() == numbered.number.tolist()
    assert table.index.tolist() == list(range(1, len(plan.route) + 1))
    begins = pd.Timestamp("2026-11-16 06:00")
    seconds = [
        (pd.Timestamp(f"2026-11-16 {at}") - begins).total_seconds() for at in table["arrive"]
    ]
    assert seconds == pytest.approx(plan.route.arrive_s, abs=0.51)


def test_no_stop_has_a_chance_of_nothing_or_all():
    plot = a_plot()
    choices = chosen(plot, records_at(plot, [50], [1]))
    route = choices.plan().route
    chance = np.resize([1e-6, 0.5, 1 - 1e-6], len(route))
    shown = DayRoute(replace(route, chance=chance), chosen_day.starts(choices, choices.plan()))
    said = day.stops(choices, shown)["chance"].tolist()[:3]
    assert said == [f"{one}\u00a0%" for one in ("under 0.1", "50.0", "over 99.9")]


def test_no_stop_is_shown_at_an_hour_that_clocks_leave_out():
    plot = a_plot()
    plan = chosen(plot, records_at(plot, [50], [1])).plan()
    shown = DayRoute(plan.route, datetime(2027, 3, 26, 1, 30))
    assert [f"{shown.at(s):%H:%M}" for s in (0, 1799, 1801)] == ["01:30", "01:59", "03:00"]
    noted = replace(shown, worked=True)  # from one time noted to another
    assert f"{noted.at(7200):%H:%M}" == "03:30"


def test_stops_of_a_day_that_was_worked_say_what_was_found_there(worked):
    choices = on(worked, 0)
    table = day.stops(choices, chosen_day.route(choices))
    done = worked.history.inspections.on(BEGINS)
    assert len(table) == 40
    assert (table["result"] == "found").sum() == (done.result == 1).sum()


def test_what_changed_is_the_difference_of_two_days(worked):
    title, told = day.changes(on(worked, 1))
    said = "\n".join(told)
    before, now = (day_figures(worked, BEGINS + timedelta(days=n)) for n in (0, 1))
    assert title == "Since the last visit, Mon 6 Apr"
    assert f"{before.found_today} found on 40 plants inspected on Mon 6 Apr." in said
    assert f"still infested: {now.expected:.0f}; on the evening of Mon 6 Apr: " in said
    assert f"{before.expected:.0f}." in said
    assert day.changes(on(worked, 0))[1] == [texts.CHANGED_FIRST]
    assert day.changes(chosen(a_plot())) == ("", [])


def test_what_changed_is_told_since_the_last_visit_whenever_that_was(worked):
    visited, now = (day_figures(worked, BEGINS + timedelta(days=n)) for n in (1, 9))
    title, said = day.changes(on(worked, 9))
    assert title == "Since the last visit, Tue 7 Apr"
    assert f"{visited.found_today} found on 40 plants inspected on Tue 7 Apr." in said
    assert any(f"infested: {now.expected:.0f}; on the evening of Tue 7 Apr" in one for one in said)
    past = replace(on(worked, 9), today=BEGINS + timedelta(days=30))
    assert day.changes(past) == ("Since the visit before, Tue 7 Apr", said)
    ahead = replace(on(worked, 9), today=BEGINS + timedelta(days=2))
    assert day.changes(ahead) == (title, said)


def test_before_any_visit_it_is_told_since_the_season_began(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    title, said = day.changes(on(season, 3))
    assert title == "Since the season began, Mon 6 Apr"
    assert said[0] == texts.CHANGED_NONE


def test_finds_of_the_last_visit_are_the_reason_however_long_ago_it_was(worked):
    """By their weekday only where no other day is meant by it."""
    finds = r"around (?:(\w+)'s find|the find of (\w+ \d+ Apr)) in"

    def days(choices):
        said = re.findall(finds, "\n".join(day.reasons(choices, choices.plan())))
        return {weekday or of_date for weekday, of_date in said}

    assert days(on(worked, 2)) == {"Monday", "Tuesday"}
    assert days(on(worked, 7)) <= {"Mon 6 Apr", "Tuesday"}
    later = days(on(worked, 20))
    assert later
    assert later <= {"Mon 6 Apr", "Tue 7 Apr"}
    elsewhere = replace(on(worked, 2), today=BEGINS)
    assert days(elsewhere) == {"Mon 6 Apr", "Tue 7 Apr"}


def test_plants_only_flagged_are_said_beside_those_not_found(tmp_path):
    season = a_season(tmp_path / "s.gpkg", belief=BeliefSettings(treated=False))
    looked = Inspections.of(np.arange(20), np.ones(20, int), np.datetime64(BEGINS))
    season.record(looked, "finds")
    said = "\n".join(day.changes(on(season, 1))[1])
    still, before = (still_infested(season, BEGINS + timedelta(days=k)).expected for k in (1, 0))
    assert before > 20
    assert f"still infested: {still:.0f}; on the evening of Mon 6 Apr: {before:.0f}." in said
    assert "are not found yet, and 20 were found and only flagged." in said


def test_rows_that_rose_most_come_first(worked):
    said = day.changes(on(worked, 1))[1][-1]
    grid = worked.plot.grid
    line = grid.row_line[grid.row]
    evenings = [worked.evening(BEGINS + timedelta(days=n)) for n in (0, 1)]
    rise = [np.mean((evenings[1] - evenings[0])[line == k]) for k in range(line.max() + 1)]
    best = int(np.argmax(rise))
    if rise[best] > 0.001:
        # the sign belongs to its number in a sentence from the right, too
        assert f"percentage points: {best + 1} (\u2068+{100 * rise[best]:.1f}\u2069)" in apart(said)
    else:
        assert "rose most" not in said
