"""What the reading process answers about maps in tiles: what is in them, and one tile.

MBTiles (1.3) is a SQLite database whose rows count from the south; PMTiles (3) one file of
directories and tiles.
"""

from __future__ import annotations

import gzip
import math
import sqlite3
import struct
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pmtiles import tile as pm
from pmtiles.reader import MmapSource, Reader

from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem
from fieldmon.io.formats.signatures import picture_type

if TYPE_CHECKING:
    from collections.abc import Callable

    #: kind of pictures, first and last zoom, bounds, pixels along a side, credit
    Described = tuple[str, tuple[int, int], tuple[float, float, float, float], int, str]

#: the last zoom at which anybody has tiles
_MOST_ZOOM = 30
# one tile is never so large
_MOST_BYTES = 10_000_000
_EDGE = 85.0511
_BROKEN = (sqlite3.Error, OSError, ValueError, KeyError, IndexError, EOFError, struct.error,
           OverflowError, pm.SpecVersionUnsupported, pm.MagicNumberNotFound)  # fmt: skip


def described(path: str) -> Described:
    """Return what a map in tiles holds; raise `FileProblem` if it is none, or not of pictures."""
    name = Path(path).name
    try:
        return (_pm_described if _is_pm(path) else _mb_described)(path)
    except _BROKEN as bad:
        raise FileProblem(
            worded(
                "{name} must be a map in tiles (MBTiles or PMTiles), but it cannot "
                "be read so ({problem}). Export or download it again.",
                name=name,
                problem=_short(bad),
            )
        ) from bad


def tile(path: str, zoom: int, column: int, row: int) -> bytes | None:
    """Return the picture of a tile, rows from the north; None: there is none, or it is no picture.

    A tile that cannot be read is none: the map goes on without it.
    """
    if not (0 <= zoom <= _MOST_ZOOM and 0 <= column < 2**zoom and 0 <= row < 2**zoom):
        return None
    try:
        found = (_pm_tile if _is_pm(path) else _mb_tile)(path, zoom, column, row)
    except _BROKEN:
        return None
    if found is None or len(found) > _MOST_BYTES or picture_type(found) is None:
        return None
    return found


def side_of(picture: bytes) -> int:
    """Return the pixels along a tile's side, by the head of its picture: 256 or 512."""
    if picture.startswith(b"\x89PNG"):
        return 512 if struct.unpack(">I", picture[16:20])[0] >= 512 else 256
    if picture.startswith(b"RIFF"):
        return 512 if _webp_width(picture) >= 512 else 256
    at = 2
    while picture.startswith(b"\xff\xd8") and at + 9 < len(picture):
        marker, length = picture[at + 1], struct.unpack(">H", picture[at + 2 : at + 4])[0]
        if 0xC0 <= marker <= 0xCF and marker not in {0xC4, 0xC8, 0xCC}:
            return 512 if struct.unpack(">H", picture[at + 7 : at + 9])[0] >= 512 else 256
        at += 2 + length
    return 256


def _webp_width(picture: bytes) -> int:
    """Return the pixels across a WebP, which says them in three ways (RFC 9649)."""
    if picture[12:16] == b"VP8X":
        return 1 + int.from_bytes(picture[24:27], "little")
    if picture[12:16] == b"VP8L":
        return 1 + (int.from_bytes(picture[21:23], "little") & 0x3FFF)
    return int.from_bytes(picture[26:28], "little") & 0x3FFF


def _is_pm(path: str) -> bool:
    with Path(path).open("rb") as file:
        return file.read(7) == b"PMTiles"


def _short(bad: Exception) -> str:
    return str(bad).splitlines()[0][:120] if str(bad) else type(bad).__name__


def _pictures(picture: bytes, name: str) -> tuple[str, int]:
    mime = picture_type(picture)
    if mime is None:
        raise FileProblem(
            worded(
                "The tiles of {name} must be pictures (PNG, JPEG, WebP), but they "
                "are not: such maps are drawn by other programs. Export it as "
                "raster tiles.",
                name=name,
            )
        )
    return mime, side_of(picture)


# -- MBTiles


def _opened(path: str) -> closing[sqlite3.Connection]:
    db = sqlite3.connect(f"{Path(path).absolute().as_uri()}?mode=ro&immutable=1", uri=True)
    db.execute("PRAGMA trusted_schema = OFF")
    return closing(db)


