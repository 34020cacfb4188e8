"""Who is told that inner loops are being compiled: each once an installation, when it is needed."""

from __future__ import annotations

import sys
from multiprocessing import parent_process
from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    #: told when a loop's compiling begins or ends: loops compiled so far, seconds that took
    Listener = Callable[[int, float], None]

COMPILING = "Compiling parts of fieldmon used here for the first time (up to 2 min) ..."
#: what takes less is not said: most commands need some parts that none before them did
LEAST_S = 3.0


class FirstUse:
    """Counts the loops that this process had to compile, and tells whoever asked last.

    Where nobody asked, as in a program of one's own, it says so once on standard error, if
    somebody sits there: at a terminal or before a notebook.
    """

    def __init__(self) -> None:
        self.compiled = 0
        self._depth = 0
        self._began = self._took_s = 0.0
        self._listener: Listener | None = None
        self._said = False

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
        return now - self._compiling_s(now)

    def _compiling_s(self, now: float) -> float:
        """Return for how many seconds loops were compiled, or waited for."""
        return self._took_s + (now - self._began if self._depth else 0.0)

    def waited(self, seconds: float) -> None:
        """Note how long another process was waited for that compiles the same loops."""
        self._took_s += seconds

    def began(self) -> None:
        """Note that a loop's compiling has begun; loops it calls are compiled within."""
        if not self._depth:
            self._began = monotonic()
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
        seconds = self._compiling_s(monotonic())
        if self._listener is not None:
            self._listener(self.compiled, seconds)
        elif seconds >= LEAST_S and not self._said and _somebody_sees():
            self._said = True
            sys.stderr.write(f"{COMPILING}\n")
            sys.stderr.flush()


def _somebody_sees() -> bool:
    """Return whether somebody sees what this process writes to standard error."""
    if sys.stderr is None or parent_process() is not None:
        return False
    return sys.stderr.isatty() or "ipykernel" in sys.modules


FIRST_USE = FirstUse()
