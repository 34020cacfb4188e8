"""What must be done whole, though somebody stops the program meanwhile."""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

# the last is not known everywhere
_TOLD_BY = ("SIGINT", "SIGTERM", "SIGHUP")


@contextmanager
def stops_wait() -> Iterator[None]:
    """Let Ctrl-C, and who else tells the program to end, wait until this is done.

    In the main thread only: others are not interrupted.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    told: list[int] = []
    before: dict[int, Any] = {}
    try:
        for name in _TOLD_BY:
            one = getattr(signal, name, None)
            # None: no handler of Python's, which could not be put back
            if one is not None and signal.getsignal(one) not in {signal.SIG_IGN, None}:
                before[one] = signal.signal(one, lambda number, _: told.append(number))
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)
        for number in told:
            signal.raise_signal(number)
