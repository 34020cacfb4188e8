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
        self._since = self._began = self._took_s = 0.0
        self._listener: Listener | None = None

    def tell(self, listener: Listener) -> None:
        """Tell `listener` from now on, and nobody else."""
        self._listener = listener

    @property
    def is_busy(self) -> bool:
        """Return whether one is being compiled."""
        return self._depth > 0

    def work_clock(self) -> float:
        """Return seconds by a clock that stands while loops are compiled, or waited for.

        Work that may take so long and no longer goes by it: what an installation compiles once
        must not cost the first plan what all others get.
        """
        now = monotonic()
        return now - self._took_s - (now - self._began if self._depth else 0.0)

    def waited(self, seconds: float) -> None:
        """Note how long another process was waited for that compiles the same loops."""
        self._took_s += seconds

    def began(self) -> None:
        """Note that a loop's compiling has begun; loops it calls are compiled within."""
        if not self._depth:
            self._began = monotonic()
        if not self.compiled and not self._depth:
            self._since = monotonic()
        self._depth += 1
        self._say()

    def ended(self) -> None:
        """Note that it is done, or has failed."""
        if self._depth == 1:
            now = monotonic()
            self._took_s, self._began = self._took_s + now - self._began, now
        self._depth -= 1
        self.compiled += 1
        self._say()

    def _say(self) -> None:
        if self._listener is not None:
            self._listener(self.compiled, monotonic() - self._since)


FIRST_USE = FirstUse()
