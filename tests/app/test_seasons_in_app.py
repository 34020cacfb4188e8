"""A season in the app: begun, scouted, recorded, undone, come back to."""

import re
import shutil
from dataclasses import replace
from datetime import date

import numpy as np
import pytest

from app import figures
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from tests.app.app_driving import begun, go, heading, layer, metric, opened, press, texts_of


@pytest.fixture(scope="module")
def begun_file(tmp_path_factory):
    """Begin a season in the app, once; return its file."""
    folder = tmp_path_factory.mktemp("begun")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FIELDMON_SEASONS", str(folder))
        assert "has begun" in begun(opened()).success[0].value
    return folder / "Gate 2026.gpkg"


@pytest.fixture
def app(begun_file, seasons_folder):
    shutil.copy(begun_file, seasons_folder)
    return opened("Gate 2026")


@pytest.fixture
def season(seasons_folder):
    return lambda: Season(seasons_folder / "Gate 2026.gpkg")


def tap(app, key):
    app.button(key=key).click().run()
    assert not app.exception
    assert not app.error


def test_a_season_begins_and_is_found_again_by_a_new_session(season):
    app = opened()
    route = layer(app, "route")["data"]
    begun(app)
    assert layer(app, "route")["data"] == route
    assert "has begun" in app.success[0].value
    assert app.selectbox(key="season").value == "Gate 2026"
    assert season().settings.begins == date(2026, 11, 16)
    assert season().messages()
    again = opened("Gate 2026")
    assert heading(again) == "Gate · 2026-11-16"
    assert "first day of the season" in texts_of(again)
    assert layer(again, "plants")["data"] == layer(app, "plants")["data"]


def test_the_first_click_after_a_reload_stays_in_the_season(app):
    go(app, "map")
    assert app.selectbox(key="season").value == "Gate 2026"
    again = opened("Gate 2026")
    for page in ("season", "study", "today"):
        go(again, page)
    assert again.selectbox(key="season").value == "Gate 2026"
    assert "first day of the season" in texts_of(again)
    assert again.query_params["season"] == "Gate 2026"


def test_a_season_is_never_begun_over_another_and_its_name_stays_in_the_folder(app, season):
    before = season().path.read_bytes()
    for name, says in (("Gate 2026", "new file"), ("../up", "name must be"), ("", "name must be")):
        app.selectbox(key="season").set_value("Sample estate").run()
        begun(app, name)
        assert not app.exception
        assert says in app.error[0].value
    assert season().path.read_bytes() == before
    assert [p.name for p in season().path.parent.iterdir()] == ["Gate 2026.gpkg"]


@pytest.mark.parametrize("page", ["map", "season", "compare", "plot", "report", "scout"])
def test_every_page_opens_on_a_season(app, page):
    go(app, page)
    assert not app.exception
    assert not app.error


def test_each_tap_of_the_scout_is_kept_at_once_and_the_route_goes_on(app, season):
    go(app, "scout")
    route = season().kept_route(date(2026, 11, 16))
    assert len(route) > 100
    tap(app, "scout_clean")
    app.number_input(key="scout_count").set_value(7)
    tap(app, "scout_found")
    tap(app, "scout_skip")
    done = season().history.inspections
    assert done.plant[:2].tolist() == route[:2].tolist()
    assert done.result.tolist() == [0, 1, 2]
    assert (np.diff(done.second) > 0).all()
    assert app.number_input(key="scout_count").value is None


def test_a_reload_of_the_page_goes_on_where_the_scout_stood(app):
    go(app, "scout")
    for key in ("scout_clean", "scout_found"):
        tap(app, key)
    again = opened("Gate 2026")
    go(again, "scout")
    assert again.markdown[0].value == app.markdown[0].value


def test_the_scout_takes_the_last_tap_back(app, season):
    go(app, "scout")
    tap(app, "scout_clean")
    before = app.markdown[0].value
    tap(app, "scout_found")
    assert app.markdown[0].value != before
    tap(app, "scout_undo")
    assert app.markdown[0].value == before
    assert season().history.inspections.result.tolist() == [0]


