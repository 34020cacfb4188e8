"""How well measured plants stand in the rows that were found, and what is to be doubted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import Worded, counted, worded
from fieldmon.plot.crossed_rows import CrossedRows, crossed_rows
from fieldmon.plot.measured_rows import LEAST_TRACED, nearer_share
from fieldmon.plot.planting import Planting
from fieldmon.plot.row_detection import NO_ROWS
from fieldmon.plot.strands import row_deviations

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.measured_rows import SaidRows
    from fieldmon.plot.row_detection import RowDirection, Rows

    Float = NDArray[np.float64]

# a plant this part of the row spacing beside its row is off it
_OFF = 0.25
# so many off their rows, or in others than their names say, are worth a word
_WORTH_A_WORD = 0.01
# so much nearer to one other than to a third, a plant is in a pair; so many are worth a word
_CLOSE, _PAIRED, _FEW = 0.6, 0.4, 6
# where so many have a third as near as that one, give or take, some of a line are missing instead
_AS_NEAR, _IN_LINE = 1.25, 0.1
# pairs along their rows have gaps of one size between them, so many at least; where some of a line
# are missing, gaps are of many, and of a few nobody can tell
_ALIKE, _FEW_GAPS = 0.6, 6
# plants of a double row stand about as far from its middle, much unlike plants that stray, and
# mostly by turns: the greatest spread of how far, the least share of changes of side, the least
# distance and the least number
_EVEN, _BY_TURNS, _LEAST_M, _MANY = 0.55, 0.65, 0.05, 20
# a spacing that was said is the measured one if it is off by so much at most
_AS_SAID = 0.1
# rows are double rows where gaps between them are of two kinds, one so much narrower
_NARROW, _RARE = 0.5, 0.25
# rows that bend may be traced along another direction where plants stand nearly as far apart in
# them as the rows are
_SQUARE = 0.58
# plants of rows that have nothing to do with each other stand a quarter of a spacing off level
_LEVEL = 0.15
# where so many plants are nearer to another row than to their own, and not all, rows may run
# another way in a part of the plot
_PART, _LEFT = 0.15, 0.005
# lines so straight were laid out by a program, and nobody said which way rows run
_EXACT_M = 0.005
# so many plants are asked for the nearest one of another row, among so many about them
_ASKED, _NEAR = 5000, 6
_NOT_CROSSED = CrossedRows()


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
    directions
        Every direction in which they stand in rows, the one taken first; empty where there is one
        only, or where a bearing or names decided.
    misnamed_share
        Share of the plants that stand in another row than its name says; None without names.
    named
        Whether names decided.
    of_trial
        Whether the blocks that plants name run through rows, and were left aside.
    paired_share
        Share of the plants that stand much nearer to one other than to any third.
    zigzag_m, zigzag_share
        How far to the left and right of their row plants stand by turns, as in staggered double
        rows, and how many of them; 0 where they do not.
    gaps_m
        How far apart rows are by turns, as in double rows; None where they are not.
    nearly_square_m
        How far apart rows are, and plants in them, where that is nearly as far, and rows that bend
        could run another way; else None.
    rows_said_m, plants_said_m
        How far apart rows, and plants in them, were said to be, and are; None: nobody said
        another distance.
    strayed
        Which plants stand amid another row than they name; empty: none.
    nearer_share
        Share of the plants that stand much nearer to one of another row than to those of their own.
    crossed
        Plants in line with a row that runs across theirs.
    exact
        Whether plants stand exactly in lines, and nobody said which way rows run.
    """

    how: str
    off_m: float
    off_share: float
    in_rows: bool
    directions: tuple[RowDirection, ...] = ()
    misnamed_share: float | None = None
    named: bool = False
    of_trial: bool = False
    paired_share: float = 0.0
    zigzag_m: float = 0.0
    zigzag_share: float = 0.0
    gaps_m: tuple[float, float] | None = None
    nearly_square_m: tuple[float, float] | None = None
    rows_said_m: tuple[float, float] | None = None
    plants_said_m: tuple[float, float] | None = None
    nearer_share: float = 0.0
    strayed: str = ""
    crossed: CrossedRows = _NOT_CROSSED
    exact: bool = False

    @property
    def doubts(self) -> tuple[str, ...]:
        """Return a sentence for each thing to be looked at before the rows are used."""
        return (
            *self._off_rows(), *self._names(), *self._double_plants(), *self._double_rows(),
            *self._other_ways(), *self._other_spacings(),
        )  # fmt: skip

    @property
    def may_be_mixed(self) -> tuple[str, ...]:
        """Return what may be why no way leads to some rows: the gravest of these doubts alone."""
        said = [self.strayed] if self.strayed else [] if self.named else [*self._ways_across()]
        return tuple(said[:1])

    def _ways_across(self) -> list[str]:
        """Return what to say of parts of the plot in which rows may run another way."""
        if not self.in_rows or self.named:
            return []
        said = list(self.crossed.doubts)
        # a few plants beside exact lines are those of rows that run along them
        most = 1.0 - (_LEFT if self.exact else _PART)
        if _PART <= self.nearer_share <= most:
            said.append(
                worded(
                    "{share:.0%} of the plants stand nearer to one of another row than to those of "
                    "their own, and the others do not: in a part of the plot rows may run another "
                    "way. Look at them, and give blocks or name each plant's row if they do.",
                    share=self.nearer_share,
                )
            )
        return said

    def _off_rows(self) -> list[str]:
        """Return what to say of plants that stand in no rows, or beside theirs."""
        if not self.in_rows:
            return [
                worded(
                    "No rows were found: the plants stand anyhow. The lines along which they would "
                    "be visited are none of theirs, and aisles between them may not be there. Give "
                    "the row bearing or name each plant's row; or say that they stand in no rows, "
                    "and they are visited by nearness."
                )
            ]
        if self.off_share < _WORTH_A_WORD:
            return []
        return [
            worded(
                "{off_share:.0%} of the plants stand more than a quarter of the row spacing "
                "beside their row: look at the rows before you use them.",
                off_share=self.off_share,
            )
        ]

    def _names(self) -> list[str]:
        """Return what to say of the rows that plants name."""
        strayed = [self.strayed] if self.strayed else []
        if self.misnamed_share is None or self.misnamed_share < _WORTH_A_WORD:
            return strayed
        decided = worded("the names decided") if self.named else worded("rows were found instead")
        return [
            *strayed,
            worded(
                "{misnamed_share:.0%} of the plants seem to stand in another row than the file "
                "names; {decided}. Look whether its rows are named rightly.",
                misnamed_share=self.misnamed_share,
                decided=decided,
            ),
        ]

    def _double_plants(self) -> list[str]:
        """Return what to say of plants that stand in close pairs."""
        if self.paired_share < _PAIRED or self.named or not self.in_rows:
            return []
        return [
            worded(
                "{paired_share:.0%} of the plants stand in close pairs, as in double rows or "
                "where two are planted in one place: rows may be seen where there are none. "
                "Look at them, name each plant's row, or leave one of each pair out.",
                paired_share=self.paired_share,
            )
        ]

    def _other_ways(self) -> list[str]:
        """Return what to say of blocks, bends and directions that may be others."""
        said: list[str] = []
        if self.of_trial:
            said.append(
                worded(
                    "The blocks that the file names change within rows without a gap, as those of "
                    "a trial do; they were left aside. Part the plot by areas or lines if they are "
                    "not."
                )
            )
        said += self._ways_across()
        if self.nearly_square_m is not None and self.in_rows:
            said.append(
                worded(
                    "Rows are {nearly_square_m:.2f} m apart, and plants in them "
                    "{nearly_square_m_2:.2f} m, nearly as far: they may run, or bend, another way. "
                    "Look at them, and draw one row or name each plant's row if they do.",
                    nearly_square_m=self.nearly_square_m[0],
                    nearly_square_m_2=self.nearly_square_m[1],
                )
            )
        if self.directions:
            taken, *others = map(str, self.directions)
            said.append(
                worded(
                    "The plants stand in rows in {n} directions: {taken}, but also {names}. The "
                    "first, with the longest rows, was taken. Give the row bearing if it is "
                    "another.",
                    n=len(self.directions),
                    taken=taken,
                    names=" and ".join(others),
                )
            )
        return said

    def _other_spacings(self) -> list[str]:
        """Return what to say of spacings that were told, and are none of measured plants."""
        said: list[str] = []
        if self.rows_said_m is not None:
            told, measured = self.rows_said_m
            said.append(
                worded(
                    "Rows of the measured plants are {measured:.2f} m apart, not {said:g} m as was "
                    "said: spacings are for plants that are laid.",
                    measured=measured,
                    said=told,
                )
            )
        if self.plants_said_m is not None:
            told, measured = self.plants_said_m
            said.append(
                worded(
                    "Measured plants are {measured:.2f} m apart in their rows, not {said:g} m as "
                    "was said: spacings are for plants that are laid.",
                    measured=measured,
                    said=told,
                )
            )
        return said

    def _double_rows(self) -> list[str]:
        """Return what to say of double rows, taken as one row or as two."""
        said: list[str] = []
        if self.zigzag_m and self.in_rows and not self.named:
            said.append(
                worded(
                    "{zigzag_share:.0%} of the plants stand off their row, {zigzag_m:.2f} m to its "
                    "left and right by turns, as in staggered double rows: each double row was "
                    "taken as one row. If one drives between its two lines, name each plant's row.",
                    zigzag_share=self.zigzag_share,
                    zigzag_m=self.zigzag_m,
                )
            )
        if self.gaps_m is not None and self.in_rows:
            said.append(
                worded(
                    "Rows are {gaps_m:.2f} and {gaps_m_2:.2f} m apart by turns, as in double rows, "
                    "and ways were laid in the narrow gaps as well. If nobody drives there, name "
                    "the two lines of each double row one row.",
                    gaps_m=self.gaps_m[0],
                    gaps_m_2=self.gaps_m[1],
                )
            )
        return said


