"""Who takes part: samplers with the beliefs they are given, and bounds for orientation."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.errors import SettingError
from fieldmon.infestation.pairs.independent_plants import IndependentPlants
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.plot.robot import Robot
from fieldmon.samplers import kind_of, sampler_maker
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import Sampler
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.own import is_own, labels_of, own_text
from fieldmon.samplers.sweeps import Bouncy, Naive

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.samplers.base import InspectionTimes, Scene, Stops, WouldFind

ADAPTIVE, WORDED, TUNED = "adaptive", "dynamic, as worded", "dynamic, tuned"
PAIRS, NAIVE = "adaptive, pairs only", "naive"
NO_TRAVEL, CLAIRVOYANT = "no travel", "clairvoyant"
SOME = 10
_DIGITS = 6
#: what no sampler can reach, and samplers that take part in every tenth season only
BOUNDS = (
    NO_TRAVEL, CLAIRVOYANT, "dynamic, independent plants", "adaptive, independent plants",
)  # fmt: skip
#: each in a sentence
ABOUT = {
    ADAPTIVE: "the default of fieldmon, on the map of chances that it uses.",
    PAIRS: "the same sampler on a map that knows the plants next to each other only.",
    WORDED: "the thesis's sampler as its text has it: plants next to a find, then suspicious ones.",
    TUNED: "the same with its open choices searched.",
    "dynamic, independent plants": "dynamic on a map without neighbours; every tenth season.",
    "adaptive, independent plants": "adaptive on a map without neighbours; every tenth season.",
    NAIVE: "a plain sweep: every plant, up one row and down the next.",
    "bouncy": "every second plant of that sweep.",
    NO_TRAVEL: "a bound: adaptive if driving took no time; every tenth season.",
    CLAIRVOYANT: "a bound: drives, but knows which plants are infested; every tenth season.",
}


@dataclass(frozen=True)
class Contender:
    """Who takes part: a sampler with the belief it is given.

    Parameters
    ----------
    name
        What it is called.
    sampler
        Who decides.
    believe
        How plot and chance map become a belief.
    drives
        False for the bound: driving and changing rows take no time.
    every
        Takes part in every so many-th season: who is there for orientation need not be in all.
    """

    name: str
    sampler: Sampler
    believe: Callable[[PlantGrid, NDArray[np.float64]], Belief] = PairApproximation.of
    drives: bool = True
    every: int = 1


# what `tuning.losses` came to; the map of pairs is the better one for Dynamic too
CONTENDERS = (
    Contender(ADAPTIVE, Adaptive(), TracedPairs.of),
    Contender(PAIRS, Adaptive()),
    Contender(WORDED, Dynamic()),
    Contender(TUNED, Dynamic(suspicious=0.06)),
    Contender("dynamic, independent plants", Dynamic(), IndependentPlants, every=SOME),
    Contender("adaptive, independent plants", Adaptive(), IndependentPlants, every=SOME),
    Contender(NAIVE, Naive(), IndependentPlants),
    Contender("bouncy", Bouncy(), IndependentPlants),
    Contender(NO_TRAVEL, Adaptive(), TracedPairs.of, drives=False, every=SOME),
)
# of the maps only that of traced pairs follows a pest: all are given it, each sampler once
OF_PESTS = tuple(
    replace(each, believe=TracedPairs.of)
    for each in CONTENDERS
    if each.name != PAIRS and not each.name.endswith("independent plants")
)
NAMES = (*(contender.name for contender in CONTENDERS), CLAIRVOYANT)


@dataclass(frozen=True)
class Added:
    """A sampler that somebody adds to those compared, on the map that Adaptive is given.

    Parameters
    ----------
    label
        What sentences and reports call it.
    called
        What the table calls it: of an own one with digits that tell its code from any other.
    about
        What it is, in a sentence.
    make
        Makes one: what an own one keeps in mind is of one season.
    """

    label: str
    called: str
    about: str
    make: Callable[[], Sampler]

    def contender(self) -> Contender:
        """Return it as it takes part in one season."""
        return Contender(self.called, self.make(), TracedPairs.of)


def added(names: Iterable[str], to: Sequence[str] = NAMES) -> tuple[Added, ...]:
    """Return samplers to be added, by name or as ``my_sampler.py:Mine``.

    Those that take part anyway, `to` which they are added, are left out. Raise `SettingError` if
    there is none of that name, or two have one name.
    """
    told = [name for name in dict.fromkeys(names) if is_own(name) or name not in to]
    made = []
    for name, label in zip(told, labels_of(told), strict=True):
        if label in to:
            raise SettingError(
                f"A sampler of your own must have another name than those compared, but {name} is "
                f"called {label}, too. Give the class another name."
            )
        make, called, about = sampler_maker(name), label, "added; on the map of adaptive"
        if is_own(name):
            called = f"{label}, {digest(own_text(name), length=_DIGITS)}"
            about = f"of your own, {about}."
        else:
            about = f"{kind_of(name).does}; {about}."
        made.append(Added(label, called, about, make))
    return tuple(made)


class Oracle(Sampler):
    """The clairvoyant: drives as Adaptive does, on the truth instead of a chance map.

    Parameters
    ----------
    truth
        ``(n,)`` which plants are infested today; whoever plays the season tells it every morning.
    """

    def __init__(self, truth: NDArray[np.bool_]) -> None:
        self.truth = truth

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day, at infested plants first."""
        chance = np.where(self.truth, 1.0 - 1e-6, 1e-6)
        start, other = scene.grid.adjacent
        pair_chance = np.repeat(chance, np.diff(start)) * chance[other]
        return Adaptive().walk(replace(scene, chance=chance, pair_chance=pair_chance), would_find)


class Misinformed(Sampler):
    """A sampler that takes the robot to detect what the thesis's does.

    Parameters
    ----------
    sampler
        Who decides.
    """

    def __init__(self, sampler: Sampler) -> None:
        self.sampler = sampler

    def inspection_times(self, robot: Robot) -> InspectionTimes:
        """Return the times among which it chooses, and what they really detect."""
        return self.sampler.inspection_times(robot)

    def walk(self, scene: Scene, would_find: WouldFind) -> Stops:
        """Return the stops of the rest of the day."""
        robot = replace(scene.robot, detection=Robot().detects)
        return self.sampler.walk(replace(scene, robot=robot), would_find)
