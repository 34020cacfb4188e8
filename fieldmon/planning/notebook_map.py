"""A planned day as a map in a notebook. pydeck is loaded with this module alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pydeck as pdk
import shapely

from fieldmon.compute.wording import chance_figure
from fieldmon.plot.grid import plant_numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.planning.route import Route
    from fieldmon.plot.grid import PlantGrid

    Floats = NDArray[np.float64]

# chances from which a colour holds: pale to dark, told apart without hue too
_FROM = np.array([0.0, 0.01, 0.02, 0.05, 0.10, 0.25, 0.50])
_COLOURS = np.array(
    [
        *((240, 222, 150), (254, 200, 100), (254, 178, 76), (240, 120, 40)),
        *((210, 55, 30), (150, 10, 40), (70, 0, 30)),
    ]
)
_ROUTE = [20, 80, 200]
_SURROUNDINGS = 1.3  # what the view shows, as a share of the plot's extent


def deck_of(route: Route, chance: Floats) -> pdk.Deck:
    """Return a deck with the layers ``plot``, ``plants``, ``route`` and ``stops``.

    `chance` is what is believed of every plant, ``(n,)``.
    """
    grid = route.aisles.grid
    area = grid.frame.geometry_lonlat(grid.drivable_m)
    layers = [
        pdk.Layer(
            "GeoJsonLayer", shapely.geometry.mapping(area), id="plot", stroked=True, filled=False,
            get_line_color=[110, 120, 110], line_width_min_pixels=2,
        ),
        pdk.Layer(
            "ScatterplotLayer", _plants(grid, chance), id="plants", get_position="at",
            pickable=True, get_fill_color="colour", radius_min_pixels=1.5,
            get_radius=0.3 * min(grid.plant_spacing_m, grid.row_spacing_m),
        ),
        pdk.Layer(
            "PathLayer", [{"path": route.line_lonlat().tolist()}], id="route", get_path="path",
            get_color=_ROUTE, width_min_pixels=2,
        ),
        pdk.Layer(
            "ScatterplotLayer", _stops(route), id="stops", get_position="at", pickable=True,
            filled=False, stroked=True, get_line_color=_ROUTE, line_width_min_pixels=1.5,
            get_radius=0.4 * grid.plant_spacing_m, radius_min_pixels=3,
        ),
    ]  # fmt: skip
    return pdk.Deck(
        layers, initial_view_state=_view(area.bounds), map_provider=None, tooltip={"text": "{text}"}
    )


def _plants(grid: PlantGrid, believed: Floats) -> list[dict[str, Any]]:
    numbered = plant_numbers(grid)
    colours = _COLOURS[np.searchsorted(_FROM, believed, side="right") - 1]
    return [
        {
            "at": at,
            "colour": colour,
            "text": f"row {row}, plant {number}: chance {chance_figure(chance, 1)}",
        }
        for at, colour, row, number, chance in zip(
            grid.lonlat().round(8).tolist(),
            colours.tolist(),
            *(numbered.line.tolist(), numbered.number.tolist()),
            believed.tolist(),
            strict=True,
        )
    ]


def _stops(route: Route) -> list[dict[str, Any]]:
    numbered = plant_numbers(route.aisles.grid, route.plant)
    columns = (
        route.stops_lonlat().round(8).tolist(),
        *(numbered.line.tolist(), numbered.number.tolist()),
        *(route.arrive_s.tolist(), route.chance.tolist()),
    )
    return [
        {
            "at": at,
            "text": f"stop {order}: row {row}, plant {number}, after {_clock(arrive_s)}, "
            f"chance {chance_figure(chance, 1)}",
        }
        for order, (at, row, number, arrive_s, chance) in enumerate(zip(*columns, strict=True), 1)
    ]


def _clock(seconds: float) -> str:
    minutes = round(seconds / 60)
    return f"{minutes // 60} h {minutes % 60:02d} min"


def _view(bounds: tuple[float, ...]) -> pdk.ViewState:
    west, south, east, north = bounds
    lon, lat = (west + east) / 2, (south + north) / 2
    return pdk.ViewState(longitude=lon, latitude=lat, zoom=_zoom(east - west, north - south, lat))


def _zoom(wide_deg: float, high_deg: float, latitude: float) -> float:
    """Return the zoom at which so many degrees fill a map of 600 by 450 pixels, and a little more.

    A Web Mercator tile of zoom 0 shows 360 degrees on 512 pixels.
    """
    high_deg /= np.cos(np.deg2rad(latitude))
    scale = max(wide_deg / 600, high_deg / 450) * _SURROUNDINGS
    return float(np.clip(np.log2(360 / 512 / max(scale, 1e-9)), 1, 20))
