"""What is drawn in which colour, and the classes of what is believed and known of plants."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Colour = tuple[int, int, int]
# pale to dark, told apart without hue too
CHANCE_FROM = (0.0, 0.01, 0.02, 0.05, 0.10, 0.25, 0.50)
CHANCE_COLOURS: tuple[Colour, ...] = (
    *((255, 250, 220), (254, 227, 145), (254, 178, 76), (240, 120, 40), (210, 55, 30)),
    *((150, 10, 40), (70, 0, 30)),
)
# on a dark page it is the other way round: the more likely, the brighter
CHANCE_IN_DARK: tuple[Colour, ...] = (
    *((64, 54, 64), (98, 58, 78), (146, 62, 78), (196, 78, 64), (236, 122, 48)),
    *((252, 182, 70), (255, 244, 170)),
)
FOUND: Colour = (213, 30, 30)
CLEAN: Colour = (90, 160, 230)
NEVER: Colour = (150, 150, 145)
TRUTH: Colour = (0, 0, 0)
TRUTH_IN_DARK: Colour = (255, 255, 255)
ROUTE: Colour = (20, 80, 200)
ROUTE_IN_DARK: Colour = (110, 220, 255)
GATE: Colour = (0, 140, 90)
HOT: Colour = (140, 40, 180)
HOT_IN_DARK: Colour = (205, 130, 255)
OUTLINE: Colour = (70, 80, 70)
OUTLINE_IN_DARK: Colour = (190, 200, 190)
# days since a plant was inspected: fresh is pale green, long ago is dark
AGE_FROM = (0, 1, 3, 7, 14)
AGE_COLOURS: tuple[Colour, ...] = (
    (217, 240, 163), (120, 198, 121), (49, 163, 84), (0, 104, 55), (0, 50, 30),
)  # fmt: skip
AGE_IN_DARK: tuple[Colour, ...] = (
    (34, 74, 48), (40, 108, 64), (56, 154, 88), (128, 204, 128), (224, 244, 172),
)  # fmt: skip
_EMPTY = 30  # opacity of a plant never inspected: an outline with next to nothing in it


@dataclass(frozen=True)
class Shade:
    """A colour for every plant by its rank ``(n,)``; higher ranks win a pixel.

    ``table`` is ``(k, 4)`` uint8, a colour with its opacity for each rank.
    """

    table: NDArray[np.uint8]
    rank: NDArray[np.uint8]

    @classmethod
    def of(cls, colours: list[tuple[int, ...]], rank: NDArray[np.integer]) -> Shade:
        """Return the shade of these colours, a rank each; where no opacity is named, it is full."""
        table = np.array([(*c, 255) if len(c) == 3 else c for c in colours], np.uint8)
        return cls(table, rank.astype(np.uint8))


def by_chance(chance: NDArray[np.float64], *, dark: bool = False) -> Shade:
    """Return plants shaded by their chance of infestation, in the legend's classes."""
    rank = np.searchsorted(CHANCE_FROM, chance, side="right") - 1
    return Shade.of([*(CHANCE_IN_DARK if dark else CHANCE_COLOURS)], rank)


def by_state(state: NDArray[np.int8]) -> Shade:
    """Return plants shaded as found (1), clean (0) or never inspected (-1: an empty ring)."""
    return Shade.of([(*NEVER, _EMPTY), CLEAN, FOUND], state + np.int8(1))


def by_age(days: NDArray[np.integer], *, dark: bool = False) -> Shade:
    """Return plants shaded by the days since they were inspected; -1 (never): an empty ring."""
    rank = np.searchsorted(AGE_FROM, days, side="right")
    return Shade.of([(*NEVER, _EMPTY), *(AGE_IN_DARK if dark else AGE_COLOURS)], rank)


def plain(n: int) -> Shade:
    """Return n plants in one colour."""
    return Shade.of([(90, 150, 90)], np.zeros(n, np.uint8))