def test_found_plants_and_clean_ones_show_on_the_map(app):
    go(app, "scout")
    tap(app, "scout_found")
    tap(app, "scout_clean")
    assert len(layer(app, "finds0")["data"]) == 1
    shown = [p["c"] for p in layer(app, "plants")["data"]]
    assert sum(c == [213, 30, 30, 255] for c in shown) == 1
    assert sum(c == [90, 160, 230, 255] for c in shown) == 1


def test_a_day_that_was_worked_is_played_as_it_was_worked(app, season):
    plants = np.array([900, 5, 200])
    for on, at_s in (("2026-11-16", [25_200.0, 21_660.0, 28_800.0]), ("2026-11-17", [np.nan] * 3)):
        season().record(
            Inspections.of(plants, np.zeros(3, np.int8), np.datetime64(on), second=np.array(at_s)),
            on,
        )
    noted, driven = (figures.done(season(), date(2026, 11, day)) for day in (16, 17))
    assert noted.plant.tolist() == [5, 900, 200], "in the order of the times noted"
    assert noted.leave_s.tolist() == [60.0, 3600.0, 7200.0]
    assert noted.line_m[noted.line_stop] == pytest.approx(noted.aisles.stop_m[noted.plant])
    assert driven.plant.tolist() == plants.tolist()
    gaps = np.diff(driven.leave_s, prepend=0.0)
    assert (gaps > season().settings.robot.visit_s).all()
    go(app, "map")
    app.select_slider[0].set_value("2026-11-16").run()
    path = layer(app, "route")["data"][0]["path"]
    assert np.array(path) == pytest.approx(noted.line_lonlat(), abs=1e-7)


def test_today_says_why_it_goes_where_it_goes(app):
    assert "never inspected yet" in texts_of(app)
    go(app, "scout")
    place = app.markdown[0].value.lower()
    tap(app, "scout_found")
    go(app, "today")
    why = next(m.value for m in app.markdown if "around today's find" in m.value)
    row, plant = (int(n) for n in re.findall(r"find in row (\d+), plant (\d+)", why)[0])
    assert f"row {row} · plant {plant}" in place


def test_one_plant_is_recorded_and_undone_on_the_season_page(app, season):
    go(app, "season")
    app.number_input(key="one_row").set_value(3)
    app.number_input(key="one_plant").set_value(4)
    app.segmented_control(key="one_result").set_value(1)
    next(b for b in app.button if b.label == "Record" and "one_plant" in b.proto.form_id).click()
    app.run()
    assert "1 recorded" in app.success[0].value
    (plant,) = season().history.inspections.plant
    label = season().label
    assert (label.line[plant], label.number[plant]) == (3, 4)
    assert metric(app, "Found") == "1"
    press(app, "Undo")
    assert metric(app, "Found") == "0"
    assert not len(season().history.inspections)


def test_one_hour_more_is_one_however_late_it_is(app, season):
    project, setup = season(), season().settings
    project.change(replace(setup, robot=setup.robot.with_hours(2.0)), setup)
    evening = Inspections.of(np.array([7]), np.array([0]), np.datetime64("2026-11-16"),
                         second=np.array([17 * 3600.0 + 1320.0]))  # fmt: skip
    project.record(evening, "scout mode")
    go(app, "scout")
    assert "Done for today" in texts_of(app)
    tap(app, "scout_hour")
    assert "Done for today" not in texts_of(app)
    assert season().settings.robot.hours == 12.5
    tap(app, "scout_clean")


def test_a_treatment_and_changes_of_settings_are_taken_back(app, season):
    before = metric(go(app, "season"), "Still infested")
    next(b for b in app.button if b.label == "Note the treatment").click()
    app.run()
    assert metric(app, "Still infested") != before
    assert "treatment of the plot" in texts_of(app)
    press(app, "Undo")
    assert metric(app, "Still infested") == before
    assert "undone" in texts_of(app)
    assert not [one for one in app.button if one.key == "undo_change"]
    setup = season().settings
    for hours in (7.0, 16.0):
        next(one for one in app.slider if one.key.startswith("hours ")).set_value(hours).run()
        press(app, "Use from now on")
    press(app, "Back to Adaptive · 7 h · 40 s, from 06:00")
    assert season().settings.robot.hours == 7.0
    press(app, "Back to Adaptive · 12 h · 40 s, from 06:00")
    assert season().settings == setup
    assert not [one for one in app.button if one.key == "undo_change"]