def row_report(
    grid: PlantGrid, found: Rows, said: SaidRows, planting: Planting | None = None
) -> RowReport:
    """Return how well measured plants stand in the rows of their grid.

    `planting` is what was said of them; None: nothing.
    """
    told = planting or Planting()
    first = grid.side == grid.side[0]
    faces = np.flatnonzero(first[grid.row])
    xy_m, row = grid.xy_m[faces], grid.row_line[grid.row[faces]]
    left_m, alone_m, free = row_deviations(xy_m, row)
    decided = said.bearing or said.label is not None or grid.aisles_m is not None
    typical_m = float(np.sqrt(np.sum(left_m**2) / free)) if free > 0 else 0.0
    # what bends was only taken since plants stand in it; of straight lines that is not known
    straight = grid.aisles_m is None and "hardly" in found.how
    scattered = straight or typical_m > NO_ROWS * grid.row_spacing_m
    parallel = grid.aisles_m is None
    return RowReport(
        _how(grid, len(faces), typical_m),
        typical_m,
        float(np.mean(alone_m > _OFF * grid.row_spacing_m)),
        said.label is not None or not scattered,
        () if decided else found.directions,
        said.misnamed,
        said.label is not None and len(xy_m) >= LEAST_TRACED,
        said.of_trial,
        _paired_share(xy_m, row),
        *_zigzag(left_m, row),
        _two_gaps(grid),
        _nearly_square(grid, found, said),
        _said_otherwise(grid, told, "row_spacing_m"),
        _said_otherwise(grid, told, "plant_spacing_m"),
        _nearer_share(grid),
        # straight rows of one direction cross none
        crossed=_NOT_CROSSED if parallel or said.label is not None else crossed_rows(xy_m, row),
        exact=typical_m <= _EXACT_M and not said.bearing,
    )


