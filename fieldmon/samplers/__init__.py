"""The samplers: who decides which plants come next.

A new sampler is one file and one line in `SAMPLERS`; the promises test finds it by itself.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError
from fieldmon.plot.travel import GATE
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Sampler, Scene, Stops
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.sweeps import Bouncy, Naive
from fieldmon.samplers.without_prior import (
    Neighbor,
    NeighborRandom,
    RandomShare,
    Snake,
    SnakeRandom,
)

if TYPE_CHECKING:
    from collections.abc import Callable

SAMPLERS: dict[str, Callable[..., Sampler]] = {
    "naive": Naive,
    "bouncy": Bouncy,
    "dynamic": Dynamic,
    "adaptive": Adaptive,
    "adaptive-looks": partial(Adaptive, chooses_look=True),
    "snake": Snake,
    "snake-random": SnakeRandom,
    "neighbor": Neighbor,
    "neighbor-random": NeighborRandom,
    "random": RandomShare,
}
# those that take a setting ``every``
EVERY = frozenset({"bouncy", "snake", "neighbor", "random"})

__all__ = [
    "EVERY",
    "GATE",
    "NEVER",
    "SAMPLERS",
    "Adaptive",
    "Bouncy",
    "Dynamic",
    "Naive",
    "Neighbor",
    "NeighborRandom",
    "RandomShare",
    "Sampler",
    "Scene",
    "Snake",
    "SnakeRandom",
    "Stops",
    "sampler",
]


def sampler(name: str, **settings: float) -> Sampler:
    """Return the sampler called `name`; raise `SettingError` if there is none."""
    if name not in SAMPLERS:
        raise SettingError(f"A sampler must be one of {', '.join(SAMPLERS)}, but it is {name!r}.")
    return SAMPLERS[name](**settings)
