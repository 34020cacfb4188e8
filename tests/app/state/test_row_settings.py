"""What is said of rows by hand is of one plot, in the unit that is chosen."""

import pytest

from app.state import row_settings, widget_memory
from tests.app.driving import go, metric, row_box


def test_spacings_are_set_in_the_chosen_unit_and_carried_over(app):
    go(app, "plot")
    row_box(app, "row_spacing").set_value(8.0).run()
    row_box(app, "headland").set_value(50.0).run()
    row_box(app, "headland").set_value(4.0).run()
    plants = metric(app, "Plants")
    app.selectbox(key="length").set_value("ft").run()
    assert row_box(app, "row_spacing").label == "Row to row (ft)"
    assert row_box(app, "row_spacing").value == pytest.approx(26.2467)
    assert row_box(app, "headland").value == pytest.approx(13.1234)
    assert row_box(app, "plant_spacing").value is None
    assert metric(app, "Plants") == plants
    assert metric(app, "Rows / plants apart").startswith("26.2 ft")
    row_box(app, "headland").set_value(160.0).run()
    row_box(app, "headland").set_value(20.0).run()
    row_box(app, "plant_spacing").set_value(20.0).run()
    fewer = metric(app, "Plants")
    assert int(fewer.replace(",", "")) < int(plants.replace(",", "")) / 1.8
    go(app, "today")
    app.selectbox(key="length").set_value("m").run()
    go(app, "plot")
    assert row_box(app, "plant_spacing").value == pytest.approx(6.096)
    assert row_box(app, "row_spacing").value == pytest.approx(8.0)
    assert metric(app, "Plants") == fewer


def test_rows_set_by_hand_are_those_of_one_plot(app):
    go(app, "plot")
    row_box(app, "row_bearing").set_value(10.0).run()
    other = app.selectbox(key="feature sample/paran_estate.zip").set_value(1).run()
    assert metric(other, "Row direction") != "10.0°"
    app.selectbox(key="feature sample/paran_estate.zip").set_value(0).run()
    assert metric(app, "Row direction") == "10.0°"


@pytest.mark.usefixtures("session")
def test_lengths_in_feet_are_metres_and_empty_boxes_say_nothing():
    widget_memory.first("length", "ft")
    widget_memory.first("row_spacing a", 10.0)
    widget_memory.first("row_bearing a", 158.0)
    said = row_settings.row_settings("a")
    assert said["row_spacing_m"] == pytest.approx(3.048)
    assert said["row_bearing_deg"] == 158.0
    assert said["plant_spacing_m"] is None
    assert said["faces"] is None
    assert row_settings.is_said("a")
    assert not row_settings.is_said("b")


@pytest.mark.usefixtures("session")
def test_both_faces_are_two():
    widget_memory.first("both_faces a", value=True)
    assert row_settings.row_settings("a")["faces"] == 2