def _how(grid: PlantGrid, n_plants: int, typical_m: float) -> Worded:
    """Return in words how many plants stand in how many rows, and how far beside their lines."""
    blocks = bend = ""
    if grid.n_blocks > 1:
        blocks = worded(" of {n_blocks}", n_blocks=counted(grid.n_blocks, "block"))
    if grid.aisles_m is not None:
        bend = worded(", as they bend")
    return worded(
        "{counted} in {n_rows}{blocks}{bend}, {typical_m:.2f} m beside their lines",
        counted=counted(n_plants, "plant"),
        n_rows=counted(int(grid.row_line.max()) + 1, "row"),
        blocks=blocks,
        bend=bend,
        typical_m=typical_m,
    )


def _said_otherwise(
    grid: PlantGrid, planting: Planting, spacing: str
) -> tuple[float, float] | None:
    """Return a spacing as it was said and as it is, by its name; None: nobody said another."""
    said = getattr(planting, spacing)
    # the usual one may come of nobody's saying anything
    return None if said == getattr(Planting(), spacing) else _otherwise(grid, spacing, said)


def _otherwise(grid: PlantGrid, spacing: str, said: float) -> tuple[float, float] | None:
    """Return a spacing as it was said and as it is; None where these agree."""
    measured = getattr(grid, spacing)
    return None if abs(said - measured) <= _AS_SAID * measured else (said, measured)


