"""Files that leave a choice are asked about; bad ones are a sentence."""

import json
from types import SimpleNamespace

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest
from shapely import transform

from app.actions import bringing_files
from app.words import texts
from fieldmon.infestation.inspections import CLEAN, FOUND
from tests.app.driving import go, metric, plot_name, press, square, texts_of, upload, zipped


def test_a_missing_crs_is_asked_for_and_answered_by_button(app, tmp_path):
    data = zipped(tmp_path, square().to_crs(2039), without=".prj")
    upload(app, plot=("plot.zip", data))
    assert not app.exception
    assert "coordinate system" in app.warning[0].value
    ask = next(box for box in app.selectbox if box.key.startswith("ask "))
    assert "EPSG:2039" in ask.options
    ask.set_value("EPSG:2039").run()
    press(app, "Use this")
    assert not app.exception
    assert not app.warning
    assert plot_name(app) == "square"
    press(app, "Take back: EPSG:2039")
    assert "coordinate system" in app.warning[0].value


def test_a_doubt_about_the_plot_is_said_on_today_with_its_remedy_before_a_season_begins(app):
    # longitude and latitude exchanged: it lies in the open sea
    at_sea = square().set_geometry([transform(square().geometry[0], lambda xy: xy[:, ::-1])])
    upload(app, plot=("plot.geojson", at_sea.to_json().encode()))
    for page in ("today", "record"):
        go(app, page)
        assert not app.exception
        assert texts.SEVERITIES["doubtful"] in texts_of(app)
        (remedy,) = [one for one in app.button if one.key.startswith("remedy ")]
    remedy.click().run()
    assert texts.SEVERITIES["doubtful"] not in texts_of(go(app, "today"))


def test_words_that_say_neither_are_asked_about_together(app, tmp_path):
    table = "lon,lat,date,result\n" + "".join(
        f"{35.15 + 1e-4 * k},30.36,2026-11-0{k + 1},{word}\n"
        for k, word in enumerate(["yes", "krobbig", "perhaps", "naja", "no"])
    )
    upload(app, plot=("plot.zip", zipped(tmp_path, square())), record=("r.csv", table.encode()))

    def asked():
        """Return the keys of the boxes for words, by these."""
        words = [one.key for one in app.get("button_group") if (one.key or "").startswith("word ")]
        return {key.rpartition(" ")[2]: key for key in words}

    assert [*asked()] == ["krobbig", "naja", "perhaps"]
    app.session_state[asked()["krobbig"]] = FOUND
    app.session_state[asked()["perhaps"]] = CLEAN
    press(app, texts.WORDS_TAKE)
    assert not app.exception
    assert [*asked()] == ["naja"]
    app.session_state[asked()["naja"]] = FOUND
    press(app, texts.WORDS_TAKE)
    assert not asked()
    assert "say neither" not in texts_of(app)
    press(app, "Take back: krobbig, naja: found")
    assert [*asked()] == ["naja"]


def test_a_bad_file_is_a_sentence(app):
    for name, data, says in (
        ("plot.zip", b"no zip", "plot"),
        ("plot.geojson", b"{}", "plot"),
        ("plot.csv", b"a,b\n1,2\n", "longitudes"),
    ):
        upload(app, plot=(name, data))
        assert not app.exception
        said = [message.value for message in [*app.error, *app.warning]]
        assert any(says in one for one in said)
        assert app.file_uploader(key="plot_file")


def test_plants_dropped_in_the_box_of_the_plot_are_taken_as_plants_by_one_button(app):
    at = [(681_500 + 3.0 * row, 3_360_000 + 1.5 * k) for row in range(6) for k in range(10)]
    table = "x,y,row\n" + "".join(f"{x},{y},{1 + n // 10}\n" for n, (x, y) in enumerate(at))
    upload(app, plot=("vines.csv", table.encode()))
    boxes = [box for box in app.selectbox if box.key.startswith("ask ")]
    boxes[0].set_value("EPSG:32636").run()
    press(app, "Use this")
    assert "not its corners" in app.warning[0].value
    press(app, texts.THESE_ARE_PLANTS)
    assert not app.exception
    assert not app.warning
    assert metric(app, "Plants") == "60"
    # the boxes are empty: another file dropped there is not one with this
    assert not any(box.value for box in app.file_uploader)
    assert "In use: " in texts_of(app)
    assert "vines.csv" in texts_of(app)


