"""The first morning of a season: who is infested, and what is believed about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.infestation.prior import start_infested

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.compute.random_streams import RandomStreams
    from fieldmon.plot.grid import PlantGrid


@dataclass(frozen=True, eq=False)
class Start:
    """The first morning.

    Parameters
    ----------
    infested
        ``(n,)`` the truth, which no sampler sees.
    chance
        ``(n,)`` chance of infestation as believed.
    """

    infested: NDArray[np.bool_]
    chance: NDArray[np.float64]


def draw_start(
    grid: PlantGrid, chance: NDArray[np.float64], share: float | None, streams: RandomStreams
) -> Start:
    """Draw who is infested on the first morning, each plant by its own chance.

    Parameters
    ----------
    grid
        The plants; the two faces of one vine start alike.
    chance
        ``(n,)`` chance of infestation as believed, and drawn from.
    share
        Mean share of infested plants to which the chances are scaled; None: as they are.
    streams
        Of the season; the stream ``start`` is drawn from.
    """
    drawn = start_infested(chance, share, streams.of("start"))
    return Start(drawn[grid.vine], chance)
