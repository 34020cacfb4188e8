"""Plants in rows: where each stands, who is next to it, and from which aisle it is inspected."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from fieldmon.compute.arrays import offsets, read_only
from fieldmon.compute.wording import counted, runs, worded
from fieldmon.errors import PlotError

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.spatial import cKDTree
    from shapely import MultiPolygon
    from shapely.geometry.base import BaseGeometry

    from fieldmon.compute.wording import Worded
    from fieldmon.plot.polylines import Polylines
    from fieldmon.plot.projection import Frame


class PlantNumbers(NamedTuple):
    """Where plants stand, as people count from 1 or as the plot's file has it, ``(k,)`` each.

    Rows are numbered on from block to block: a row and a number in it are one plant.
    """

    line: NDArray[np.int64]
    number: NDArray[np.int64]

    def __repr__(self) -> str:
        return f"<PlantNumbers: {counted(len(self.line), 'plant')}>"


class Csr(NamedTuple):
    """Lists of plants, one per plant: those of plant i are ``plant[start[i]:start[i + 1]]``."""

    start: NDArray[np.int32]
    plant: NDArray[np.int32]

    def __repr__(self) -> str:
        return f"<Csr: {counted(len(self.plant), 'plant')} in lists of {len(self.start) - 1}>"


class Linked(NamedTuple):
    """The same, and for each entry the place ``(e,)`` where the other plant's list names this."""

    start: NDArray[np.int32]
    plant: NDArray[np.int32]
    back: NDArray[np.int32]

    def __repr__(self) -> str:
        return f"<Linked: {counted(len(self.plant), 'plant')} in lists of {len(self.start) - 1}>"


