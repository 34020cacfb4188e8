"""Plants that plans leave out: nobody could inspect them, or they are known to be infested."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted, worded

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.planning.route import Route
    from fieldmon.samplers.base import Scene

# left out for longer than any season lasts
_MOST_DOUBLED = 12


@dataclass(frozen=True, eq=False)
class Skips:
    """How often in a row each plant was skipped: somebody stood before it and could not inspect it.

    A plant that was skipped is left out of plans for the next day. Each further skip in a row
    doubles that: 1, 2, 4, 8 ... days. An inspection ends the row, at whatever time of the same day.
    Where all plants were skipped, as of a locked gate, none is left out.

    Parameters
    ----------
    times
        ``(n,)`` days in a row on which it was skipped; 0: it was inspected since, or never skipped.
    last
        ``(n,)`` number of the last of these days; meaningless where there is none.

    Examples
    --------
    >>> import numpy as np
    >>> plant, day = np.array([0, 0, 1, 2]), np.array([3, 5, 5, 5])
    >>> skips = Skips.of(plant, day, last_inspected=np.array([-1, 2, 5]))
    >>> skips.times
    array([2, 1, 0])
    >>> [skips.left_out(day).tolist() for day in (6, 7, 8)]
    [[True, True, False], [True, False, False], [False, False, False]]
    """

    times: NDArray[np.int64]
    last: NDArray[np.int64]

    @classmethod
    def of(
        cls,
        plant: NDArray[np.integer],
        day: NDArray[np.integer],
        last_inspected: NDArray[np.integer],
    ) -> Skips:
        """Return it of the plants ``(k,)`` that were skipped and the days on which they were.

        `last_inspected`: ``(n,)`` day of the last inspection of each plant, or `NEVER`.
        """
        n = len(last_inspected)
        since = day > last_inspected[plant]
        # two who could not inspect it on one day say the same
        on_day, skipped = np.divmod(np.unique(day[since].astype(np.int64) * n + plant[since]), n)
        last = np.full(n, -1, np.int64)
        np.maximum.at(last, skipped, on_day)
        return cls(np.bincount(skipped, minlength=n), last)

    def left_out(self, day: int) -> NDArray[np.bool_]:
        """Return ``(n,)`` the plants that are left out of the plans of a day after these skips."""
        doubled = np.clip(self.times - 1, 0, _MOST_DOUBLED)
        out: NDArray[np.bool_] = (self.times > 0) & (day - self.last <= 1 << doubled)
        return np.zeros_like(out) if out.all() else out


def without_skipped(scene: Scene, skips: Skips) -> Scene:
    """Return a scene in which nobody is sent to plants left out: they seem inspected today.

    Those that were inspected today are not among its `skipped` plants, and those that are among
    them are not among its `flagged` ones: what happened last is said.
    """
    flagged, open_still = scene.flagged, scene.last_inspected != scene.day
    if flagged is not None:
        open_still |= flagged
    skipped = skips.left_out(scene.day) & open_still
    if not skipped.any():
        return scene
    last = np.where(skipped, np.int32(scene.day), scene.last_inspected)
    rest = None if flagged is None else flagged & ~skipped
    return replace(scene, last_inspected=last, skipped=skipped, flagged=rest)


def without_flagged(scene: Scene, flagged: NDArray[np.bool_] | None) -> Scene:
    """Return a scene in which nobody is sent to `flagged` plants ``(n,)``: they seem inspected.

    They were found infested and left so: to inspect them again tells nothing. None: there are none.
    """
    if flagged is None:
        return scene
    known = flagged & (scene.last_inspected != scene.day)
    if not known.any():
        return scene
    last = np.where(known, np.int32(scene.day), scene.last_inspected)
    return replace(scene, last_inspected=last, flagged=known)


def left_out(scene: Scene, *routes: Route) -> dict[str, NDArray[np.intp]]:
    """Return the plants that a day's routes leave out, by why: ``"skipped"`` and ``"flagged"``."""
    masks = {"skipped": scene.skipped, "flagged": scene.flagged}
    return {why: _still_out(mask, routes) for why, mask in masks.items()}


def left_out_in_words(scene: Scene, *routes: Route) -> tuple[Worded, ...]:
    """Return how many plants a day's routes leave out, and why; nothing where there are none."""
    out, said = left_out(scene, *routes), []
    if skipped := len(out["skipped"]):
        plants = counted(skipped, "plant")
        said.append(
            worded(
                "Left out of this plan: {plants} that nobody could inspect last time.",
                plants=plants,
            )
        )
    if flagged := len(out["flagged"]):
        plants = counted(flagged, "plant")
        said.append(
            worded("Left out of this plan: {plants} found and only flagged.", plants=plants)
        )
    return tuple(said)


def nothing_left_in_words(scene: Scene) -> Worded | None:
    """Return that no plant is left that could be inspected, and why; None: one is."""
    if (scene.last_inspected != scene.day).any():
        return None
    every = len(scene.last_inspected)
    n = 0 if scene.flagged is None else int(np.count_nonzero(scene.flagged))
    if not n:
        return worded(
            "Nothing is left to inspect: every plant was inspected on this day or is left out of "
            "it."
        )
    if n == every:
        return worded(
            "Every plant is known: {plants} {n:was|were} found and only flagged. Nothing is left "
            "to inspect until {n:it is|they are} treated.",
            plants=counted(n, "plant"),
            n=n,
        )
    return worded(
        "Nothing is left to inspect: {plants} {n:was|were} found and only flagged, and all others "
        "were inspected on this day or are left out of it.",
        plants=counted(n, "plant"),
        n=n,
    )


def _still_out(mask: NDArray[np.bool_] | None, routes: tuple[Route, ...]) -> NDArray[np.intp]:
    """Return those of some plants ``(n,)`` that are on none of these routes."""
    if mask is None:
        return np.empty(0, np.intp)
    out = mask.copy()
    for route in routes:
        out[route.plant] = False  # somebody wishes for them
    return np.flatnonzero(out)
