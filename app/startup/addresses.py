"""Which names of this machine a browser may ask by, and which pages may ask: nobody else's.

A name that somebody else owns can be made to lead to this machine (DNS rebinding); his page would
then read ours as its own. And any page may open a WebSocket to any address. So both are checked:
the name that was asked for, and the page that asks. No Streamlit in here.
"""

from __future__ import annotations

import os
import re
import socket
from ipaddress import ip_address
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    Headers = Iterable[tuple[bytes, bytes]]

#: names besides those that this machine has by itself; `fieldmon app --name` sets them
NAMES = "FIELDMON_NAMES"
_CHANGING = frozenset({"POST", "PUT", "DELETE", "PATCH"})
_HOST = re.compile(r"(\[[0-9a-f:.]+\]|[^:/\[\]@\s]+)(:\d{1,5})?", re.IGNORECASE)


def own_names() -> frozenset[str]:
    """Return the names by which this machine may be asked, without ports."""
    told = {name.strip().lower() for name in os.environ.get(NAMES, "").split(",")}
    machine = socket.gethostname().lower()
    return frozenset({"localhost", machine, f"{machine}.local", *told} - {""})


def refusal(
    scope: dict[str, object], headers: Headers, names: frozenset[str] | None = None
) -> str | None:
    """Return why a request is refused, in a sentence, or None.

    A number can be used as a name by nobody else, so numbers are always good.
    """
    names = own_names() if names is None else names
    said = {key.decode("latin-1").lower(): value.decode("latin-1") for key, value in headers}
    host = said.get("host", "")
    name = _name(host)
    if name is None or not (name in names or _is_number(name)):
        return (
            "This app must be asked for by a name that it knows, but it was asked for by another. "
            "Whoever runs it can tell it the name: fieldmon app --name NAME"
        )
    origin = said.get("origin")
    changes = scope.get("type") == "websocket" or scope.get("method") in _CHANGING
    if origin is None or not changes or _same(origin, host, names):
        return None
    return "Only the app's own pages may ask that, but a page of another site did."


def _same(origin: str, host: str, names: frozenset[str]) -> bool:
    """Tell whether a page is ours: of the address asked for, or of a name given for a proxy."""
    kind, _, place = origin.lower().partition("://")
    if kind not in {"http", "https"}:  # also "null": a page of nobody's
        return False
    default = ":443" if kind == "https" else ":80"
    if place.removesuffix(default) == host.lower().removesuffix(default):
        return True
    told = {name.strip().lower() for name in os.environ.get(NAMES, "").split(",")} - {""}
    # before a proxy the port differs, and the host may be the proxy's own way to us
    return _name(place) in (told & names)


def is_host(host: bytes) -> bool:
    """Tell whether a Host header is a name or number, with or without a port."""
    return _HOST.fullmatch(host.decode("latin-1")) is not None


def _name(host: str) -> str | None:
    """Return the name in a Host header without its port; None where it is none."""
    found = _HOST.fullmatch(host)
    return None if found is None else found[1].lower().rstrip(".")


def _is_number(name: str) -> bool:
    try:
        ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True
