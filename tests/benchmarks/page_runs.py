"""What a page's own program takes: ``python -m tests.benchmarks.page_runs [plants]``.

Turns through the pages of the app in a season of so many plants, three times, without a browser and
without a server. Prints of the last turn the processor time of each page, and how often it opened
the season's file. It hardly depends on what else the machine does.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from datetime import timedelta
from pathlib import Path

import numpy as np

from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.monitoring.file import connections
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.plot import Plot
from tests.app.driving import go, opened
from tests.benchmarks.test_bench_grid import crooked_plot

N_PLANTS, N_RECORDS = 8_281, 2_000
PAGES = ("today", "scout", "record", "decide", "season", "field", "report", "plot")


def begun(path: Path, n_plants: int) -> int:
    """Begin a season with records in a file; return its plants."""
    plot, rng = Plot.of(crooked_plot(n_plants)), np.random.default_rng(5)
    today = local_clock(plot.field).today()
    days = [np.datetime64(today - timedelta(days=int(k))) for k in rng.integers(1, 60, N_RECORDS)]
    seen = (rng.random(N_RECORDS) < 0.05).astype(np.int8)
    where = plot.grid.lonlat(rng.integers(0, len(plot.grid), N_RECORDS))
    records = Records.of(where, seen, np.array(days))
    Season.create(path, plot, records, MonitoringSettings(today))
    return len(plot.grid)


def main() -> None:
    """Print the processor time of each page."""
    n_plants = int(sys.argv[1]) if len(sys.argv) > 1 else N_PLANTS
    connect, files = connections.connect, []
    connections.connect = lambda *of: files.append(of[0]) or connect(*of)
    with tempfile.TemporaryDirectory() as folder:
        os.environ["FIELDMON_SEASONS"] = folder
        sys.stdout.write(f"{begun(Path(folder) / 'Timed.gpkg', n_plants):,} plants\n")
        app = opened("Timed")
        for turn in range(3):
            for page in PAGES:
                began, n = time.process_time(), len(files)
                go(app, page)
                assert not app.exception
                spent = time.process_time() - began
                if turn == 2:
                    sys.stdout.write(f"{page:10s}{spent:6.2f} s, {len(files) - n} times opened\n")


if __name__ == "__main__":
    main()
