"""How much room a map has on the device that shows it."""

from __future__ import annotations

from ..state import browser
from .maps import deck

# beside a map there may be something else
_BESIDE = {"field_map": deck.MOST_PX, "plot_map": deck.HALF_PX, "season_map": deck.HALF_PX}


def room_px(name: str = "") -> tuple[int, int]:
    """Return the room that a map has, width and height, by the map's name."""
    if browser.is_phone():
        return deck.PHONE_PX
    return _BESIDE.get(name, deck.PAGE_PX)


def height_px() -> int:
    """Return the height of a map: half a phone's screen, more on a laptop."""
    return 400 if browser.is_phone() else 520