def told_by_hand(report: RowReport, grid: PlantGrid, given: Mapping[str, float]) -> RowReport:
    """Return a report that knows which spacings somebody said, and be it the usual one."""
    rows, plants = "row_spacing_m", "plant_spacing_m"
    if rows in given:
        report = replace(report, rows_said_m=_otherwise(grid, rows, given[rows]))
    if plants in given:
        report = replace(report, plants_said_m=_otherwise(grid, plants, given[plants]))
    return report


def _paired_share(xy_m: Float, row: NDArray[np.integer]) -> float:
    """Return the share of plants that are much nearer to one other than to any third.

    Plants come row by row, along each. None are where such ones are what is left of a line.
    """
    if len(xy_m) < _FEW:
        return 0.0
    from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

    near_m, third_m = cKDTree(xy_m).query(xy_m, k=3)[0][:, 1:].T
    paired = near_m < _CLOSE * third_m
    if not paired.any():
        return 0.0
    pair_m = float(np.median(near_m[paired]))
    if np.mean(third_m < _AS_NEAR * pair_m) > _IN_LINE:
        return 0.0
    apart_m = np.where(np.diff(row) == 0, np.hypot(*np.diff(xy_m, axis=0).T), np.inf)
    beside_m = np.minimum(np.append(apart_m, np.inf), np.insert(apart_m, 0, np.inf))
    is_along = np.mean(beside_m[paired] < _AS_NEAR * near_m[paired]) > 0.5
    between_m = np.sort(apart_m[(apart_m > pair_m / _CLOSE) & np.isfinite(apart_m)])
    if is_along and not _are_alike(between_m):
        return 0.0
    return float(np.mean(paired))


def _are_alike(gaps_m: Float) -> bool:
    """Return whether gaps, from the least on, are mostly of one size, and enough to tell."""
    if len(gaps_m) < _FEW_GAPS:
        return False
    alike = np.searchsorted(gaps_m, _AS_NEAR * gaps_m, "right") - np.arange(len(gaps_m))
    return bool(alike.max() >= _ALIKE * len(gaps_m))


def _zigzag(left_m: Float, row: NDArray[np.integer]) -> tuple[float, float]:
    """Return how far plants stand on either side of their row by turns, and how many; 0, 0: none.

    Plants come row by row, along each.
    """
    off_m, same = np.abs(left_m), np.diff(row) == 0
    if np.count_nonzero(same) < _MANY:
        return 0.0, 0.0
    turned = np.mean((left_m[1:] * left_m[:-1] < 0.0)[same])
    typical_m = float(off_m.mean())
    if typical_m < _LEAST_M or off_m.std() > _EVEN * typical_m or turned < _BY_TURNS:
        return 0.0, 0.0
    return typical_m, float(np.mean(off_m > typical_m / 2))


