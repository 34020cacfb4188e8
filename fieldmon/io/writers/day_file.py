"""What is handed off: a route with its stops, as every format tells of them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol
from xml.etree import ElementTree as ET

import numpy as np

from fieldmon.compute.wording import PAPER_IN_ENGLISH, PaperLanguage, worded
from fieldmon.plot.grid import block_number, plant_numbers
from fieldmon.plot.local_clock import grid_clock

if TYPE_CHECKING:
    from collections.abc import Callable
    from datetime import datetime

    from numpy.typing import NDArray

    from fieldmon.infestation.forecast import Forecast
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.travel import Aisles

    Floats = NDArray[np.float64]

#: decimals of a degree in every file: about a millimetre
DECIMALS = 8

# what XML 1.0 cannot hold, not even escaped, and no other format wants
_NO_TEXT = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


class Stop(NamedTuple):
    """One stop, in numbers and words that stand in files.

    ``order``, ``block``, ``row``, ``number`` and ``face`` count from 1; ``plant`` is the plant's
    number in the grid, from 0. ``row_name`` is what the plot's file calls the row, where that is
    more than its number. ``vertex`` tells where on the driven line the robot stands, ``detects``
    how likely it sees an infested plant there. ``inspect_s`` is all that is charged there,
    ``look_s`` what is left of it for looking.
    """

    order: int
    plant: int
    row: int
    number: int
    face: int
    lon: float
    lat: float
    arrive: str
    arrive_s: float
    inspect_s: float
    chance: float
    vertex: int
    block: int
    row_name: str
    detects: float
    look_s: float

    @property
    def plant_label(self) -> str:
        """Return the plant's number in its row, with its face where it has two: ``17``, ``17b``."""
        return f"{self.number}{'ab'[self.face - 1] if self.face else ''}"

    @property
    def label(self) -> str:
        """Return a short name that a handheld shows, and that reads back: ``012 R3/17``.

        Or with the row's name: ``012 R101·5A/17``.
        """
        name = "_".join(self.row_name.replace("/", " ").split())
        row = f"R{self.row}{name and f'·{name}'}/" if self.row else ""
        return f"{self.order:03d} {row}{self.plant_label}"


class DrivenRoute(Protocol):
    """What files tell of a route; see `fieldmon.planning.route.Route`, which is one."""

    @property
    def aisles(self) -> Aisles:
        """Return the plot it runs through."""
        ...

    @property
    def plant(self) -> NDArray[np.int32]:
        """Return plants in order, ``(k,)``."""
        ...

    @property
    def arrive_s(self) -> Floats:
        """Return seconds since the start on arrival at each, ``(k,)``."""
        ...

    @property
    def leave_s(self) -> Floats:
        """Return seconds since the start on leaving each, ``(k,)``."""
        ...

    @property
    def believed(self) -> Floats:
        """Return believed chance of infestation at each stop, ``(k,)``."""
        ...

    @property
    def detects(self) -> Floats:
        """Return chance at each stop that an infested plant is seen, ``(k,)``."""
        ...

    @property
    def line_m(self) -> Floats:
        """Return the driven line, metres of the plot's frame, ``(m, 2)``."""
        ...

    @property
    def line_stop(self) -> NDArray[np.int64]:
        """Return vertex of the line at which each stop is made, ``(k,)``."""
        ...

    @property
    def line_s(self) -> Floats:
        """Return seconds since the start at each vertex of the line, ``(m,)``."""
        ...

    @property
    def end_s(self) -> float:
        """Return seconds at the end of the line."""
        ...

    @property
    def stop_s(self) -> float:
        """Return the seconds at each stop that are charged for stopping."""
        ...

    @property
    def drive_m(self) -> float:
        """Return length of the driven line."""
        ...

    @property
    def expected_visible(self) -> float:
        """Return infested plants on the route that can be seen, as believed."""
        ...

    @property
    def expected_finds(self) -> float:
        """Return infested plants that would be found on the route, as believed."""
        ...

    @property
    def found_bound(self) -> float | None:
        """Return what no route of these hours can expect to find; None if it is not known."""
        ...

    @property
    def bound_sentence(self) -> str:
        """Return for people what is expected and what no other route can exceed, or ""."""
        ...

    def __len__(self) -> int:
        """Return the number of stops."""
        ...

    def line_lonlat(self) -> Floats:
        """Return the driven line in degrees, ``(m, 2)``."""
        ...

    def stops_lonlat(self) -> Floats:
        """Return the plants' own positions in degrees, ``(k, 2)``."""
        ...


@dataclass(frozen=True)
class RouteNotes:
    """What a route file says beside the route.

    Parameters
    ----------
    plot
        The plot's name.
    sampler
        Who chose the plants.
    start
        Local date and time of the start, or None: only seconds are given then. Later times are
        what the clock on the plot shows, though it be put forward or back.
    who
        Who of a team drives it; None: it is the only one.
    ahead
        Returns how many plants are infested on the next mornings, asked by GeoJSON alone (a second
        of work on a large plot); None: it is not known.
    language
        In which a sheet to print is written.
    """

    plot: str
    sampler: str
    start: datetime | None = None
    who: str | None = None
    ahead: Callable[[], Forecast] | None = None
    language: PaperLanguage = PAPER_IN_ENGLISH


