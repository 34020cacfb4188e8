"""What is tried: a strategy on a vineyard, by the listings or by the prose."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter4 import listings, nights, prose_model
from fieldmon.studies.thesis.chapter4.listing_errors import AS_PUBLISHED, ListingErrors
from fieldmon.studies.thesis.chapter4.vineyard import CHAPTER_4, VIEWPOINTS_S, Hours, Vineyard

NAMES = {
    1: "snake, every plant",
    2: "snake, every N",
    3: "snake, online random",
    4: "neighbor, every N",
    5: "neighbor, online random",
    6: "neighbor, every plant",
    7: "random 1/N of the field each day",
}
SCATTERED = 7
_ONLINE = (3, 5)
_NEIGHBOR = (4, 5, 6)


@dataclass(frozen=True)
class ThesisStrategy:
    """One of the thesis's seven algorithms.

    Parameters
    ----------
    algorithm
        1 to 7, see `NAMES`.
    every
        N; 1 for the algorithms that have none.
    """

    algorithm: int
    every: int = 1

    def __post_init__(self) -> None:
        if self.algorithm not in NAMES:
            raise SettingError(f"An algorithm must be 1 to 7, but it is {self.algorithm}.")
        least, most = (1, 1) if self.algorithm in (1, 3, 5, 6) else (1, 50)
        if not least <= self.every <= most:
            raise SettingError(
                f"N must be {least} to {most} in algorithm {self.algorithm} "
                f"({NAMES[self.algorithm]}), but it is {self.every}."
            )

    @property
    def online(self) -> bool:
        """Whether N is drawn on the way."""
        return self.algorithm in _ONLINE

    @property
    def neighbor(self) -> bool:
        """Whether both sides of the aisle are inspected from one stop."""
        return self.algorithm in _NEIGHBOR

    @property
    def n(self) -> str:
        """How the tables write N: a number, or R for random."""
        return "R" if self.online else str(self.every)


TABLE_ROWS = (
    ThesisStrategy(1),
    ThesisStrategy(2, 2),
    ThesisStrategy(2, 3),
    ThesisStrategy(2, 4),
    ThesisStrategy(3),
    ThesisStrategy(6),
    ThesisStrategy(4, 2),
    ThesisStrategy(4, 3),
    ThesisStrategy(4, 4),
    ThesisStrategy(5),
)
"""The rows of tables 2 to 5."""


@dataclass(frozen=True)
class Prose:
    """The strategies as the thesis describes them, where its text leaves a choice.

    Parameters
    ----------
    reenter_anywhere
        At the end of the field, go on from the nearest face of the whole field not yet visited;
        otherwise, as in the listings, from one of the last N (the least visited, then the nearest).
    turn_90_s
        Charged at every stop for turning to the plant; the listings hold such a time and never
        charge it.
    independent_coins
        Each neighbour of an infested face has its own coin at night, not one coin for all three.
    """

    reenter_anywhere: bool = False
    turn_90_s: float = 0.0
    independent_coins: bool = False

    def __post_init__(self) -> None:
        if not 0 <= self.turn_90_s < math.inf:
            raise SettingError(f"turn_90_s must be 0 s or more, but it is {self.turn_90_s}.")


@dataclass(frozen=True)
class NoPriorTrial:
    """One configuration to be run again and again.

    Parameters
    ----------
    vineyard, strategy
        Where, and how.
    viewpoints
        1, 2 or 3 viewpoints at a stop (see `VIEWPOINTS_S`).
    severity
        Chance that an infested face spreads in a night.
    rules
        `ListingErrors`: as the listings run. `Prose`: as the text describes.
    """

    vineyard: Vineyard
    strategy: ThesisStrategy
    viewpoints: int = 3
    severity: float = 0.3
    rules: ListingErrors | Prose = AS_PUBLISHED
    hours: Hours = CHAPTER_4

    START = 0.3  # chance that a vine is infested on the first morning

    def __post_init__(self) -> None:
        if self.viewpoints not in VIEWPOINTS_S:
            raise SettingError(f"Viewpoints must be 1, 2 or 3, but there are {self.viewpoints}.")
        if not 0 <= self.severity <= 1:
            raise SettingError(f"Severity must be in 0..1, but it is {self.severity}.")
        if self.strategy.every >= self.vineyard.plants:
            raise SettingError(
                f"N must be below the {self.vineyard.plants} vines of a row, but it is "
                f"{self.strategy.every}."
            )
        if self.strategy.algorithm == SCATTERED and isinstance(self.rules, ListingErrors):
            raise SettingError(
                "Algorithm 7 has no listing in the thesis: run it as described (Prose)."
            )

    @property
    def plant_s(self) -> float:
        """Seconds from one vine to the next."""
        return self.vineyard.between_plants_m / self.hours.speed_m_s

    @property
    def look_s(self) -> float:
        """Seconds spent looking at one face."""
        return VIEWPOINTS_S[self.viewpoints]


def table_viewpoints(strategy: ThesisStrategy, slips: ListingErrors) -> int:
    """Return how many viewpoints tables 2 to 5 gave a strategy."""
    return 1 if strategy.neighbor and slips.unequal_viewpoints else 3


def _listing(strategy: ThesisStrategy) -> int:
    if strategy.neighbor:
        return nights.NEIGHBOR
    return nights.RANDOM_SNAKE if strategy.online else nights.SNAKE


def walk_of(trial: NoPriorTrial, slips: ListingErrors) -> listings.ListingWalk:
    """Return what the kernel needs to walk as the listings do."""
    field, strategy, hours = trial.vineyard, trial.strategy, trial.hours
    online = listings.EACH_STOP if slips.draw_every_stop else listings.EACH_PASS
    return listings.ListingWalk(
        plants=field.plants,
        sides=field.sides,
        listing=_listing(strategy),
        skip=strategy.every,
        draws=online if strategy.online else listings.FIXED,
        most=5 if slips.draw_one_to_five else 4,
        travel_s=trial.plant_s,
        look_s=trial.look_s,
        turn_s=hours.turn_180_s,
        change_s=hours.row_change_s,
        day_s=hours.day_s,
        days=hours.days,
        travel_once=slips.travel_once,
        change_by_counter=slips.row_change_by_counter,
        one_way=slips.one_way_rows,
        reentry_by_index=slips.reentry_by_index,
    )


def night_of(trial: NoPriorTrial, slips: ListingErrors) -> nights.Night:
    """Return what the kernel needs to let insects spread as the listings do."""
    return nights.Night(
        plants=trial.vineyard.plants,
        sides=trial.vineyard.sides,
        listing=_listing(trial.strategy),
        severity=trial.severity,
        other_face_slip=slips.night_other_face,
        row_index_slip=slips.night_row_index,
        phantoms=slips.phantom_infections,
    )


def prose_walk_of(trial: NoPriorTrial, prose: Prose) -> prose_model.ProseWalk:
    """Return what the kernel needs to do as the prose describes."""
    field, strategy, hours = trial.vineyard, trial.strategy, trial.hours
    looks_s = trial.look_s
    if strategy.neighbor:
        looks_s += hours.turn_180_s + trial.look_s
    return prose_model.ProseWalk(
        plants=field.plants,
        sides=field.sides,
        neighbor=strategy.neighbor,
        skip=strategy.every,
        online=strategy.online,
        scattered=strategy.algorithm == SCATTERED,
        plant_s=trial.plant_s,
        stop_s=looks_s + prose.turn_90_s,
        turn_s=hours.turn_180_s,
        change_s=hours.row_change_s,
        day_s=float(hours.day_s),
        days=hours.days,
        reenter_anywhere=prose.reenter_anywhere,
        severity=trial.severity,
        one_coin=not prose.independent_coins,
    )
