"""The page Drive."""

from app.words import texts
from tests.app.driving import go, map_of


def test_a_file_is_asked_for_where_a_day_was_driven_already(app):
    go(app, "drive")
    app.segmented_control(key="drive_source").set_value("recorded").run()
    assert [one.label for one in app.get("file_uploader")] == [texts.DRIVE_FILE]
    app.get("file_uploader")[0].set_value(("x.csv", b"a,b\n1,2\n", "text/csv")).run()
    assert "must begin with the columns" in app.error[0].value
    assert map_of(app)["drive"] is None
