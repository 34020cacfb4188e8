"""Every page, driven without a browser."""

import json
from datetime import date
from types import SimpleNamespace

import numpy as np
import pytest
import streamlit as st
from rasterio.io import MemoryFile
from rasterio.transform import from_bounds
from streamlit.testing.v1 import AppTest

from app.startup import preload
from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.monitoring import Season
from tests.app.driving import (
    PAGES,
    begun,
    go,
    heading,
    layer,
    map_of,
    metric,
    opened,
    press,
    row_box,
    square,
    texts_of,
    upload,
    zipped,
)


@pytest.fixture
def app():
    return opened()


def test_the_first_screen_shows_the_sample_estate_with_a_route(app):
    assert not app.exception
    assert heading(app) == "Gate · 2026-11-16"
    n = len(layer(app, "plants")["data"])
    assert n > 3000
    assert len(layer(app, "route")["data"][0]["path"]) > 100
    assert "hot" in {one["id"] for one in map_of(app)["layers"]}
    assert metric(app, "Plants to inspect").endswith(f"/ {n:,}")
    assert app.get("download_button")


@pytest.mark.parametrize("page", PAGES)
def test_every_page_opens_on_the_sample_and_before_anything_was_brought(app, page):
    go(app, page)
    assert not app.exception
    assert not app.error
    assert texts_of(app)
    app.selectbox(key="season").set_value("My own files").run()
    assert not app.exception
    assert "Bring a plot" in texts_of(app)


def test_another_plot_is_another_map(app):
    n = len(layer(app, "plants")["data"])
    app.selectbox(key="feature sample/paran_estate.zip").set_value(1).run()
    assert not app.exception
    assert not heading(app).startswith("Gate")
    assert len(layer(app, "plants")["data"]) != n


def test_shorter_hours_give_a_shorter_route_on_every_page(app):
    stops = int(metric(app, "Plants to inspect").split(" / ")[0])
    app.slider(key="hours Robot").set_value(3.0).run()
    assert int(metric(app, "Plants to inspect").split(" / ")[0]) < stops / 2
    go(app, "map")
    assert app.slider(key="hours Robot").value == 3.0


def test_rows_can_be_turned_and_set_apart(app):
    go(app, "plot")
    row_box(app, "row_bearing").set_value(158.0).run()
    row_box(app, "row_spacing").set_value(8.0).run()
    assert not app.exception
    assert metric(app, "Row bearing") == "158.0°"
    assert 1500 < len(layer(app, "plants")["data"]) < 2000
    go(app, "today")
    assert 1500 < len(layer(app, "plants")["data"]) < 2000


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


def test_layers_are_switched_off_and_on_while_the_view_stays(app):
    view = map_of(app)["initialViewState"]
    app.pills(key="layers").set_value(["plants", "records"]).run()
    assert layer(app, "route") is None
    assert len(layer(app, "records")["data"]) > 100
    assert map_of(app)["initialViewState"] == view


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


def test_rows_set_by_hand_are_those_of_one_plot(app):
    go(app, "plot")
    row_box(app, "row_bearing").set_value(10.0).run()
    other = app.selectbox(key="feature sample/paran_estate.zip").set_value(1).run()
    assert metric(other, "Row bearing") != "10.0°"
    app.selectbox(key="feature sample/paran_estate.zip").set_value(0).run()
    assert metric(app, "Row bearing") == "10.0°"


def test_a_gate_is_set_where_only_plants_were_brought(app):
    lonlat = "\n".join(f"{35 + x / 4e3:.6f},{30 + y / 4e3:.6f}" for x in range(6) for y in range(9))
    upload(app, plant=("plants.csv", f"lon,lat\n{lonlat}\n".encode(), "text/csv"))
    plants = metric(app, "Plants")
    app.selectbox(key="draw_kind").set_value("gate").run()
    app.text_input(key="draw_typed").set_value("35.0001,29.9999").run()
    press(app, "Add")
    assert not app.error
    assert metric(app, "Plants") == plants
    assert layer(app, "gate")["data"][0]["p"] == [35.0001, 29.9999]
    go(app, "today")
    assert layer(app, "gate")["data"][0]["p"] == pytest.approx([35.0001, 29.9999], abs=1e-6)


def test_a_scout_is_planned_for_too(app):
    app.segmented_control(key="who").set_value("Scout on foot").run()
    assert not app.exception
    assert app.slider(key="hours Scout on foot").value == 4.0


