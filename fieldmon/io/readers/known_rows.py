"""What a plot file's columns say about the rows: direction and spacings."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.io.import_report import ImportMessage, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.values import numbers

if TYPE_CHECKING:
    from fieldmon.io.formats.layer import Layer


class KnownRows(NamedTuple):
    """What a file states of a plot's rows, as `Field` has it; None where it does not."""

    row_bearing_deg: float | None = None
    row_spacing_m: float | None = None
    plant_spacing_m: float | None = None


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


def known_rows(layer: Layer, names: list[str]) -> tuple[dict[str, KnownRows], list[ImportMessage]]:
    """Return what a layer's columns state of the rows of its features, by the features' names."""
    called = {plain(column): column for column in layer.columns}
    values: list[list[float | None]] = []
    used = []
    for setting, columns in _COLUMNS.items():
        column = next((called[plain(c)] for c in columns if plain(c) in called), None)
        if column is None:
            values.append([None] * len(names))
            continue
        used.append(f"{column!r}")
        stated = numbers(layer.column(column))
        usable = np.isfinite(stated) & ((stated > 0) | (setting == "row_bearing_deg"))
        values.append([float(v) if good else None for v, good in zip(stated, usable, strict=True)])
    if not used:
        return {}, []
    rows = (KnownRows(*one) for one in zip(*values, strict=True))
    said = seen(
        worded(
            "Direction and spacings of rows and plants are taken from {names}.",
            names=", ".join(used),
        )
    )
    return dict(zip(names, rows, strict=True)), [said]
