"""What was said about a plot's rows by hand; lengths are kept in the unit chosen for the boxes."""

from __future__ import annotations

from typing import TypedDict

from . import widget_memory
from .chosen_units import units

#: the boxes that hold lengths
LENGTHS = ("row_spacing", "plant_spacing", "headland", "half_canopy")
BLOCK_LENGTHS = ("block_row_spacing", "block_plant_spacing")


class RowSettings(TypedDict):
    """What was said of rows, as `fieldmon.io.plot_request.PlantingChoices` has it."""

    row_bearing_deg: float | None
    row_spacing_m: float | None
    plant_spacing_m: float | None
    headland_m: float | None
    faces: int | None
    half_canopy_m: float | None
    in_rows: bool


class BlockSettings(TypedDict, total=False):
    """What was said of a block's rows, as `fieldmon.plot.block.Block` has it."""

    row_bearing_deg: float
    row_spacing_m: float
    plant_spacing_m: float


_UNSAID = RowSettings(
    row_bearing_deg=None, row_spacing_m=None, plant_spacing_m=None, headland_m=None, faces=None,
    half_canopy_m=None, in_rows=True,
)  # fmt: skip


def row_settings(plot_key: str) -> RowSettings:
    """Return the rows' settings, metres and degrees; None: found, or as the file says."""
    return RowSettings(
        row_bearing_deg=widget_memory.value(f"row_bearing {plot_key}"),
        row_spacing_m=_metres(f"row_spacing {plot_key}"),
        plant_spacing_m=_metres(f"plant_spacing {plot_key}"),
        headland_m=_metres(f"headland {plot_key}"),
        faces=2 if widget_memory.value(f"both_faces {plot_key}") else None,
        half_canopy_m=_metres(f"half_canopy {plot_key}"),
        in_rows=not widget_memory.value(f"no_rows {plot_key}"),
    )


def _metres(box: str) -> float | None:
    shown = widget_memory.value(box)
    return None if shown is None else units().in_metres(shown)


def say(plot_key: str, said: dict[str, float | bool]) -> None:
    """Let boxes begin with this, lengths in metres, by the names of the boxes (for callbacks)."""
    for name, value in said.items():
        shown = units().shown(value) if name in LENGTHS else value
        widget_memory.put(f"{name} {plot_key}", shown)


def is_said(plot_key: str) -> bool:
    """Return whether anything was said of a plot's rows by hand."""
    return row_settings(plot_key) != _UNSAID


def turn(plot_key: str, bearing_deg: float | None) -> None:
    """Let a plot's rows run along a bearing, or as they are found (for callbacks)."""
    widget_memory.put(f"row_bearing {plot_key}", bearing_deg)


def block_settings(plot_key: str, name: str) -> BlockSettings:
    """Return what was said of a block's rows by hand; nothing else."""
    place, said = f"{name} {plot_key}", BlockSettings()
    bearing_deg: float | None = widget_memory.value(f"block_bearing {place}")
    if bearing_deg is not None:
        said["row_bearing_deg"] = bearing_deg
    if (rows_m := _metres(f"block_row_spacing {place}")) is not None:
        said["row_spacing_m"] = rows_m
    if (plants_m := _metres(f"block_plant_spacing {place}")) is not None:
        said["plant_spacing_m"] = plants_m
    return said
