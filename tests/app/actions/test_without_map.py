"""Where there is no map, a card says what is wrong and offers the next step."""

import json

from app.actions import without_map
from app.state.brought_files import File
from app.words import texts
from fieldmon.io.options import Upload
from tests.app.driving import map_of, opened, press, row_box, square, texts_of, upload, zipped


def card(app):
    """Return what the card in the map's place says."""
    return [one for one in texts.NO_MAP.values() if f"### {one}" in texts_of(app)]


def test_before_a_file_is_brought_the_map_s_place_says_what_will_be_there(app):
    app.selectbox(key="season").set_value("My own files").run()
    assert card(app) == [texts.NO_MAP["bring"]]
    assert not app.get("bidi_component")


def test_a_file_that_cannot_be_read_is_said_there_and_taken_out_there(app, tmp_path):
    upload(app, plot=("plot.zip", b"no zip"))
    assert card(app) == [texts.NO_MAP["file"]]
    said = app.error[0].value
    assert texts_of(app).count(said) == 1, "what is wrong, once"
    assert "plot.zip" in app.button(key="no_map_take_out").label
    app.button(key="no_map_take_out").click().run()
    assert card(app) == [texts.NO_MAP["bring"]]
    upload(app, plot=("plot.zip", zipped(tmp_path, square())))
    assert card(app) == []
    assert map_of(app)["layers"]


def test_a_file_that_was_taken_out_is_no_part_of_what_is_dropped_next(app, tmp_path):
    upload(app, plot=("pic.png", b"no plot"))
    app.button(key="no_map_take_out").click().run()
    (box,) = (one for one in app.file_uploader if one.key.startswith("plot_file"))
    assert not box.value
    box.upload("plot.zip", zipped(tmp_path, square())).run()
    assert card(app) == []
    kept = app.session_state["brought"]["plot"]
    assert kept.names == ["plot.zip"]


def test_rows_that_leave_no_plot_are_said_there_too(tmp_path):
    app = upload(opened(), plot=("plot.zip", zipped(tmp_path, square(0.0006))))
    row_box(app, "headland").set_value(49.0).run()
    assert app.error
    assert card(app) == [texts.NO_MAP["plot"]]


def test_a_question_with_nothing_to_look_at_points_to_its_answers(app):
    upload(app, plot=("plot.csv", b"a,b\n1,2\n"))
    assert card(app) == [texts.NO_MAP["asked"]]
    app.selectbox(key="season").set_value("Sample estate").run()
    assert card(app) == []
    press(app, texts.TO_ROUTE)
    assert not app.exception


def test_of_several_files_that_are_one_the_button_says_how_many_it_takes_out():
    parts = tuple(Upload(f"vines.{ending}", b"") for ending in ("shp", "dbf", "prj"))
    several, one = File("key", parts, "plot"), File("key", parts[0], "plot")
    assert texts.isolated("vines.shp") in without_map._take_out(several)
    assert without_map._take_out(several).endswith("and 2 more")
    assert without_map._take_out(one).endswith(texts.isolated("vines.shp"))


def test_one_measured_plant_is_planned_where_it_is_said_that_it_stands_in_no_row(app):
    one = {"type": "Point", "coordinates": [0.62, 41.62]}
    upload(app, plot=("one.geojson", json.dumps(one).encode()))
    press(app, texts.THESE_ARE_PLANTS)
    assert card(app) == [texts.NO_MAP["plot"]]
    assert "--" not in app.error[0].value
    next(box for box in app.toggle if box.label == texts.NO_ROWS).set_value(True).run()
    assert not app.error
    assert card(app) == []


def test_a_plot_with_nothing_to_change_by_hand_points_to_its_file(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(0.00002))))
    assert app.error
    assert card(app) == [texts.NO_MAP["file"]]
