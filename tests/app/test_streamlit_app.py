"""The frame: every page opens, whatever is chosen."""

import pytest

from tests.app.driving import PAGES, go, texts_of


@pytest.mark.parametrize("page", PAGES)
def test_every_page_opens_on_the_sample_and_before_anything_was_brought(app, page):
    go(app, page)
    assert not app.exception
    assert not app.error
    assert texts_of(app)
    app.selectbox(key="season").set_value("My own files").run()
    assert not app.exception
    assert "Bring a plot" in texts_of(app)


@pytest.mark.parametrize("page", ["map", "season", "compare", "plot", "report", "scout"])
def test_every_page_opens_on_a_season(season_app, page):
    go(season_app, page)
    assert not season_app.exception
    assert not season_app.error
