"""Work that goes on while the page stays usable. No Streamlit in here."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from fieldmon.errors import FieldmonError

if TYPE_CHECKING:
    from collections.abc import Callable

#: nobody has looked for so long: then nobody will; a tab that was lost comes back sooner
UNSEEN_S = 120.0
_EVERY_S = 0.5


class BackgroundWork:
    """Work in a thread of its own that can be watched and stopped; `work` says what it is."""

    def __init__(self) -> None:
        self.problem: FieldmonError | None = None
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self._tabs: dict[str, Callable[[], bool]] = {}
        self._unseen_since_s: float | None = None

    @property
    def running(self) -> bool:
        """Tell whether it is at work."""
        return self._thread is not None and self._thread.is_alive()

    def begin(self) -> None:
        """Begin, or go on where it was stopped."""
        self._stop.clear()
        self._unseen_since_s = None
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Ask it to end after the step that it is at."""
        self._stop.set()

    def watch(self, tab: str, is_open: Callable[[], bool]) -> None:
        """Note a tab that watches it; `is_open` tells, in any thread, whether it still does."""
        self._tabs[tab] = is_open

    def leave(self, tab: str) -> None:
        """Note that a tab that is open shows something else in its place."""
        self.watch(tab, lambda: False)

    def wait(self, timeout_s: float) -> None:
        """Wait for the end."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def work(self) -> None:
        """Do it, asking after every step `_is_over_here`, or `_is_over` where none may wait."""
        raise NotImplementedError

    def _is_over_here(self) -> bool:
        """Return whether it is to end; while no tab is open any more, wait for one for a while."""
        while not (over := self._is_over()) and self._unseen_since_s is not None:
            self._stop.wait(_EVERY_S)
        return over

    def _is_over(self) -> bool:
        """Return whether it is to end: it was stopped, or no tab has been open for a while."""
        if self._is_watched():
            self._unseen_since_s = None
        elif self._unseen_since_s is None:
            self._unseen_since_s = time.monotonic()
        since_s = self._unseen_since_s
        is_left = since_s is not None and time.monotonic() - since_s >= UNSEEN_S
        return self._stop.is_set() or is_left

    def _is_watched(self) -> bool:
        tabs = [*self._tabs.values()]  # others may come meanwhile
        return not tabs or any(is_open() for is_open in tabs)

    def _work(self) -> None:
        try:
            self.work()
        except FieldmonError as error:
            self.problem = error
