"""What lies under the plants: a picture of the ground, its relief, or a map in tiles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pydeck import Layer

from .deck import ArraysLayer

if TYPE_CHECKING:
    from fieldmon.io.rasters.tiles import Tileset
    from fieldmon.io.rasters.values import Backdrop

#: layers of the ground, from below to above
IDS = ("ground-map", "ground-tiles", "ground-picture")
# by night, a relief is a dark one
_BY_NIGHT = [84, 96, 98]


def picture(made: Backdrop, *, is_relief: bool = False, dark: bool = False) -> Layer:
    """Return a picture of the ground where it lies."""
    tint = _BY_NIGHT if is_relief and dark else [255, 255, 255]
    return ArraysLayer(
        "BitmapLayer", {"image": made.image}, id="ground-picture",
        bounds=made.corners_lonlat.tolist(), tint_color=tint,
    )  # fmt: skip


def tiles(address: str, of: Tileset) -> Layer:
    """Return a map in tiles that this server hands out."""
    return _tiles("ground-tiles", address, of.zooms, tile_size=of.size, extent=list(of.bounds))


def web_map(address: str, last_zoom: int) -> Layer:
    """Return a map in tiles of another server; to draw it is to ask that server."""
    return _tiles("ground-map", address, (0, last_zoom), tile_size=256)


def _tiles(name: str, address: str, zooms: tuple[int, int], **more: object) -> Layer:
    return Layer("GroundLayer", address, id=name, min_zoom=zooms[0], max_zoom=zooms[1], **more)
