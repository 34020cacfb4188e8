"""An estate's day: a route for each turn, what is closed, who is free; and all of it as files."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.units import Units
from fieldmon.compute.wording import worded
from fieldmon.io.writers.csv import safe_cell
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.io.writers.file_names import plain_name
from fieldmon.monitoring.days.estate_day import EstateTurn
from fieldmon.monitoring.treating.closures import closed_in_words
from fieldmon.plot.local_clock import grid_clock
from fieldmon.plot.projection import GEOD

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from datetime import datetime

    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.monitoring.days.estate_day import EstatePlot, SharedEstate
    from fieldmon.planning.members import TeamMember
    from fieldmon.planning.plan import DayPlan
    from fieldmon.planning.route import Route
    from fieldmon.samplers.base import Scene

    Float = NDArray[np.float64]

#: the table's file, beside the routes
PLAN_TABLE = "plan.csv"
#: faster than this nobody goes from plot to plot
MOST_KM_H = 60.0
_COLUMNS = ("file", "plot", "who", "from", "to", "plants", "finds_expected", "closed", "left_out")


@dataclass(frozen=True, eq=False)
class EstateRoute:
    """A turn of an estate's day, ready to be handed out.

    Parameters
    ----------
    plot, who
        Names of the plot and of who works there.
    begins
        Local time.
    route
        What they drive or walk.
    sampler
        Who chose the plants.
    closed
        Sentences on what is left off, as people may not be there.
    """

    plot: str
    who: str
    begins: datetime
    route: Route
    sampler: str
    closed: Sequence[str] = ()

    @property
    def ends(self) -> datetime:
        """Return when the route ends, to the second that its file says."""
        return grid_clock(self.route.aisles.grid).after(self.begins, round(self.route.end_s))

    @property
    def plants(self) -> int:
        """Return how many plants are inspected: both faces of one are one."""
        return len(np.unique(self.route.aisles.grid.vine[self.route.plant]))

    @property
    def notes(self) -> RouteNotes:
        """Return what the route's file says beside it."""
        return RouteNotes(self.plot, self.sampler, self.begins, self.who)


@dataclass(frozen=True, eq=False)
class NamedPlot:
    """A plot of an estate's day as it is called, its sampler's name, and how dates are said."""

    name: str
    sampler: str
    known: EstatePlot
    units: Units = field(default_factory=Units)


@dataclass(frozen=True)
class PlotLeftOut:
    """A plot to which nobody goes that day: why, and sentences on what is closed there."""

    plot: str
    why: str
    closed: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class EstateRoutes:
    """What comes of a shared day.

    Parameters
    ----------
    turns
        Those with a stop or more, with their routes, in the order of who works.
    closed
        Of each plot, sentences on what is left off, as people may not be there.
    left_out
        The plots to which nobody goes.
    free
        Names of those who have no plot.
    """

    turns: tuple[tuple[EstateTurn, EstateRoute], ...]
    closed: tuple[tuple[str, ...], ...]
    left_out: tuple[PlotLeftOut, ...]
    free: tuple[str, ...]


def walked(
    shared: SharedEstate,
    plots: Sequence[NamedPlot],
    members: Sequence[TeamMember],
    plan: Callable[[EstateTurn], DayPlan] = EstateTurn.plan,
    said: Callable[[Worded], str] = str,
) -> EstateRoutes:
    """Return the routes of a day that was shared between plots, and what else comes of it.

    Parameters
    ----------
    shared, plots, members
        As shared, and of what, and between whom.
    plan
        Plans a turn.
    said
        Says a sentence in the language of who reads it.
    """
    closed = tuple(
        tuple(map(said, closed_in_words(some, one.known.scene.grid, one.units)))
        for one, some in zip(plots, shared.closed, strict=True)
    )
    turns = []
    for turn in shared.turns:
        if len(route := plan(turn).route):
            plot, who = plots[turn.plot], members[turn.who].name
            sentences = closed[turn.plot]
            made = EstateRoute(plot.name, who, turn.begins, route, plot.sampler, sentences)
            turns.append((turn, made))
    there, busy = {turn.plot for turn, _ in turns}, {turn.who for turn, _ in turns}
    return EstateRoutes(
        tuple(turns), closed,
        tuple(
            PlotLeftOut(one.name, said(_why(one.known.scene, closed[k])), closed[k])
            for k, one in enumerate(plots)
            if k not in there
        ),
        tuple(one.name for k, one in enumerate(members) if k not in busy),
    )  # fmt: skip


