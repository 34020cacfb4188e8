"""Maps in tiles: an MBTiles or PMTiles file of pictures, read where it lies.

What is in it is looked up in a process of its own (`fieldmon.io.sandbox`), a tile at a time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.sandbox import process

if TYPE_CHECKING:
    from pathlib import Path

    from fieldmon.plot.field import Field


@dataclass(frozen=True)
class Tileset:
    """A map in tiles of Web Mercator, each a picture.

    Parameters
    ----------
    path
        The file.
    mime
        What kind of pictures: ``"image/png"``.
    zooms
        The first and the last zoom that it holds.
    bounds
        What it covers: west, south, east, north.
    size
        Pixels along a tile's side.
    credit
        Whom its file names as its source; empty: nobody.
    """

    path: Path
    mime: str
    zooms: tuple[int, int]
    bounds: tuple[float, float, float, float]
    size: int = 256
    credit: str = ""

    def tile(self, zoom: int, column: int, row: int) -> bytes | None:
        """Return the picture of a tile, rows from the north; None: there is none."""
        found: bytes | None = process.call(
            "fieldmon.io.rasters.tile_files:tile", str(self.path), zoom, column, row
        )
        return found


def is_tiles(head: bytes) -> bool:
    """Return whether a file that begins so may be a map in tiles."""
    return head.startswith((b"PMTiles", b"SQLite format 3\x00"))


def read_tiles(path: Path, near: Field | None = None) -> Tileset:
    """Return what a map in tiles holds.

    Raise `FileProblem` if it is none, if its tiles are no pictures, or if it does not show the
    plot `near`.
    """
    mime, zooms, bounds, size, credit = process.call(
        "fieldmon.io.rasters.tile_files:described", str(path)
    )
    found = Tileset(path, mime, zooms, bounds, size, credit)
    if near is not None:
        west, south, east, north = near.boundary.bounds
        if west > bounds[2] or east < bounds[0] or south > bounds[3] or north < bounds[1]:
            raise FileProblem(
                worded(
                    "{name} must show plot {plot}, but it shows another place "
                    "({west:.3f} to {east:.3f} east, {south:.3f} to {north:.3f} "
                    "north). Choose another map.",
                    name=path.name,
                    plot=near.name,
                    west=bounds[0],
                    east=bounds[2],
                    south=bounds[1],
                    north=bounds[3],
                )
            )
    return found