def test_too_short_a_day_is_said_in_a_sentence(app):
    go(app, "plot")
    row_box(app, "headland").set_value(40.0).run()
    app.slider(key="hours Robot").set_value(0.5).run()
    assert not app.exception


def hears_clicks(app):
    return json.loads(app.get("bidi_component")[0].proto.json)["draws"]


def test_the_gate_and_areas_are_drawn_and_taken_back(app):
    go(app, "plot")
    plants = len(layer(app, "plants")["data"])
    lon, lat = layer(app, "plants")["data"][plants // 2]["p"]
    assert not hears_clicks(app)
    app.selectbox(key="draw_kind").set_value("no_go").run()
    assert hears_clicks(app)
    corners = [(lon, lat), (lon + 3e-4, lat), (lon + 3e-4, lat + 3e-4), (lon, lat + 3e-4)]
    app.text_input(key="draw_typed").set_value(" ".join(f"{x},{y}" for x, y in corners)).run()
    press(app, "Add")
    assert len(layer(app, "corners")["data"]) == 4
    press(app, "Finish")
    assert not app.exception
    left = len(layer(app, "plants")["data"])
    assert left < plants - 20
    press(app, "Undo the last one")
    assert len(layer(app, "plants")["data"]) == plants


def test_an_area_that_crosses_itself_is_refused_in_a_sentence(app):
    go(app, "plot")
    app.selectbox(key="draw_kind").set_value("no_go").run()
    app.text_input(key="draw_typed").set_value("35,30 35.1,30.1 35.1,30 35,30.1").run()
    press(app, "Add")
    press(app, "Finish")
    assert "must not cross itself" in app.error[0].value


def test_the_map_tells_three_states_apart_by_shape_and_the_history_of_a_plant(app):
    go(app, "map")
    app.radio(key="shade").set_value("state").run()
    colours = {tuple(p["c"]) for p in layer(app, "plants")["data"]}
    assert {c[3] for c in colours} == {30, 255}
    finds = len(layer(app, "finds0")["data"])
    assert finds == sum(p["c"][:3] == [213, 30, 30] for p in layer(app, "plants")["data"])
    assert finds > 20
    app.number_input(key="history row").set_value(20).run()
    assert "Chance of infestation now" in texts_of(app)
    app.number_input(key="history row").set_value(99_999).run()
    assert not app.exception
    assert "must be one of 1 to" in app.error[0].value


def test_a_picture_of_the_ground_lies_under_the_plants_where_it_is(app):
    data = geotiff(np.full((400, 400), 90, np.uint8))
    go(app, "map")
    app.pills(key="map_layers").set_value(["backdrop"]).run()
    app.file_uploader(key="backdrop_file").upload("ground.tif", data).run()
    assert not app.exception
    assert map_of(app)["layers"][1]["id"] == "backdrop"
    corners = np.array(layer(app, "backdrop")["bounds"])
    plants = np.array([p["p"] for p in layer(app, "plants")["data"]])
    assert (corners.min(axis=0) <= plants.min(axis=0)).all()
    assert (corners.max(axis=0) >= plants.max(axis=0)).all()
    app.file_uploader(key="backdrop_file").upload("ground.tif", b"no picture").run()
    assert not app.exception
    assert app.error
    assert layer(app, "backdrop") is None


def test_the_path_grows_as_the_day_is_played(app):
    go(app, "map")
    clock = "clock 2026-11-16"
    lengths = []
    for minute in (30, 200, 500):
        app.slider(key=clock).set_value(minute).run()
        lengths.append(len(layer(app, "trail")["data"][0]["path"]))
    assert lengths == sorted(set(lengths))
    app.button(key="play").click().run()
    assert not app.exception
    assert app.slider(key=clock).value >= 500


def test_lengths_and_dates_are_written_as_the_person_wants(app):
    app.selectbox(key="length").set_value("ft").run()
    app.selectbox(key="date_like").set_value("16.11.2026").run()
    assert heading(app) == "Gate · 16.11.2026"
    assert metric(app, "Drive").endswith(" mi")
    go(app, "plot")
    app.selectbox(key="area").set_value("dunam").run()
    assert metric(app, "Area").endswith("dunam")
    assert metric(app, "Rows / plants apart") == "13.1 ft / 9.8 ft"


def test_strategies_are_compared_and_the_best_is_put_to_use(app):
    go(app, "compare")
    app.number_input(key="seeds").set_value(3)
    app.number_input(key="n_days").set_value(4).run()
    assert "press Compare" in texts_of(app)
    app.button(key="run").click().run()
    for _ in range(300):
        if len(app.dataframe) and app.button(key="stop").disabled:
            break
        app.run()
    assert not app.exception
    table = app.dataframe[0].value
    assert len(table) == 3
    assert table["verdict"].iloc[0] == "★ best"
    naive = next(b for b in app.selectbox if b.label == "Strategy")
    naive.set_value(next(o for o in naive.options if o.startswith("Naive"))).run()
    press(app, "Use this strategy")
    assert app.selectbox(key="sampler").value == "naive"


def test_comparing_nothing_is_said_in_a_sentence(app):
    go(app, "compare")
    app.multiselect(key="strategy_samplers").set_value([]).run()
    assert not app.exception
    assert "Choose fewer" in app.warning[0].value


def test_the_report_holds_map_figures_settings_and_stops(app):
    go(app, "report")
    assert not app.exception
    assert "Save as PDF" in texts_of(app)
    assert app.get("download_button")


def test_a_season_is_simulated_and_its_day_slider_moves_the_map(app):
    go(app, "simulate")
    inspected = []
    for day in (1, 5, 12):
        app.slider(key="season_day").set_value(day).run()
        inspected.append(sum(p["c"][3] == 255 for p in layer(app, "plants")["data"]))
    assert inspected == sorted(set(inspected))
    assert layer(app, "truth") is None
    app.toggle(key="truth").set_value(True).run()
    assert layer(app, "truth") is not None


def test_an_uploaded_plot_and_records_are_planned(app, tmp_path):
    mites = b"date,lon,lat,count\n2026-11-10,35.1505,30.3605,9\n"
    plot = zipped(tmp_path, square(name="שדה"))
    upload(app, plot=("plot.zip", plot), record=("mites.csv", mites))
    assert not app.exception
    assert heading(app).startswith("שדה")
    go(app, "today")
    worst = max(layer(app, "plants")["data"], key=lambda p: float(p["t"].split(": ")[1][:-8]))
    assert worst["p"] == pytest.approx([35.1505, 30.3605], abs=4e-5)


def test_one_session_does_not_see_the_files_of_another(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(name="secret"))))
    assert heading(app).startswith("secret")
    other = opened()
    other.selectbox(key="season").set_value("My own files").run()
    assert "Bring a plot" in texts_of(other)


