"""What a study compares, and how it is cut into chunks that take seconds."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from itertools import product
from typing import TYPE_CHECKING

from fieldmon.compute.digest import digest
from fieldmon.errors import SettingError
from fieldmon.samplers import COMPARED, kind_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from fieldmon.infestation.observations import Observations
    from fieldmon.plot.field import Field
    from fieldmon.plot.layout import Planting

# a chunk takes about so long; what seasons cost was measured, see the README's section on speed
_CHUNK_S = 4.0
_S_PER_DAY = 3e-4
# changes when seasons come out differently, so that old chunks are not taken for new ones
_VERSION, _DIGITS = "1", 20


@dataclass(frozen=True, eq=False)
class Site:
    """A plot as it travels to whoever simulates on it; its plants are laid there.

    Parameters
    ----------
    field
        The plot.
    planting
        How it is planted.
    observations
        Records on it, from which the first morning's chances follow.
    day
        The day they are seen from.
    """

    field: Field
    planting: Planting
    observations: Observations
    day: np.datetime64

    @property
    def digest(self) -> str:
        """Return what tells this plot and its records from any others."""
        parts = (*vars(self.field).values(), *vars(self.observations).values())
        return digest(*parts, _as_written(self.planting), str(self.day), length=_DIGITS)

    @property
    def about_plants(self) -> int:
        """Return roughly how many plants there is room for."""
        if self.field.plants is not None:
            return len(self.field.plants)
        area_m2 = self.field.frame().geometry_m(self.field.boundary).area
        each_m2 = self.planting.row_spacing_m * self.planting.plant_spacing_m
        return 1 + int(area_m2 / each_m2)


@dataclass(frozen=True)
class Case:
    """One combination of settings: who inspects how, and what the insects do.

    Parameters
    ----------
    sampler
        Name in `fieldmon.samplers.SAMPLERS`.
    hours, look_s
        Working day, and seconds spent looking at a plant.
    infested
        Share of plants infested at the start.
    spread
        Chance a night to infest each neighbour.
    """

    sampler: str
    hours: float
    look_s: float
    infested: float
    spread: float


@dataclass(frozen=True)
class Design:
    """All that is compared: every sampler with every setting and every seed.

    Parameters
    ----------
    samplers
        Names in `fieldmon.samplers.SAMPLERS`.
    hours, look_s, infested, spread
        Values of the settings of `Case`.
    n_days
        Working days of a season.
    n_seeds, first_seed
        Seasons of each case; season k starts from seed ``first_seed + k``, the same for all cases.
    """

    samplers: tuple[str, ...] = COMPARED
    hours: tuple[float, ...] = (12.0,)
    look_s: tuple[float, ...] = (40.0,)
    infested: tuple[float, ...] = (0.02,)
    spread: tuple[float, ...] = (0.1,)
    n_days: int = 25
    n_seeds: int = 100
    first_seed: int = 1

    def __post_init__(self) -> None:
        for name in self.samplers:
            kind_of(name)
        for named in fields(self)[:5]:
            values = getattr(self, named.name)
            if not values or len(set(values)) < len(values):
                raise SettingError(
                    f"A study needs one value of {named.name} or more, each once, "
                    f"but they are {values}."
                )
        if self.n_days < 1 or self.n_seeds < 1 or self.first_seed < 0:
            raise SettingError(
                "A study needs 1 day and 1 seed or more, seeds from 0, but it has "
                f"{self.n_days} day(s) and {self.n_seeds} seed(s) from {self.first_seed}."
            )
        for share in self.infested:
            if not 0.0 < share < 1.0:
                raise SettingError(
                    f"The share infested at the start must be between 0 and 1, but it is {share}."
                )

    @property
    def cases(self) -> tuple[Case, ...]:
        """Return all combinations of settings."""
        values = (self.samplers, self.hours, self.look_s, self.infested, self.spread)
        return tuple(Case(*each) for each in product(*values))


@dataclass(frozen=True, eq=False)
class Chunk:
    """Seasons of one case on one plot that are simulated in one go.

    Parameters
    ----------
    site
        The plot.
    case
        The settings.
    seeds
        First seed, and the one after the last.
    n_days
        Working days of a season.
    key
        Names what comes out; it depends on all of the above and on nothing else.
    """

    site: Site
    case: Case
    seeds: tuple[int, int]
    n_days: int
    key: str = field(default="")

    def __len__(self) -> int:
        """Return the number of seasons."""
        return self.seeds[1] - self.seeds[0]


def chunks(sites: tuple[Site, ...], design: Design) -> Iterator[Chunk]:
    """Yield the chunks of a study: the same ones, whoever simulates them."""
    end = design.first_seed + design.n_seeds
    for site in sites:
        of_site, n_plants = site.digest, site.about_plants
        for case in design.cases:
            size = _seasons(case.sampler, n_plants, design.n_days)
            for first in range(design.first_seed, end, size):
                seeds = (first, min(first + size, end))
                parts = (_VERSION, of_site, _as_written(case), seeds, design.n_days)
                key = digest(*parts, length=_DIGITS)
                yield Chunk(site, case, seeds, design.n_days, key)


def _seasons(sampler: str, n_plants: int, n_days: int) -> int:
    """Return how many seasons take about `_CHUNK_S`."""
    day_s = _S_PER_DAY + n_plants * kind_of(sampler).s_per_plant_day
    return math.ceil(_CHUNK_S / (n_days * day_s))


def _as_written(settings: object) -> bytes:
    """Return what stands for settings in digests: names and values in the order of the class."""
    return repr(vars(settings)).encode()
