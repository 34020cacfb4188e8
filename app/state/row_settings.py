"""What was said about a plot's rows by hand; lengths are kept in the unit chosen for the boxes."""

from __future__ import annotations

from . import widget_memory
from .chosen_units import units

#: the boxes that hold lengths
LENGTHS = ("row_spacing", "plant_spacing", "headland", "half_canopy")
BLOCK_LENGTHS = ("block_row_spacing", "block_plant_spacing")


def row_settings(plot_key: str) -> dict[str, float | None]:
    """Return the rows' settings, metres and degrees; None: found, or as the file says."""
    said, now = {}, units()
    for name in LENGTHS:
        shown = widget_memory.value(f"{name} {plot_key}")
        said[f"{name}_m"] = None if shown is None else now.in_metres(shown)
    both = widget_memory.value(f"both_faces {plot_key}")
    bearing = widget_memory.value(f"row_bearing {plot_key}")
    in_rows = not widget_memory.value(f"no_rows {plot_key}")
    return {**said, "row_bearing_deg": bearing, "faces": 2 if both else None, "in_rows": in_rows}


def say(plot_key: str, said: dict[str, float | bool]) -> None:
    """Let boxes begin with this, lengths in metres, by the names of the boxes (for callbacks)."""
    for name, value in said.items():
        shown = units().shown(value) if name in LENGTHS else value
        widget_memory.put(f"{name} {plot_key}", shown)


def is_said(plot_key: str) -> bool:
    """Return whether anything was said of a plot's rows by hand."""
    return row_settings(plot_key) != dict.fromkeys(row_settings(plot_key), None) | {"in_rows": True}


def turn(plot_key: str, bearing_deg: float | None) -> None:
    """Let a plot's rows run along a bearing, or as they are found (for callbacks)."""
    widget_memory.put(f"row_bearing {plot_key}", bearing_deg)


def block_settings(plot_key: str, name: str) -> dict[str, float]:
    """Return what was said of a block's rows by hand, as `fieldmon.plot.block.Block` has it."""
    now = units()
    said = {"row_bearing_deg": widget_memory.value(f"block_bearing {name} {plot_key}")}
    for key in BLOCK_LENGTHS:
        shown = widget_memory.value(f"{key} {name} {plot_key}")
        setting = f"{key.removeprefix('block_')}_m"
        said[setting] = None if shown is None else now.in_metres(shown)
    return {setting: value for setting, value in said.items() if value is not None}
