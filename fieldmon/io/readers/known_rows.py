"""What a plot file's columns say about the rows: direction and spacings."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, Severity, WrongRows, doubtful, seen
from fieldmon.io.parse.columns import plain
from fieldmon.io.parse.lengths import UNITS_M, metres, unit_m, units_said
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


# to which a longer name is cut
_LETTERS_OF_SHAPEFILE = 10
# nothing that is grown in rows stands so far apart
VERY_FAR_M = 30.0
_NO_UNITS = frozenset({"", "deg", "degree", "degrees", "°"})
#: rows or plants and how they stand; or, alone, what only they have
_OF_ROWS = re.compile(
    r"^(?:row|rows|vine|vines|plant|plants|tree|trees|reihen?|zeilen?|pflanz|pflanzen|rebstock)"
    r"(?:spac|dist|abstand|gap$|width|weite|beari|azimu|orient|direction|richtung|heading)"
    r"|^(?:inter|between|in|intra|within)rows?(?:spac|dist|width)?$|spacing|abstand$"
    r"|^distancia(?:entre)?(?:filas|hileras|plantas)|^(?:inter|entre)(?:rang|linea|linha|fila)"
    r"|^marco(?:de)?plantaci|^sesto|^headland"
)
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
    values: list[list[float | None]] = []
    used = []
    wrong: list[ImportMessage] = []
    for setting, columns in _COLUMNS.items():
        found = _column(list(layer.columns), columns, in_metres=setting != "row_bearing_deg")
        if found is None:
            values.append([None] * len(names))
            continue
        column, unit_m = found
        used.append(column)
        cells = layer.column(column)
        stated = numbers(cells) if setting == "row_bearing_deg" else metres(cells, unit_m)
        # 0 and less stand for what nobody knows
        usable = np.isfinite(stated) & ((stated > 0) | (setting == "row_bearing_deg"))
        values.append([float(v) if good else None for v, good in zip(stated, usable, strict=True)])
        wrong += left_aside(column, cells, usable | (stated == 0), names)
        wrong += _out_of_range(setting, column, values[-1], names)
        wrong += _very_far(setting, column, values[-1], names)
    wrong += _unread([column for column in layer.columns if column not in used])
    if not used:
        return {}, wrong
    rows = (KnownRows(*one) for one in zip(*values, strict=True))
    said = seen(
        worded(
            "Direction and spacings of rows and plants are taken from {names}.",
            names=", ".join(map(repr, used)),
        )
    )
    return dict(zip(names, rows, strict=True)), [said, *wrong]


def _column(
    columns: list[str], known: tuple[str, ...], *, in_metres: bool
) -> tuple[str, float] | None:
    """Return the column that has one of the known names, and how many metres its unit is."""
    read = [(*_name_and_unit(column), column) for column in columns]
    for name in map(plain, known):
        for own, metres_each, column in read:
            if name == own and (metres_each is not None or not in_metres):
                return column, metres_each or 1.0
    return None


def _name_and_unit(column: str) -> tuple[str, float | None]:
    """Return a column's plain name, and the metres of the unit behind it; None: it is no length."""
    if in_brackets := units_said(column, at_end=True):
        (said,) = in_brackets
        return plain(column), 1.0 if said in _NO_UNITS else unit_m(said)
    stem, _, unit = column.casefold().replace(" ", "_").rpartition("_")
    if stem and unit in UNITS_M and unit != "m":
        return plain(stem), UNITS_M[unit]
    return plain(column), 1.0


def _unread(columns: list[str]) -> list[ImportMessage]:
    """Return a doubt about columns that seem to say how rows or plants stand, and are not read."""
    alike = [column for column in columns if _OF_ROWS.search(plain(column))]
    if not alike:
        return []
    names = first_few([repr(column) for column in alike])
    if any(len(column) == _LETTERS_OF_SHAPEFILE for column in alike):
        said = worded(
            "What seems to be said of rows or plants is not read: {names}. Call such columns "
            "bearing, row_m and plant_m, since a shapefile cuts names after 10 letters, or say it "
            "by hand.",
            names=names,
        )
    else:
        said = worded(
            "What seems to be said of rows or plants is not read: {names}. Call such columns "
            "row_bearing_deg, row_spacing_m and plant_spacing_m, or say it by hand.",
            names=names,
        )
    return [doubtful(said)]


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
                some=first_few([f"{names[k]} ({text(cells[k])!r})" for k in wrong]),
            )
        )
    ]


def _very_far(
    setting: str, column: str, stated: list[float | None], names: list[str]
) -> list[ImportMessage]:
    """Return a doubt for each plot whose rows or plants are as far apart as in another unit."""
    if setting == "row_bearing_deg":
        return []
    broken = PLANTED[setting].broken
    return [
        doubtful(
            worded(
                "Column {column!r} says {value:g} m, as no rows or plants stand: check its unit, "
                "and write it with the number or behind the column's name, as in row_spacing_cm.",
                column=column,
                value=value,
            ),
            name,
            many="Rows or plants of {n} plots would stand as far apart as in another unit",
        )
        for name, value in zip(names, stated, strict=True)
        if value is not None and value > VERY_FAR_M and not broken(value)
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
