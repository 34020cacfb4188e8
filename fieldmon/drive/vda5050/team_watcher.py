"""Who listens to several robots at once, by one clock."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from fieldmon.drive.vda5050.watcher import RobotWatcher, RowsOfPlants

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fieldmon.drive.vda5050.mqtt import Inbox
    from fieldmon.plot.grid import PlantGrid


class TeamWatcher:
    """Follows the days of several robots on one plot; sends nothing.

    Seconds are those since the first of them was heard, whatever their own clocks say.

    Parameters
    ----------
    inboxes
        By serial number; others may come while it listens.
    grid
        The plants.
    """

    def __init__(self, inboxes: Mapping[str, Inbox], grid: PlantGrid) -> None:
        self._inboxes, self._grid = inboxes, grid
        self._rows = RowsOfPlants(grid)
        self._begun_s: float | None = None
        #: who listens to each robot, by its serial number
        self.robots: dict[str, RobotWatcher] = {}

    def __repr__(self) -> str:
        """Say whom it listens to."""
        return f"<TeamWatcher to {', '.join(self.robots)}>"

    def take(self) -> None:
        """Take in what was heard since."""
        for serial, inbox in [*self._inboxes.items()]:
            if serial not in self.robots:
                self.robots[serial] = RobotWatcher(inbox, self._grid, self._now_s, self._rows)
            self.robots[serial].take()

    def _now_s(self) -> float:
        now_s = time.monotonic()
        if self._begun_s is None:
            self._begun_s = now_s
        return now_s - self._begun_s
