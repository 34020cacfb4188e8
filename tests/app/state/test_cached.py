"""What the app keeps between clicks, all sessions together."""

from tests.app.driving import go, metric, opened, tap


def test_two_windows_on_one_season_see_each_other(season_app):
    other = opened("Gate 2026")
    go(season_app, "scout")
    tap(season_app, "scout_found")
    go(other, "season")
    assert metric(other, "Found") == "1"
