"""What people know about a plot, as plain values in degrees (lon, lat, WGS84)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import shapely
from shapely import MultiLineString, MultiPolygon

from fieldmon.compute.arrays import as_kept
from fieldmon.compute.kinds import checked, must_hold_kinds
from fieldmon.compute.wording import counted, worded
from fieldmon.errors import PlotError
from fieldmon.plot.block import let_have_parts
from fieldmon.plot.positions import lonlat_of
from fieldmon.plot.projection import Frame, goes_round, on_both_sides

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.plot.block import Block


@checked
@dataclass(frozen=True, eq=False)
class Field:
    """A plot: where it is, where its rows are if that is known, and how one gets in.

    Parameters
    ----------
    name
        As the grower calls it, any script.
    boundary
        Parts and holes of the plot, lon/lat. Holes are not driven through.
    no_go
        Areas inside the boundary that carry no plants and are not driven through, lon/lat.
    gate
        ``(lon, lat)`` where a working day starts and ends, or None: the nearest row end then.
    paths
        Paths and roads along which insects enter, lon/lat.
    plants
        ``(n, 2)`` lon/lat of plants whose positions were measured, or None.
    row_lines
        Rows drawn or measured as lines, lon/lat; empty if unknown. Several are the rows; of a
        single one all others are copies.
    row_bearing_deg, row_spacing_m, plant_spacing_m
        As stated for this plot, or None: direction of the rows clockwise from true north, and the
        distances from row to row and from plant to plant.
    plant_rows
        ``(n,)`` the name of each measured plant's row; None: not known. Rows are found unless all
        plants have one.
    plant_blocks
        ``(n,)`` the name of each measured plant's block; None: not known, then blocks are found.
    plant_names
        ``(n,)`` what each measured plant is called, or nothing; None: not known.
    blocks
        Parts of the plot with rows of their own; empty: the plot is one.
    in_rows
        Whether plants stand in rows. If not, measured ones are visited by nearness.

    Raises
    ------
    PlotError
        If the boundary is empty or no valid area; `read_plot` repairs what files have.
    ObservationError
        If the gate or a plant is no position on earth.
    SettingError
        If something is of another kind.

    Examples
    --------
    >>> import fieldmon as fm, shapely
    >>> area = shapely.MultiPolygon([shapely.box(35.150, 30.360, 35.151, 30.361)])
    >>> field = fm.Field("home", area, row_bearing_deg=90.0)
    >>> fm.Plot.of(field)
    <Plot home: 810 plants in 27 rows>
    """

    name: str
    boundary: MultiPolygon
    no_go: MultiPolygon = field(default_factory=MultiPolygon)
    gate: tuple[float, float] | None = None
    paths: MultiLineString = field(default_factory=MultiLineString)
    plants: NDArray[np.float64] | None = None
    row_lines: MultiLineString = field(default_factory=MultiLineString)
    row_bearing_deg: float | None = None
    row_spacing_m: float | None = None
    plant_spacing_m: float | None = None
    plant_rows: NDArray[np.str_] | None = None
    plant_blocks: NDArray[np.str_] | None = None
    blocks: tuple[Block, ...] = ()
    in_rows: bool = True
    plant_names: NDArray[np.str_] | None = None

    def __post_init__(self) -> None:
        let_have_parts(self, "boundary")
        must_hold_kinds(self, "A plot's")
        if self.boundary.is_empty or not self.boundary.is_valid:
            raise PlotError(
                worded(
                    "The boundary of plot {name!r} must be a valid, non-empty "
                    "area, but it is {value}. Draw it again or let the import "
                    "repair it.",
                    name=self.name,
                    value="empty"
                    if self.boundary.is_empty
                    else shapely.is_valid_reason(self.boundary),
                )
            )
        if self.gate is not None:
            lonlat_of("A gate", [self.gate])
        if self.plants is not None:
            lonlat_of("Plants", self.plants)
            object.__setattr__(self, "plants", as_kept(self.plants))

    def __repr__(self) -> str:
        parts = counted(len(self.boundary.geoms), "part")
        plants = "" if self.plants is None else f", {counted(len(self.plants), 'measured plant')}"
        return f"<Field {self.name}: {parts}{plants}>"

    @property
    def content(self) -> tuple[object, ...]:
        """Return all that is said of the plot, as digests take it.

        What later versions added counts only where it is said: digests of before stay valid.
        """
        said = dict(vars(self))
        for name in ("plant_rows", "plant_blocks", "plant_names"):
            if said[name] is None:
                del said[name]
        del said["blocks"]
        if self.in_rows:
            del said["in_rows"]
        return (*said.values(), *(part for block in self.blocks for part in block.content))

    def frame(self, bearing_deg: float = 90.0) -> Frame:
        """Return the plane in metres centred on this plot, x along ``bearing_deg``.

        Raise `PlotError` where its longitudes jump from 180 to -180.
        """
        west, south, east, north = self.boundary.bounds
        if goes_round([west, east]):
            raise PlotError(on_both_sides())
        lon = (west + east) / 2  # an area drawn on across 180 has its middle there or beyond
        return Frame(lon - 360 if lon > 180 else lon, (south + north) / 2, bearing_deg)

    def drivable(self) -> MultiPolygon:
        """Return the boundary without the no-go areas, lon/lat.

        Raise `PlotError` where nothing is left of it.
        """
        if self.no_go.is_empty:
            return self.boundary
        left = shapely.difference(self.boundary, self.no_go)
        # where nothing is left, GEOS has one part, which is empty
        areas = [part for part in shapely.get_parts(left) if part.area > 0]
        if not areas:
            raise PlotError(
                worded(
                    "Some of plot {name!r} must lie outside its no-go areas, "
                    "but nothing does. Remove or shrink a no-go area.",
                    name=self.name,
                )
            )
        return MultiPolygon(areas)
