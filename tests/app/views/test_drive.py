"""The page Drive."""

from app.words import texts
from tests.app.driving import fetched, go, map_of, press, until


def test_a_planned_day_is_driven_and_handed_to_the_map_and_nothing_is_recorded(season_app, season):
    before = season().revision
    app = go(season_app, "drive")
    assert not app.exception
    assert map_of(app)["drive"] is None
    press(app, texts.DRIVE_RUN)
    until(lambda: map_of(app.run())["drive"] is not None)
    assert b'"stops":[[' in fetched(map_of(app)["drive"])
    assert any(one.value == texts.DRIVE_MADE_UP for one in app.caption)
    assert season().revision == before


def test_a_file_is_asked_for_where_a_day_was_driven_already(app):
    go(app, "drive")
    app.segmented_control(key="drive_source").set_value("recorded").run()
    assert [one.label for one in app.get("file_uploader")] == [texts.DRIVE_FILE]
    app.get("file_uploader")[0].set_value(("x.csv", b"a,b\n1,2\n", "text/csv")).run()
    assert "must begin with the columns" in app.error[0].value
    assert map_of(app)["drive"] is None


def test_a_robot_that_drives_now_is_asked_for_and_what_is_wrong_is_said(app):
    go(app, "drive")
    app.segmented_control(key="drive_source").set_value("live").run()
    assert any(one.value == texts.DRIVE_LIVE for one in app.caption)
    app.text_input(key="drive_broker").set_value("127.0.0.1:1").run()
    press(app, texts.DRIVE_WATCH)
    until(lambda: any("must answer" in one.value for one in app.run().error))
    assert map_of(app)["drive"] is None
    app.text_input(key="drive_serial").set_value("a/b").run()
    assert "must have no /" in app.error[0].value
