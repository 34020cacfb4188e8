"""What a person at a terminal sees while a command takes its time."""

from __future__ import annotations

import sys
import threading
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING, Any

import typer

from fieldmon.compute.jit_progress import COMPILING, FIRST_USE, LEAST_S

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

# a command that answers sooner says nothing; what is said is shorter than any answer, which so
# writes over it
_SILENT_S = 2.0
_EVERY_S = 0.5
_WORKING = "Working, {seconds:.0f} s"
_WIPE = "\r\x1b[K"


class Waiting:
    """Counts the seconds on standard error until it is left, or a bar says more than that."""

    def __init__(self) -> None:
        self._over = threading.Event()
        self._still = threading.Event()
        # what is wiped away stays so: nobody writes between a look at the two above and the writing
        self._pen = threading.Lock()
        self._compiling_said = False

    def __enter__(self) -> None:
        """Begin to count, if there is somebody to see it."""
        self._over.clear()
        FIRST_USE.tell(self._compiling)
        if sys.stderr.isatty():
            threading.Thread(target=self._count, daemon=True).start()

    def __exit__(self, *_: object) -> None:
        """Wipe the count away."""
        with self._pen:
            self._over.set()
            _show(_WIPE)

    @contextmanager
    def silent(self) -> Iterator[None]:
        """Say nothing meanwhile."""
        with self._pen:
            self._still.set()
            _show(_WIPE)
        try:
            yield
        finally:
            self._still.clear()

    def _count(self) -> None:
        began = monotonic()
        while not self._over.wait(_EVERY_S):
            seconds = monotonic() - began
            if seconds > _SILENT_S:
                self._say(f"\r{_WORKING.format(seconds=seconds)}\r")

    def _say(self, text: str) -> None:
        with self._pen:
            if not (self._over.is_set() or self._still.is_set() or FIRST_USE.is_busy):
                _show(text)

    def _compiling(self, compiled: int, seconds: float) -> None:
        if seconds < LEAST_S:
            return
        if sys.stderr.isatty():
            said = f"{COMPILING} {compiled} so far" if FIRST_USE.is_busy else ""
            _show(f"{_WIPE}{said}")
        elif not self._compiling_said:
            self._compiling_said = True
            typer.echo(COMPILING, err=True)


def _show(text: str) -> None:
    if sys.stderr.isatty():
        sys.stderr.write(text)
        sys.stderr.flush()


WAITING = Waiting()


@contextmanager
def progress(label: str, length: int = 1) -> Iterator[Any]:
    """Show a bar with the time left instead."""
    with (
        WAITING.silent(),
        typer.progressbar(
            length=length, label=label, file=sys.stderr, show_eta=True, width=40
        ) as bar,
    ):
        yield bar


@contextmanager
def counting(label: str) -> Iterator[Callable[[int, int], None]]:
    """Show a bar that is told how much is done, and of how much."""
    with progress(label) as bar:

        def count(done: int, total: int) -> None:
            bar.length = total
            bar.update(done - bar.pos)

        yield count