@dataclass(frozen=True, eq=False)
class PlantGrid:
    """Plants of one plot, row-major and ragged: row by row, along the row.

    A *row* here is an unbroken piece: where a hole or a no-go area cuts a row on the ground, two
    rows share one *line*. Each row is inspected from one lane, in the aisle beside it; the lane
    reaches beyond the row's last plants on both ends, out into the headland, where rows can be
    changed. Everything but `frame` is in metres of that frame (x along the rows, y across).

    Parameters
    ----------
    frame
        Bridge to lon/lat.
    xy_m
        ``(n, 2)`` plant positions; x increases along each row.
    row_start
        ``(r + 1,)`` offsets: plants of row k are ``row_start[k]:row_start[k + 1]``.
    row_line
        ``(r,)`` number of the line on the ground, ascending with y, 0 first.
    lane_y_m
        ``(r,)`` y of the lane from which the row is inspected.
    lane_x_m
        ``(r, 2)`` x of the lane's two ends in the headland, low and high.
    corridor
        ``(r,)`` rows with the same number are inspected from the same aisle, in which one drives
        straight from each to each unless it is cut (see `stretch`).
    side
        ``(r,)`` int8: which side of its lane the row is on (-1: lower y, +1: higher y).
    drivable_m
        Where a robot may drive between and around the rows; parts and holes as they are.
    beyond_m
        Where it may besides, though outside a boundary that somebody drew: about measured rows
        that have no end within it. None: nowhere.
    row_spacing_m, plant_spacing_m
        Typical distances between rows and between plants in a row.
    along_start, along_plant
        CSR lists ``(n + 1,)``, ``(e,)``: neighbours of each plant in its own row.
    across_start, across_plant
        CSR lists: neighbours of each plant in the rows on either side.
    twin
        ``(n,)`` the other face of the same vine where both faces are inspected, else -1.
    block
        ``(r,)`` the block of each row, ascending, 0 first; None: there is one.
    place_m, aisle, aisle_start, aisle_m
        Where rows bend or blocks turn, else None: the place of each plant ``(n,)`` along the
        middle of its aisle; the aisle of each row ``(r,)``; and the corners of the aisles'
        middles: those of aisle a are ``aisle_m[aisle_start[a]:aisle_start[a + 1]]``. Then
        `lane_x_m` are places along the aisle too, and `lane_y_m` is 0.
    half_canopy_m
        How far plants reach to each side of their middle; None: nobody said.
    in_rows
        Whether plants stand in rows. If not, each is a row by itself here, and people count
        plants only.
    line_called
        ``(lines, 2)`` the number by which people know each line, and that in its block, where
        these count by themselves; None: lines count from 1, with y.
    plant_called
        ``(n,)`` the number by which people know each plant of its line; None: plants count from
        1, with x.
    line_named, plant_named
        ``(lines,)``, ``(n,)`` what the plot's file calls each line and each plant, where that is
        more than their numbers; None: it is not. Several names of a line are lines of text.
    block_named
        ``(blocks,)`` the same of the blocks.
    stretch, whole, cut
        Where something cuts lanes of unbroken rows, else None: a row here is a piece of one then.
        ``(r,)`` rows with the same number are inspected from the same stretch of lane, and are
        pieces of the same unbroken row; ``(r, 2)`` ends at which a lane is cut while the row goes
        on: nobody leaves it there.
    """

    frame: Frame
    xy_m: NDArray[np.float64]
    row_start: NDArray[np.int64]
    row_line: NDArray[np.int32]
    lane_y_m: NDArray[np.float64]
    lane_x_m: NDArray[np.float64]
    corridor: NDArray[np.int32]
    side: NDArray[np.int8]
    drivable_m: MultiPolygon
    row_spacing_m: float
    plant_spacing_m: float
    along_start: NDArray[np.int32]
    along_plant: NDArray[np.int32]
    across_start: NDArray[np.int32]
    across_plant: NDArray[np.int32]
    twin: NDArray[np.int32]
    block: NDArray[np.int32] | None = None
    place_m: NDArray[np.float64] | None = None
    aisle: NDArray[np.int32] | None = None
    aisle_start: NDArray[np.int64] | None = None
    aisle_m: NDArray[np.float64] | None = None
    half_canopy_m: float | None = None
    in_rows: bool = True
    line_called: NDArray[np.int64] | None = None
    plant_called: NDArray[np.int64] | None = None
    line_named: NDArray[np.str_] | None = None
    plant_named: NDArray[np.str_] | None = None
    block_named: NDArray[np.str_] | None = None
    beyond_m: MultiPolygon | None = None
    stretch: NDArray[np.int32] | None = None
    whole: NDArray[np.int32] | None = None
    cut: NDArray[np.bool_] | None = None

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                read_only(value)

    def __repr__(self) -> str:
        return f"<PlantGrid: {self.counts}>"

    def __len__(self) -> int:
        """Return the number of plants (of faces, where both faces are inspected)."""
        return len(self.xy_m)

    @property
    def counts(self) -> str:
        """Return how many plants and rows there are, in words."""
        if not self.in_rows:
            return f"{counted(len(self), 'plant')} in no rows"
        blocks = f" of {counted(self.n_blocks, 'block')}" if self.n_blocks > 1 else ""
        return f"{counted(len(self), 'plant')} in {counted(self.n_lines, 'row')}{blocks}"

    @cached_property
    def ground_m(self) -> BaseGeometry:
        """Where a robot may drive, on the plot and where it must beyond."""
        if self.beyond_m is None:
            return self.drivable_m
        ground: BaseGeometry = shapely.union(self.drivable_m, self.beyond_m)
        return ground

    @property
    def end_plants(self) -> NDArray[np.int64]:
        """Return the first and the last plant of each row, ``(r, 2)``."""
        return np.stack([self.row_start[:-1], self.row_start[1:] - 1], axis=1)

    @property
    def beyond_plants_m(self) -> NDArray[np.float64]:
        """Return how far each lane reaches beyond the first and the last plant, ``(r, 2)``."""
        beyond_m: NDArray[np.float64] = np.abs(self.lane_x_m - self.along_m[self.end_plants])
        return beyond_m

    @property
    def cut_ends(self) -> NDArray[np.bool_]:
        """Return at which ends ``(r, 2)`` a lane is cut while the row goes on."""
        return np.zeros((self.n_rows, 2), np.bool_) if self.cut is None else self.cut

    @property
    def closed_rows(self) -> NDArray[np.bool_]:
        """Return which rows ``(r,)`` nobody gets to: their stretch of lane is cut at both ends."""
        if self.cut is None:
            return np.zeros(self.n_rows, np.bool_)
        entered = np.zeros(int(self.stretches.max()) + 1, np.bool_)
        entered[self.stretches[~self.cut.all(axis=1)]] = True
        return ~entered[self.stretches]

    @property
    def stretches(self) -> NDArray[np.int32]:
        """Return a number for each row ``(r,)``: one drives straight between rows of the same."""
        return self.corridor if self.stretch is None else self.stretch

    @property
    def unbroken(self) -> NDArray[np.intp]:
        """Return the first piece of each row that is unbroken on the ground, ``(w,)``."""
        if self.whole is None:
            return np.arange(self.n_rows)
        return np.flatnonzero(np.diff(self.whole, prepend=-1) != 0)

    @cached_property
    def unbroken_row(self) -> NDArray[np.int32]:
        """Row of each plant as it is unbroken on the ground, ``(n,)``, whatever cuts its lane."""
        if self.whole is None:
            return self.row
        rows = np.arange(len(self.unbroken), dtype=np.int32)
        return read_only(np.repeat(rows, np.diff(self.unbroken_start)))

    @property
    def unbroken_start(self) -> NDArray[np.int64]:
        """Return offsets ``(w + 1,)`` of the plants of rows that are unbroken on the ground."""
        return np.append(self.row_start[self.unbroken], len(self))

    @property
    def n_blocks(self) -> int:
        """Return the number of blocks."""
        return 1 if self.block is None else int(self.block[-1]) + 1

    @cached_property
    def aisles_m(self) -> Polylines | None:
        """Middles of the aisles where rows bend or blocks turn, None where all is straight."""
        if self.aisle_start is None or self.aisle_m is None:
            return None
        from fieldmon.plot.polylines import Polylines  # noqa: PLC0415 - as slow to import as link

        return Polylines.of(self.aisle_start, self.aisle_m)

    @property
    def n_rows(self) -> int:
        """Return the number of rows (unbroken pieces)."""
        return len(self.row_start) - 1

    @property
    def n_lines(self) -> int:
        """Return the number of lines of plants, which people count as rows: holes cut some."""
        return len(np.unique(self.row_line))

    @cached_property
    def row(self) -> NDArray[np.int32]:
        """Row of each plant, ``(n,)``."""
        rows = np.arange(self.n_rows, dtype=np.int32)
        return read_only(np.repeat(rows, np.diff(self.row_start)))

    @cached_property
    def line_number(self) -> NDArray[np.int64]:
        """Number of each line as people count or name them, ``(lines,)``."""
        if self.line_called is not None:
            return self.line_called[:, 0]
        return read_only(np.arange(1, int(self.row_line.max()) + 2))

    @property
    def counts_on(self) -> bool:
        """Return whether lines are counted on from block to block: named are they once each."""
        called = self.line_called
        return called is None or bool((called[:, 0] != called[:, 1]).any())

    @cached_property
    def line_odd(self) -> NDArray[np.bool_]:
        """Return which lines have a number that is not the one of their name, ``(lines,)``."""
        if self.line_called is None or self.line_named is None:
            return np.full(len(self.line_number), self.line_called is None)
        own = zip(self.line_named.tolist(), self.line_called[:, 1].tolist(), strict=True)
        return np.array([not any(_ends_in(one, k) for one in name.splitlines()) for name, k in own])

    @cached_property
    def rows_beyond(self) -> frozenset[int]:
        """Return the numbers of lines whose names have none, while others keep theirs."""
        odd = self.line_number[self.line_odd] if self.line_called is not None else np.empty(0, int)
        return frozenset(odd.tolist())

    @cached_property
    def row_names(self) -> dict[int, str]:
        """Return the names of lines that say more than their numbers, by these."""
        if self.line_named is None:
            return {}
        own = zip(self.line_number.tolist(), self.line_named.tolist(), self.line_odd, strict=True)
        return {k: name for k, name, odd in own if odd and name and "\n" not in name}

    @cached_property
    def line_signs(self) -> dict[int, str]:
        """Return how each line is shown to people, by its number: that, and a name that says more.

        All lines, in their order on the ground.
        """
        names = self.row_names
        return {k: f"{k} · {names[k]}" if k in names else f"{k}" for k in self.line_number.tolist()}

    @property
    def row_line_number(self) -> NDArray[np.int64]:
        """Number of each row's line as people count or name them, ``(r,)``."""
        return self.line_number[self.row_line]

    @cached_property
    def adjacent(self) -> Csr:
        """Neighbours of each plant, those in its own row first, then those across."""
        n_along, n_across = np.diff(self.along_start), np.diff(self.across_start)
        start = self.along_start + self.across_start
        plant = np.empty(len(self.along_plant) + len(self.across_plant), np.int32)
        ahead = np.repeat(self.across_start[:-1], n_along)
        plant[np.arange(len(self.along_plant)) + ahead] = self.along_plant
        behind = np.repeat(self.along_start[1:], n_across)
        plant[np.arange(len(self.across_plant)) + behind] = self.across_plant
        return Csr(read_only(start), read_only(plant))

    @cached_property
    def linked(self) -> Linked:
        """Neighbours as in `adjacent`, each linked with its own entry for the plant."""
        from fieldmon.plot.adjacency import link  # noqa: PLC0415 - a quarter second to import

        back = np.empty(len(self.adjacent.plant), np.int32)
        link(*self.adjacent, back)
        return Linked(*self.adjacent, read_only(back))

    @cached_property
    def has_faces(self) -> bool:
        """Whether both faces of some plant are inspected, each for itself.

        Examples
        --------
        >>> import fieldmon as fm, shapely
        >>> area = shapely.MultiPolygon([shapely.box(35.150, 30.360, 35.151, 30.361)])
        >>> field = fm.Field("home", area, row_bearing_deg=90.0)
        >>> [fm.Plot.of(field, fm.Planting(faces=n)).grid.has_faces for n in (1, 2)]
        [False, True]
        """
        return bool((self.twin >= 0).any())

    def counted(self, n: int) -> Worded:
        """Return in words so many plants of it, or faces where both of a plant are inspected."""
        return counted(n, "face") if self.has_faces else counted(n, "plant")

    @cached_property
    def vine(self) -> NDArray[np.intp]:
        """One number for both faces of a vine, ``(n,)``: that of the lower-numbered face."""
        itself = np.arange(len(self))
        return read_only(np.where(self.twin >= 0, np.minimum(self.twin, itself), itself))

    @cached_property
    def vines_beside(self) -> Csr:
        """Neighbours of each vine, by first faces: as `adjacent`, and across aisles in any case.

        Where both faces are inspected insects stay on a vine's faces, but a sprayer reaches the
        next row.
        """
        if not self.has_faces:
            return self.adjacent
        from fieldmon.plot.adjacency import beside_vines  # noqa: PLC0415 - as below

        made = beside_vines(
            self.vine,
            (self.xy_m, self.row_line[self.row]),
            (self.row_spacing_m, self.plant_spacing_m),
            (self.along_start, self.along_plant),
            bent=self.aisle is not None,
        )
        return Csr(*map(read_only, made))

    def vines_of(self, plants: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which vines are among plants ``(n,)``, each by its lower-numbered face alone."""
        among = np.zeros(len(self), np.bool_)
        among[self.vine[plants]] = True
        return among

    @cached_property
    def snake(self) -> NDArray[np.int32]:
        """All plants, up one line and down the next, ``(n,)``; each face is a line of its own."""
        new_pass = (np.diff(self.row_line) != 0) | (np.diff(self.side) != 0)
        turn = offsets(new_pass)[self.row]
        place = np.arange(len(self))
        plants = np.lexsort((np.where(turn % 2 == 0, place, -place), turn))
        return read_only(plants.astype(np.int32))

    @cached_property
    def tree(self) -> cKDTree:
        """The plants by position. Rows are even: halving boxes is as quick to ask, and to make."""
        from scipy.spatial import cKDTree  # noqa: PLC0415 - half a second to import

        return cKDTree(self.xy_m, compact_nodes=False, balanced_tree=False)

    @property
    def along_m(self) -> NDArray[np.float64]:
        """Place of each plant along its lane, ``(n,)``: its x where rows are straight."""
        return self.xy_m[:, 0] if self.place_m is None else self.place_m

    @cached_property
    def stop_m(self) -> NDArray[np.float64]:
        """Where the robot stands to inspect each plant, ``(n, 2)``: in the middle of its aisle."""
        if self.aisles_m is None or self.aisle is None:
            return read_only(np.stack([self.along_m, self.lane_y_m[self.row]], axis=1))
        return read_only(self.aisles_m.points(self.aisle[self.row], self.along_m))

    def lonlat(self, plants: NDArray[np.integer] | None = None) -> NDArray[np.float64]:
        """Return degrees ``(k, 2)`` of the given plants, or of all."""
        return self.frame.lonlat(self.xy_m if plants is None else self.xy_m[plants])


def plant_numbers(grid: PlantGrid, plants: NDArray[np.integer] | None = None) -> PlantNumbers:
    """Return line and number within the line of the given plants, or of all.

    As the plot's file names them, where it does by numbers; else both count from 1. Numbers run on
    along a line that is cut into pieces. Both faces of a plant share their numbers.
    """
    chosen = np.arange(len(grid)) if plants is None else np.asarray(plants)
    line = grid.row_line_number[grid.row[chosen]]
    if grid.plant_called is not None:
        return PlantNumbers(line, grid.plant_called[chosen])
    return PlantNumbers(line, chosen - _line_faces(grid)[grid.row[chosen]] + 1)


def block_number(grid: PlantGrid, plants: NDArray[np.integer] | None = None) -> NDArray[np.int64]:
    """Return the block, from 1, of the given plants, or of all, ``(k,)``."""
    row = grid.row if plants is None else grid.row[plants]
    if grid.block is None:
        return np.ones(len(row), np.int64)
    return grid.block[row].astype(np.int64) + 1


def row_in_block(grid: PlantGrid, plants: NDArray[np.integer] | None = None) -> NDArray[np.int64]:
    """Return the row of the given plants, or of all, as its block counts by itself, ``(k,)``.

    That is from 1, or as the plot's file names them.
    """
    row = grid.row if plants is None else grid.row[plants]
    if grid.line_called is not None:
        called: NDArray[np.int64] = grid.line_called[grid.row_line[row], 1]
        return called
    block = np.zeros(grid.n_rows, np.int64) if grid.block is None else grid.block
    first = np.full(grid.n_blocks, np.iinfo(np.int64).max)
    np.minimum.at(first, block, grid.row_line)
    in_block: NDArray[np.int64] = (grid.row_line - first[block] + 1)[row]
    return in_block


def plant_at(grid: PlantGrid, line: int, number: int) -> int:
    """Return the plant with these numbers (its first face); raise `PlotError` if there is none."""
    numbered = plant_numbers(grid)
    in_line = numbered.line == line
    if not in_line.any():
        raise PlotError(
            worded(
                "A row must be one of {some} on this plot, but it is {line}.",
                some=runs(grid.line_number.tolist()),
                line=line,
            )
        )
    found = np.flatnonzero(in_line & (numbered.number == number))
    if not len(found):
        raise PlotError(
            worded(
                "A plant in row {line} must be one of {some} on this plot, but it is {number}.",
                line=line,
                some=runs(numbered.number[in_line].tolist()),
                number=number,
            )
        )
    return int(found[0])


def before_rows(
    grid: PlantGrid, row: NDArray[np.integer], beyond_m: float | None = None
) -> NDArray[np.float64]:
    """Return a place ``(k, 2)`` in line with each row, before its first plant.

    As far as its lane reaches, or `beyond_m` from that plant.
    """
    first = grid.row_start[row]
    back_m = grid.lane_x_m[row, 0] - grid.along_m[first]
    if beyond_m is not None:
        back_m = np.full(len(row), -beyond_m)
    if grid.aisles_m is None or grid.aisle is None:
        straight: NDArray[np.float64] = grid.xy_m[first] + np.stack([back_m, 0 * back_m], axis=1)
        return straight
    ahead = grid.aisles_m.ahead(grid.aisle[row], grid.lane_x_m[row, 0])
    before: NDArray[np.float64] = grid.xy_m[first] + back_m[:, None] * ahead
    return before


def nearest_plants(
    grid: PlantGrid, lonlat: NDArray[np.float64], max_m: float
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Return the nearest plant of each position ``(m, 2)`` and its distance in metres, ``(m,)``.

    Positions further than `max_m` from every plant get plant -1 and an infinite distance. Where
    both faces of a plant are inspected, the one with the lower index is returned.
    """
    within_m = np.nextafter(max_m, np.inf)
    distance_m, plant = grid.tree.query(grid.frame.xy_m(lonlat), distance_upper_bound=within_m)
    plant = np.where(plant == len(grid), -1, plant)
    first_face = (plant >= 0) & (grid.twin[plant] >= 0) & (grid.twin[plant] < plant)
    return np.where(first_face, grid.twin[plant], plant), distance_m


def row_ends(grid: PlantGrid, line: NDArray[np.integer]) -> tuple[str, str]:
    """Return how the first and the last of some lines are shown, the same where it is one.

    Those without a number of their own have no place among the others, and stand behind the last.
    """
    rows = np.unique(line).tolist()
    beyond = [k for k in rows if k in grid.rows_beyond]
    own = [k for k in rows if k not in beyond] or beyond[:1]
    last = [*own[1:][-1:], *(k for k in beyond if k != own[0])] or own
    return grid.line_signs[own[0]], ", ".join(grid.line_signs[k] for k in last)


def rows_listed(grid: PlantGrid, line: NDArray[np.integer]) -> str:
    """Return which lines these are: ``1–12, 101 · 5A``."""
    rows = np.unique(line).tolist()
    if len(rows) == 1:
        return grid.line_signs[rows[0]]
    own = runs(k for k in rows if k not in grid.rows_beyond)
    return ", ".join(
        [own] * bool(own) + [grid.line_signs[k] for k in rows if k in grid.rows_beyond]
    )


def _ends_in(name: str, number: int) -> bool:
    """Tell whether a whole number stands at the end of a name."""
    return re.search(rf"(?<!\d)0*{number}(\.0+)?\s*$", name) is not None


def _line_faces(grid: PlantGrid) -> NDArray[np.int64]:
    """Return for each row the first plant of its line and face."""
    first = grid.row_start[:-1]
    new_line = np.diff(grid.row_line, prepend=-1) != 0
    new_face = new_line | (np.diff(grid.side, prepend=0) != 0)
    of_row: NDArray[np.int64] = first[new_face][np.cumsum(new_face) - 1]
    return of_row
