"""Three ways in: they show until one is taken, and each leads where it says."""

import shutil

from app.state import menu
from app.words import texts
from tests.app.driving import go, heading, opened, texts_of


def ways(app):
    return [button.key for button in app.button if button.key.startswith("way_")]


def test_they_show_at_first_and_not_once_one_is_taken(app):
    assert ways(app) == ["way_sample", "way_file", "way_season"]
    app.button(key="way_sample").click().run()
    assert not app.exception
    assert ways(app) == []
    assert "Gate" in heading(app)


def test_each_way_leads_to_the_days_plan_whatever_was_shown_before(app):
    go(app, "record")
    go(app, "plots")
    app.button(key="way_sample").click().run()
    assert not app.exception
    assert app.session_state[menu.key("today")] == "today"
    assert texts.STEP_BUTTONS["send"] in [button.label for button in app.button]


def test_an_own_plot_begins_with_its_file(app):
    app.button(key="way_file").click().run()
    assert app.file_uploader(key="plot_file")
    assert "Bring a plot" in texts_of(app)


def test_without_a_season_it_is_said_where_they_lie(app, seasons_folder):
    app.button(key="way_season").click().run()
    assert not app.exception
    assert texts.NO_SEASONS.format(folder=seasons_folder) in texts_of(app)


def test_the_one_season_is_opened_and_several_are_shown(begun_file, seasons_folder):
    shutil.copy(begun_file, seasons_folder)
    app = opened()
    app.button(key="way_season").click().run()
    assert app.selectbox(key="season").value == "Gate 2026"
    shutil.copy(begun_file, seasons_folder / "Other.gpkg")
    app = opened()
    app.button(key="way_season").click().run()
    assert not app.exception
    go(app, "plots")
    (table,) = (frame.value for frame in app.dataframe)
    assert sorted(table[texts.PLOTS_COLUMNS["name"]]) == ["Gate 2026", "Other"]
