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

_PATH = re.compile(r"/_stcore/upload_file/([^/]+)/[^/]+")
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

    def refusal(self, method: str, path: str, headers: list[tuple[bytes, bytes]]) -> str | None:
        """Count an upload and return None, or why it is refused, in a sentence; others are none."""
        found = _PATH.fullmatch(path)
        if found is None or method not in {"PUT", "POST"}:
            return None
        length = dict(headers).get(b"content-length", b"")
        if not length.isdigit():
            return "An upload must say how long it is, but this one does not."
        window, size, now = found[1], int(length), monotonic()
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
