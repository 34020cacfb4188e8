"""What a team knows as its day goes: stops that all have heard of, and what is believed then."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.planning.team_worker import ROUNDING_S

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.tracing.tracing import Traces
    from fieldmon.planning.team_worker import TeamWorker

    #: what is believed after inspections: plants, whether each was a find, and its detection
    Learn = Callable[[NDArray[np.int32], NDArray[np.bool_], NDArray[np.float64]], Belief]
    #: chances of plants and of pairs, and how far insects jump
    Believed = tuple[NDArray[np.float64], NDArray[np.float64] | None, Traces | None]


class StopTold(NamedTuple):
    """A stop that all know of: when it was left, by whom, and what was found."""

    leave_s: float
    k: int
    plant: int
    found: bool
    detects: float


class TeamNews:
    """What all of a team know.

    Parameters
    ----------
    workers
        The team.
    learn
        What is believed after inspections; None: nobody hears of anything.
    """

    def __init__(self, workers: Sequence[TeamWorker], learn: Learn | None) -> None:
        first = workers[0].scene
        self._workers, self._learn = workers, learn
        self._taken: NDArray[np.bool_] = first.last_inspected == first.day
        self.known: list[StopTold] = []
        self.believed: Believed = first.chance, first.pair_chance, first.traces

    @property
    def heard(self) -> bool:
        """Whether finds are heard of at all."""
        return self._learn is not None

    def hear(self, now_s: float) -> list[StopTold]:
        """Tell all what was found so far; return what is new, in order of the clock."""
        news = sorted(told for each in self._workers for told in self._untold(each, now_s))
        for told in news:
            self._workers[told.k].told += 1
        self.known += news
        self.believed = self._after(self.known)
        return news

    def believed_by(self, worker: TeamWorker, now_s: float) -> Believed:
        """Return what one believes who knows its own stops as well."""
        own = self._untold(worker, now_s) if self.heard else []
        return self._after(sorted([*self.known, *own])) if own else self.believed

    def taken(self, now_s: float) -> NDArray[np.bool_]:
        """Return ``(n,)`` the plants inspected today, and those that somebody drives to.

        Stops that others are yet to make in their aisles hang on what they will find.
        """
        for worker in self._workers:
            n = worker.under_way(now_s)
            self._taken[[stop.plant for stop in worker.done[worker.begun : n]]] = True
            worker.begun = max(worker.begun, n)
        return self._taken

    def _untold(self, worker: TeamWorker, now_s: float) -> list[StopTold]:
        """Return the stops that a worker has made and not told of."""
        return [
            StopTold(stop.leave_s, worker.k, stop.plant, stop.found, stop.detects)
            for stop in worker.done[worker.told :]
            if stop.leave_s <= now_s + ROUNDING_S
        ]

    def _after(self, told: list[StopTold]) -> Believed:
        """Return what is believed after some stops, in order of the clock."""
        assert self._learn is not None  # noqa: S101 - asked before
        _, _, plants, found, detects = (np.array(column) for column in zip(*told, strict=True))
        belief = self._learn(plants.astype(np.int32), found, detects)
        return belief.chance, belief.pair_chance, belief.traces