def test_more_hours_than_the_slider_had_and_odd_seconds_leave_the_page_whole(app, season):
    project, setup = season(), season().settings
    robot = replace(setup.robot, hours=17.0, look_s=12.5)
    project.change(replace(setup, robot=robot), setup)
    go(app, "today")
    assert not app.exception
    assert next(one for one in app.slider if one.key.startswith("hours ")).value == 17.0
    assert not [one for one in app.button if one.key == "change_setup"]


def test_a_file_of_findings_is_recorded_once(app, season):
    go(app, "season")
    table = b"row,number,found,count\n1,1,yes,3\n1,2,no,\n2,5,,\n"
    for says in ("2 recorded, 0 known", "0 recorded, 2 known"):
        app.file_uploader(key="findings_file").upload("found.csv", table).run()
        app.button(key="record_file").click().run()
        assert says in app.success[0].value
    assert season().history.inspections.result.tolist() == [1, 0]


@pytest.mark.parametrize("data", [b"a,b\n1,2\n", b"row,number,found\n999,1,yes\n", b"\x00\x01"])
def test_a_file_that_does_not_fit_is_a_sentence(app, season, data):
    go(app, "season")
    app.file_uploader(key="findings_file").upload("found.csv", data).run()
    app.button(key="record_file").click().run()
    assert not app.exception
    (said,) = [*app.error, *app.success]
    assert "found must" in said.value or "found.csv" in said.value or "0 recorded" in said.value
    assert not len(season().history.inspections)


def test_ten_days_in_the_app_give_the_digits_of_the_same_days_without_it(app, season, tmp_path):
    mine = season()
    twin = Season.create(tmp_path / "twin.gpkg", mine.plot, mine.observations, mine.settings)
    for day in range(16, 26):
        on = date(2026, 11, day)
        app.date_input(key="day Gate 2026").set_value(on).run()
        go(app, "season")
        app.number_input(key="stops_done").set_value(30)
        next(b for b in app.button if b.label == "Record" and "route" in b.proto.form_id).click()
        app.run()
        assert not app.exception
        record_clean(twin, on, 30)
        assert season().morning(on).tolist() == twin.morning(on).tolist()
        assert season().evening(on).tolist() == twin.evening(on).tolist()
        rest = [one.plan(on, keep=False).route.plant.tolist() for one in (season(), twin)]
        assert rest[0] == rest[1]
    go(app, "today")
    assert "30 plants inspected" in texts_of(app)
    assert "Still infested, as expected" in texts_of(app)


def record_clean(project, on, n):
    from fieldmon.infestation.inspections import Inspections

    plants = project.plan(on, keep=False).route.plant[:n]
    project.record(Inspections.of(plants, np.zeros(n, np.int8), np.datetime64(on)), "twin")


def test_other_hours_are_used_from_now_on_when_asked_for(app, season):
    hours = next(s for s in app.slider if s.label == "Working hours")
    hours.set_value(4.0).run()
    assert season().settings.robot.hours == 12.0
    press(app, "Use from now on")
    assert season().settings.robot.hours == 4.0
    assert int(metric(app, "Plants to inspect").split(" / ")[0]) < 300


def test_a_treatment_lowers_what_is_expected(app):
    go(app, "season")
    before = float(metric(app, "Still infested").split(" ")[0])
    next(b for b in app.button if b.label == "Note the treatment").click()
    app.run()
    assert not app.error
    assert float(metric(app, "Still infested").split(" ")[0]) < 0.2 * before


def test_two_windows_on_one_season_see_each_other(app):
    other = opened("Gate 2026")
    go(app, "scout")
    tap(app, "scout_found")
    go(other, "season")
    assert metric(other, "Found") == "1"


def test_a_season_that_is_gone_leaves_the_sample(app, season):
    season().path.unlink()
    app.run()
    assert not app.exception
    assert app.selectbox(key="season").value == "Sample estate"


def test_names_that_lead_out_of_the_folder_are_refused(seasons_folder):
    from app import seasons

    for name in ("..", "../x", "a/b", "a\\b", "", ".hidden", "x" * 90):
        with pytest.raises(SettingError):
            seasons.path_of(name)
    assert seasons.path_of("מטע 2026").parent == seasons_folder
