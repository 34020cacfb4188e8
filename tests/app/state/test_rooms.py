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


@pytest.mark.usefixtures("session")
def test_the_first_part_is_shown_until_another_is_opened(session):
    assert rooms.part_of("today") == "today"
    rooms.open_part("scout")
    assert rooms.part_of("today") == "scout"
    assert rooms.part_of("season") == "season"
    session[rooms.key("today")] = "report"
    assert rooms.part_of("today") == "today", "the report is in another room"


def test_a_part_that_was_opened_is_kept_when_its_box_is_not_shown(session):
    rooms.open_part("record")
    assert rooms.part_of("today") == "record"
    widget_memory.first(rooms.key("today"), "record")
    del session[rooms.key("today")]
    assert rooms.part_of("today") == "record"


@pytest.mark.usefixtures("session")
def test_a_room_is_turned_to_once():
    assert rooms.turned_to() is None
    rooms.turn_to("plot")
    assert rooms.turned_to() == "plot"
    assert rooms.turned_to() is None
