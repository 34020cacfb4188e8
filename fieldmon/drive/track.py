"""The way that a robot really took, noted as it drives."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]

_LEAST_S, _FIX_S = 0.1, 1.0


class Track:
    """Places in time, ten a second at most, and what a receiver of positions said, once a second.

    Parameters
    ----------
    far_m
        What is so far from the place before is noted however soon it comes, as of a robot that is
        faster than the clock.

    Examples
    --------
    >>> from fieldmon.drive.track import Track
    >>> track = Track()
    >>> for k in range(4):
    ...     track.add(0.05 * k, 0.1 * k, 0.0, 0.0)
    >>> track.poses[:, 0].round(2).tolist()
    [0.0, 0.1, 0.15]
    """

    def __init__(self, far_m: float = math.inf) -> None:
        self._far_m = far_m
        self._rows: list[tuple[float, float, float, float]] = []
        self._last: tuple[float, float, float, float] | None = None
        #: seconds and metres, where a receiver said another place than the true one
        self.fixes: list[tuple[float, float, float]] = []
        #: standard deviation of such a place, to each side; None: not known
        self.fix_m: float | None = None
        #: how far the places may be off, to each side
        self.off_m = 1e-3

    def __repr__(self) -> str:
        """Say how many places there are."""
        return f"<Track of {len(self._rows)} places>"

    def add(self, at_s: float, x_m: float, y_m: float, yaw: float) -> None:
        """Note where the robot is, seconds since the day began."""
        row = (at_s, x_m, y_m, yaw)
        is_due = not self._rows or at_s >= self._rows[-1][0] + _LEAST_S - 1e-9
        if is_due or math.dist(self._rows[-1][1:3], (x_m, y_m)) > self._far_m:
            self._rows.append(row)
            self._last = None
        else:
            self._last = row

    def fix(self, at_s: float, x_m: float, y_m: float) -> None:
        """Note where a receiver said that the robot is."""
        if not self.fixes or at_s >= self.fixes[-1][0] + _FIX_S - 1e-9:
            self.fixes.append((at_s, x_m, y_m))

    @property
    def last_s(self) -> float:
        """When the robot was last seen, seconds since the day began; -inf before it was."""
        last = self._last or (self._rows[-1] if self._rows else None)
        return -np.inf if last is None else last[0]

    @property
    def poses(self) -> Float:
        """Seconds, x, y and heading, ``(k, 4)``; the last one is always there."""
        rows = self._rows + ([] if self._last is None else [self._last])
        return np.array(rows, float).reshape(-1, 4)
