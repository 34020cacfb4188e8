"""A day that is asked for a plant and told what was seen there, whoever keeps it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from numbers import Real
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from fieldmon.compute.arguments import must_be, shown
from fieldmon.errors import ObservationError
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    from fieldmon.plot.grid import PlantGrid

# no working day has so many seconds
_NO_DAY_S = 1e9


class PlantToInspect(NamedTuple):
    """What `MonitorDay.ask` answers: the plant to inspect next.

    Parameters
    ----------
    plant
        Number in the grid, from 0.
    row, number
        Where it stands, as people count, from 1.
    lonlat
        Its position, degrees WGS84.
    arrive_s
        Seconds since the day began, on arrival, as driving and inspecting are charged.
    inspect_s
        Seconds to spend there.
    detects
        Chance that so long an inspection finds what is there.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> stop = fm.Monitor(plot, sampler="naive").day().ask()
    >>> stop.plant, stop.row, stop.number, stop.inspect_s
    (0, 1, 1, 41.13)
    """

    plant: int
    row: int
    number: int
    lonlat: tuple[float, float]
    arrive_s: float
    inspect_s: float
    detects: float

    @property
    def done_s(self) -> float:
        """Seconds since the day began when it is done, as charged."""
        return self.arrive_s + self.inspect_s


def plant_to_inspect(
    grid: PlantGrid, plant: int, arrive_s: float, inspect_s: float, detects: float
) -> PlantToInspect:
    """Return a plant of a grid as it is asked for, with its names and its position."""
    one = np.array([plant])
    numbered, (lon, lat) = plant_numbers(grid, one), grid.lonlat(one)[0].tolist()
    row, number = int(numbered.line[0]), int(numbered.number[0])
    return PlantToInspect(plant, row, number, (lon, lat), arrive_s, inspect_s, detects)


class AskedDay(ABC):
    """A day that is told what was seen at the plant that was asked for; it checks what it is told.

    Parameters
    ----------
    gone_s
        Seconds of the day that are gone when it begins.
    """

    #: told so many seconds later or earlier than charged, the rest of the day is planned anew
    late_s: ClassVar[float]

    def __init__(self, gone_s: float) -> None:
        self._asked: PlantToInspect | None = None
        self._clock_s = gone_s

    def _tell(self, found: bool | None, at_s: float | None) -> None:  # noqa: FBT001 - a result
        """Check what is told, and take it in; see `MonitorDay.tell`."""
        stop = self._asked
        if stop is None:
            raise ObservationError("A plant must be asked for before it is told of. Call ask().")
        if found is not None and not isinstance(found, bool | np.bool_):
            raise ObservationError(
                "What was seen must be True, False, or None where nobody could look, but it is "
                f"{shown(found)}."
            )
        if at_s is not None:
            must_be("A day's clock must be in seconds", at_s, Real, "Give at_s=3600.0.", (bool,))
            if not self._clock_s <= at_s < _NO_DAY_S:
                raise ObservationError(
                    f"The day's clock must go on, and stay below {_NO_DAY_S:,.0f} s since the day "
                    f"began, but it was {self._clock_s:.0f} s and is {shown(at_s)} s."
                )
        now_s = stop.done_s if at_s is None else at_s
        self._take(stop, found, now_s)
        self._asked, self._clock_s = None, now_s
        self._go_on(stop, found, is_late=abs(now_s - stop.done_s) > self.late_s)

    def leave(self) -> None:
        """Go to no plant any more: what was asked for is free for others, where there are any."""
        self._asked = None

    @abstractmethod
    def _take(self, stop: PlantToInspect, found: bool | None, now_s: float) -> None:  # noqa: FBT001
        """Keep what was seen, and when."""

    @abstractmethod
    def _go_on(self, stop: PlantToInspect, found: bool | None, *, is_late: bool) -> None:  # noqa: FBT001
        """Stand at the plant that was told of, and plan what is left anew where that is needed."""
