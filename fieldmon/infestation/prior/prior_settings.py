"""How records, edges and paths become a chance of infestation: the figures, and their sources."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

# after so many half-lives a record hardly counts
_HARDLY = 5.0


@dataclass(frozen=True)
class PriorSettings:
    """How records, edges and paths become a chance of infestation.

    Where no source is named the value is our choice, for the reason given.

    Parameters
    ----------
    background_chance
        Chance of a plant of which nothing is known, far from edges and paths. Small, not zero:
        mites drift on the wind, so no plant is beyond suspicion.
    edge_chance, edge_depth_m
        Chance added at the plot's boundary (its holes' too: weeds around a pond or a house are a
        margin like any other), and the depth over which it falls to 1/e. That insects enter
        there is Shmuel (2018), through Yehoshua's thesis (2023), which gives no numbers.
    path_chance, path_depth_m
        The same for paths and roads (same sources): people, vehicles and dust carry mites.
    at_record
        Chance that a plant recorded as infested today is infested: short of 1 for the wrong
        plant, the wrong species, a slip of the pen.
    beside_one, beside_many, half_count
        Chance that plants beside a record are infested because of it: where few pests were
        counted, where very many were, and the count that lies half-way (and stands in where
        presence alone was noted). In mapped plots with 13-20 % of the plants infested, 0.21-0.56
        of the neighbours of an infested plant were so too (citrus tristeza 1991, bell pepper
        Phytophthora: the public maps of the R packages epiphy and agridat).
    reach_m
        How far a record speaks for the plants about it: the standard deviation of a round bell.
        Mites crawl from plant to plant where leaves touch: a few plants along, a row or two across.
    accuracy_m
        Position accuracy (1 sigma) of records that do not state theirs. A phone in the open is
        within 4.9 m (GPS.gov).
    half_life_days
        After this time a record counts half. *Tetranychus urticae* grows from egg to adult in
        7-14 days (UMass Extension): by then another generation sits on the plants.
    undated_days
        Age at which records without a date are taken. One half-life: they count half.
    detection
        Chance that a look finds what is there, where the leaves sampled are not stated: the
        quickest look of the thesis's robot (20 s, 50 %).
    leaf_detection
        Chance that one leaf of an infested plant shows it; k leaves miss it by (1 - chance)^k.
        Young infestations sit on few leaves.

    Examples
    --------
    >>> from datetime import date
    >>> import fieldmon as fm
    >>> usual_here = fm.PriorSettings(background_chance=0.03)
    >>> fm.MonitoringSettings(date(2026, 4, 6), prior=usual_here).prior.background_chance
    0.03
    """

    background_chance: float = 0.01
    edge_chance: float = 0.05
    edge_depth_m: float = 10.0
    path_chance: float = 0.05
    path_depth_m: float = 10.0
    at_record: float = 0.95
    beside_one: float = 0.2
    beside_many: float = 0.6
    half_count: float = 10.0
    reach_m: float = 5.0
    accuracy_m: float = 5.0
    half_life_days: float = 14.0
    undated_days: float = 14.0
    detection: float = 0.5
    leaf_detection: float = 0.1

    @property
    def hardly_days(self) -> float:
        """Age from which on a record hardly counts: after five half-lives a thirtieth is left."""
        return _HARDLY * self.half_life_days

    def __post_init__(self) -> None:
        must_hold_kinds(self, "The prior's")
        above_0 = {"edge_depth_m", "path_depth_m", "half_count", "reach_m", "half_life_days"}
        from_0 = {"accuracy_m", "undated_days"}
        for name in (each.name for each in fields(self)):
            value = getattr(self, name)
            if name in above_0 and not 0.0 < value < np.inf:
                raise SettingError(
                    worded(
                        "The prior's {name} must be above 0, but it is {value}.",
                        name=name,
                        value=value,
                    )
                )
            if name in from_0 and not 0.0 <= value < np.inf:
                raise SettingError(
                    worded(
                        "The prior's {name} must be 0 or more, but it is {value}.",
                        name=name,
                        value=value,
                    )
                )
            if name not in above_0 | from_0 and not 0.0 <= value <= 1.0:
                raise SettingError(
                    worded(
                        "The prior's {name} must be a chance in 0..1, but it is {value}.",
                        name=name,
                        value=value,
                    )
                )
        if self.beside_many < self.beside_one:
            raise SettingError(
                worded(
                    "Many pests must not say less than one: the prior's beside_many must be at "
                    "least beside_one ({beside_one}), but it is {beside_many}.",
                    beside_one=self.beside_one,
                    beside_many=self.beside_many,
                )
            )
