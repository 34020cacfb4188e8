"""The frame: every room and part opens, whatever is chosen."""

from app.words import texts
from tests.app.driving import PAGES, go, map_of, texts_of


def test_every_part_opens_on_the_sample(app):
    for page in PAGES:
        go(app, page)
        assert not app.exception, page
        assert not app.error, page
        assert texts_of(app), page
        assert map_of(app)["layers"], page


def test_every_part_asks_for_a_plot_where_nothing_was_brought(app):
    app.selectbox(key="season").set_value(texts.UPLOAD).run()
    for page in PAGES:
        if page == "plots":
            continue
        go(app, page)
        assert not app.exception, page
        assert "Bring a plot" in texts_of(app), page
        assert app.file_uploader(key="plot_file"), page
        assert app.get("bidi_component") == [], page


def test_every_part_opens_on_a_season(season_app):
    for page in PAGES:
        go(season_app, page)
        assert not season_app.exception, page
        assert not season_app.error, page
