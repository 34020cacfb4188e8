"""A plot drawn without a file: from the page, by typed corners and by taps; refusals are said."""

import json

import pytest

from app.actions import drawing_plot
from app.state import drawn_plot, plot_source, web_maps, widget_memory
from app.words import texts
from fieldmon.monitoring import Season
from tests.app.driving import (
    begun,
    go,
    map_of,
    metric,
    opened,
    plot_name,
    press,
    tap,
    texts_of,
    upload,
    zipped,
)
from tests.cli.estate import square

SQUARE = ((34.9, 31.5), (34.901, 31.5), (34.901, 31.501), (34.9, 31.501))


@pytest.fixture
def drawing():
    """Return a session in which a plot is about to be drawn."""
    app = go(opened(texts.UPLOAD), "plot")
    press(app, texts.OUTLINE_BEGIN)
    return app


def typed(app, text, label=texts.OUTLINE_ADD):
    app.text_input(key="outline_typed").set_value(text)
    return press(app, label)


def corners(app, places):
    for lon, lat in places:
        typed(app, f"{lat}, {lon}")
    return app


def test_four_typed_corners_are_a_plot_that_survives_a_reload_and_begins_seasons(
    drawing, tmp_path, seasons_folder
):
    corners(drawing, SQUARE)
    assert map_of(drawing)["draw"]["points"] == [list(corner) for corner in SQUARE]
    assert "4 corners, 1.05 ha" in texts_of(drawing).replace("\u00a0", " ")
    press(drawing, texts.OUTLINE_USE)
    assert not drawing.exception
    assert not drawing.error
    assert metric(drawing, "Area") == "1.05 ha"
    assert plot_name(drawing) == texts.OUTLINE_NAME
    assert "named by column" not in texts_of(drawing)
    assert texts.MESSAGES_DRAWN in texts_of(drawing)
    word = drawing.query_params["files"]
    again = opened(texts.UPLOAD, files=word[0] if isinstance(word, list) else word)
    assert plot_name(again) == texts.OUTLINE_NAME
    assert "route" in {one["key"] for one in map_of(again)["switches"]}
    # another season of one opened by its address has its boundary, gate and no-go areas
    drawn = {"gate": "34.9,31.5", "no_go": "34.9003,31.5003 34.9006,31.5003 34.9006,31.5006"}
    for kind, places in drawn.items():
        drawing.selectbox(key="draw_kind").set_value(kind).run()
        drawing.text_input(key="draw_typed").set_value(places).run()
        press(drawing, "Add")
    plants = metric(go(drawing, "plot"), "Plants")
    begun(drawing, "Drawn 2026")
    another = go(opened("Drawn 2026"), "plot")
    assert metric(another, "Plants") == plants
    press(another, texts.ANOTHER)
    assert not another.exception
    assert texts.ANOTHER_BARE in [one.value for one in another.success]
    assert another.selectbox(key="season").value == plot_source.FILES
    assert (metric(another, "Area"), metric(another, "Plants")) == ("1.05 ha", plants)
    assert "the gate: 1" in texts_of(another)
    assert texts.OUTLINE_CORRECT in [one.label for one in another.button]
    begun(another, "Drawn again")
    kept = [
        Season(seasons_folder / f"{name}.gpkg").plot.field for name in ("Drawn 2026", "Drawn again")
    ]
    assert kept[0].boundary.equals_exact(kept[1].boundary, 1e-7, normalize=True)
    assert kept[0].no_go.equals_exact(kept[1].no_go, 1e-7, normalize=True)
    # and opens no other plot that is at hand
    other = upload(opened(), plot=("plot.zip", zipped(tmp_path, square())))
    other.selectbox(key="season").set_value("Drawn 2026").run()
    press(go(other, "plot"), texts.ANOTHER)
    assert texts.ANOTHER_ELSEWHERE in [one.value for one in other.error]
    assert other.selectbox(key="season").value == "Drawn 2026"


def test_corners_so_far_survive_a_reload_and_what_is_used_can_be_corrected(drawing):
    corners(drawing, SQUARE[:3])
    word = drawing.query_params["files"]
    again = go(opened(texts.UPLOAD, files=word[0] if isinstance(word, list) else word), "plot")
    assert map_of(again)["draw"]["points"] == [list(corner) for corner in SQUARE[:3]]
    press(again, texts.OUTLINE_USE)
    assert metric(again, "Area") == "0.527 ha"
    press(again, texts.OUTLINE_CORRECT)
    corners(again, SQUARE[3:])
    press(again, texts.OUTLINE_USE)
    assert not again.error
    assert metric(again, "Area") == "1.05 ha"


