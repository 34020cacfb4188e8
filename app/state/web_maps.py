"""Addresses of maps on the internet: what one must look like, and whose server it names.

A browser's page may ask no other server. A map that was agreed to is asked for by a worker of the
browser, which may ask that one server. No Streamlit in here. Nothing in here asks anything of an
address.
"""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import quote, urlsplit

from fieldmon.errors import SettingError

from ..words import texts

#: whose pictures are free for everybody who looks at a plot now and then, and whom they ask to name
OSM, OSM_CREDIT = "https://tile.openstreetmap.org/{z}/{x}/{y}.png", "© OpenStreetMap contributors"
#: the last zoom at which such servers have pictures; nearer, these are drawn larger
LAST_ZOOM = 19
_HERE = frozenset({"127.0.0.1", "localhost", "::1"})
_LONGEST = 500
#: where the server hands out workers, and what one is
PATH, WORKER = "/web_map/", Path(__file__).parents[1] / "map_view" / "web_tiles.js"
_ORIGIN = re.compile(r"https?://([a-z0-9._-]+|\[[0-9a-f:.]+\])(:\d{1,5})?")


def checked(address: str) -> str:
    """Return the address of a map in tiles; raise `SettingError` if it is none."""
    address = address.strip()
    parts = urlsplit(address) if len(address) <= _LONGEST else urlsplit("")
    names = set(re.findall(r"\{(-?\w+)\}", address))
    is_whole = {"z", "x"} <= names <= {"z", "x", "y", "-y"} and len(names) == 3
    is_safe = parts.scheme == "https" or (parts.scheme == "http" and parts.hostname in _HERE)
    is_plain = not parts.username and not re.search(r"[\s\"'<>\\]", address)
    if not (is_whole and is_safe and is_plain and _ORIGIN.fullmatch(_origin(address))):
        raise SettingError(texts.WEB_MAP_LIKE.format(address=address[:120]))
    return address


class Asked:
    """The servers that somebody agreed to since the app was started."""

    def __init__(self) -> None:
        self._origins: set[str] = set()

    def worker(self, address: str) -> str:
        """Let browsers ask a map's server from now on; return the address of the worker for it."""
        origin = _origin(address)
        if not _ORIGIN.fullmatch(origin):  # kept before names were held to this
            return ""
        self._origins.add(origin)
        return f"{PATH}{quote(origin, safe='')}.js"

    def policy(self, path: str) -> str | None:
        """Return what the worker at an address may ask; None: nobody agreed to it."""
        origin = path.removeprefix(PATH).removesuffix(".js")
        return f"default-src 'none'; connect-src {origin}" if origin in self._origins else None


#: of this server
ASKED = Asked()


def _origin(address: str) -> str:
    """Return a server as browsers call it."""
    parts = urlsplit(address)
    return f"{parts.scheme}://{_in_ascii(parts.netloc.lower())}"


def _in_ascii(name: str) -> str:
    try:
        return name.encode("idna").decode()
    except UnicodeError:
        return ""


def host(address: str) -> str:
    """Return the name of the server that an address asks."""
    return urlsplit(address).netloc.rpartition("@")[2]


def credit(address: str) -> str:
    """Return whom to name on a map of this address."""
    return OSM_CREDIT if address == OSM else host(address)
