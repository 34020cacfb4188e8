"""One robot's ways between aisles, on a plot that it shares with others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.plot.passing import legs_of
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from fieldmon.drive.aisle_keeper import AisleKeeper
    from fieldmon.drive.errand import Float
    from fieldmon.plot.travel import Aisles

_HERE_M = 1e-3


class Crossing:
    """Asks for the aisles that a robot needs, and gives back those that it has left.

    Parameters
    ----------
    keeper
        Who may be in which aisle.
    name
        Of the robot.
    aisles
        The ways that it can drive.
    at_m
        ``(2,)`` where it stands, metres of the plot's frame: at a plant's stop, or the gate.
    """

    def __init__(self, keeper: AisleKeeper, name: str, aisles: Aisles, at_m: Float) -> None:
        self._keeper, self._name, self._aisles = keeper, name, aisles
        self._aisle = aisles.grid.corridor[aisles.grid.row]
        self._stretch = aisles.grid.stretches[aisles.grid.row]
        away_m = np.hypot(*(aisles.stop_m - at_m).T)
        here = int(np.argmin(away_m))
        self._at = here if away_m[here] < _HERE_M else GATE
        keeper.enter(name, self._own(self._at))

    def __repr__(self) -> str:
        """Say whose ways they are."""
        return f"<Crossing of {self._name}>"

    def enter(self, plant: int) -> bool:
        """Take all aisles on the way to a plant (-1: the gate), or none; return whether."""
        return self._keeper.enter(self._name, self._needed(plant))

    def blocked(self, plant: int) -> bool:
        """Tell whether the way to a plant is blocked for the rest of the day."""
        return self._keeper.blocked(self._name, self._needed(plant))

    def parted(self, line_m: Float, plant: int) -> tuple[Float, Float]:
        """Return a way to a plant up to the end of the own aisle, and from there on."""
        if self._at == GATE:
            return line_m[:1], line_m
        steps_m = np.hypot(*np.diff(line_m, axis=0).T)
        gone_m = np.append(0.0, np.cumsum(steps_m))
        out_m = min(legs_of(self._aisles).leg(self._at, plant).out_m, float(gone_m[-1]))
        there = np.array([[np.interp(out_m, gone_m, line_m[:, axis]) for axis in (0, 1)]])
        before, after = line_m[gone_m < out_m - _HERE_M], line_m[gone_m > out_m + _HERE_M]
        if not len(before):
            return line_m[:1], line_m
        return np.concatenate([before, there]), np.concatenate([there, after])

    def left(self) -> None:
        """Give back the own aisle: the robot stands at its end."""
        self._keeper.keep_only(self._name, ())

    def arrived(self, plant: int) -> None:
        """Give back all aisles but the one that the robot is in now."""
        self._at = plant
        self._keeper.keep_only(self._name, self._own(plant))

    def _own(self, plant: int) -> list[int]:
        return [] if plant == GATE else [int(self._aisle[plant])]

    def _needed(self, plant: int) -> list[int]:
        if GATE not in {plant, self._at} and self._stretch[plant] == self._stretch[self._at]:
            return self._own(plant)
        if plant == self._at == GATE:
            return []
        return [*legs_of(self._aisles).leg(self._at, plant).through, *self._own(plant)]
