"""What is drawn in which colour, and the classes of what is believed and known of plants."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.reports import colours as on_paper

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Colour = tuple[int, int, int]
#: with how much of what is below it hides, up to 255
Translucent = tuple[int, int, int, int]
# on paper and on a light ground the same
_LIGHT: tuple[Colour, ...] = on_paper.CHANCE
CHANCE_FROM = on_paper.CHANCE_FROM
_MAGMA_IN_DARK: tuple[Colour, ...] = (
    *((104, 42, 132), (148, 50, 131), (196, 62, 118), (236, 95, 96), (251, 146, 102)),
    *((254, 200, 140), (252, 250, 200)),
)
FOUND: Colour = (213, 30, 30)
CLEAN: Colour = (90, 160, 230)
NEVER: Colour = (150, 150, 145)
NOT_INSPECTED: Colour = (140, 105, 60)
TRUTH: Colour = (0, 0, 0)
TRUTH_IN_DARK: Colour = (255, 255, 255)
ROUTE: Colour = (12, 62, 170)
ROUTE_IN_DARK: Colour = (110, 220, 255)
#: several robots, told apart by the colour-blind of each kind too; their names say it as well
ROBOTS: tuple[Colour, ...] = (
    ROUTE, (108, 119, 3), (92, 7, 86), (176, 87, 115), (45, 38, 25), (135, 0, 255),
)  # fmt: skip
ROBOTS_IN_DARK: tuple[Colour, ...] = (
    ROUTE_IN_DARK, (248, 232, 117), (34, 156, 150), (255, 168, 139), (160, 140, 50), (183, 255, 0),
)  # fmt: skip
CASING: Colour = (255, 255, 255)
CASING_IN_DARK: Colour = (10, 20, 26)
GATE: Colour = (0, 140, 90)
ROWS: Translucent = (60, 60, 60, 110)
ROWS_IN_DARK: Translucent = (230, 230, 230, 120)
HOT: Colour = (20, 26, 30)
HOT_IN_DARK: Colour = (255, 255, 255)
ZONE: Colour = (118, 42, 131)
ZONE_IN_DARK: Colour = (231, 180, 255)
TREATED: Colour = (0, 104, 116)
TREATED_IN_DARK: Colour = (150, 230, 120)
OUTLINE: Colour = (60, 70, 60)
OUTLINE_IN_DARK: Colour = (190, 200, 190)
# the outline of a plot among answers of all other colours
AMONG_ANSWERS: Colour = (60, 130, 90)
PLAIN: Colour = (90, 150, 90)
#: a record of which nobody knows what was seen, on light and dark ground
UNKNOWN: Colour = (130, 130, 130)
BEFORE: Colour = (230, 120, 0)
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
class PlanTones:
    """What a plan is drawn in: quiet, so that plants and route stand out from it."""

    headland: Colour
    rows: Colour
    aisle: Colour
    no_go: Colour
    hatch: Colour


PLAN = PlanTones((226, 214, 186), (214, 223, 201), (244, 241, 232), (226, 214, 208), (120, 74, 60))
PLAN_IN_DARK = PlanTones((60, 54, 40), (22, 36, 30), (30, 36, 33), (48, 34, 32), (196, 148, 130))


@dataclass(frozen=True)
class Shade:
    """A colour for every plant by its rank ``(n,)``; higher ranks win a pixel.

    ``table`` is ``(k, 4)`` uint8, a colour with its opacity for each rank.
    """

    table: NDArray[np.uint8]
    rank: NDArray[np.uint8]

    @classmethod
    def of(cls, colours: Sequence[Colour | Translucent], rank: NDArray[np.integer]) -> Shade:
        """Return the shade of these colours, a rank each; where no opacity is named, it is full."""
        table = np.array([(*c, 255) if len(c) == 3 else c for c in colours], np.uint8)
        return cls(table, rank.astype(np.uint8))


def of_chance(*, dark: bool = False) -> tuple[Colour, ...]:
    """Return the colours of the chance classes: on either ground the highest stands out most."""
    return _MAGMA_IN_DARK if dark else _LIGHT


def by_chance(chance: NDArray[np.float64], *, dark: bool = False) -> Shade:
    """Return plants shaded by their chance of infestation, in the legend's classes."""
    return Shade.of(of_chance(dark=dark), classes(chance))


def classes(chance: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return in which of the legend's classes chances are, from 0 for the least."""
    return np.searchsorted(CHANCE_FROM, chance, side="right") - 1


def by_state(state: NDArray[np.int8], not_inspected: NDArray[np.bool_] | None = None) -> Shade:
    """Return plants shaded as found (1), clean (0) or never inspected (-1: an empty ring).

    Of those some could not be inspected, or are gone: ``(n,)``.
    """
    shades: list[Colour | Translucent] = [(*NEVER, _EMPTY), CLEAN, FOUND]
    rank = state + np.int8(1)
    if not_inspected is not None and not_inspected.any():
        shades.insert(1, NOT_INSPECTED)
        rank = np.where(rank > 0, rank + 1, not_inspected & (rank == 0))
    return Shade.of(shades, rank)


def by_age(days: NDArray[np.integer], *, dark: bool = False) -> Shade:
    """Return plants shaded by the days since they were inspected; -1 (never): an empty ring."""
    rank = np.searchsorted(AGE_FROM, days, side="right")
    return Shade.of([(*NEVER, _EMPTY), *(AGE_IN_DARK if dark else AGE_COLOURS)], rank)


def of_robot(k: int) -> tuple[Colour, Colour]:
    """Return the colours of the kth of several robots, on light and on dark ground."""
    return ROBOTS[k % len(ROBOTS)], ROBOTS_IN_DARK[k % len(ROBOTS_IN_DARK)]


def plain(n: int) -> Shade:
    """Return n plants in one colour."""
    return Shade.of([PLAIN], np.zeros(n, np.uint8))
