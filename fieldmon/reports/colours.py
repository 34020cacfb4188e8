"""Colours on paper, which are those of the app on a light ground: a colour means one thing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import figure

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.reports.drawing import Colour

#: lower ends of the classes of chance
CHANCE_FROM = (0.0, 0.01, 0.02, 0.05, 0.10, 0.25, 0.50)
#: magma (M. Bostock after S. van der Walt and N. Smith, 2015), cut to what stands out from a light
#: ground: even steps of lightness, so that grey prints and colour-blind readers see them too
CHANCE: tuple[Colour, ...] = (
    *((254, 194, 135), (251, 150, 104), (241, 102, 92), (205, 64, 113), (158, 47, 127)),
    *((106, 28, 129), (45, 17, 96)),
)
FOUND: Colour = (213, 30, 30)
#: never inspected, looked clean, found
STATES: tuple[Colour, ...] = ((205, 205, 198), (120, 176, 222), FOUND)
#: could not be inspected, or gone
NOT_INSPECTED: Colour = (140, 105, 60)
ROUTE: Colour = (20, 80, 200)
GATE: Colour = (0, 140, 90)
INK: Colour = (20, 26, 30)
SOFT: Colour = (98, 108, 116)
FAINT: Colour = (206, 211, 214)
GROUND: Colour = (245, 245, 240)
PAPER: Colour = (255, 255, 255)
ACCENT: Colour = (24, 92, 62)
BAR: Colour = (143, 180, 206)


def ranks(chance: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the class of each chance ``(n,)``, from 0."""
    return np.searchsorted(CHANCE_FROM, chance, side="right") - 1


def chance_names() -> list[str]:
    """Return what is written beside the classes: their lower ends."""
    *lower, last = (low * 100 for low in CHANCE_FROM)
    return [*(figure(low, "g", " %") for low in lower), figure(last, "g", " %+")]
