"""Rooms and their parts: each part is in one room, has a page, and words."""

import pytest

from app.state import rooms, widget_memory
from app.words import texts
from tests.paths import ROOT

PARTS = [part for room in rooms.ROOMS.values() for part in room.parts]


def test_every_part_is_in_one_room_and_has_a_page_and_words():
    assert len(PARTS) == len(set(PARTS))
    for part in PARTS:
        assert (ROOT / "app" / "views" / f"{part}.py").is_file()
        assert part in rooms.ROOMS[rooms.room_of(part)].parts
    assert set(texts.ROOMS) == set(rooms.ROOMS)
    several = {part for room in rooms.ROOMS.values() if len(room.parts) > 1 for part in room.parts}
    assert set(texts.PARTS) >= several


def test_a_part_that_is_opened_is_shown_in_its_room(session):
    rooms.open_part("scout")
    assert session[rooms.key("today")] == "scout"
    assert rooms.key("season") not in session


def test_a_part_that_was_opened_is_kept_when_its_box_is_not_shown(session):
    rooms.open_part("record")
    widget_memory.first(rooms.key("today"), "today")
    assert widget_memory.value(rooms.key("today")) == "record"
    del session[rooms.key("today")]
    assert widget_memory.value(rooms.key("today")) == "record"


@pytest.mark.usefixtures("session")
def test_a_room_is_turned_to_once():
    assert rooms.turned_to() is None
    rooms.turn_to("plot")
    assert rooms.turned_to() == "plot"
    assert rooms.turned_to() is None


def test_which_part_is_shown_is_known_before_its_box_is(session):
    assert rooms.shown_part("today") == "today"
    rooms.open_part("decide")
    assert rooms.shown_part("today") == "decide"
    session[rooms.key("season")] = None
    assert rooms.shown_part("season") == "season"
