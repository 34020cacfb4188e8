"""Tiles of people's own maps, handed to browsers by this server under a digest nobody can guess."""

from __future__ import annotations

import hashlib
import re
import secrets
import threading
from collections import OrderedDict
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fieldmon.io.rasters.tiles import Tileset

#: where the server hands them out
PATH = "/map_tiles/"
_TILE = re.compile(r"(/map_tiles/[0-9a-f]{40})/(\d{1,2})/(\d{1,10})/(\d{1,10})")
_MAPS = 50


class TileShelf:
    """Maps in tiles by address, the ones shown last."""

    def __init__(self, at_most: int = _MAPS) -> None:
        self._secret = secrets.token_bytes(32)
        self._at_most = at_most
        self._kept: OrderedDict[str, Tileset] = OrderedDict()
        self._lock = threading.Lock()

    def publish(self, tiles: Tileset) -> str:
        """Hand a map out; return the address of its tiles, with {z}, {x} and {y} in it."""
        file = tiles.path.stat()
        named = f"{tiles.path} {file.st_mtime_ns} {file.st_size}".encode()
        address = PATH + hashlib.blake2b(named, digest_size=20, key=self._secret).hexdigest()
        with self._lock:
            self._kept[address] = tiles
            self._kept.move_to_end(address)
            while len(self._kept) > self._at_most:
                self._kept.popitem(last=False)
        return f"{address}/{{z}}/{{x}}/{{y}}"

    def get(self, path: str) -> tuple[str, bytes] | None:
        """Return the kind and the bytes of a tile, or None."""
        asked = _TILE.fullmatch(path)
        with self._lock:
            tiles = self._kept.get(asked[1]) if asked else None
        if tiles is None or asked is None:
            return None
        found = tiles.tile(*(int(number) for number in asked.groups()[1:]))
        return None if found is None else (tiles.mime, found)


#: the maps of this server
SHELF = TileShelf()
