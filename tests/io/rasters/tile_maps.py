"""Maps in tiles that people bring: MBTiles by its specification, PMTiles by its own package."""

import io
import math
import sqlite3
from contextlib import closing

import numpy as np
from PIL import Image
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer


def picture(colour, size=256, kind="PNG", **options):
    """Return a tile of one colour."""
    out = io.BytesIO()
    Image.fromarray(np.full((size, size, 3), colour, np.uint8)).save(out, kind, **options)
    return out.getvalue()


def tile_at(lon, lat, zoom):
    """Return column and row, from the north, of the tile in which a place lies."""
    n = 2**zoom
    y = math.asinh(math.tan(math.radians(lat))) / math.pi
    return int((lon + 180) / 360 * n), int((1 - y) / 2 * n)


def about(lon, lat, zooms, make=lambda zoom, column, row: picture((zoom, column % 256, row % 256))):
    """Return tiles round a place, ``{(zoom, column, row): picture}``."""
    tiles = {}
    for zoom in zooms:
        column, row = tile_at(lon, lat, zoom)
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                tiles[zoom, column + dx, row + dy] = make(zoom, column + dx, row + dy)
    return tiles


def mbtiles(path, tiles, **said):
    """Write MBTiles 1.3: rows count from the south."""
    with closing(sqlite3.connect(path)) as db, db:
        db.execute("CREATE TABLE metadata (name TEXT, value TEXT)")
        db.execute("CREATE TABLE tiles (zoom_level INTEGER, tile_column INTEGER, tile_row INTEGER, "
                   "tile_data BLOB)")  # fmt: skip
        db.executemany("INSERT INTO metadata VALUES (?, ?)", {"name": "t", **said}.items())
        from_south = [(z, x, 2**z - 1 - y, data) for (z, x, y), data in tiles.items()]
        db.executemany("INSERT INTO tiles VALUES (?, ?, ?, ?)", from_south)
    return path


def pmtiles(path, tiles, bounds, kind=TileType.PNG, credit=""):
    """Write PMTiles 3."""
    with path.open("wb") as file:
        writer = Writer(file)
        for (z, x, y), data in sorted(tiles.items(), key=lambda one: zxy_to_tileid(*one[0])):
            writer.write_tile(zxy_to_tileid(z, x, y), data)
        head = {"tile_type": kind, "tile_compression": Compression.NONE}
        for name, edge in zip(("min_lon", "min_lat", "max_lon", "max_lat"), bounds, strict=True):
            head[f"{name}_e7"] = int(edge * 1e7)
        head |= {"center_zoom": 0, "center_lon_e7": 0, "center_lat_e7": 0}
        writer.finalize(head, {"attribution": credit} if credit else {})
    return path
