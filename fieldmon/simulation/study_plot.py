"""What a season of a study is simulated on and with: a plot, and a level of every factor."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from fieldmon.compute.digest import digest

if TYPE_CHECKING:
    import numpy as np

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.infestation.records import Records
    from fieldmon.plot.field import Field
    from fieldmon.plot.planting import Planting

# settings that later versions added: unsaid, they leave a plot what it was
_LATER = ("half_canopy_m", "in_rows")
#: digits of a digest by which plots and chunks are kept
DIGITS = 20


@dataclass(frozen=True, eq=False)
class StudyPlot:
    """A plot of a study as it travels to whoever simulates on it; its plants are laid there.

    Parameters
    ----------
    field
        The plot.
    planting
        How it is planted.
    records
        Records on it, from which the first morning's chances follow.
    day
        The day they are seen from.
    pest_in_weather
        The pest, in the weather of the season's days; None: nights are as the levels have them.
    """

    field: Field
    planting: Planting
    records: Records
    day: np.datetime64
    pest_in_weather: PestInWeather | None = None

    @cached_property
    def digest(self) -> str:
        """Return what tells this plot and its records from any others."""
        parts = (*self.field.content, *vars(self.records).values())
        # unsaid, it leaves a plot what it was before pests could be named
        pest = () if self.pest_in_weather is None else self.pest_in_weather.content
        return digest(*parts, as_written(self.planting), str(self.day), *pest, length=DIGITS)

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


def as_written(settings: object) -> bytes:
    """Return what stands for settings in digests: names and values in the order of the class."""
    written = {name: value for name, value in vars(settings).items() if name not in _LATER or value}
    return repr(written).encode()
