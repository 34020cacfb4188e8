"""A block: a part of a plot with rows of its own."""

from __future__ import annotations

from dataclasses import dataclass

import shapely
from shapely import MultiPolygon, Polygon

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.wording import worded
from fieldmon.errors import PlotError


def let_have_parts(holder: object, name: str) -> None:
    """Let a holder's area, by its name, be of parts where it is a single one."""
    if isinstance(area := getattr(holder, name), Polygon):
        object.__setattr__(holder, name, MultiPolygon([area]))


@dataclass(frozen=True, eq=False)
class Block:
    """A part of a plot with rows of its own.

    Parameters
    ----------
    name
        As the grower calls it; "" for none.
    area
        Where it is, lon/lat. What lies outside the plot is not planted.
    row_bearing_deg, row_spacing_m, plant_spacing_m
        As stated for this block, or None: its rows run along its own longest side, as far apart
        as on the rest of the plot.

    Examples
    --------
    >>> import fieldmon as fm, shapely
    >>> area = shapely.MultiPolygon([shapely.box(35.150, 30.360, 35.151, 30.361)])
    >>> fm.Block("north", area, row_bearing_deg=20.0)
    <Block north>
    """

    name: str
    area: MultiPolygon
    row_bearing_deg: float | None = None
    row_spacing_m: float | None = None
    plant_spacing_m: float | None = None

    def __post_init__(self) -> None:
        let_have_parts(self, "area")
        must_hold_kinds(self, "A block's")
        if self.area.is_empty or not self.area.is_valid:
            raise PlotError(
                worded(
                    "Block {name!r} must be a valid, non-empty area, but it is {how}. Draw it "
                    "again.",
                    name=self.name,
                    how="empty" if self.area.is_empty else shapely.is_valid_reason(self.area),
                )
            )

    def __repr__(self) -> str:
        return f"<Block {self.name}>"

    @property
    def content(self) -> tuple[object, ...]:
        """Return all that is said of the block, as digests take it."""
        return tuple(vars(self).values())
