"""Boxes of lengths, and of what an area costs: in the chosen unit, whenever that changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import widget_memory
from .chosen_units import units
from .row_settings import BLOCK_LENGTHS, LENGTHS

if TYPE_CHECKING:
    from ..words.units import UnitsInLanguage

#: what is asked of a decision: boxes of lengths, and of what an area costs or is given
DECIDE_LENGTHS, DECIDE_BY_AREA = ("decide on", "decide off"), ("decide rate", "decide per_ha")
_LENGTHS = (*LENGTHS, *BLOCK_LENGTHS, "robot_width", "robot_turns", "team_passing",
            *DECIDE_LENGTHS)  # fmt: skip


def carry_over(before: UnitsInLanguage) -> None:
    """Carry what boxes hold over into the units that are now chosen (for callbacks)."""
    now = units()
    if now.length != before.length:
        widget_memory.change(_LENGTHS, lambda shown: now.shown(before.in_metres(shown)))
    if now.area != before.area:
        widget_memory.change(DECIDE_BY_AREA, lambda shown: now.by_area(before.by_hectare(shown)))
