"""Every page, driven without a browser."""

import json
import zipfile
from io import BytesIO
from pathlib import Path

import geopandas as gpd
import pytest
from shapely import box
from streamlit.testing.v1 import AppTest

ROOT = Path(__file__).resolve().parents[2]
ESTATE = ROOT / "sample_data"


@pytest.fixture
def app():
    return AppTest.from_file(str(ROOT / "app" / "streamlit_app.py"), default_timeout=120).run()


def map_of(app):
    return json.loads(app.get("deck_gl_json_chart")[0].proto.json)


def layer(app, name):
    return next((one for one in map_of(app)["layers"] if one["id"] == name), None)


def metric(app, label):
    return next(m.value for m in app.metric if m.label == label)


def upload(app, **files):
    app.segmented_control(key="where").set_value("My own files").run()
    for key, (name, data) in files.items():
        app.file_uploader(key=f"{key}_file").upload(name, data)
    return app.run()


def zipped(folder, plots):
    plots.to_file(folder / "plot.shp")
    data = BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for part in folder.glob("plot.*"):
            archive.write(part, part.name)
    return data.getvalue()


def square(size=0.001, name="square"):
    shape = box(35.15, 30.36, 35.15 + size, 30.36 + size)
    return gpd.GeoDataFrame([{"name": name, "geometry": shape}], crs="EPSG:4326")


def test_the_first_screen_shows_the_sample_estate_with_a_route(app):
    assert not app.exception
    assert app.subheader[0].value == "Gate"
    n = len(layer(app, "plants")["data"])
    assert n > 3000
    assert len(layer(app, "route")["data"][0]["path"]) > 100
    assert "hot" in {one["id"] for one in map_of(app)["layers"]}
    assert metric(app, "Plants to inspect").endswith(f"/ {n:,}")
    assert app.get("download_button")


def test_another_plot_is_another_map(app):
    n = len(layer(app, "plants")["data"])
    app.selectbox(key="feature sample/paran_estate.zip").set_value("Terrace").run()
    assert not app.exception
    assert app.subheader[0].value == "Terrace"
    assert len(layer(app, "plants")["data"]) != n


def test_shorter_hours_give_a_shorter_route(app):
    stops = int(metric(app, "Plants to inspect").split(" / ")[0])
    app.slider(key="hours Robot").set_value(3.0).run()
    assert int(metric(app, "Plants to inspect").split(" / ")[0]) < stops / 2


def test_rows_can_be_turned_and_set_apart(app):
    app.number_input(key="bearing").set_value(158.0).run()
    app.number_input(key="rows").set_value(8.0).run()
    assert not app.exception
    assert 1500 < len(layer(app, "plants")["data"]) < 2000


def test_layers_are_switched_off_and_on_while_the_view_stays(app):
    view = map_of(app)["initialViewState"]
    app.pills(key="layers").set_value(["plants", "records"]).run()
    assert layer(app, "route") is None
    assert len(layer(app, "records")["data"]) > 100
    assert map_of(app)["initialViewState"] == view


def test_a_scout_is_planned_for_too(app):
    app.segmented_control(key="who").set_value("Scout on foot").run()
    assert not app.exception
    assert app.slider(key="hours Scout on foot").value == 4.0


def test_too_short_a_day_is_said_in_a_sentence(app):
    app.number_input(key="headland").set_value(40.0).run()
    app.slider(key="hours Robot").set_value(0.5).run()
    assert not app.exception


def test_a_season_is_simulated_and_its_day_slider_moves_the_map():
    page = AppTest.from_function(season_page, default_timeout=120).run()
    assert not page.exception
    seen = [sum(p["c"] != [205, 205, 198] for p in layer(page, "plants")["data"])]
    for day in (1, 12):
        page.slider(key="season_day").set_value(day).run()
        seen.append(sum(p["c"] != [205, 205, 198] for p in layer(page, "plants")["data"]))
    assert seen[1] < seen[0] < seen[2]
    assert layer(page, "truth") is None
    page.toggle(key="truth").set_value(True).run()
    assert layer(page, "truth") is not None


def season_page():
    from app.choices import choose
    from app.views import season

    season.show(choose())


def test_an_uploaded_plot_and_records_are_planned(app, tmp_path):
    mites = b"date,lon,lat,count\n2026-11-10,35.1505,30.3605,9\n"
    upload(
        app,
        plot=("plot.zip", zipped(tmp_path, square(name="שדה"))),
        record=("mites.csv", mites),
    )
    assert not app.exception
    assert app.subheader[0].value == "שדה"
    worst = max(layer(app, "plants")["data"], key=lambda p: float(p["t"].split("<br>")[1][:-8]))
    assert worst["p"] == pytest.approx([35.1505, 30.3605], abs=4e-5)


def test_before_an_upload_the_page_says_what_to_bring(app):
    app.segmented_control(key="where").set_value("My own files").run()
    assert not app.exception
    assert "Bring a plot" in app.markdown[0].value


def test_a_missing_crs_is_asked_for_and_answered_by_button(app, tmp_path):
    plots = square().to_crs(2039)
    plots.to_file(tmp_path / "plot.shp")
    (tmp_path / "plot.prj").unlink()
    data = BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for part in tmp_path.glob("plot.*"):
            archive.write(part, part.name)
    upload(app, plot=("plot.zip", data.getvalue()))
    assert not app.exception
    assert "coordinate system" in app.warning[0].value
    ask = next(box for box in app.selectbox if box.label.endswith("crs"))
    assert "EPSG:2039" in ask.options
    ask.set_value("EPSG:2039").run()
    app.button[0].click().run()
    assert not app.exception
    assert not app.warning
    assert app.subheader[0].value == "square"


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
    shown = [message.value for message in [*app.error, *app.warning]]
    assert any(says in text for text in shown)


def test_a_plot_too_small_for_a_plant_is_a_sentence(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(size=2e-5))))
    assert not app.exception
    assert "room for one plant" in app.error[0].value


def test_records_that_are_all_elsewhere_are_a_sentence(app, tmp_path):
    mites = b"date,lon,lat,count\n2026-11-10,8.0,49.0,9\n"
    upload(app, plot=("plot.zip", zipped(tmp_path, square())), record=("mites.csv", mites))
    assert not app.exception
    assert "km" in app.error[0].value


def test_very_many_plants_travel_as_one_picture(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square(size=0.006))))
    assert not app.exception
    assert layer(app, "plants")["@@type"] == "BitmapLayer"
    assert len(json.dumps(map_of(app))) < 1_000_000


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
