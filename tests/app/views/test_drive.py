"""The page Drive."""

from dataclasses import replace

from app.state.choices import WHOSE_DAY
from app.words import texts
from fieldmon.planning.members import team_of
from tests.app.driving import go, map_of, texts_of


def test_a_file_is_asked_for_where_a_day_was_driven_already(app):
    go(app, "drive")
    app.segmented_control(key="drive_source").set_value("recorded").run()
    assert [one.label for one in app.get("file_uploader")] == [texts.DRIVE_FILE]
    app.get("file_uploader")[0].set_value(("x.csv", b"a,b\n1,2\n", "text/csv")).run()
    assert "must begin with the columns" in app.error[0].value
    assert map_of(app)["drive"] is None


def test_whose_day_is_driven_is_chosen_and_one_without_stops_says_why(season_app, season):
    before = season().settings
    first, second = team_of(2, before.robot.with_hours(1))
    second = replace(second, robot=second.robot.with_hours(0.01))
    season().change(replace(before, team=(first, second)), before)
    go(season_app, "drive")
    whose = season_app.segmented_control(key=WHOSE_DAY)
    assert whose.value == first.name
    assert [one.key for one in season_app.button if one.key.startswith("drive_run")]
    assert "This share is what the season believes" in texts_of(season_app)
    (share,) = [one for one in season_app.number_input if one.key.startswith("drive_share")]
    share.set_value(12.0).run()
    assert "This share is what the season believes" not in texts_of(season_app)
    season_app.segmented_control(key=WHOSE_DAY).set_value(second.name).run()
    assert not [one.key for one in season_app.button if one.key.startswith("drive_run")]
    assert texts.NO_STOPS in [one.value for one in season_app.warning]
