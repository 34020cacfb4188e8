"""What maps are made of, kept where browsers fetch it: each thing under a digest of its content.

A map that is drawn again costs nothing for what the browser already has. Addresses cannot be
guessed: the digest is keyed with a secret of this process.
"""

from __future__ import annotations

import hashlib
import secrets
import threading
from collections import OrderedDict
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    Changing = Callable[[int | None], bytes]

#: where the server hands it out
PATH = "/map_data/"
JSON, BYTES = "application/json", "application/octet-stream"
_AT_MOST = 512 * 2**20
_MOST_CHANGING = 16


class MapStore:
    """Bytes by address, the ones published last; what is let go of is published again when shown.

    Parameters
    ----------
    at_most
        How many bytes are kept together.
    """

    def __init__(self, at_most: int = _AT_MOST) -> None:
        self._secret = secrets.token_bytes(32)
        self._at_most, self._size = at_most, 0
        self._kept: OrderedDict[str, tuple[str, bytes]] = OrderedDict()
        self._lock = threading.Lock()
        self._changing: OrderedDict[str, Changing] = OrderedDict()

    def publish(self, data: bytes, kind: str = BYTES) -> str:
        """Keep some bytes; return the address at which browsers find them."""
        address = self._address(data)
        with self._lock:
            if address in self._kept:
                self._kept.move_to_end(address)
                return address
            self._kept[address] = kind, data
            self._size += len(data)
            while self._size > self._at_most and len(self._kept) > 1:
                _, (_, gone) = self._kept.popitem(last=False)
                self._size -= len(gone)
        return address

    def _address(self, of: bytes) -> str:
        return PATH + hashlib.blake2b(of, digest_size=20, key=self._secret).hexdigest()

    def attach(self, name: str, made: Changing) -> str:
        """Return an address at which browsers find what is made (JSON) whenever they ask.

        It takes the number of the answer that they had last, or None. The same name has the same
        address; only the last few are kept.
        """
        address = self._address(name.encode())
        with self._lock:
            self._changing[address] = made
            self._changing.move_to_end(address)
            while len(self._changing) > _MOST_CHANGING:
                self._changing.popitem(last=False)
        return address

    def changing(self, address: str) -> Changing | None:
        """Return what makes the bytes at an address that change, or None."""
        with self._lock:
            return self._changing.get(address)

    def get(self, address: str) -> tuple[str, bytes] | None:
        """Return the kind and the bytes at an address, or None."""
        with self._lock:
            return self._kept.get(address)


#: what all maps of this server are made of
STORE = MapStore()