def test_a_missing_crs_is_asked_for_and_answered_by_button(app, tmp_path):
    data = zipped(tmp_path, square().to_crs(2039), without=".prj")
    upload(app, plot=("plot.zip", data))
    assert not app.exception
    assert "coordinate system" in app.warning[0].value
    ask = next(box for box in app.selectbox if box.label.endswith("crs"))
    assert "EPSG:2039" in ask.options
    ask.set_value("EPSG:2039").run()
    press(app, "Use this")
    assert not app.exception
    assert not app.warning
    assert heading(app).startswith("square")
    press(app, "Take back: crs = EPSG:2039")
    assert "coordinate system" in app.warning[0].value


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        ("plot.zip", b"no zip", "plot"),
        ("plot.geojson", b"{}", "plot"),
        ("plot.csv", b"a,b\n1,2\n", "longitudes"),
    ],
)
def test_a_bad_file_is_a_sentence(app, name, data, says):
    upload(app, plot=(name, data))
    assert not app.exception
    assert any(says in message.value for message in [*app.error, *app.warning])
    assert app.file_uploader(key="plot_file")


def test_a_plot_of_many_plants_travels_as_one_picture(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(size=0.006))))
    go(app, "today")
    assert not app.exception
    assert layer(app, "plants")["@@type"] == "BitmapLayer"
    assert len(json.dumps(map_of(app))) < 1_000_000
    go(app, "map")
    first, last = app.slider(key="rows_close").value
    assert 0 < len(layer(app, "part")["data"]) < 20_000
    assert all(
        first <= int(p["t"].split(",")[0][4:]) <= last for p in layer(app, "part")["data"][::50]
    )


