"""The insects of a simulated season: as a rule of nights has them, or as a pest in its weather."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from fieldmon.infestation.insects.colonies import Colonies

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather, Spell
    from fieldmon.plot.grid import PlantGrid

    Night = Callable[[PlantGrid, NDArray[np.bool_], np.uint64], NDArray[np.bool_]]


class PlotInsects(Protocol):
    """What lives on a plot, from morning to morning."""

    @property
    def infested(self) -> NDArray[np.bool_]:
        """Which plants are infested now, ``(n,)``."""
        ...

    def showing(self, number: int) -> NDArray[np.bool_]:
        """Return where an inspection may find something on a day, ``(n,)``."""
        ...

    def pass_night(self, found: NDArray[np.int32], number: int, key: np.uint64) -> int:
        """Destroy those on the plants found, let the others go on; return how many are new."""
        ...


class NightInsects:
    """Insects that do at night what a rule says, and nothing by day."""

    def __init__(
        self, grid: PlantGrid, infested: NDArray[np.bool_], night: Night, hidden_nights: int = 0
    ) -> None:
        self.grid, self.infested = grid, infested.copy()
        self._night, self._hidden_nights = night, hidden_nights
        self._shows_on = np.zeros(len(infested), np.int32)

    def showing(self, number: int) -> NDArray[np.bool_]:
        """Return where an inspection may find something on a day, ``(n,)``."""
        showing: NDArray[np.bool_] = self.infested & (self._shows_on <= number)
        return showing

    def pass_night(self, found: NDArray[np.int32], number: int, key: np.uint64) -> int:
        """Destroy those on the plants found, let the others go on; return how many are new."""
        evening = self.infested.copy()
        evening[found] = False
        self.infested = self._night(self.grid, evening, key)
        new = self.infested & ~evening
        self._shows_on[new] = number + 1 + self._hidden_nights
        return int(np.count_nonzero(new))


class PestInsects:
    """Insects of a pest in its weather: by the night, or hour by hour."""

    def __init__(
        self, grid: PlantGrid, infested: NDArray[np.bool_], pest_in_weather: PestInWeather
    ) -> None:
        self.pest_in_weather = pest_in_weather
        self.colonies = Colonies.grown(grid, pest_in_weather.pest, infested)
        self._hour = 0
        self._hours_of: tuple[int, list[Spell]] = (-1, [])

    @property
    def infested(self) -> NDArray[np.bool_]:
        """Which plants are infested now, ``(n,)``."""
        return self.colonies.infested

    @property
    def by_hour(self) -> bool:
        """Tell whether the pest is simulated hour by hour."""
        return self.pest_in_weather.pest.movement.by_hour

    def showing(self, number: int) -> NDArray[np.bool_]:  # noqa: ARG002 - as the others
        """Return where an inspection may find something now, ``(n,)``."""
        return self.colonies.visible

    def pass_hour(self, found: NDArray[np.int32], number: int, key: np.uint64) -> int:
        """Destroy those on the plants found, let an hour of the day pass; return how many are new.

        Hours that passed so are not passed again at night.
        """
        hours = self._hours(number)
        before = self.colonies.without(found)
        self.colonies = before.after(hours[self._hour], key, self._hour)
        self._hour += 1
        return _new(before, self.colonies)

    def pass_night(self, found: NDArray[np.int32], number: int, key: np.uint64) -> int:
        """Destroy those on the plants found, let the others go on; return how many are new."""
        frame = self.colonies.grid.frame
        self.colonies = self.colonies.without(found)
        spells = [self.pest_in_weather.night(number, frame)]
        if self.by_hour:
            spells = self._hours(number)[self._hour :]
        new, turn = 0, self._hour
        for spell in spells:
            before = self.colonies
            self.colonies = before.after(spell, key, turn)
            new += _new(before, self.colonies)
            turn += 1
        self._hour = 0
        return new

    def _hours(self, number: int) -> list[Spell]:
        """Return the hours of a day, made once."""
        if self._hours_of[0] != number:
            self._hours_of = number, self.pest_in_weather.hours(number, self.colonies.grid.frame)
        return self._hours_of[1]


def _new(before: Colonies, after: Colonies) -> int:
    return int(np.count_nonzero(after.infested & ~before.infested))
