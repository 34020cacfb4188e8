"""The day's route: stops in order with their times, and the line that is driven."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.array_arguments import must_hold_shapes
from fieldmon.compute.arrays import as_seen
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import counted
from fieldmon.planning.bound_wording import bound_sentence
from fieldmon.plot.passing import legs_of
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from geopandas import GeoDataFrame
    from numpy.typing import NDArray
    from shapely import LineString

    from fieldmon.infestation.forecast import Forecast
    from fieldmon.io.writers.day_file import RouteNotes
    from fieldmon.planning.workday import Workday
    from fieldmon.plot.travel import Aisles
    from fieldmon.samplers.base import Scene


@checked
@dataclass(frozen=True, eq=False)
class Route:
    """A day's route, as it is driven.

    Parameters
    ----------
    aisles
        The plot it runs through.
    plant
        ``(k,)`` int32 plants in order.
    arrive_s, leave_s
        ``(k,)`` seconds since the start of the route.
    chance, detects
        ``(k,)`` believed chance of infestation that can be seen at each stop, and chance to find
        what is there.
    line_m
        ``(m, 2)`` the driven line, metres of the plot's frame. It crosses no row of plants.
    line_stop
        ``(k,)`` the vertex of the line at which each stop is made.
    line_s
        ``(m,)`` seconds since the start at each vertex on arrival.
    end_s
        Seconds at the end of the line.
    notes
        Plot, sampler and start, for files; None: files say nothing of them.
    found_bound
        What no route of these hours can expect to find, see `fieldmon.planning.day_bound`; None:
        it is not known.
    stop_s
        Seconds at each stop that are charged for stopping; the others are for looking.
    infested
        ``(k,)`` believed chance of infestation, where some of it cannot be seen; None: all can.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> route = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1)).route
    >>> route.end_s <= 3600.0, route.line_m.shape[1], len(route.plant) == len(route)
    (True, 2, True)
    """

    aisles: Aisles
    plant: NDArray[np.int32]
    arrive_s: NDArray[np.float64]
    leave_s: NDArray[np.float64]
    chance: NDArray[np.float64]
    detects: NDArray[np.float64]
    line_m: NDArray[np.float64]
    line_stop: NDArray[np.int64]
    line_s: NDArray[np.float64]
    end_s: float
    notes: RouteNotes | None = None
    found_bound: float | None = None
    stop_s: float = 0.0
    infested: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        must_hold_kinds(self, "A route's")
        k, m = self.plant.size, len(self.line_m)
        stops = ("plant", "arrive_s", "leave_s", "chance", "detects", "line_stop")
        shapes = dict.fromkeys(stops, (k,)) | {"line_m": (m, 2), "line_s": (m,)}
        if self.infested is not None:
            shapes["infested"] = (k,)
        must_hold_shapes(self, "A route's", shapes)
        for name in shapes:
            if (values := getattr(self, name)).flags.writeable:
                object.__setattr__(self, name, as_seen(values))

    def __repr__(self) -> str:
        length_km, hours = self.drive_m / 1000, self.end_s / 3600
        return f"<Route: {counted(len(self), 'stop')}, {length_km:.2f} km, {hours:.2f} h>"

    def __len__(self) -> int:
        """Return the number of stops."""
        return len(self.plant)

    @cached_property
    def drive_m(self) -> float:
        """Length of the driven line."""
        return float(np.hypot(*np.diff(self.line_m, axis=0).T).sum())

    @property
    def believed(self) -> NDArray[np.float64]:
        """Believed chance of infestation at each stop, ``(k,)``, as the map has it."""
        return self.chance if self.infested is None else self.infested

    @property
    def expected_visible(self) -> float:
        """Infested plants on the route that can be seen, as believed; not all would be found."""
        return float(self.chance.sum())

    @property
    def expected_finds(self) -> float:
        """Infested plants that would be found on the route, as believed."""
        return float((self.chance * self.detects).sum())

    @property
    def bound_sentence(self) -> str:
        """Return for people what is expected, and what no other route can exceed; "" if unknown."""
        if self.found_bound is None:
            return ""
        return bound_sentence(self.expected_finds, self.found_bound)

    @cached_property
    def ways_said(self) -> tuple[str, ...]:
        """Return for people what cannot be reached, and where the route leaves the plot."""
        return self.aisles.said_of(self.line_m)

    def line_lonlat(self) -> NDArray[np.float64]:
        """Return the driven line in degrees, ``(m, 2)``."""
        return self.aisles.grid.frame.lonlat(self.line_m)

    def stops_lonlat(self) -> NDArray[np.float64]:
        """Return the plants' own positions in degrees, ``(k, 2)``."""
        return self.aisles.grid.lonlat(self.plant)

    @property
    def line(self) -> LineString:
        """Return the driven line in degrees; empty where there is no stop."""
        from shapely import LineString  # noqa: PLC0415 - not needed to plan

        return LineString(self.line_lonlat())

    def to_file(self, path: str | Path, as_format: str | None = None) -> tuple[Path, ...]:
        """Write the route for whoever drives; return the files written, the main one first.

        Parameters
        ----------
        path
            Its ending tells the format: ``.geojson``, ``.gpx``, ``.kml``, ``.gpkg``, ``.zip``
            (shapefile), ``.csv``, ``.nav2.geojson``, ``.yaml``, ``.html`` (a sheet to print).
        as_format
            The format's name where the ending tells none, see `fieldmon.io.writers.FORMATS`.

        Raises
        ------
        SettingError
            If there is no such format.
        FileProblem
            If a file cannot be written; each appears whole or not at all.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> day = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1))
        >>> [file.name for file in day.route.to_file("day.gpx")]
        ['day.gpx']
        """
        from fieldmon.io.writers import HandoffPlan, write_handoff  # noqa: PLC0415 - as above
        from fieldmon.io.writers.day_file import RouteNotes  # noqa: PLC0415

        return write_handoff(HandoffPlan(self, self.notes or RouteNotes("", "")), path, as_format)

    def to_geopandas(self) -> GeoDataFrame:
        """Return the stops in order, a point each at its plant, EPSG:4326.

        Columns ``plant`` (number in the grid, from 0), ``row`` and ``number`` (from 1),
        ``arrive_s``, ``leave_s`` (seconds since the start), ``chance``; the index is the order,
        from 1. The driven line is `line`.

        Examples
        --------
        >>> import fieldmon as fm
        >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
        >>> stops = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1)).route.to_geopandas()
        >>> list(stops.columns)
        ['plant', 'row', 'number', 'arrive_s', 'leave_s', 'chance', 'geometry']
        """
        from fieldmon.plot.frames import plant_frame  # noqa: PLC0415 - as above

        stops = plant_frame(self.aisles.grid, self.plant)
        after = stops.columns.get_loc("number") + 1
        columns = {"arrive_s": self.arrive_s, "leave_s": self.leave_s, "chance": self.believed}
        for place, (name, values) in enumerate(columns.items(), after):
            stops.insert(place, name, values)
        stops.index = stops.index.__class__(range(1, len(self) + 1), name="order")
        return stops


