"""How a plot is planted, as it is said: spacings, headlands, faces."""

from __future__ import annotations

from dataclasses import dataclass

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.compute.ranges import AllowedRange, broken_setting
from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError

_SPACING = AllowedRange(0.05, 1000.0, said=worded("0.05 to 1000 metres"))
#: what settings of `Planting` may be
PLANTED = {
    "row_bearing_deg": AllowedRange(-360.0, 360.0, said=worded("-360 to 360 degrees")),
    "row_spacing_m": _SPACING,
    "plant_spacing_m": _SPACING,
    "headland_m": _SPACING,
    "half_canopy_m": AllowedRange(0.0, 10.0, said=worded("0 to 10 metres")),
}


@dataclass(frozen=True)
class Planting:
    """How a plot is planted.

    Parameters
    ----------
    row_bearing_deg
        Direction of the rows, degrees clockwise from true north, -360 to 360; None:
        found.
    row_spacing_m, plant_spacing_m
        From row to row, and from plant to plant in a row (thesis: 4 m and 3 m).
    headland_m
        Free of plants at both ends of each row, where rows are changed. The default leaves 4 m:
        enough for a small robot or a person; tractors take 6 m or more.
    half_canopy_m
        How far plants reach to each side of their middle; None: not known. It counts for robots
        whose width is known.
    faces
        1: a row is inspected from the aisle above it (higher y). 2: both faces of each row are
        inspected, each from its own aisle.
    outer_faces
        With two faces: whether faces that look at no other row are inspected too (the thesis
        leaves them out).

    Examples
    --------
    >>> import fieldmon as fm
    >>> fm.Planting(row_spacing_m=2.5, plant_spacing_m=1.0, faces=2).headland_m
    4.0
    """

    row_bearing_deg: float | None = None
    row_spacing_m: float = 4.0
    plant_spacing_m: float = 3.0
    headland_m: float = 4.0
    faces: int = 1
    outer_faces: bool = True
    half_canopy_m: float | None = None

    def __post_init__(self) -> None:
        must_hold_kinds(self, "The planting's")
        if broken := broken_setting(self, PLANTED):
            raise SettingError(
                worded("The planting's {name} must be {rule}, but it is {value}.", **broken)
            )
        if self.faces not in (1, 2):
            raise SettingError(
                worded(
                    "A row has 1 or 2 faces to inspect, but the planting says {faces}.",
                    faces=self.faces,
                )
            )