def test_the_study_page_makes_a_table_again():
    page = AppTest.from_function(study_page, default_timeout=120).run()
    page.selectbox(key="study_table").set_value("3").run()
    page.number_input(key="study_replicates").set_value(10).run()
    page.button(key="study_run").click().run()
    assert not page.exception
    assert len(page.dataframe[0].value) > 50
    assert any("Table 3" in text.value for text in page.markdown)


def study_page():
    from app.views import study

    study.show()


def geotiff(values, edges=(35.1, 30.3, 35.2, 30.4)):
    """Return a raster ``(h, w)`` over the sample estate as the bytes of a GeoTIFF."""
    high, wide = values.shape
    with MemoryFile() as memory:
        shape = {"width": wide, "height": high, "count": 1, "dtype": values.dtype}
        place = from_bounds(*edges, wide, high)
        with memory.open(**shape, driver="GTiff", crs="EPSG:4326", transform=place) as raster:
            raster.write(values[None])
        return memory.read()


def test_plants_that_a_raster_shows_to_be_missing_are_not_laid(app):
    go(app, "plot")
    every = np.array([p["p"] for p in layer(app, "plants")["data"]])
    west, east = every[:, 0].min(), every[:, 0].max()
    low, high = every[:, 1].min(), every[:, 1].max()
    half = np.repeat(np.array([[0.2, 1.5]], np.float32), 50, axis=1).repeat(50, axis=0)
    # the middle half of the plot from west to east, and beyond it to the north and south
    quarter = (east - west) / 4
    data = geotiff(half, (west + quarter, low - 0.001, east - quarter, high + 0.001))
    app.file_uploader(key="missing_plants_file").upload("canopy.tif", data).run()
    left = np.array([p["p"] for p in layer(app, "plants")["data"]])
    gone = (every[:, 0] > west + 1.05 * quarter) & (every[:, 0] < west + 1.95 * quarter)
    assert gone.sum() > 500
    assert not set(map(tuple, every[gone])) & set(map(tuple, left))
    stays = (every[:, 0] < west + 0.95 * quarter) | (every[:, 0] > west + 2.05 * quarter)
    assert set(map(tuple, every[stays])) <= set(map(tuple, left))
    assert f"{len(every) - len(left)} of {len(every)} plants are missing" in texts_of(app)
    assert "have no value on the raster and count as there" in texts_of(app)
    app.number_input(key="missing_below").set_value(2.0).run()
    assert len(layer(app, "plants")["data"]) < len(left)
    press(app, "Take it out")
    assert len(layer(app, "plants")["data"]) == len(every)


def test_a_raster_of_risk_changes_the_chances_and_the_season_keeps_it(app, seasons_folder):
    rows = np.repeat(np.linspace(40, 0, 400, dtype=np.float32)[:, None], 400, axis=1)
    data = geotiff(rows)
    before = float(metric(app, "Expected finds"))
    go(app, "plot")
    app.file_uploader(key="risk_file").upload("risk.tif", data).run()
    assert "must hold values in 0..1" in app.error[0].value, "percent were taken for chances"
    app.selectbox(key="risk_meaning").set_value("percent").run()
    assert not app.error
    assert "Risk by percent: 0.1" in texts_of(app)
    go(app, "today")
    assert float(metric(app, "Expected finds")) > before
    begun(app)
    risk = Season(seasons_folder / "Gate 2026.gpkg").risk
    assert risk is not None
    assert 0.1 < np.nanmean(risk) < 0.4


def test_while_loops_are_compiled_the_page_says_so_and_shows_the_outline(monkeypatch):
    class Ready:
        asked = 0

        def is_set(self):
            return False

        def wait(self, _):
            self.asked += 1
            if self.asked > 2:
                st.stop()
            return False

    waiting = SimpleNamespace(ready=Ready(), load=lambda **_: None)
    monkeypatch.setattr(preload, "start", lambda: waiting)
    monkeypatch.setattr(FIRST_USE, "compiled", 7)
    app = opened()
    assert "7 parts" in app.info[0].value
    (picture,) = app.get("deck_gl_json_chart")
    assert "boundary" in picture.proto.json
    assert not app.metric


def test_records_of_later_days_make_no_hot_spot_yet(app):
    assert "hot" in {one["id"] for one in map_of(app)["layers"]}
    app.date_input[0].set_value(date(2026, 1, 1)).run()
    assert "hot" not in {one["id"] for one in map_of(app)["layers"]}
