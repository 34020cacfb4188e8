"""How well measured plants stand in the rows that were found, and what is to be doubted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import counted, worded
from fieldmon.plot.row_tracing import beside_their_rows

if TYPE_CHECKING:
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.measured_rows import SaidRows
    from fieldmon.plot.row_detection import Rows

# a plant this part of the row spacing beside its row is off it
_OFF = 0.25
# so many off their rows, or in others than their names say, are worth a word
_WORTH_A_WORD = 0.01
# plants in no rows stray so far from any lines seen in them, in row spacings
_NO_ROWS = 0.2


@dataclass(frozen=True)
class RowReport:
    """How well measured plants stand in rows.

    Parameters
    ----------
    how
        The evidence in words.
    off_m
        How far plants stray from their rows: the root of the mean square.
    off_share
        Share of the plants that stand more than a quarter of the row spacing beside their row.
    in_rows
        Whether they stand in rows at all.
    others_deg
        Other directions in which they stand in rows as well.
    misnamed_share
        Share of the plants that stand in another row than its name says; None without names.
    named
        Whether names decided.
    """

    how: str
    off_m: float
    off_share: float
    in_rows: bool
    others_deg: tuple[float, ...] = ()
    misnamed_share: float | None = None
    named: bool = False

    @property
    def doubts(self) -> tuple[str, ...]:
        """Return a sentence for each thing to be looked at before the rows are used."""
        said = []
        if not self.in_rows:
            said.append(
                "No rows were found: the plants stand anyhow. The lines along which they would "
                "be visited are none of theirs, and aisles between them may not be there. Give "
                "the row bearing, name each plant's row, or draw the rows."
            )
        elif self.off_share >= _WORTH_A_WORD:
            said.append(
                f"{self.off_share:.0%} of the plants stand more than a quarter of the row spacing "
                "beside their row: look at the rows before you use them."
            )
        if self.misnamed_share is not None and self.misnamed_share >= _WORTH_A_WORD:
            decided = "the names decided" if self.named else "rows were found instead"
            said.append(
                f"{self.misnamed_share:.0%} of the plants seem to stand in another row than the "
                f"file names; {decided}. Look whether its rows are named rightly."
            )
        if self.others_deg:
            ways = " and ".join(f"{way:.0f}" for way in self.others_deg)
            said.append(
                f"The plants stand in rows along {ways} degrees as well; the direction with the "
                "longest rows was taken. Give the row bearing if it is another."
            )
        return tuple(said)


def row_report(grid: PlantGrid, found: Rows, said: SaidRows) -> RowReport:
    """Return how well measured plants stand in the rows of their grid."""
    first = grid.side == grid.side[0]
    faces = np.flatnonzero(first[grid.row])
    xy_m, row = grid.xy_m[faces], grid.row_line[grid.row[faces]]
    off_m, alone_m, free = beside_their_rows(xy_m, row)
    decided = said.bearing or said.label is not None or grid.aisles_m is not None
    typical_m = float(np.sqrt(np.sum(off_m**2) / free)) if free > 0 else 0.0
    # what bends was only taken since plants stand in it; of straight lines that is not known
    straight = grid.aisles_m is None and "hardly" in found.how
    scattered = straight or typical_m > _NO_ROWS * grid.row_spacing_m
    n_rows = counted(int(grid.row_line.max()) + 1, "row")
    blocks = f" of {counted(grid.n_blocks, 'block')}" if grid.n_blocks > 1 else ""
    bend = ", as they bend" if grid.aisles_m is not None else ""
    how = worded(
        "{counted} in {n_rows}{blocks}{bend}, {typical_m:.2f} m beside",
        counted=counted(len(faces), "plant"),
        n_rows=n_rows,
        blocks=blocks,
        bend=bend,
        typical_m=typical_m,
    )
    return RowReport(
        f"{how} their lines",
        typical_m,
        float(np.mean(alone_m > _OFF * grid.row_spacing_m)),
        said.label is not None or not scattered,
        () if decided else found.others_deg,
        said.misnamed,
        said.label is not None,
    )
