"""How much may be uploaded, by one window and by all: in number, bytes and time.

The server holds uploads in its memory until their window is closed. No Streamlit in here.
"""

from __future__ import annotations

import asyncio
import re
import threading
from collections import deque
from dataclasses import dataclass
from time import monotonic
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    Receive = Callable[[], Awaitable[dict[str, Any]]]
    Send = Callable[[dict[str, Any]], Awaitable[None]]
    Application = Callable[[dict[str, Any], Receive, Send], Awaitable[None]]
    Headers = list[tuple[bytes, bytes]]

_PATH = re.compile(r"/_stcore/upload_file/([^/]+)/[^/]+")
_SENDING = frozenset({"PUT", "POST"})
_MB = 10**6


@dataclass(frozen=True)
class UploadLimits:
    """The most that is taken.

    Parameters
    ----------
    files, megabytes
        Of one window within `within_s`.
    all_files, all_megabytes
        Of all windows together within `within_s`.
    within_s
        How long an upload counts.
    seconds
        How long one upload may take.
    """

    files: int = 200
    megabytes: int = 1_000
    all_files: int = 2_000
    all_megabytes: int = 4_000
    within_s: float = 3600.0
    seconds: float = 600.0


class Uploads:
    """Counts the uploads of the last hour."""

    def __init__(self, limits: UploadLimits | None = None) -> None:
        self.limits = limits or UploadLimits()
        self._taken: deque[tuple[float, str, int]] = deque()
        self._lock = threading.Lock()

    def refusal(self, method: str, path: str, headers: Headers) -> str | None:
        """Count an upload and return None, or why it is refused, in a sentence; others are none."""
        found = _PATH.fullmatch(path)
        if found is None or method not in _SENDING:
            return None
        length = _length(headers)
        if length is None:
            return "An upload must say how long it is, but this one does not."
        window, size, now = found[1], length, monotonic()
        most = self.limits
        with self._lock:
            while self._taken and now - self._taken[0][0] > most.within_s:
                self._taken.popleft()
            own = [n for _, other, n in self._taken if other == window]
            every = [n for _, _, n in self._taken]
            for taken, files, megabytes in (
                (own, most.files, most.megabytes),
                (every, most.all_files, most.all_megabytes),
            ):
                if len(taken) >= files or sum(taken) + size > megabytes * _MB:
                    return (
                        f"At most {files} files and {megabytes} MB can be uploaded within "
                        f"{most.within_s / 60:.0f} minutes, but these are more. Leave out what is "
                        "not about the plots, or wait."
                    )
            self._taken.append((now, window, size))
        return None

    async def passed_on(
        self, app: Application, scope: dict[str, Any], receive: Receive, send: Send
    ) -> None:
        """Pass on an upload that was counted; one that the app does not take counts no more."""
        taken = False

        async def seen(message: dict[str, Any]) -> None:
            nonlocal taken
            if message["type"] == "http.response.start":
                taken = 200 <= message["status"] < 300
            await send(message)

        try:
            await app(scope, self.timed(receive), seen)
        finally:
            if not taken and scope.get("method") in _SENDING:
                self._give_back(scope["path"], scope["headers"])

    def _give_back(self, path: str, headers: Headers) -> None:
        found, size = _PATH.fullmatch(path), _length(headers)
        with self._lock:
            for one in reversed(self._taken):
                if found and one[1:] == (found[1], size):
                    self._taken.remove(one)
                    return

    def timed(self, receive: Receive) -> Receive:
        """Return `receive` for an upload: one that trickles in for too long is given up."""
        until = monotonic() + self.limits.seconds

        async def in_time() -> dict[str, Any]:
            try:
                return await asyncio.wait_for(receive(), max(0.0, until - monotonic()))
            except TimeoutError:
                return {"type": "http.disconnect"}

        return in_time


def is_upload(path: str) -> bool:
    """Tell whether an address is one that files are sent to."""
    return _PATH.fullmatch(path) is not None


def _length(headers: Headers) -> int | None:
    """Return how long an upload says it is; one in chunks is as long as it likes."""
    said = dict(headers)
    length = said.get(b"content-length", b"")
    return int(length) if length.isdigit() and b"transfer-encoding" not in said else None
