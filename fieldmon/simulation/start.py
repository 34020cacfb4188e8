"""The first morning of a simulated season: which plants are infested, what is believed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.compute.array_arguments import must_be_chances, must_hold_shapes
from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.wording import counted
from fieldmon.errors import SettingError
from fieldmon.infestation.prior.prior import start_infested

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
        ``(n,)`` chance of infestation as believed, in 0..1.

    Raises
    ------
    SettingError
        If both are not of as many plants, or a chance is not in 0..1.

    Examples
    --------
    >>> import fieldmon as fm, numpy as np
    >>> fm.Start(infested=np.array([True, False]), chance=np.array([0.2, 0.1]))
    <Start: 1 of 2 plants infested>
    """

    infested: NDArray[np.bool_]
    chance: NDArray[np.float64]

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A start's")
        must_hold_shapes(self, "A start's", dict.fromkeys(vars(self), (self.infested.size,)))
        must_be_chances("A start", self.chance)

    def __repr__(self) -> str:
        plants = counted(len(self.infested), "plant")
        return f"<Start: {int(self.infested.sum())} of {plants} infested>"


def season_start(
    grid: PlantGrid, chance: NDArray[np.float64], share: float, streams: RandomStreams
) -> Start:
    """Draw a season's start from a chance map ``(n,)``: each plant by its own chance.

    `share` of all plants are infested on average, above 0 and below 1. Both faces of a plant are
    infested together. Streams of the same seed infest the same plants, whoever is to inspect them.
    """
    must_be_start_share(share)
    infested = start_infested(chance, share, streams.of("start"))
    return Start(infested[grid.vine], chance)


def must_be_start_share(share: float) -> None:
    """Raise `SettingError` unless some plants are infested at a season's start, and others not."""
    if not 0.0 < share < 1.0:
        raise SettingError(
            f"The share infested at the start must be above 0 and below 1, but it is {share}."
        )
