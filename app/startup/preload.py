"""Loading and compiling while the person is still looking, the first page's needs first.

Nothing heavy is imported here: the server answers before any of it is loaded.
"""

from __future__ import annotations

import gc
import threading
import time
from functools import cache
from importlib import import_module

# a browser that is sent its first map has a second's work, for which it needs the processors
_BROWSER_S = 1.0
# what other pages compile must not hold up the first; but if nobody comes, somebody may yet
_LATER_S = 20.0


class Preload(threading.Thread):
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
        """Load what draws an outline, then what plans, then what prints, simulates and charts."""
        try:
            _load_outline()
            self._asked.wait(_LATER_S)
            time.sleep(self._pause_s)
            _load_first_page()
            self._loaded.set()
            _load_planning()
        finally:
            self._loaded.set()
            self.ready.set()
        self.shown.wait(_LATER_S)
        _load_paper()
        _load_simulation()
        _load_charts()
        # what is loaded stays: a click now and then would wait while all of it is looked through
        gc.collect()
        gc.freeze()


def _load_outline() -> None:
    from ..state import sample_estate  # noqa: PLC0415

    sample_estate.plots()
    import_module("pandas")  # Streamlit looks for its tables in every map


def _load_first_page() -> None:
    from ..views import today  # noqa: F401, PLC0415


def _load_planning() -> None:
    from . import compiled_loops  # noqa: PLC0415

    compiled_loops.load_planning()


def _load_paper() -> None:
    from fieldmon.reports import pdf  # noqa: PLC0415

    pdf.load()


def _load_simulation() -> None:
    from . import compiled_loops  # noqa: PLC0415

    compiled_loops.load_simulation()


def _load_charts() -> None:
    from ..show import charts  # noqa: PLC0415
    from ..views import compare  # noqa: F401, PLC0415

    charts.load()


@cache
def start() -> Preload:
    """Start loading, once for all sessions."""
    preload = Preload()
    preload.start()
    return preload
