"""What is believed on the mornings of a simulated season, worked out only if somebody asks."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief, Learning
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.planning.workday import Workday


class MorningBeliefs:
    """What is believed on every morning of a season, worked out when somebody asks.

    Most of a season's time goes into it, and half of the samplers do not read it.
    """

    def __init__(
        self,
        first: Callable[[], Belief],
        learning: Callable[[Workday], Learning],
        spread: Callable[[int], Spread],
    ) -> None:
        self._first, self.learning, self._spread = first, learning, spread
        self._works: list[Workday] = []
        self._left: dict[int, NDArray[np.float64]] = {}
        self._last: tuple[int, Belief] | None = None

    @property
    def known(self) -> int:
        """Return the number of the first day whose work it has not heard of."""
        return len(self._works)

    def add(self, work: Workday, left: NDArray[np.float64] | None = None) -> None:
        """Hear of the next day's work, and which share of each chance outlived its treatment."""
        if left is not None:
            self._left[self.known] = left
        self._works.append(work)

    def evening(self, number: int, work: Workday) -> Belief:
        """Return what is believed after a day's work, before any treatment."""
        return self.on(number).learn(work.plant, work.found, self.learning(work))

    def on(self, number: int) -> Belief:
        """Return the belief of a morning, from the last one asked for if that was before."""
        day, belief = self._last or (0, self._first())
        if day > number:
            day, belief = 0, self._first()
        for passed, work in enumerate(self._works[day:number], day):
            evening = belief.learn(work.plant, work.found, self.learning(work))
            if passed in self._left:
                evening = evening.treated(self._left[passed])
            belief = evening.overnight(self._spread(passed))
        self._last = number, belief
        return belief