def _two_gaps(grid: PlantGrid) -> tuple[float, float] | None:
    """Return the two distances of neighbouring rows, if there are two of them; else None."""
    gap_m = _gaps_m(grid)
    if len(gap_m) < _FEW:
        return None
    wide_m = float(np.quantile(gap_m, 0.9))
    narrow = gap_m < _NARROW * wide_m
    if _RARE < narrow.mean() < 1.0 - _RARE:
        return float(np.median(gap_m[narrow])), float(np.median(gap_m[~narrow]))
    # the two lines of a double row may have been taken into different blocks
    nearest_m = _nearest_row_m(grid) if grid.n_blocks > 1 else wide_m
    return (nearest_m, float(np.median(gap_m))) if nearest_m < _NARROW * wide_m else None


def _nearly_square(grid: PlantGrid, found: Rows, said: SaidRows) -> tuple[float, float] | None:
    """Return how far apart rows and their plants are, if rows that bend could run another way."""
    apart_m = grid.row_spacing_m, grid.plant_spacing_m
    if said.label is not None or not _SQUARE < apart_m[1] / apart_m[0] < 1 / _SQUARE:
        return None
    if grid.aisles_m is not None:
        return apart_m
    # straight rows that cross others are told of as such
    sure = said.bearing or bool(found.directions)
    return None if sure or not _abreast(grid) else apart_m


def _abreast(grid: PlantGrid) -> bool:
    """Tell whether plants of neighbouring rows stand in line across, perhaps in a line that bends.

    From row to row they are then as much off level as from the row before, or nearly.
    """
    one = np.repeat(np.arange(len(grid)), np.diff(grid.across_start))
    line = grid.row_line[grid.row]
    up = line[grid.across_plant] == line[one] + 1
    one, other = one[up], grid.across_plant[up]
    if len(one) < _MANY or grid.has_faces:
        return False
    of_line = np.split(
        grid.along_m[other] - grid.along_m[one], np.flatnonzero(np.diff(line[one])) + 1
    )
    shift_m = np.array([np.median(off_m) for off_m in of_line])
    whole_m = grid.plant_spacing_m
    change_m = np.abs((np.diff(shift_m) + whole_m / 2) % whole_m - whole_m / 2)
    return bool(len(change_m) and np.median(change_m) < _LEVEL * whole_m)


def _gaps_m(grid: PlantGrid) -> Float:
    """Return how far rows are from the next ones."""
    if grid.aisles_m is None:
        line = grid.row_line[grid.row]
        return np.diff(np.bincount(line, grid.xy_m[:, 1]) / np.bincount(line))
    # where rows bend lanes run midway between them
    half_m = np.hypot(*(grid.stop_m - grid.xy_m).T)
    middle = [np.median(half_m[a:b]) for a, b in pairwise(grid.row_start.tolist())]
    return 2 * np.array(middle)


def _nearer_share(grid: PlantGrid) -> float:
    """Return the share of plants that stand much nearer to another row's than to their own's."""
    if grid.has_faces:
        return 0.0
    return nearer_share(grid.xy_m, grid.row_line[grid.row])


def _nearest_row_m(grid: PlantGrid) -> float:
    """Return how far plants usually are from the nearest one of another row."""
    some = np.arange(0, len(grid), max(len(grid) // _ASKED, 1))
    far_m, near = grid.tree.query(grid.xy_m[some], k=min(_NEAR, len(grid)))
    line = grid.row_line[grid.row]
    other = line[near] != line[some][:, None]
    found = other.any(axis=1)
    nearest = far_m[np.arange(len(some)), np.argmax(other, axis=1)][found]
    return float(np.median(nearest)) if 2 * len(nearest) > len(some) else np.inf
