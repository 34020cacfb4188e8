"""Scout mode: each tap is kept at once and can be taken back."""

from dataclasses import replace
from datetime import date

import numpy as np

from fieldmon.infestation.inspections import Inspections
from tests.app.driving import go, opened, tap, texts_of


def place(app):
    """Return where the next plant is said to be."""
    return next(one.value for one in app.markdown if one.value.startswith("## "))


def test_each_tap_of_the_scout_is_kept_at_once_and_the_route_goes_on(season_app, season):
    go(season_app, "scout")
    route = season().kept_route(date(2026, 11, 16))
    assert len(route) > 100
    tap(season_app, "scout_clean")
    season_app.number_input(key="scout_count").set_value(7)
    tap(season_app, "scout_found")
    tap(season_app, "scout_skip")
    done = season().history.inspections
    assert done.plant[:2].tolist() == route[:2].tolist()
    assert done.result.tolist() == [0, 1, 2]
    assert (np.diff(done.second) > 0).all()
    assert season_app.number_input(key="scout_count").value is None


def test_a_reload_of_the_page_goes_on_where_the_scout_stood(season_app):
    go(season_app, "scout")
    for key in ("scout_clean", "scout_found"):
        tap(season_app, key)
    again = opened("Gate 2026")
    go(again, "scout")
    assert place(again) == place(season_app)


def test_the_scout_takes_the_last_tap_back(season_app, season):
    go(season_app, "scout")
    tap(season_app, "scout_clean")
    before = place(season_app)
    tap(season_app, "scout_found")
    assert place(season_app) != before
    tap(season_app, "scout_undo")
    assert place(season_app) == before
    assert season().history.inspections.result.tolist() == [0]


def test_one_hour_more_is_one_however_late_it_is(season_app, season):
    project, settings = season(), season().settings
    project.change(replace(settings, robot=settings.robot.with_hours(2.0)), settings)
    evening = Inspections.of(np.array([7]), np.array([0]), np.datetime64("2026-11-16"),
                         second=np.array([17 * 3600.0 + 1320.0]))  # fmt: skip
    project.record(evening, "scout mode")
    go(season_app, "scout")
    assert "Done for today" in texts_of(season_app)
    tap(season_app, "scout_hour")
    assert "Done for today" not in texts_of(season_app)
    assert season().settings.robot.hours == 12.5
    tap(season_app, "scout_clean")
