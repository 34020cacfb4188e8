"""Who is told to end a command, by Ctrl-C or as a service is. Imports come late."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@contextmanager
def told_to_end(end: Callable[[], None], *, also: tuple[str, ...] = ()) -> Iterator[None]:
    """Call `end` when the program is told to end, as by ``systemctl stop`` or ``docker stop``.

    That is by SIGTERM or SIGHUP, unless it was begun to pass by these, and by those named besides.
    """
    import signal
    import threading

    before = {}
    if threading.current_thread() is not threading.main_thread():  # who is told is the main one
        yield
        return
    for name in ("SIGTERM", "SIGHUP", *also):  # the second is not known everywhere
        if (one := getattr(signal, name, None)) and signal.getsignal(one) != signal.SIG_IGN:
            before[one] = signal.signal(one, lambda *_: end())
    try:
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)


def as_at_ctrl_c() -> None:
    """Stop a command as Ctrl-C does."""
    raise KeyboardInterrupt