def _mb_described(path: str) -> Described:
    with _opened(path) as db:
        said = dict(db.execute("SELECT name, value FROM metadata").fetchall())
        first, last = db.execute("SELECT min(zoom_level), max(zoom_level) FROM tiles").fetchone()
        if first is None:
            raise FileProblem(
                worded("{name} must hold tiles, but it holds none.", name=Path(path).name)
            )
        (sample,) = db.execute("SELECT tile_data FROM tiles LIMIT 1").fetchone()
        extent = db.execute(
            "SELECT min(tile_column), max(tile_column), min(tile_row), max(tile_row) FROM tiles "
            "WHERE zoom_level = ?", (last,),
        ).fetchone()  # fmt: skip
    mime, side = _pictures(sample, Path(path).name)
    bounds = _said_bounds(said.get("bounds")) or _of_tiles(int(last), *map(int, extent))
    return mime, _zooms(first, last), bounds, side, _plain(said.get("attribution"))


def _mb_tile(path: str, zoom: int, column: int, row: int) -> bytes | None:
    with _opened(path) as db:
        found = db.execute(
            "SELECT tile_data FROM tiles WHERE zoom_level = ? AND tile_column = ? AND tile_row = ?",
            (zoom, column, 2**zoom - 1 - row),
        ).fetchone()
    return None if found is None else bytes(found[0])


def _said_bounds(text: object) -> tuple[float, float, float, float] | None:
    try:
        west, south, east, north = (float(part) for part in str(text).split(","))
    except ValueError:
        return None
    is_some = west < east and south < north and abs(west) <= 180 >= abs(east)
    return (west, max(south, -_EDGE), east, min(north, _EDGE)) if is_some else None


def _of_tiles(
    zoom: int, west: int, east: int, south: int, north: int
) -> tuple[float, float, float, float]:
    """Return what tiles of a zoom cover; rows count from the south."""
    n = 2.0**zoom

    def lat(row: float) -> float:
        return math.degrees(math.atan(math.sinh(math.pi * (2 * row / n - 1))))

    def lon(column: float) -> float:
        return 360.0 * column / n - 180.0

    return lon(west), lat(south), lon(east + 1), lat(north + 1)


def _zooms(first: object, last: object) -> tuple[int, int]:
    a, b = int(first), int(last)  # type: ignore[call-overload]
    if not 0 <= a <= b <= _MOST_ZOOM:
        raise ValueError(f"zooms {a} to {b}")
    return a, b


def _plain(said: object) -> str:
    """Return whom a file names as its source, without the tags that many write."""
    text, kept, is_tag = str(said or ""), [], False
    for letter in text[:1000]:
        is_tag = letter == "<" or (is_tag and letter != ">")
        if not is_tag and letter != ">":
            kept.append(letter)
    return "".join(kept).strip()[:200]


# -- PMTiles


def _with_reader(path: str, ask: Callable[[Reader], Any]) -> Any:  # noqa: ANN401 - what it answers
    with Path(path).open("rb") as file:
        return ask(Reader(MmapSource(file)))  # type: ignore[no-untyped-call]


def _pm_described(path: str) -> Described:
    def ask(reader: Any) -> Described:  # noqa: ANN401 - the package has no types of it
        head = reader.header()
        first, last = _zooms(head["min_zoom"], head["max_zoom"])
        edges = [
            head[f"{end}_{axis}_e7"] / 1e7 for end in ("min", "max") for axis in ("lon", "lat")
        ]
        bounds = _said_bounds(",".join(map(str, edges))) or (-180.0, -_EDGE, 180.0, _EDGE)
        sample = _first_tile(reader, head)
        mime, side = _pictures(sample, Path(path).name)
        credit = ""
        if head["metadata_length"]:
            said = reader.metadata()
            credit = _plain(said.get("attribution")) if isinstance(said, dict) else ""
        return mime, (first, last), bounds, side, credit

    described_: Described = _with_reader(path, ask)
    return described_


def _first_tile(reader: Any, head: Any) -> bytes:  # noqa: ANN401 - the package has no types of it
    at, length = head["root_offset"], head["root_length"]
    for _ in range(4):
        entries = pm.deserialize_directory(reader.get_bytes(at, length))
        if not entries:
            break
        if entries[0].run_length:
            start = head["tile_data_offset"] + entries[0].offset
            return _unpacked(reader.get_bytes(start, entries[0].length), head)
        at, length = head["leaf_directory_offset"] + entries[0].offset, entries[0].length
    raise ValueError("it holds no tiles")


def _pm_tile(path: str, zoom: int, column: int, row: int) -> bytes | None:
    def ask(reader: Any) -> bytes | None:  # noqa: ANN401 - the package has no types of it
        found = reader.get(zoom, column, row)
        return None if found is None else _unpacked(found, reader.header())

    found: bytes | None = _with_reader(path, ask)
    return found


def _unpacked(found: bytes, head: Any) -> bytes:  # noqa: ANN401 - the package has no types of it
    return gzip.decompress(found) if head["tile_compression"] == pm.Compression.GZIP else found