def route_of(scene: Scene, work: Workday) -> Route:
    """Return the route of a working day that began as `scene` says.

    Its seconds are those the workday charged; its line is the one whose length they were charged
    for, leg by leg: from where the robot stands to each stop, and back to the gate if it returns.
    """
    leave_s = work.arrive_s + work.stop_s
    line_m, leg_end = _line(scene, work)
    arrivals = np.append(work.arrive_s, work.end_s)[: len(leg_end)]
    line_m, leg_end, line_s = _timed(scene, work, (line_m, leg_end), arrivals)
    return Route(
        aisles=scene.aisles,
        plant=work.plant,
        arrive_s=work.arrive_s,
        leave_s=leave_s,
        chance=scene.chance[work.plant],
        detects=work.detects,
        line_m=line_m,
        line_stop=leg_end[: len(work)],
        line_s=line_s,
        end_s=work.end_s,
        stop_s=scene.robot.stop_s,
        infested=None if scene.infested is None else scene.infested[work.plant],
    )


def with_forecast(route: Route, ahead: Callable[[], Forecast]) -> Route:
    """Return a route whose files say how many plants are infested on the next mornings."""
    if route.notes is None:
        return route
    return replace(route, notes=replace(route.notes, ahead=ahead))


def _line(scene: Scene, work: Workday) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the driven line ``(m, 2)`` and the vertex at which each of its l legs ends."""
    if not len(work):
        return np.empty((0, 2)), np.empty(0, np.int64)
    back = [GATE] if scene.robot.returns else []
    places = np.concatenate([[scene.at], work.plant, back]).astype(np.int64)
    line_m, leg_end = scene.aisles.line(places)
    return line_m, leg_end


def _timed(
    scene: Scene,
    work: Workday,
    line: tuple[NDArray[np.float64], NDArray[np.int64]],
    arrive_s: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Return the line, where its legs end, and the seconds at each vertex on arrival.

    Where one waits for others, a vertex is there twice: on coming to the end of the aisle (or at
    the gate), and on driving on.
    """
    line_m, leg_end = line
    depart_s = np.append(0.0, work.arrive_s + work.stop_s)[: len(leg_end)]
    if work.wait_s is None or not work.wait_s.any():
        return line_m, leg_end, _seconds(line_m, leg_end, depart_s, arrive_s)
    wait_s = work.wait_s[: len(leg_end)]
    line_s = _seconds(line_m, leg_end, depart_s, arrive_s - wait_s)
    places = [scene.at, *work.plant.tolist(), GATE]
    for leg in np.flatnonzero(wait_s)[::-1].tolist():
        first, end = int(leg_end[leg - 1]) if leg else 0, int(leg_end[leg])
        way_m = np.append(0.0, np.cumsum(np.hypot(*np.diff(line_m[first : end + 1], axis=0).T)))
        out_m = legs_of(scene.aisles).leg(places[leg], places[leg + 1]).out_m
        v = first + 1 + int(np.searchsorted(way_m[1:-1], out_m, "right"))
        here = np.array([np.interp(out_m, way_m, line_m[first : end + 1, k]) for k in range(2)])
        begin_s = depart_s[leg] if leg else 0.0
        drive_s = arrive_s[leg] - wait_s[leg] - begin_s
        now_s = begin_s + drive_s * (out_m / way_m[-1] if way_m[-1] else 0.0)
        line_m = np.insert(line_m, [v, v], here, axis=0)
        line_s = np.insert(line_s, [v, v], now_s)
        line_s[v + 1 : end + 3] += wait_s[leg]
        leg_end = np.where(np.arange(len(leg_end)) >= leg, leg_end + 2, leg_end)
    return line_m, leg_end, line_s


def _seconds(
    line_m: NDArray[np.float64],
    leg_end: NDArray[np.int64],
    depart_s: NDArray[np.float64],
    arrive_s: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the seconds on arrival at each vertex, at even speed within each leg."""
    if not len(leg_end):
        return np.empty(0)
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(line_m, axis=0).T)))
    leg_start = np.append(0, leg_end[:-1])
    leg = np.repeat(np.arange(len(leg_end)), leg_end - leg_start)
    length = (way[leg_end] - way[leg_start])[leg]
    gone = way[1:] - way[leg_start][leg]
    share = np.divide(gone, length, out=np.ones_like(gone), where=length > 0)
    return np.append(depart_s[0], depart_s[leg] + share * (arrive_s - depart_s)[leg])
