"""The frame: every room and part opens, whatever is chosen."""

import pytest

from app.words import texts
from tests.app.driving import PAGES, go, map_of, texts_of


@pytest.mark.parametrize("page", PAGES)
def test_every_part_opens_on_the_sample(app, page):
    go(app, page)
    assert not app.exception
    assert not app.error
    assert texts_of(app)
    assert map_of(app)["layers"]


@pytest.mark.parametrize("page", [page for page in PAGES if page != "plots"])
def test_every_part_asks_for_a_plot_where_nothing_was_brought(app, page):
    go(app, page)
    app.selectbox(key="season").set_value(texts.UPLOAD).run()
    assert not app.exception
    assert "Bring a plot" in texts_of(app)
    assert app.file_uploader(key="plot_file")
    assert app.get("bidi_component") == []


@pytest.mark.parametrize("page", PAGES)
def test_every_part_opens_on_a_season(season_app, page):
    go(season_app, page)
    assert not season_app.exception
    assert not season_app.error
