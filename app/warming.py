"""Loading and compiling while the person is still looking, the first page's needs first.

Nothing heavy is imported here: the server answers before any of it is loaded.
"""

from __future__ import annotations

import threading
import time
from functools import cache
from importlib import import_module

# a browser that is sent its first map has a second's work, for which it needs the processors
_BROWSER_S = 1.0
# what other pages compile must not hold up the first; but if nobody comes, somebody may yet
_LATER_S = 20.0


class Warming(threading.Thread):
    """Loads the app's libraries and plans a day on a few plants, which loads compiled loops."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self._asked, self._loaded = threading.Event(), threading.Event()
        self._pause_s = 0.0
        #: set once what Today needs is loaded and compiled
        self.ready = threading.Event()
        #: set once a first page is there
        self.shown = threading.Event()

    def load(self, *, map_sent: bool) -> None:
        """Wait until the libraries are loaded, which begins now, if not before."""
        if map_sent and not self._asked.is_set():
            self._pause_s = _BROWSER_S
        self._asked.set()
        self._loaded.wait()

    def run(self) -> None:
        """Load what draws an outline, then what plans, then what simulates."""
        try:
            import_module("app.early").sample()
            import_module("pandas")  # Streamlit looks for its tables in every map
            self._asked.wait(_LATER_S)
            time.sleep(self._pause_s)
            trial = import_module("app.trial")
            import_module("app.views.today")
            self._loaded.set()
            trial.plan()
        finally:
            self._loaded.set()
            self.ready.set()
        self.shown.wait(_LATER_S)
        trial.simulate()


@cache
def start() -> Warming:
    """Start warming, once for all sessions."""
    warming = Warming()
    warming.start()
    return warming
