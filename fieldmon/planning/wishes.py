"""What people want of a day beside what the sampler would choose."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.samplers.base import NEVER

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.planning.route import Route
    from fieldmon.samplers.base import Scene

# as good as known: what is wished for comes before all that is only believed
_SURE = 0.999


@dataclass(frozen=True)
class Wishes:
    """Plants that are to be inspected on a day, and plants that are not to be.

    Parameters
    ----------
    wanted
        Numbers of plants in the grid, from 0, that are to be inspected if the hours allow it.
    unwanted
        Numbers of plants that must not be inspected on the day.

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Wishes((3, 4), (7,)).also((7,))
    Wishes(wanted=(3, 4, 7), unwanted=())
    """

    wanted: tuple[int, ...] = ()
    unwanted: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        must_hold_kinds(self, "Wishes'")

    def __bool__(self) -> bool:
        """Return whether anything is wished for."""
        return bool(self.wanted or self.unwanted)

    def also(self, plants: tuple[int, ...]) -> Wishes:
        """Return the wishes with these plants to be inspected, whatever was said of them before."""
        return Wishes(_with(self.wanted, plants), _without(self.unwanted, plants))

    def never(self, plants: tuple[int, ...]) -> Wishes:
        """Return the wishes with these plants left out, whatever was said of them before."""
        return Wishes(_without(self.wanted, plants), _with(self.unwanted, plants))

    def applied_to(self, scene: Scene) -> Scene:
        """Return the scene as whoever plans is told of it.

        Wanted plants seem all but surely infested; unwanted ones seem inspected today. What is
        left out because nobody could inspect it, or as it is known, is not if it is wanted. A
        sampler that reads no chances, as a sweep, passes wishes for more by: see `unmet`.

        Raise `SettingError` where there is no such plant.
        """
        if not self:
            return scene
        last = len(scene.chance) - 1
        if wrong := [plant for plant in (*self.wanted, *self.unwanted) if not 0 <= plant <= last]:
            raise SettingError(
                worded("A plant must be 0 to {last}, but it is {plant}.", last=last, plant=wrong[0])
            )
        wanted, unwanted = (np.array(some, np.intp) for some in (self.wanted, self.unwanted))
        chance, seen = scene.chance.copy(), scene.last_inspected.copy()
        chance[wanted] = np.maximum(chance[wanted], _SURE)
        seen[wanted[scene.left_out[wanted]]] = NEVER
        seen[unwanted] = scene.day
        pairs = scene.pair_chance
        if pairs is not None and len(wanted):
            start, second = scene.grid.adjacent
            first = np.repeat(np.arange(len(scene.grid)), np.diff(start))
            touched = np.isin(first, wanted) | np.isin(second, wanted)
            # beside a plant that is infested for sure, both are if the other one is
            both = np.minimum(chance[first], chance[second])
            pairs = np.where(touched, both, pairs)
        return replace(scene, chance=chance, last_inspected=seen, pair_chance=pairs)

    def unmet(self, route: Route) -> NDArray[np.intp]:
        """Return the plants that were wished for and are not on the route."""
        return np.setdiff1d(np.array(self.wanted, np.intp), route.plant)


def _with(some: tuple[int, ...], more: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(sorted({*some, *more}))


def _without(some: tuple[int, ...], fewer: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(sorted({*some} - {*fewer}))
