"""A robot without physics: every way takes what is charged for it, as in the season simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.drive.errand import Visit

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.drive.errand import Errand, Float
    from fieldmon.monitoring.estimates.asked_day import PlantToInspect
    from fieldmon.plot.travel import Aisles


class ChargedRobot:
    """Takes the seconds that are charged, to the digit.

    Parameters
    ----------
    look
        Told a plant to inspect; says whether it is found infested.
    """

    def __init__(self, look: Callable[[PlantToInspect], bool]) -> None:
        self._look = look

    def begin(self, aisles: Aisles, at_m: Float, gone_s: float) -> None:
        """Stand anywhere."""

    def visit(self, errand: Errand) -> Visit:
        """Look at the plant at once."""
        return Visit(self._look(errand.stop))

    def home(self, line_m: Float) -> Visit | None:  # noqa: ARG002 - as charged
        """Be there."""
        return None
