"""What a belief about a plot is, and how inspections change it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.pairs.uninspected_days import Since
    from fieldmon.infestation.tracing.tracing import Traces
    from fieldmon.pests.pest import Pest


@dataclass(frozen=True)
class Learning:
    """How inspections change the chance map.

    Parameters
    ----------
    detection
        Chance in 0..1 that an inspection finds what is there; ``(k,)`` for each of a day's
        inspections, in their order, where they differ. The default is that of the usual `Robot`.
    beside_find
        Chance in 0..1 that a plant next to a find is infested too, whatever was believed before
        (infestations come in clusters; our choice).
    treated
        Whether a find is destroyed at once (the thesis's rule), or only flagged.

    Raises
    ------
    SettingError
        If a chance is not in 0..1, or `detection` is neither one nor ``(k,)``.

    Examples
    --------
    >>> import fieldmon as fm
    >>> flagging = fm.Learning(detection=0.7, treated=False)
    >>> fm.SimulationSettings(learning=flagging).learning.detection
    0.7
    """

    detection: float | NDArray[np.float64] = 0.84
    beside_find: float = 0.3
    treated: bool = True

    def __post_init__(self) -> None:
        must_hold_kinds(self, "Learning's")
        for name in ("detection", "beside_find"):
            values = np.atleast_1d(getattr(self, name))
            if not ((values >= 0.0) & (values <= 1.0)).all():
                raise SettingError(
                    f"{name} must be a chance in 0..1, but it is {getattr(self, name)}."
                )
        if np.ndim(self.detection) > 1:
            raise SettingError(
                "Learning's detection must be one chance, or (k,), but it has the shape "
                f"{np.shape(self.detection)}."
            )

    def detects(self, inspections: int) -> NDArray[np.float64]:
        """Return the detection of each of so many inspections, ``(k,)``."""
        return np.full(inspections, self.detection, np.float64)


class Belief(Protocol):
    """What is believed of a plot on a morning; never changed, each step returns another."""

    @property
    def chance(self) -> NDArray[np.float64]:
        """Chance of infestation of every plant, ``(n,)``."""
        ...

    @property
    def pair_chance(self) -> NDArray[np.float64] | None:
        """Chance that two plants side by side are both infested, ``(e,)``; None: no idea."""
        ...

    @property
    def traces(self) -> Traces | None:
        """What a day needs to trace a find to plants farther than beside it; None: no idea."""
        ...

    @property
    def doubt(self) -> float:
        """How far the expected number infested may be off, as a share.

        Days without inspections since are not in it: see `since_inspected`.
        """
        ...

    @property
    def doubt_of_rates(self) -> float:
        """The same as far as rates are not known alone: a verdict hangs on no more than that."""
        ...

    @property
    def since_inspected(self) -> Since | None:
        """What the number became on days without inspections; None: somebody inspected."""
        ...

    @property
    def pest(self) -> Pest | None:
        """The pest that lives on the plot; None: nobody named it."""
        ...

    def learn(
        self, plants: NDArray[np.int32], found: NDArray[np.bool_], learning: Learning
    ) -> Belief:
        """Return what is believed after inspecting `plants` ``(k,)`` with results `found`."""
        ...

    def overnight(self, spread: Spread) -> Belief:
        """Return what is believed the next morning."""
        ...

    def treated(self, left: NDArray[np.float64]) -> Belief:
        """Return what is believed after a treatment, `left` ``(n,)`` the share that outlives it."""
        ...
