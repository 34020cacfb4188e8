"""An item of the menu in the panel: its pages side by side, the chosen one below."""

import pytest
from streamlit.util import calc_hash

from app.state import menu
from app.words import texts
from tests.app.driving import go, opened, texts_of

SEVERAL = [name for name, item in menu.MENU.items() if len(item.pages) > 1]


@pytest.mark.parametrize("name", SEVERAL)
def test_an_item_shows_its_first_page_first_and_another_by_a_click(season_app, name):
    first, second = menu.MENU[name].pages[:2]
    go(season_app, first)
    box = season_app.segmented_control(key=menu.key(name))
    assert box.value == first
    assert [texts.PAGES[page] for page in menu.MENU[name].pages] == box.options
    before = texts_of(season_app)
    box.set_value(second).run()
    assert not season_app.exception
    assert season_app.segmented_control(key=menu.key(name)).value == second
    assert texts_of(season_app) != before


def test_the_page_that_was_shown_is_shown_again_after_another_item(app):
    assert not app.exception  # it has begun, on Today
    go(app, "field")
    go(app, "today")
    app.segmented_control(key=menu.key("today")).set_value("scout").run()
    go_to_item(app, "season")
    assert app.segmented_control(key=menu.key("season")).value == "field"
    go_to_item(app, "today")
    assert app.segmented_control(key=menu.key("today")).value == "scout"


def test_a_reload_leads_back_to_the_page_and_so_does_going_back(season_app):
    box = lambda app: app.segmented_control(key=menu.key("today"))  # noqa: E731
    box(season_app).set_value("record").run()
    assert season_app.query_params[menu.KEY] in ("record", ["record"])
    assert box(opened("Gate 2026", part="record")).value == "record"
    box(season_app).set_value("decide").run()
    # as a browser that goes back: the address is an earlier one
    season_app.query_params[menu.KEY] = "record"
    assert box(season_app.run()).value == "record"
    # a click just now comes before an address that is behind
    season_app.query_params[menu.KEY] = "scout"
    assert box(box(season_app).set_value("today").run()).value == "today"
    assert menu.KEY not in season_app.query_params


def go_to_item(app, name):
    """Turn to an item as its link does, which says nothing of pages."""
    app._page_hash = calc_hash("" if name == "today" else name)
    app.run()


def test_a_box_that_two_parts_have_keeps_what_was_chosen(season_app):
    go(season_app, "compare")
    season_app.number_input(key="n_days").set_value(7).run()
    box = season_app.segmented_control(key=menu.key("ahead"))
    box.set_value("simulate").run()
    assert season_app.number_input(key="n_days").value == 7
    season_app.number_input(key="n_days").set_value(9).run()
    season_app.segmented_control(key=menu.key("ahead")).set_value("compare").run()
    assert season_app.number_input(key="n_days").value == 9
