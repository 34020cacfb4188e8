"""Who is told that inner loops are being compiled: once an installation, for up to a minute."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    #: told when a loop's compiling begins or ends: loops compiled so far, seconds since the first
    Listener = Callable[[int, float], None]


class FirstUse:
    """Counts the loops that this process had to compile, and tells whoever asked last."""

    def __init__(self) -> None:
        self.compiled = 0
        self._depth = 0
        self._since = 0.0
        self._listener: Listener | None = None

    def tell(self, listener: Listener) -> None:
        """Tell `listener` from now on, and nobody else."""
        self._listener = listener

    @property
    def is_busy(self) -> bool:
        """Return whether one is being compiled."""
        return self._depth > 0

    def began(self) -> None:
        """Note that a loop's compiling has begun; loops it calls are compiled within."""
        if not self.compiled and not self._depth:
            self._since = monotonic()
        self._depth += 1
        self._say()

    def ended(self) -> None:
        """Note that it is done, or has failed."""
        self._depth -= 1
        self.compiled += 1
        self._say()

    def _say(self) -> None:
        if self._listener is not None:
            self._listener(self.compiled, monotonic() - self._since)


FIRST_USE = FirstUse()
