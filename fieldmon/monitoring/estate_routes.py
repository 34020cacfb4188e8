"""An estate's day as files: a route for each turn, and a table of who is where when."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from fieldmon.io.writers.csv import safe_cell
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.io.writers.file_names import plain_name
from fieldmon.plot.local_clock import grid_clock

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from datetime import datetime

    from fieldmon.planning.route import Route

#: the table's file, beside the routes
TABLE = "plan.csv"
_COLUMNS = ("file", "plot", "who", "from", "to", "plants", "finds_expected", "closed")


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
        """Return when the route ends."""
        return grid_clock(self.route.aisles.grid).after(self.begins, float(self.route.end_s))

    @property
    def notes(self) -> RouteNotes:
        """Return what the route's file says beside it."""
        return RouteNotes(self.plot, self.sampler, self.begins, self.who)


def stems(routes: Iterable[EstateRoute]) -> dict[str, EstateRoute]:
    """Return routes by the names of their files, without the endings."""
    return {f"{k:02d}-{plain_name(one.plot)}": one for k, one in enumerate(routes, start=1)}


def plan_table(
    files: Mapping[str, EstateRoute],
    waiting: Mapping[str, Sequence[str]] = MappingProxyType({}),
    free: Iterable[str] = (),
) -> bytes:
    """Return the table of an estate's day as CSV that a spreadsheet reads.

    Parameters
    ----------
    files
        The routes by the names of their files; those of several formats apart by spaces.
    waiting
        Plots to which nobody goes, and sentences on what is closed there.
    free
        Names of those who have no plot.
    """
    text = io.StringIO()
    table = csv.writer(text)
    table.writerow(_COLUMNS)
    for file, one in files.items():
        hours = (when.isoformat(timespec="seconds") for when in (one.begins, one.ends))
        finds = round(one.route.expected_found, 2)
        names, said = map(safe_cell, (one.plot, one.who)), safe_cell(" ".join(one.closed))
        table.writerow((file, *names, *hours, len(one.route), finds, said))
    table.writerows(
        ("", safe_cell(plot), *[""] * 5, safe_cell(" ".join(said)))
        for plot, said in waiting.items()
    )
    table.writerows(("", "", safe_cell(who), *[""] * 5) for who in free)
    # the mark at the beginning tells a spreadsheet that names may be in any script
    return text.getvalue().encode("utf-8-sig")
