"""What a study compares, and how it is cut into chunks that take seconds."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property, partial
from itertools import product
from typing import TYPE_CHECKING

from fieldmon.compute.digest import digest
from fieldmon.errors import SettingError
from fieldmon.samplers import COMPARED, kind_of
from fieldmon.simulation.experiment import Experiment
from fieldmon.simulation.worker import simulate_chunk

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np

    from fieldmon.infestation.observations import Observations
    from fieldmon.infestation.pest_in_weather import PestInWeather
    from fieldmon.plot.field import Field
    from fieldmon.plot.layout import Planting
    from fieldmon.simulation.worker import ChunkSeasons, Setting

# a chunk takes about so long; what seasons cost was measured, see docs/benchmarks
_CHUNK_S = 4.0
_S_PER_DAY = 3e-4
# changes when seasons come out differently, so that old chunks are not taken for new ones
_VERSION, _DIGITS = "4", 20
# settings that later versions added: unsaid, they leave a plot what it was
_LATER = ("half_canopy_m", "in_rows")


@dataclass(frozen=True, eq=False)
class StudyPlot:
    """A plot of a study as it travels to whoever simulates on it; its plants are laid there.

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
    living
        The pest, in the weather of the season's days; None: nights are as the levels have them.
    """

    field: Field
    planting: Planting
    observations: Observations
    day: np.datetime64
    living: PestInWeather | None = None

    @cached_property
    def digest(self) -> str:
        """Return what tells this plot and its records from any others."""
        parts = (*self.field.told, *vars(self.observations).values())
        # unsaid, it leaves a plot what it was before pests could be named
        living = () if self.living is None else self.living.told
        return digest(*parts, _as_written(self.planting), str(self.day), *living, length=_DIGITS)

    @cached_property
    def about_plants(self) -> int:
        """Return roughly how many plants there is room for."""
        if self.field.plants is not None:
            return len(self.field.plants)
        area_m2 = self.field.frame().geometry_m(self.field.boundary).area
        each_m2 = self.planting.row_spacing_m * self.planting.plant_spacing_m
        return 1 + int(area_m2 / each_m2)


@dataclass(frozen=True)
class Combination:
    """One level of every factor: who inspects how, and what the insects do.

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
        The levels of each factor, see `Combination`.
    n_days
        Working days of a season.
    n_seeds, first_seed
        Seasons of each combination; season k starts from seed ``first_seed + k`` in all of them.
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
    def combinations(self) -> tuple[Combination, ...]:
        """Return every level of each factor with every level of the others."""
        values = (self.samplers, self.hours, self.look_s, self.infested, self.spread)
        return tuple(Combination(*each) for each in product(*values))


def study_of(plots: Sequence[StudyPlot], design: Design) -> Experiment[Setting, ChunkSeasons]:
    """Return a design on plots as an experiment, every plot with every combination.

    Its keys are a sampler and a digest of all that its seasons depend on, and of nothing else.
    """
    n_days = design.n_days

    def key(setting: Setting, seeds: range) -> tuple[str, str]:
        plot, levels = setting
        parts = (plot.digest, _as_written(levels), (seeds.start, seeds.stop), n_days)
        return levels.sampler, digest(_VERSION, *parts, length=_DIGITS)

    return Experiment(
        settings=list(product(plots, design.combinations)),
        seeds=range(design.first_seed, design.first_seed + design.n_seeds),
        simulate=partial(simulate_chunk, n_days=n_days),
        chunk_size=lambda setting: _seasons(setting[1].sampler, setting[0].about_plants, n_days),
        key=key,
    )


def _seasons(sampler: str, n_plants: int, n_days: int) -> int:
    """Return how many seasons take about `_CHUNK_S`."""
    day_s = _S_PER_DAY + n_plants * kind_of(sampler).s_per_plant_day
    return math.ceil(_CHUNK_S / (n_days * day_s))


def _as_written(settings: object) -> bytes:
    """Return what stands for settings in digests: names and values in the order of the class."""
    written = {name: value for name, value in vars(settings).items() if name not in _LATER or value}
    return repr(written).encode()
