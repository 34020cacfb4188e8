"""Loading and compiling while the person is still looking, the first page's needs first.

Nothing heavy is imported here: the server answers before any of it is loaded.
"""

from __future__ import annotations

import threading
from functools import cache
from importlib import import_module

# the first page is drawn meanwhile; what other pages compile must not hold it up
_LATER_S = 20.0


class Warming(threading.Thread):
    """Loads the app's libraries and plans a day on a few plants, which loads compiled loops."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        #: set once what Today needs is loaded and compiled
        self.ready = threading.Event()
        #: set once a first page is there
        self.shown = threading.Event()

    def run(self) -> None:
        """Load what draws an outline, then what plans, then what simulates."""
        try:
            import_module("app.early").sample()
            import_module("pandas")  # Streamlit looks for its tables in every map
            trial = import_module("app.trial")
            trial.plan()
            import_module("app.views.today")
        finally:
            self.ready.set()
        self.shown.wait(_LATER_S)
        trial.simulate()


@cache
def start() -> Warming:
    """Start warming, once for all sessions."""
    warming = Warming()
    warming.start()
    return warming
