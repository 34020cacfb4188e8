"""What a person draws on a plot: gate, paths, no-go areas, rows and cuts. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import LineString, MultiLineString, MultiPolygon, Polygon

from fieldmon.errors import SettingError
from fieldmon.plot.block_cutting import cut_blocks
from fieldmon.plot.row_drawing import smooth_row

from ..words import language, texts

if TYPE_CHECKING:
    from fieldmon.plot.field import Field

GATE, PATH, NO_GO, ROW, CUT = "gate", "path", "no_go", "row", "cut"
NEEDED = {GATE: 1, PATH: 2, NO_GO: 3, ROW: 2, CUT: 2}
Points = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Edit:
    """One thing that was drawn.

    Parameters
    ----------
    kind
        `GATE`, `PATH`, `NO_GO`, `ROW` or `CUT`.
    lonlat
        Its corners in order.
    """

    kind: str
    lonlat: Points

    def __post_init__(self) -> None:
        least = NEEDED[self.kind]
        if len(self.lonlat) < least:
            raise SettingError(
                texts.DRAW_LEAST.format(
                    what=texts.DRAW_WHAT[self.kind], least=least, n=len(self.lonlat)
                )
            )
        if self.kind == NO_GO and not Polygon(self.lonlat).is_valid:
            raise SettingError(texts.DRAW_CROSSED)


def edited(field: Field, edits: tuple[Edit, ...]) -> Field:
    """Return the field with everything that was drawn on it."""
    for edit in edits:
        if edit.kind == GATE:
            field = replace(field, gate=edit.lonlat[0])
        elif edit.kind == PATH:
            lines = [*shapely.get_parts(field.paths), LineString(edit.lonlat)]
            field = replace(field, paths=MultiLineString(lines))
        elif edit.kind == ROW:
            field = _with_row(field, smooth_row(np.array(edit.lonlat)))
        elif edit.kind == CUT:
            field = replace(field, blocks=cut_blocks(field, LineString(edit.lonlat)))
        else:
            both = shapely.union_all([field.no_go, Polygon(edit.lonlat)])
            areas = [a for a in shapely.get_parts(both) if a.geom_type == "Polygon"]
            field = replace(field, no_go=MultiPolygon(areas))
    return field


def _with_row(field: Field, row: LineString) -> Field:
    """Return the field with a row of which the others are copies: all of them, or its block's."""
    own = next((block for block in field.blocks if _mostly_in(row, block.area)), None)
    others = [
        line for line in field.row_lines.geoms
        if own is not None and not _mostly_in(line, own.area)
    ]  # fmt: skip
    return replace(field, row_lines=MultiLineString([*others, row]))


def _mostly_in(line: LineString, area: MultiPolygon) -> bool:
    return bool(shapely.intersection(line, area).length > line.length / 2)


def points_of(text: str) -> Points:
    """Return typed positions, ``lon,lat`` each, separated by spaces, semicolons or lines.

    Where the language writes fractions with a comma, a space parts the two: ``35,15 30,36``.
    """
    made = []
    if language.separators()[0] == "," and "." not in text:
        numbers = text.replace(",", ".").replace(";", " ").split()
        text = " ".join(",".join(numbers[k : k + 2]) for k in range(0, len(numbers), 2))
    for part in text.replace(";", " ").replace(", ", ",").split():
        try:
            lon, lat = (float(number) for number in part.split(","))
        except ValueError:
            raise SettingError(texts.DRAW_WRITTEN.format(text=part)) from None
        if not (-180 <= lon <= 180 and -90 <= lat <= 90):
            raise SettingError(texts.DRAW_RANGE.format(text=part))
        made.append((lon, lat))
    return tuple(made)
