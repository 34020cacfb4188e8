"""Plot and records: what was set by hand stays within reach, whatever comes of it."""

from tests.app.driving import go, metric, row_box, square, upload, zipped


def test_rows_set_by_hand_that_leave_no_plant_can_be_set_again(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(0.0006)), "application/zip"))
    plants = metric(app, "Plants")
    row_box(app, "headland").set_value(40.0).run()
    assert "headland" in app.error[0].value
    go(app, "today")
    assert app.error
    row_box(app, "headland").set_value(4.0).run()
    assert not app.error
    go(app, "plot")
    assert metric(app, "Plants") == plants


def test_what_is_wrong_with_a_file_is_said_above_the_boxes_for_more(app):
    upload(app, plot=("plot.zip", b"", "application/zip"))
    shown = [one.type for one in app.main]
    assert shown.index("error") < shown.index("file_uploader")
