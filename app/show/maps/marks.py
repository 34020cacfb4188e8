"""What else lies on a map: hot spots, records, paths, places, what is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from pydeck import Layer

from fieldmon.infestation.hotspots import outlines_m
from fieldmon.plot.row_course import row_corners

from ...words import texts
from . import plant_layers
from .colours import (
    GATE,
    HOT,
    HOT_IN_DARK,
    TREATED,
    TREATED_IN_DARK,
    TRUTH,
    TRUTH_IN_DARK,
    UNKNOWN,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fieldmon.infestation.hotspots import HotSpots
    from fieldmon.infestation.records import Records
    from fieldmon.monitoring.treating.treatments import KeptTreatment
    from fieldmon.plot.field import Field
    from fieldmon.plot.grid import PlantGrid

    from ...words.units import UnitsInLanguage
    from .colours import Colour, Translucent

# so many places on a hot spot's edge are tried for its number where its middle is taken
_ALONG_EDGE = 12


def hot(grid: PlantGrid, spots: HotSpots, *, dark: bool = False) -> list[Layer]:
    """Return the hot spots, if there are any: their tint, and their outlines."""
    if not len(spots):
        return []
    rows = []
    for k, outline_m in enumerate(outlines_m(grid, spots)):
        shape = grid.frame.geometry_lonlat(outline_m)
        corners = np.round(shapely.get_coordinates(shape.exterior), 7).tolist()
        text = texts.TIP_HOT.format(n=k + 1, found=spots.found[k], inspected=spots.inspected[k])
        number = {"t": f"{k + 1}", "at": _for_number(grid, shape, spots.centre_m[k])}
        rows.append({"p": corners, "t": text, "number": number})
    colour = HOT_IN_DARK if dark else HOT
    return [
        Layer("PolygonLayer", rows, id="hot", get_polygon="p", get_fill_color=[*colour, 20],
              stroked=False),
        Layer("PathLayer", rows, id="hot-edge", get_path="p", get_color=list(colour),
              width_min_pixels=3, get_width=0.4),
    ]  # fmt: skip


def _for_number(
    grid: PlantGrid, shape: shapely.Polygon, centre_m: NDArray[np.float64]
) -> list[list[float]]:
    """Return where a hot spot's number may stand, lon/lat: its middle, else along its edge."""
    middle = shapely.Point(grid.frame.lonlat(centre_m[None])[0])
    inside = middle if shape.contains(middle) else shapely.point_on_surface(shape)
    along = shapely.line_interpolate_point(
        shape.exterior, np.arange(_ALONG_EDGE) / _ALONG_EDGE, normalized=True
    )
    places: list[list[float]] = np.round(shapely.get_coordinates([inside, *along]), 7).tolist()
    return places


def with_hot(layers: list[Layer], spots: list[Layer]) -> list[Layer]:
    """Return the layers with hot spots outlined, their tint under plants that can be tapped."""
    points = [k for k, layer in enumerate(layers) if layer.type == "PlantsLayer"]
    under = min([*points, len(layers)])
    return [*layers[:under], *spots[:1], *layers[under:], *spots[1:]]


def treated(
    treatments: Sequence[KeptTreatment], field: Field, units: UnitsInLanguage, *, dark: bool = False
) -> list[Layer]:
    """Return what was treated of a plot, if anything was: its tint, and its outline."""
    rows = []
    for one in treatments:
        product, day = one.application.product, units.said_day(one.on)
        text = texts.TIP_TREATED.format(day=day)
        if product:
            text = texts.TIP_TREATED_WITH.format(day=day, product=texts.isolated(product))
        rows += [
            {"p": np.round(shapely.get_coordinates(part.exterior), 7).tolist(), "t": text}
            for part in shapely.get_parts(one.place.area.intersection(field.boundary))
            if part.geom_type == "Polygon"
        ]
    colour = TREATED_IN_DARK if dark else TREATED
    return [
        Layer("PolygonLayer", rows, id="treated", get_polygon="p", get_fill_color=[*colour, 26],
              stroked=False),
        Layer("PathLayer", rows, id="treated-edge", get_path="p", get_color=list(colour),
              width_min_pixels=2, get_width=0.4),
    ] if rows else []  # fmt: skip


