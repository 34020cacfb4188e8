"""The scout's page, built ahead (see `app/scout_page`): its files by their addresses.

No Streamlit in here.
"""

from __future__ import annotations

import hashlib
import json
from functools import cache
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlencode

from ..words import scout_words
from ..words.language import LANGUAGES

#: where the app's address as phones reach it is said; `fieldmon app --lan` sets it
ADDRESS = "FIELDMON_ADDRESS"
#: where the server hands it out
PATH = "/scouting/"
FOLDER = Path(__file__).parents[1] / "scout_page" / "built"
_KINDS = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".webmanifest": "application/manifest+json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
}
_WORKER = "worker.js"
#: the page may speak to its own server and to nobody else
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; manifest-src 'self'; worker-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)


class PageFile(NamedTuple):
    """A file of the page: its type and its bytes."""

    kind: str
    data: bytes


def invitation(address: str, season: str, key: str, day: str = "", language: str = "") -> str:
    """Return the address that opens the page for a person: what a code on the screen holds.

    The key stands behind the ``#``: browsers send it to no server.

    Parameters
    ----------
    address
        Of the app, as phones reach it: ``"https://192.168.1.5:8501"``.
    season, key
        Name of the season, and somebody's key, see `fieldmon.monitoring.phones.scouts.let_in`.
    day
        ISO, where it is not to be today.
    language
        Of the page.

    Examples
    --------
    >>> invitation("https://192.168.1.5:8501", "Gate 2026", "abc")
    'https://192.168.1.5:8501/scouting/#season=Gate+2026&key=abc'
    """
    said = {"season": season, "key": key, "on": day, "lang": language}
    known = {name: value for name, value in said.items() if value}
    return f"{address.rstrip('/')}{PATH}#{urlencode(known)}"


@cache
def files() -> dict[str, PageFile]:
    """Return the page's files by their addresses; what works offline knows them all."""
    named = {
        "" if path.name == "page.html" else path.name: PageFile(
            _KINDS[path.suffix], path.read_bytes()
        )
        for path in sorted(FOLDER.iterdir())
        if path.suffix in _KINDS and path.name != _WORKER
    }
    for name in LANGUAGES:
        named[f"words/{name}.json"] = PageFile("application/json", scout_words.page_words(name))
    worker = (FOLDER / _WORKER).read_text(encoding="utf-8")
    everything = json.dumps({name: file.data.hex() for name, file in named.items()}) + worker
    version = hashlib.sha256(everything.encode()).hexdigest()[:16]
    said = worker.replace("@VERSION@", version).replace(
        "@FILES@", " ".join(n or "./" for n in named)
    )
    named[_WORKER] = PageFile(_KINDS[".js"], said.encode())
    return {PATH + name: file for name, file in named.items()}
