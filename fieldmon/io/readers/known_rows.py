"""What a plot file's columns say about the rows: direction and spacings."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, Severity, WrongRows, doubtful, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.lengths import metres
from fieldmon.io.parse.values import is_missing, numbers
from fieldmon.plot.planting import PLANTED

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer


class KnownRows(NamedTuple):
    """What a file states of a plot's rows, as `Field` has it; None where it does not."""

    row_bearing_deg: float | None = None
    row_spacing_m: float | None = None
    plant_spacing_m: float | None = None


_NAMED = 5
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
    wrong: list[ImportMessage] = []
    for setting, columns in _COLUMNS.items():
        column = next((called[plain(c)] for c in columns if plain(c) in called), None)
        if column is None:
            values.append([None] * len(names))
            continue
        used.append(f"{column!r}")
        cells = layer.column(column)
        stated = numbers(cells) if setting == "row_bearing_deg" else metres(cells)
        # 0 and less stand for what nobody knows
        usable = np.isfinite(stated) & ((stated > 0) | (setting == "row_bearing_deg"))
        values.append([float(v) if good else None for v, good in zip(stated, usable, strict=True)])
        wrong += left_aside(column, cells, usable | (stated == 0), names)
        wrong += _out_of_range(setting, column, values[-1], names)
    if not used:
        return {}, []
    rows = (KnownRows(*one) for one in zip(*values, strict=True))
    said = seen(
        worded(
            "Direction and spacings of rows and plants are taken from {names}.",
            names=", ".join(used),
        )
    )
    return dict(zip(names, rows, strict=True)), [said, *wrong]


def left_aside(
    column: str, cells: NDArray[np.object_], usable: NDArray[np.bool_], names: list[str]
) -> list[ImportMessage]:
    """Return a doubt that names the plots of which a column says what cannot be used."""
    wrong = [k for k in np.flatnonzero(~usable).tolist() if not is_missing(cells[k])]
    if not wrong:
        return []
    return [
        doubtful(
            worded(
                "Column {column!r} says what cannot be used, and was left aside, of "
                "{n} {n:plot|plots}: {some}.",
                column=column,
                n=len(wrong),
                some=first_few([f"{names[k]} ({text(cells[k])!r})" for k in wrong], _NAMED),
            )
        )
    ]


def _out_of_range(
    setting: str, column: str, stated: list[float | None], names: list[str]
) -> list[ImportMessage]:
    """Return a doubt for each plot of which a column says what no rows are."""
    allowed = PLANTED[setting]
    return [
        WrongRows(
            Severity.DOUBTFUL,
            worded(
                "Column {column!r} must be {rule}, but it is {value:g}.",
                column=column,
                rule=rule,
                value=value,
            ),
            name,
            column=column,
            setting=setting,
            rule=rule,
            value=value,
        )
        for name, value in zip(names, stated, strict=True)
        if value is not None and (rule := allowed.broken(value))
    ]
