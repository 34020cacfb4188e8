"""What comes of files: a plot that is ready, or all plots of a file, and what is said of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.infestation.records import Records
from fieldmon.io.import_report import ImportMessage, doubtful
from fieldmon.io.readers.crews import Crew
from fieldmon.io.readers.nearby import records_on_plot

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray
    from shapely import MultiLineString

    from fieldmon.io.plot_request import (
        Role,
    )
    from fieldmon.plot.assumed import Assumed
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.plot import Plot


@dataclass(frozen=True)
class SourceMessage:
    """One thing that the import of a file has to say.

    Parameters
    ----------
    role
        What the file is to the plot: whose option or button answers.
    source
        The file's name.
    message
        What there is to say.
    """

    role: Role
    source: str
    message: ImportMessage


@dataclass(frozen=True, eq=False)
class Laid:
    """A plot with its plants, what had to be assumed for them, and what is said of its rows."""

    plot: Plot

    @property
    def assumed(self) -> tuple[Assumed, ...]:
        """Return what nobody said of its rows."""
        return self.plot.assumed

    @property
    def messages(self) -> tuple[ImportMessage, ...]:
        """Return how measured plants stand in rows, and what is doubtful about it."""
        from fieldmon.io.import_report import seen  # noqa: PLC0415
        from fieldmon.plot.plant_names import said_of_numbers  # noqa: PLC0415

        if not self.plot.grid.in_rows:
            said = worded("Plants are taken to stand in no rows, and are visited by nearness.")
            return (seen(said),)
        rows, drawn = self.plot.rows, self.plot.field.row_lines
        if rows is None and self.plot.field.plants is None and len(drawn.geoms) > 1:
            return (seen(_along_drawn(self.plot.grid, drawn)),)
        if rows is None:
            return ()
        found = (seen(worded("Rows were found: {how}.", how=rows.how)),) if rows.in_rows else ()
        numbers = (seen(sentence) for sentence in said_of_numbers(self.plot.grid))
        return (*found, *numbers, *(doubtful(sentence) for sentence in self.plot.doubts))


def _along_drawn(grid: PlantGrid, drawn: MultiLineString) -> str:
    """Return along how many of the rows that were drawn plants stand."""
    lines = shapely.STRtree(shapely.get_parts(grid.frame.geometry_m(drawn)))
    n = len(np.unique(lines.nearest(shapely.points(grid.xy_m))))
    if n == len(drawn.geoms):
        return worded("Plants stand along the {n} rows that were drawn.", n=n)
    return worded(
        "Plants stand along {n} of the {all} rows that were drawn: the others have no room on the "
        "plot.",
        n=n,
        all=len(drawn.geoms),
    )


@dataclass(frozen=True, eq=False)
class Prepared:
    """A plot that is ready to be planned, simulated or begun a season on.

    Parameters
    ----------
    plot
        The plot, without the plants that are missing.
    records
        The records on it or near it.
    risk
        ``(n,)`` risk of its plants from a raster, NaN where that says nothing; None without one.
    messages
        What the imports had to say, in order.
    assumed
        What nobody said.
    """

    plot: Plot
    records: Records
    risk: NDArray[np.float64] | None
    messages: tuple[SourceMessage, ...]
    assumed: tuple[Assumed, ...]


@dataclass(frozen=True, eq=False)
class EstateRecords:
    """The records of several plots.

    Parameters
    ----------
    anywhere
        Those that belong to a plot by their position.
    named
        Those that name a plot's rows and plants, by the plot's name; empty where records do not.
    """

    anywhere: Records = field(default_factory=Records.none)
    named: Mapping[str, Records] = field(default_factory=dict)

    def candidates(self, name: str) -> Records:
        """Return the records among which those of a plot are."""
        return self.named.get(name, self.anywhere)

    def on(self, plot: Field) -> Records:
        """Return the records on a plot or near it; there may be none."""
        return records_on_plot(self.candidates(plot.name), plot)


@dataclass(frozen=True, eq=False)
class Estate:
    """Every plot of a file.

    Parameters
    ----------
    fields
        The plots, with their paths.
    crews
        Who works on each, by name, as the file says.
    records
        The records of all of them.
    messages
        What the imports had to say, in order.
    """

    fields: tuple[Field, ...]
    crews: Mapping[str, Crew]
    records: EstateRecords
    messages: tuple[SourceMessage, ...]

    def crew(self, field: Field) -> Crew:
        """Return who works on a plot."""
        return self.crews.get(field.name, Crew())


class Listener(Protocol):
    """Hears what there is to say while files are read, be a later one of no use or not."""

    def message(self, said: SourceMessage, /) -> None:
        """Hear what an import has to say."""

    def laid(self, laid: Laid, /) -> None:
        """Hear of the plot, before its records are read."""
