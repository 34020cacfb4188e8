"""Work that goes on while the page stays usable. No Streamlit in here."""

from __future__ import annotations

import threading

from fieldmon.errors import FieldmonError


class BackgroundWork:
    """Work in a thread of its own that can be watched and stopped; `work` says what it is."""

    def __init__(self) -> None:
        self.problem: FieldmonError | None = None
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def running(self) -> bool:
        """Tell whether it is at work."""
        return self._thread is not None and self._thread.is_alive()

    def begin(self) -> None:
        """Begin, or go on where it was stopped."""
        self._stop.clear()
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Ask it to end after the step that it is at."""
        self._stop.set()

    def wait(self, timeout_s: float) -> None:
        """Wait for the end."""
        if self._thread is not None:
            self._thread.join(timeout_s)

    def work(self) -> None:
        """Do it, asking `_stop` after every step."""
        raise NotImplementedError

    def _work(self) -> None:
        try:
            self.work()
        except FieldmonError as error:
            self.problem = error