@dataclass(frozen=True, eq=False)
class HandoffPlan:
    """A planned day, ready to be handed to whoever inspects.

    Parameters
    ----------
    route
        Stops in order with their times, the driven line, and the plants it belongs to. How long
        the robot pauses at a plant is its ``leave_s - arrive_s``.
    notes
        Name of the plot, who chose the plants, local date and time of the start.
    """

    route: DrivenRoute
    notes: RouteNotes

    @property
    def grid(self) -> PlantGrid:
        """Return the plants."""
        return self.route.aisles.grid

    @property
    def title(self) -> str:
        """Return what to call the day: the plot, and date and member where they are known."""
        start, who = self.notes.start, self.notes.who
        title = self.notes.plot if start is None else f"{self.notes.plot} {start:%F}"
        return plain_text(title if who is None else f"{title} {who}")

    @property
    def bound(self) -> str:
        """Return what is expected and what no other route can exceed, in a sentence, or ""."""
        return self.route.bound_sentence

    @property
    def has_faces(self) -> bool:
        """Return whether both faces of a plant are inspected, each for itself."""
        return self.grid.has_faces

    @property
    def has_blocks(self) -> bool:
        """Return whether the plot has several blocks."""
        return self.grid.n_blocks > 1

    @property
    def in_rows(self) -> bool:
        """Return whether plants stand in rows."""
        return self.grid.in_rows

    @property
    def has_row_names(self) -> bool:
        """Return whether the plot's file calls a row otherwise than by its number."""
        return self.in_rows and bool(self.grid.row_names)

    @cached_property
    def stops(self) -> tuple[Stop, ...]:
        """Stops in order; ``face`` is 0 where plants have but one, ``row`` where there are none."""
        route = self.route
        numbered, there_s = plant_numbers(self.grid, route.plant), route.leave_s - route.arrive_s
        lonlat = route.stops_lonlat().round(DECIMALS)
        columns = zip(
            range(1, len(route) + 1),
            route.plant.tolist(),
            (numbered.line if self.in_rows else np.zeros_like(numbered.line)).tolist(),
            numbered.number.tolist(),
            faces(self.grid, route.plant).tolist(),
            lonlat[:, 0].tolist(),
            lonlat[:, 1].tolist(),
            [self.clock(s) for s in route.arrive_s.tolist()],
            np.round(route.arrive_s, 3).tolist(),
            np.round(there_s, 3).tolist(),
            np.round(route.believed, 6).tolist(),
            route.line_stop.tolist(),
            block_number(self.grid, route.plant).tolist(),
            [plain_text(self.grid.row_names.get(line, "")) for line in numbered.line.tolist()],
            np.round(route.detects, 6).tolist(),
            np.round(np.maximum(there_s - route.stop_s, 0.0), 3).tolist(),
            strict=True,
        )
        return tuple(Stop(*values) for values in columns)

    @cached_property
    def line_lonlat(self) -> NDArray[np.float64]:
        """Driven line in degrees, ``(m, 2)``."""
        return self.route.line_lonlat().round(DECIMALS)

    @property
    def begins(self) -> datetime | None:
        """Return the start as a moment that names its zone; None: the one or the other is unknown.

        The zone is the plot's where the start names none.
        """
        start, clock = self.notes.start, grid_clock(self.grid)
        if start is None or start.tzinfo is not None:
            return start
        return clock.moment(start.date(), start.time()) if clock.zone else None

    def clock(self, seconds: float) -> str:
        """Return date and local time so many seconds after the start; empty if it is not known."""
        start = self.notes.start
        if start is None:
            return ""
        return grid_clock(self.grid).after(start, round(seconds)).isoformat()


def faces(grid: PlantGrid, plants: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return 1 or 2 for the face of each plant ``(k,)``, 0 where it has but one."""
    twin = grid.twin[plants]
    return np.where(twin < 0, 0, np.where(plants < twin, 1, 2)).astype(np.int64)


def with_face(grid: PlantGrid, plant: int, number: int) -> str:
    """Return a plant's number in its row, with the face where it has two, for a sentence."""
    (face,) = faces(grid, np.array([plant])).tolist()
    return of_face(number, face)


def of_face(number: int, face: int) -> str:
    """Return a plant's number in its row with its face, 1 or 2; 0: it has but one."""
    return worded("{number}, face {face}", number=number, face=face) if face else str(number)


def plain_text(text: str) -> str:
    """Return text without the control characters that XML and tables cannot hold."""
    return _NO_TEXT.sub(" ", text)


def add_text(parent: ET.Element, tag: str, text: str) -> None:
    """Add an element of XML that holds a text."""
    ET.SubElement(parent, tag).text = plain_text(text)


def pieces(n: int, most: int) -> list[slice]:
    """Cut ``n`` points of a line into runs of at most `most`, each begun by the last one's end."""
    if n < 2:
        return [slice(0, n)] if n else []
    return [slice(first, min(first + most, n)) for first in range(0, n - 1, most - 1)]