def test_too_few_corners_and_crossed_ones_are_refused_in_a_sentence_and_stay(drawing):
    for n in (0, 2):
        corners(drawing, SQUARE[:n])
        assert drawing.button(key="outline_use").disabled
        assert f"needs three corners or more, but {n} are set" in texts_of(drawing)
    corners(drawing, (SQUARE[3], SQUARE[2]))
    crossing = "4 corners; the edges after corners 2 and 4 cross"
    assert crossing in texts_of(drawing)
    assert map_of(drawing)["draw"]["hint"] == crossing
    press(drawing, texts.OUTLINE_USE)
    assert "must not cross itself" in drawing.error[0].value
    assert len(map_of(drawing)["draw"]["points"]) == 4
    typed(drawing, "somewhere")
    assert "must be written latitude, longitude" in drawing.error[0].value


def test_a_place_is_said_with_its_country_and_can_be_exchanged(drawing):
    typed(drawing, "31.5, 34.9", texts.OUTLINE_GO)
    assert "Read as latitude 31.5, longitude 34.9: Israel." in texts_of(drawing)
    assert map_of(drawing)["place"].startswith("drawing (34.9, 31.5)")
    press(drawing, texts.OUTLINE_TURN)
    assert "Read as latitude 34.9, longitude 31.5" in texts_of(drawing)
    assert map_of(drawing)["place"].startswith("drawing (31.5, 34.9)")
    typed(drawing, "34.9, 31.5")
    assert map_of(drawing)["draw"]["points"] == [[34.9, 31.5]]
    typed(drawing, "https://www.openstreetmap.org/#map=17/31.5/34.9", texts.OUTLINE_GO)
    assert map_of(drawing)["place"].startswith("drawing (34.9, 31.5)")
    assert texts.OUTLINE_TURN not in [one.label for one in drawing.button]


def test_a_map_of_the_world_is_shown_once_agreed_to(drawing):
    drawing.selectbox(key="web_map").set_value("osm").run()
    assert map_of(drawing)["ground"]["ids"] == []
    tap(drawing, "web_map_agree")
    assert map_of(drawing)["ground"]["ids"] == ["ground-map"]
    assert map_of(drawing)["ground"]["credit"] == web_maps.OSM_CREDIT
    tap(drawing, "web_map_back")
    assert map_of(drawing)["ground"]["ids"] == []


def test_who_leaves_is_back_at_the_boxes_for_files_and_finds_the_corners_again(drawing):
    corners(drawing, SQUARE[:2])
    press(drawing, texts.OUTLINE_LEAVE)
    assert drawing.file_uploader
    press(drawing, texts.OUTLINE_BEGIN)
    assert len(map_of(drawing)["draw"]["points"]) == 2


def test_the_sample_and_files_are_not_offered_to_be_corrected(app):
    go(app, "plot")
    assert texts.OUTLINE_CORRECT not in [one.label for one in app.button]


@pytest.fixture
def heard(session):
    """Return what hears of taps on the map, and the corners that are kept."""
    widget_memory.put(plot_source.KEY, plot_source.FILES)
    drawn_plot.begin()

    def hear(kind, points):
        drawing_plot._drawn(kind, points)
        return drawn_plot.so_far()

    hear.session = session
    return hear


def test_taps_are_kept_and_finished_and_those_of_an_older_drawing_are_not(heard):
    assert heard("outline 0", SQUARE[:2]).corners == SQUARE[:2]
    assert heard("outline 0", ()).corners == ()
    drawn_plot.drawn_anew()
    assert heard("outline 0", SQUARE).corners == ()
    assert heard("outline 0 done", SQUARE).corners == ()
    assert drawn_plot.is_open()
    heard("outline 1 done", SQUARE[:2])
    assert heard.session["notice"][0] == "error"
    heard("outline 1 done", SQUARE)
    assert not drawn_plot.is_open()
    assert json.loads(drawn_plot.data_of_plot())["geometry"]["type"] == "Polygon"


def test_where_one_is_becomes_the_place_that_is_seen(heard):
    made = heard("outline 0 here", SQUARE[:1])
    assert (made.at, made.corners) == (SQUARE[0], ())