def too_far(
    routes: Iterable[EstateRoute], move_s: float, units: Units | None = None
) -> list[Worded]:
    """Return a sentence for each way to the next plot that is too far for the time it is given.

    Parameters
    ----------
    routes
        Of a day, of whoever works.
    move_s
        What going from one plot to the next takes.
    units
        Write the distance, which is from gate to gate in a straight line.
    """
    written, own, said = units or Units(), dict[str, list[EstateRoute]](), []
    for one in routes:
        own.setdefault(one.who, []).append(one)
    for some in own.values():
        for first, then in pairwise(sorted(some, key=lambda one: one.begins)):
            (lon, to_lon), (lat, to_lat) = np.concatenate([_gate(first), _gate(then)]).T.tolist()
            away_m = GEOD.inv(lon, lat, to_lon, to_lat)[2]
            if away_m > MOST_KM_H / 3.6 * move_s:
                said.append(
                    worded(
                        "From {first} to {then} it is {away} in a straight line, more than "
                        "{minutes:g} minutes allow at {most:g} km/h: give more time from plot to "
                        "plot.",
                        first=first.plot, then=then.plot, away=written.metres(away_m),
                        minutes=move_s / 60.0, most=MOST_KM_H,
                    )
                )  # fmt: skip
    return said


def _gate(one: EstateRoute) -> Float:
    """Return the gate of a route's plot as lon/lat ``(1, 2)``."""
    aisles = one.route.aisles
    return aisles.grid.frame.lonlat(aisles.gate_m)


def _why(scene: Scene, closed: Sequence[str]) -> Worded:
    """Return why nobody goes to a plot that shares a day."""
    if closed:
        return worded("closed to people")
    if (scene.last_inspected == scene.day).all():
        return worded("all of it was inspected today")
    return worded("no time")


def stems(routes: Iterable[EstateRoute]) -> dict[str, EstateRoute]:
    """Return routes by the names of their files, without the endings."""
    return {f"{k:02d}-{plain_name(one.plot)}": one for k, one in enumerate(routes, start=1)}


def plan_table(
    files: Mapping[str, EstateRoute],
    left_out: Iterable[PlotLeftOut] = (),
    free: Iterable[str] = (),
) -> bytes:
    """Return the table of an estate's day as CSV that a spreadsheet reads.

    Parameters
    ----------
    files
        The routes by the names of their files; those of several formats apart by spaces.
    left_out
        Plots to which nobody goes.
    free
        Names of those who have no plot.
    """
    text = io.StringIO()
    table = csv.writer(text)
    table.writerow(_COLUMNS)
    for file, one in files.items():
        hours = (when.isoformat(timespec="seconds") for when in (one.begins, one.ends))
        finds = round(one.route.expected_finds, 2)
        names, said = map(safe_cell, (one.plot, one.who)), safe_cell(" ".join(one.closed))
        table.writerow((file, *names, *hours, one.plants, finds, said, ""))
    table.writerows(
        ("", safe_cell(one.plot), *[""] * 5, *map(safe_cell, (" ".join(one.closed), one.why)))
        for one in left_out
    )
    table.writerows(("", "", safe_cell(who), *[""] * 6) for who in free)
    # the mark at the beginning tells a spreadsheet that names may be in any script
    return text.getvalue().encode("utf-8-sig")