def blocks(field: Field, *, dark: bool = False) -> list[Layer]:
    """Return the outlines of the blocks, if the plot has several."""
    if len(field.blocks) < 2:
        return []
    rings = shapely.get_rings(shapely.get_parts([block.area for block in field.blocks]))
    rows = [{"path": np.round(shapely.get_coordinates(ring), 7).tolist()} for ring in rings]
    return [
        Layer("PathLayer", rows, id="blocks", get_path="path",
              get_color=[230, 230, 230] if dark else [40, 40, 40], get_width=0.4,
              width_min_pixels=2)
    ]  # fmt: skip


def paths(field: Field) -> list[Layer]:
    """Return the paths along which insects come in."""
    rows = [
        {"path": np.round(shapely.get_coordinates(line), 7).tolist(), "t": texts.TIP_PATH}
        for line in shapely.get_parts(field.paths)
    ]
    return [
        Layer("PathLayer", rows, id="paths", get_path="path", get_color=[150, 110, 60, 160],
              get_width=1.0, width_min_pixels=2)
    ]  # fmt: skip


def rows(grid: PlantGrid, name: str, colour: Colour | Translucent, note: str = "") -> Layer:
    """Return the rows as lines."""
    lines = [
        {"path": np.round(grid.frame.lonlat(line_m), 7).tolist(), **({"t": note} if note else {})}
        for line_m in row_corners(grid)
    ]
    return Layer("PathLayer", lines, id=name, get_path="path", get_color=list(colour),
                 get_width=0.25, width_min_pixels=1.2)  # fmt: skip


def records(records: Records, *, dark: bool = False) -> list[Layer]:
    """Return the records: filled where pests were seen, empty where not, grey if nobody knows."""
    colour = HOT_IN_DARK if dark else HOT
    rows = [
        {
            "p": place,
            "c": [*colour, 220 if seen == 1 else 0],
            "l": [*(colour if seen in texts.TIP_SEEN else UNKNOWN), 170],
            "t": texts.TIP_RECORD.format(
                day=day, result=texts.TIP_SEEN.get(seen, texts.TIP_NOT_KNOWN)
            ),
        }
        for place, seen, day in zip(
            np.round(records.lonlat, 7).tolist(),
            records.present.tolist(),
            records.day.astype(str).tolist(),
            strict=True,
        )
    ]
    return [
        Layer(
            "ScatterplotLayer", rows, id="records", get_position="p", get_fill_color="c",
            get_radius=1.2, radius_min_pixels=3, stroked=True, get_line_color="l",
            line_width_min_pixels=1,
        )
    ]  # fmt: skip


def truth(grid: PlantGrid, infested: NDArray[np.bool_], *, dark: bool = False) -> list[Layer]:
    """Return dots on plants that are infested, as only a simulation can know."""
    here = np.round(plant_layers.drawn_at(grid, np.flatnonzero(infested)), 7).tolist()
    return [
        Layer(
            "ScatterplotLayer", [{"p": p, "t": texts.TIP_INFESTED} for p in here], id="truth",
            get_position="p", get_fill_color=list(TRUTH_IN_DARK if dark else TRUTH),
            get_radius=0.5, radius_min_pixels=2,
        )
    ]  # fmt: skip


def places(lonlat: list[list[float]], name: str, colour: Colour, note: str) -> Layer:
    """Return large rings about some positions: where one stands, what was tapped."""
    rows = [{"p": p, "t": note} for p in lonlat]
    return Layer(
        "ScatterplotLayer", rows, id=name, get_position="p", get_radius=1.5, radius_min_pixels=11,
        filled=True, get_fill_color=[*colour, 60], stroked=True, get_line_color=list(colour),
        line_width_min_pixels=4,
    )  # fmt: skip


def drawing(points: tuple[tuple[float, float], ...]) -> list[Layer]:
    """Return what is being drawn: its corners so far, joined."""
    here = [list(point) for point in points]
    return [
        Layer(
            "PathLayer", [{"path": here}] if len(here) > 1 else [], id="drawing", get_path="path",
            get_color=list(GATE), width_min_pixels=3, get_width=0.4,
        ),
        places(here, "corners", GATE, texts.TIP_CORNER),
    ]  # fmt: skip
