"""Addresses of maps on the internet: what one must look like, and whose server it names.

No Streamlit in here. Nothing in here asks anything of an address.
"""

from __future__ import annotations

import re
from urllib.parse import urlsplit

from fieldmon.errors import SettingError

from ..words import texts

#: whose pictures are free for everybody who looks at a plot now and then, and whom they ask to name
OSM, OSM_CREDIT = "https://tile.openstreetmap.org/{z}/{x}/{y}.png", "© OpenStreetMap contributors"
#: the last zoom at which such servers have pictures; nearer, these are drawn larger
LAST_ZOOM = 19
_HERE = frozenset({"127.0.0.1", "localhost", "::1"})
_LONGEST = 500


def checked(address: str) -> str:
    """Return the address of a map in tiles; raise `SettingError` if it is none."""
    address = address.strip()
    parts = urlsplit(address) if len(address) <= _LONGEST else urlsplit("")
    names = set(re.findall(r"\{(-?\w+)\}", address))
    is_whole = {"z", "x"} <= names <= {"z", "x", "y", "-y"} and len(names) == 3
    is_safe = parts.scheme == "https" or (parts.scheme == "http" and parts.hostname in _HERE)
    is_plain = not parts.username and not re.search(r"[\s\"'<>\\]", address)
    if not (is_whole and is_safe and parts.hostname and is_plain and "{" not in parts.netloc):
        raise SettingError(texts.WEB_MAP_LIKE.format(address=address[:120]))
    return address


def host(address: str) -> str:
    """Return the name of the server that an address asks."""
    return urlsplit(address).netloc.rpartition("@")[2]


def credit(address: str) -> str:
    """Return whom to name on a map of this address."""
    return OSM_CREDIT if address == OSM else host(address)
