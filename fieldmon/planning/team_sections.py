"""Who of a team has which aisle as its day goes: given out anew where that gains enough."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.planning.sections import (
    aisle_heights,
    aisle_worth,
    best_sections,
    even_sections,
    worth_together,
)
from fieldmon.planning.team_worker import ROUNDING_S

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.planning.members import Teamwork
    from fieldmon.planning.sections import AisleWorth
    from fieldmon.planning.team_news import TeamNews
    from fieldmon.planning.team_worker import TeamWorker


class TeamSections:
    """Who has each aisle.

    Parameters
    ----------
    workers
        The team.
    teamwork
        How much a change must gain.
    news
        What all know.
    by_worth
        Whether aisles are given out by what they hold; or evenly, by hours.
    """

    def __init__(
        self, workers: Sequence[TeamWorker], teamwork: Teamwork, news: TeamNews, *, by_worth: bool
    ) -> None:
        self._workers, self._teamwork, self._news = workers, teamwork, news
        self._by_worth = by_worth
        self._grid = workers[0].scene.grid
        self._heights = aisle_heights(self._grid)
        self._valued: tuple[tuple[float, int], AisleWorth] | None = None
        #: ``(a,)`` who has each aisle
        self.owner: NDArray[np.int64] = np.empty(0, np.int64)

    def begin(self, before: NDArray[np.int64] | None) -> None:
        """Give out the aisles; what is given out stays so, if no other way gains enough.

        Parameters
        ----------
        before
            ``(a,)`` who has each aisle so far today, -1: nobody; None: nobody has any.
        """
        if self._by_worth:
            best = self._proposed(-np.inf)
        else:
            shares = np.array([worker.scene.robot.day_s for worker in self._workers])
            best = self._with_claims(even_sections(self._grid, shares))
        self.owner = best
        if before is None:
            return
        kept = self._with_claims(np.where(before >= 0, before, best))
        if not self._by_worth or self._gain(best, kept, -np.inf) < self._teamwork.least_gain:
            self.owner = kept

    def share_anew(self, now_s: float) -> list[int]:
        """Give the aisles out anew if that gains enough; return whose aisles are others now."""
        if not self._news.heard:
            return []
        owner = self._proposed(now_s)
        if self._gain(owner, self.owner, now_s) < max(self._teamwork.least_gain, ROUNDING_S):
            return []
        other = owner != self.owner
        changed = {*owner[other].tolist(), *self.owner[other].tolist()}
        self.owner = owner
        return sorted(changed)

    def _proposed(self, now_s: float) -> NDArray[np.int64]:
        """Return the best sections for the seconds left."""
        up = np.argsort(self._stands(), kind="stable")
        worth, left_s = self._worth(now_s), self._left_s(now_s)
        return self._with_claims(best_sections(worth, self._heights, left_s, up))

    def _gain(self, owner: NDArray[np.int64], other: NDArray[np.int64], now_s: float) -> float:
        """Return how many more finds are expected with some sections than with others."""
        worth, left_s, stands = self._worth(now_s), self._left_s(now_s), self._stands()
        held, less = (
            worth_together(worth, one, left_s - self._way_s(one, stands)) for one in (owner, other)
        )
        return held - less

    def _worth(self, now_s: float) -> AisleWorth:
        """Return what aisles hold now; worked out once for a moment."""
        key = now_s, len(self._news.known)
        if self._valued is None or self._valued[0] != key:
            robots = [worker.scene.robot for worker in self._workers]
            chance = np.where(self._news.taken(now_s), 0.0, self._news.believed[0])
            self._valued = key, aisle_worth(self._workers[0].scene.aisles, robots, chance)
        return self._valued[1]

    def _left_s(self, now_s: float) -> NDArray[np.float64]:
        """Return the seconds that each has left after what it has begun, ``(m,)``."""
        return np.array([worker.left_s(now_s) for worker in self._workers])

    def _stands(self) -> NDArray[np.float64]:
        """Return where across the plot each is, ``(m,)`` metres; at the gate below all."""
        lane_m, row = self._grid.lane_y_m, self._grid.row
        return np.array([lane_m[row[w.at]] if w.at >= 0 else -np.inf for w in self._workers])

    def _way_s(self, owner: NDArray[np.int64], stands: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return about how long each takes to the nearest of its aisles, ``(m,)``."""
        way_s = np.zeros(len(self._workers))
        for k, worker in enumerate(self._workers):
            own = self._heights[owner == k]
            if len(own) and np.isfinite(stands[k]):
                way_s[k] = np.abs(own - stands[k]).min() / worker.scene.robot.speed_m_s
        return way_s

    def _with_claims(self, owner: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return sections in which each keeps the aisle that it is in, or about to enter."""
        for worker in self._workers:
            if worker.claims >= 0:
                owner[worker.claims] = worker.k
        return owner
