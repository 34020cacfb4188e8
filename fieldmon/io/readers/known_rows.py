"""What a plot file's columns say about the rows: direction and spacings."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.values import numbers

if TYPE_CHECKING:
    from fieldmon.io.formats.layer import Layer
    from fieldmon.plot.field import Field

_COLUMNS = {
    "row_bearing_deg": ("row_bearing_deg", "row_bearing", "bearing", "row_azimuth", "azimuth"),
    "row_spacing_m": (
        "row_spacing_m",
        "row_spacing",
        "row_spac_m",
        "row_m",
        "row_dist",
        "rowspace",
    ),
    "plant_spacing_m": (
        *("plant_spacing_m", "plant_spacing", "plnt_spac", "plant_m", "plant_dist", "vine_spacing"),
        *("tree_spacing",),
    ),
}


def with_known_rows(
    fields: tuple[Field, ...], layer: Layer, names: list[str]
) -> tuple[tuple[Field, ...], list[ImportMessage]]:
    """Return the plots with the row bearing and spacings that the layer's columns state.

    `names` are those of the layer's features, in its order; plots are told apart by them.
    """
    called = {plain(column): column for column in layer.columns}
    known: dict[str, dict[str, float]] = {name: {} for name in names}
    used = []
    for setting, columns in _COLUMNS.items():
        column = next((called[plain(c)] for c in columns if plain(c) in called), None)
        if column is None:
            continue
        used.append(f"{column!r}")
        for name, value in zip(names, numbers(layer.column(column)), strict=True):
            if np.isfinite(value) and (value > 0 or setting == "row_bearing_deg"):
                known[name][setting] = float(value)
    if not used:
        return fields, []
    said = seen(
        worded(
            "Direction and spacings of rows and plants are taken from {names}.",
            names=", ".join(used),
        )
    )
    return tuple(
        replace(
            field,
            row_bearing_deg=known[field.name].get("row_bearing_deg"),
            row_spacing_m=known[field.name].get("row_spacing_m"),
            plant_spacing_m=known[field.name].get("plant_spacing_m"),
        )
        for field in fields
    ), [said]
