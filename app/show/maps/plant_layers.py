"""The plants on a map: points, or one picture of very many; finds told by shape too."""

from __future__ import annotations

import base64
import io
import zlib
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import pydeck as pdk
from PIL import Image
from pydeck import Layer

from fieldmon.plot.grid import row_label

from ...words import texts
from .colours import FOUND

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fieldmon.plot.grid import PlantGrid

    from .colours import Colour, Shade

    #: what is said of some plants, in words
    Notes = Callable[[NDArray[np.intp]], list[str]]

# more plants than this travel as one picture
POINTS_AT_MOST = 20_000
_PICTURE_AT_MOST = 2048
# plots are not changed once laid; their pictures' pixels go when they do
_RASTERS: WeakKeyDictionary[PlantGrid, _Raster] = WeakKeyDictionary()


def plants(
    grid: PlantGrid, shade: Shade, notes: Notes, part: NDArray[np.intp] | None = None
) -> Layer:
    """Return the plants: points with a note each, or one picture if there are very many.

    `part` names the plants to draw as points where the plot is too large to draw all.
    """
    if part is None and len(grid) > POINTS_AT_MOST:
        return _picture(grid, shade)
    which = np.arange(len(grid)) if part is None else part
    label = row_label(grid, which)
    columns = zip(
        np.round(grid.lonlat(which), 7).tolist(), shade.table[shade.rank[which]].tolist(),
        label.line.tolist(), label.number.tolist(), which.tolist(), notes(which), strict=True,
    )  # fmt: skip
    rows = [
        {
            "p": place,
            "c": colour,
            "i": plant,
            "t": texts.TIP_PLANT.format(row=line, plant=number, note=note),
        }
        for place, colour, line, number, plant, note in columns
    ]
    return Layer(
        "ScatterplotLayer",
        rows,
        id="plants" if part is None else "part",
        get_position="p",
        get_fill_color="c",
        get_radius=0.4 * min(grid.plant_spacing_m, grid.row_spacing_m),
        radius_min_pixels=1.5,
        stroked=True,
        get_line_color=[120, 110, 90, 140],
        line_width_min_pixels=0.5,
        get_line_width=0.05,
        pickable=True,
    )


def unsaid(which: NDArray[np.intp]) -> list[str]:
    """Return nothing to say of each of these plants."""
    return [""] * len(which)


def finds(grid: PlantGrid, state: NDArray[np.int8]) -> list[Layer]:
    """Return a dark ring with a pale rim round each find: told by shape, not by colour alone.

    Where finds stand close, the rings run together, but none covers a find.
    """
    here = np.round(grid.lonlat(np.flatnonzero(state == 1)), 7).tolist()
    least_m = min(grid.plant_spacing_m, grid.row_spacing_m)
    rings = [
        _ring(f"finds{k}", here, 0.55 * least_m, (colour, pixels))
        for k, (colour, pixels) in enumerate([((255, 255, 255), 4.5), ((20, 0, 0), 2.0)])
    ]
    dots = Layer(
        "ScatterplotLayer", [{"p": p} for p in here], id="found", get_position="p",
        get_fill_color=list(FOUND), get_radius=0.4 * least_m, radius_min_pixels=2,
    )  # fmt: skip
    return [*rings, dots]


def chosen(grid: PlantGrid, plant: int) -> list[Layer]:
    """Return a broad yellow ring with a dark rim round the plant whose history is shown."""
    here = np.round(grid.lonlat(np.array([plant])), 7).tolist()
    size = 0.9 * min(grid.plant_spacing_m, grid.row_spacing_m)
    return [
        _ring(f"chosen{k}", here, size, pen, 9.0)
        for k, pen in enumerate([((40, 30, 0), 6.5), ((255, 190, 0), 4.0)])
    ]


def _ring(
    name: str,
    places: list[list[float]],
    size_m: float,
    pen: tuple[Colour, float],
    least_px: float = 4.5,
) -> Layer:
    colour, pixels = pen
    return Layer(
        "ScatterplotLayer", [{"p": p} for p in places], id=name, get_position="p",
        get_radius=size_m, radius_min_pixels=least_px, filled=False, stroked=True,
        get_line_color=list(colour), line_width_min_pixels=pixels, get_line_width=0.05,
    )  # fmt: skip


class _Raster(NamedTuple):
    """A picture of a plot: its size, its corners lon/lat, and the pixel of each plant ``(n,)``."""

    tall: int
    wide: int
    corners: list[list[float]]
    pixel: NDArray[np.intp]


def _raster(grid: PlantGrid) -> _Raster:
    kept = _RASTERS.get(grid)
    if kept is not None:
        return kept
    low, high = grid.xy_m.min(axis=0), grid.xy_m.max(axis=0)
    step = np.array([grid.plant_spacing_m, grid.row_spacing_m])
    step = np.maximum(step, (high - low) / _PICTURE_AT_MOST)
    low, high = low - step / 2, high + step / 2
    wide, tall = np.ceil((high - low) / step).astype(int).tolist()
    column, line = np.floor((grid.xy_m - low) / step).astype(np.intp).T
    right, top = low + step * [wide, tall]
    corners = [[low[0], low[1]], [low[0], top], [right, top], [right, low[1]]]
    lonlat = grid.frame.lonlat(corners).tolist()
    _RASTERS[grid] = _Raster(tall, wide, lonlat, (tall - 1 - line) * wide + column)
    return _RASTERS[grid]


def _picture(grid: PlantGrid, shade: Shade) -> Layer:
    """Return the plants as one picture, the most important plant of each pixel on top."""
    raster = _raster(grid)
    # one number a pixel, looked up in a table of colours; 0 is the ground between plants
    pixels = np.zeros(raster.tall * raster.wide, np.uint8)
    np.maximum.at(pixels, raster.pixel, shade.rank + np.uint8(1))
    image = Image.fromarray(pixels.reshape(raster.tall, raster.wide))
    image.putpalette(bytes(3) + shade.table[:, :3].tobytes())
    file = io.BytesIO()
    # rows are runs of one colour: looked for as such, they pack as well as at the highest level
    opacity = bytes(1) + shade.table[:, 3].tobytes()
    image.save(file, "PNG", transparency=opacity, compress_type=zlib.Z_RLE)
    uri = "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()
    return Layer(
        "BitmapLayer",
        None,
        id="plants-picture",  # its own: the page takes a layer of the same id for the same layer
        image=pdk.types.String(uri),
        bounds=raster.corners,
        texture_parameters={"magFilter": "nearest", "minFilter": "nearest"},
    )
