"""What a person draws on a plot: gate, paths and no-go areas. No Streamlit in here."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import shapely
from shapely import LineString, MultiLineString, MultiPolygon, Polygon

from fieldmon.errors import SettingError

from ..words import texts

if TYPE_CHECKING:
    from fieldmon.plot.field import Field

GATE, PATH, NO_GO = "gate", "path", "no_go"
NEEDED = {GATE: 1, PATH: 2, NO_GO: 3}
Points = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Edit:
    """One thing that was drawn.

    Parameters
    ----------
    kind
        `GATE`, `PATH` or `NO_GO`.
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
        else:
            both = shapely.union_all([field.no_go, Polygon(edit.lonlat)])
            areas = [a for a in shapely.get_parts(both) if a.geom_type == "Polygon"]
            field = replace(field, no_go=MultiPolygon(areas))
    return field


def points_of(text: str) -> Points:
    """Return typed positions, ``lon,lat`` each, separated by spaces, semicolons or lines."""
    made = []
    for part in text.replace(";", " ").replace(", ", ",").split():
        try:
            lon, lat = (float(number) for number in part.split(","))
        except ValueError:
            raise SettingError(texts.DRAW_WRITTEN.format(text=part)) from None
        if not (-180 <= lon <= 180 and -90 <= lat <= 90):
            raise SettingError(texts.DRAW_RANGE.format(text=part))
        made.append((lon, lat))
    return tuple(made)
