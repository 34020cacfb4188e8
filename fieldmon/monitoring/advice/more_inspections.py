"""After how many looks more a verdict can come, at the earliest."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.decisions.map_verdict import verdict_of
from fieldmon.decisions.sequential import LEAVE, TREAT
from fieldmon.infestation.belief import Learning
from fieldmon.samplers.decide import Decide

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.decisions.sequential import Verdict
    from fieldmon.infestation.belief import Belief
    from fieldmon.monitoring.settings.advice_settings import AdviceSettings
    from fieldmon.samplers.base import Scene

# nobody looks at more plants than this for a verdict
_MOST_LOOKS = 1000
_LONG_DAY_S = 1e7


@dataclass(frozen=True)
class MoreInspections:
    """After how many looks more a verdict can come, at the earliest.

    Parameters
    ----------
    if_clean
        Looks after which it need not be treated if all of them are clean; None: too many.
    if_found
        Looks after which it must be treated if all of them find something; None: too many.
    """

    if_clean: int | None
    if_found: int | None


def inspections_to_verdict(
    evening: Belief, scene: Scene, asked: AdviceSettings, found: NDArray[np.bool_] | None = None
) -> MoreInspections:
    """Return after how many looks, driven as Decide drives, a verdict can come at the earliest."""
    n = len(scene.chance)
    known = np.zeros(n, np.bool_) if found is None else found
    day = replace(scene, seconds_left=min(_LONG_DAY_S, 1e4 * n))
    order = Decide().walk(day, np.zeros(n, np.bool_)).plant[:_MOST_LOOKS]
    learning = Learning(scene.robot.detects, treated=False)

    def verdict(looks: int, *, all_found: bool) -> Verdict:
        after = evening.learn(order[:looks], np.full(looks, all_found), learning)
        now = known.copy()
        now[order[:looks]] |= all_found
        return verdict_of(scene.grid, after, asked.level, asked.sure, now).verdict

    return MoreInspections(
        _first(lambda looks: verdict(looks, all_found=False) == LEAVE, len(order)),
        _first(lambda looks: verdict(looks, all_found=True) == TREAT, len(order)),
    )


def _first(clear: Callable[[int], bool], most: int) -> int | None:
    """Return the fewest looks at which it is clear, by doubling and halving; None: not within."""
    clear = cache(clear)
    high = 1
    while high < most and not clear(high):
        high *= 2
    high = min(high, most)
    if most == 0 or not clear(high):
        return None
    low = high // 2
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if clear(middle) else (middle, high)
    return high
