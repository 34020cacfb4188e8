"""Items of the menu and their pages: each is in one item, has a module, and words."""

import pytest

from app.state import menu, widget_memory
from app.words import texts
from tests.paths import ROOT

PAGES = [page for item in menu.MENU.values() for page in item.pages]


def test_every_page_is_in_one_item_and_has_a_module_and_words():
    assert len(PAGES) == len(set(PAGES))
    for page in PAGES:
        assert (ROOT / "app" / "views" / f"{page}.py").is_file()
        assert page in menu.MENU[menu.item_of(page)].pages
    assert set(texts.MENU) == set(menu.MENU)
    several = {page for item in menu.MENU.values() if len(item.pages) > 1 for page in item.pages}
    assert set(texts.PAGES) >= several


def test_a_page_that_is_opened_is_shown_in_its_item(session):
    menu.open_page("scout")
    assert session[menu.key("today")] == "scout"
    assert menu.key("season") not in session


def test_a_page_that_was_opened_is_kept_when_its_box_is_not_shown(session):
    menu.open_page("record")
    widget_memory.first(menu.key("today"), "today")
    assert widget_memory.value(menu.key("today")) == "record"
    del session[menu.key("today")]
    assert widget_memory.value(menu.key("today")) == "record"


@pytest.mark.usefixtures("session")
def test_an_item_is_turned_to_once():
    assert menu.turned_to() is None
    menu.turn_to("plot")
    assert menu.turned_to() == "plot"
    assert menu.turned_to() is None


def test_which_page_is_shown_is_known_before_its_box_is(session):
    assert menu.shown_page("today") == "today"
    menu.open_page("decide")
    assert menu.shown_page("today") == "decide"
    session[menu.key("season")] = None
    assert menu.shown_page("season") == "season"