def test_corners_brought_as_points_are_taken_as_the_outline_by_one_button(app):
    at = [(35.151, 30.36), (35.1526, 30.3601), (35.1525, 30.361), (35.151, 30.3609)]
    points = [{"type": "Point", "coordinates": one} for one in at]
    features = [{"type": "Feature", "properties": {}, "geometry": one} for one in points]
    data = json.dumps({"type": "FeatureCollection", "features": features})
    upload(app, plot=("corners.geojson", data.encode()))
    assert "Are they its corners" in app.warning[0].value
    press(app, texts.ANSWER_OUTLINE)
    assert not app.exception
    assert not app.warning
    assert int(metric(app, "Plants").replace(",", "")) > 500


def two_layers(folder):
    """Return a plot and its records as the bytes of one GeoPackage."""
    path = folder / "both.gpkg"
    square().to_file(path, layer="plots")
    here = gpd.points_from_xy(35.1502 + np.arange(5) * 1e-4, [30.3605] * 5)
    finds = gpd.GeoDataFrame({"date": "2026-11-10", "count": [3, 0, 2, 0, 9]}, geometry=here,
                             crs="EPSG:4326")  # fmt: skip
    finds.to_file(path, layer="finds")
    return path.read_bytes()


def test_one_file_is_plot_and_records_each_with_its_own_answer(app, tmp_path):
    data = two_layers(tmp_path)
    upload(app, plot=("both.gpkg", data), record=("both.gpkg", data))
    next(one for one in app.button if one.label.startswith("1 · plots · ")).click().run()
    assert plot_name(app).startswith("square")
    assert "are not used on this plot" in texts_of(app)
    press(app, "2 · finds · 5 of 5 on the plot, 3 finds")
    assert not app.warning
    assert "5 of 5 records shown (3 with pests, 2 without)" in texts_of(app)
    assert plot_name(app).startswith("square")


def test_records_of_one_block_do_not_lock_the_others_out(app, tmp_path):
    east, west = square(name="east"), square(name="west")
    west.geometry = west.translate(-0.3)
    blocks = pd.concat([east, west])
    mites = b"lon,lat,date,count\n35.1505,30.3605,2026-11-10,4\n"
    data = zipped(tmp_path, gpd.GeoDataFrame(blocks, crs="EPSG:4326"))
    upload(app, plot=("blocks.zip", data), record=("mites.csv", mites))
    which = next(box for box in app.selectbox if box.label == texts.WHICH_PLOT)
    which.set_value(1).run()
    assert not app.exception
    assert plot_name(app).startswith("west")
    for page in ("today", "plot", "field"):
        go(app, page)
        assert not app.exception
        assert "mites.csv" in texts_of(app)
        assert "must lie on plot west or near it" in texts_of(app)
    next(box for box in app.selectbox if box.label == texts.WHICH_PLOT).set_value(0).run()
    assert "not used" not in texts_of(app)
    assert "not used" not in texts_of(go(app, "plot"))
    assert "1 of 1 records shown" in texts_of(app)


def test_answers_have_buttons_unless_they_were_seen_to_lead_nowhere():
    offered = [f"EPSG:{k}" for k in range(1, 15)]
    led = {one: SimpleNamespace(leads=one in {"EPSG:2", "EPSG:12"}) for one in offered[:12]}
    made = bringing_files.with_buttons(offered, led)
    # those that nobody tried may lead somewhere
    assert made == [(2, "EPSG:2"), (12, "EPSG:12"), (13, "EPSG:13"), (14, "EPSG:14")]
    assert bringing_files.with_buttons(offered, {}) == [*enumerate(offered[:12], start=1)]


def test_the_first_screen_doubts_nothing_of_the_sample_and_its_import_says_it(app):
    assert "lie on no plant" not in texts_of(app)
    assert "there it is always Mon 16 Nov 2026." in texts_of(app)
    assert "lie on no plant" in texts_of(go(app, "plot"))


@pytest.mark.parametrize(("n", "warned"), [(3, True), (40, False)])
def test_a_plot_with_room_for_hardly_a_plant_is_doubted(n, warned, monkeypatch):
    said = []
    monkeypatch.setattr(bringing_files.st, "warning", said.append)
    monkeypatch.setattr(bringing_files, "show_messages", lambda *_: None)
    grid = SimpleNamespace(vine=np.arange(n))
    choices = SimpleNamespace(plot=SimpleNamespace(grid=grid), season=object(), messages=())
    bringing_files.show_of_plot(choices)
    assert said == ([texts.FEW_PLANTS.format(n=n)] if warned else [])


def test_corners_in_the_wrong_order_are_doubted_on_today(app):
    corners = [[35.15, 30.36], [35.152, 30.362], [35.152, 30.36], [35.15, 30.362], [35.15, 30.36]]
    tie = {"type": "Polygon", "coordinates": [corners]}
    upload(app, plot=("plot.geojson", json.dumps(tie).encode()))
    said = texts_of(go(app, "today"))
    assert texts.SEVERITIES["doubtful"] in said
    assert "corners seem to be in the wrong order" in said
