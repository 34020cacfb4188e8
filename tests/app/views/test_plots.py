"""All plots: on the map and in a table, to be opened; and the ways to begin."""

from app.words import texts
from tests.app.driving import broken, go, map_of, texts_of


def test_the_sample_s_plots_are_on_the_map_and_in_the_table(app):
    go(app, "plots")
    assert not app.exception
    named = {one["t"] for one in map_of(app)["labels"]}
    (table,) = (frame.value for frame in app.dataframe)
    assert set(table[texts.PLOTS_COLUMNS["name"]]) == named
    assert len(named) > 1
    assert map_of(app)["taps"]


def test_a_season_is_among_the_plots_with_its_state(season_app):
    go(season_app, "plots")
    assert not season_app.exception
    (table,) = (frame.value for frame in season_app.dataframe)
    assert table[texts.PLOTS_COLUMNS["name"]].tolist() == ["Gate 2026"]
    assert table[texts.PLOTS_COLUMNS["expected"]].iloc[0] > 0


def test_a_season_that_cannot_be_opened_is_said(app, seasons_folder):
    broken(seasons_folder / "Broken.gpkg")
    go(app, "plots")
    assert not app.exception
    assert "Broken" in texts_of(app)


def test_ways_to_begin_lead_to_the_sample_and_to_own_files(app):
    for way, says in (("way_file", "Bring a plot"), ("way_sample", "Inspect ")):
        go(app, "plots")
        app.button(key=way).click().run()
        assert not app.exception
        assert says in texts_of(app)
