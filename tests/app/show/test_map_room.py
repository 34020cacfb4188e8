"""A phone has a phone's room for a map, whatever the map; beside other things there is less."""

import pytest

from app.show import map_room
from app.show.maps import deck
from app.state import browser


@pytest.mark.parametrize(
    ("name", "room"),
    [("map", deck.PAGE_PX), ("field_map", deck.MOST_PX), ("plot_map", deck.HALF_PX)],
)
def test_the_room_is_that_of_the_device(monkeypatch, name, room):
    monkeypatch.setattr(browser, "is_phone", lambda: False)
    assert map_room.room_px(name) == room
    assert map_room.height_px() > room[1]
    monkeypatch.setattr(browser, "is_phone", lambda: True)
    assert map_room.room_px(name) == deck.PHONE_PX
    assert map_room.height_px() > deck.PHONE_PX[1]
