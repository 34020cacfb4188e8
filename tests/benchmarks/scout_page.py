"""The scout's page in a real browser: ``python -m tests.benchmarks.scout_page``.

Begins a season on a plot of so many plants (``--plants``, 8 000 and 100 000 unless told), loads
its day on a phone's browser, ends the server, and prints what a scout waits for in the field:

open
    from a killed browser's first request to a page that can be touched, median of ``--times``
tap
    from a tap on Clean to the next plant, on the disk by then; and to its picture
memory
    of the process that draws the page, and what the phone stores

The kernel's load is printed too: beside other work all of it takes longer.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from datetime import date
from pathlib import Path

import numpy as np
import psutil
from playwright.sync_api import sync_playwright
from shapely import MultiPolygon, box

from app.state.scout_page import invitation
from fieldmon.infestation.observations import Observations
from fieldmon.monitoring import MonitoringSettings, Season, scouts
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import scout
from tests.app.scouting import Line, PhoneBrowser
from tests.conftest import CHROMIUM, FLAGS

# plants that stand on a square degree of a plot without gaps, three metres by two
_PER_DEGREE = 8_700_000_000 / 8.0
_DAY = date(2026, 11, 16)
_TAPS = """async (times) => {
  const place = () => document.querySelector("#place").dataset.plant, taken = [];
  for (let k = 0; k < times; k++) {
    const was = place(), began = performance.now();
    document.querySelector("#clean").click();
    while (place() === was) await new Promise((done) => setTimeout(done, 0));
    const shown = performance.now() - began;
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)));
    taken.push([shown, performance.now() - began]);
    await new Promise((done) => setTimeout(done, 150));
  }
  return taken;
}"""


def a_season(folder: Path, plants: int) -> Season:
    """Begin a season on about so many plants."""
    side = float(np.sqrt(plants / _PER_DEGREE))
    boundary = MultiPolygon([box(35.15, 30.36, 35.15 + 1.16 * side, 30.36 + side)])
    plot = Plot.of(Field("Large", boundary, gate=(35.15, 30.36)))
    settings = MonitoringSettings(_DAY, robot=scout())
    return Season.create(folder / "large.gpkg", plot, Observations.none(), settings)


def measured(browser, season: Season, times: int) -> str:
    """Return what opening, tapping and keeping cost, in a line."""
    folder = season.path.parent
    os.environ["FIELDMON_SEASONS"] = str(folder)
    line = Line()
    line.come()
    phone = PhoneBrowser(browser, folder / "phone")
    key = scouts.let_in(season, "Ann")
    phone.page.goto(invitation(line.address, "large", key, str(_DAY), "en"))
    phone.page.locator("#clean").wait_for(timeout=300_000)
    phone.page.evaluate("() => navigator.serviceWorker.ready.then(() => null)")
    phone.page.wait_for_function("() => navigator.serviceWorker.controller !== null")
    line.go()
    opened = []
    for _ in range(times):
        phone.kill()
        phone.page.goto(f"{line.address}/scouting/")
        ready = phone.page.locator("html[data-ready]")
        ready.wait_for(state="attached")
        opened.append(int(ready.get_attribute("data-ready")))
    shown, painted = np.array(phone.page.evaluate(_TAPS, 40)).T
    stored = phone.page.evaluate("() => navigator.storage.estimate().then((one) => one.usage)")
    drawing = max(_renderers(folder / "phone"))
    phone.close()
    return (
        f"{len(season.plot.grid):,} plants: open {np.median(opened) / 1000:.2f} s "
        f"({min(opened) / 1000:.2f} to {max(opened) / 1000:.2f}), tap {np.median(shown):.0f} ms, "
        f"painted {np.median(painted):.0f} ms (95 %: {np.percentile(painted, 95):.0f}), memory "
        f"{drawing / 1e6:.0f} MB, stored {stored / 1e6:.1f} MB, load {os.getloadavg()[0]:.1f}"
    )


def _renderers(folder: Path) -> list[int]:
    mine = {f"--user-data-dir={folder}", "--type=renderer"}
    found = [p for p in psutil.process_iter(["cmdline"]) if mine <= {*(p.info["cmdline"] or [])}]
    return [one.memory_info().rss for one in found] or [0]


def main() -> None:
    """Measure each size."""
    asked = argparse.ArgumentParser()
    asked.add_argument("--plants", type=int, nargs="+", default=[8_000, 100_000])
    asked.add_argument("--times", type=int, default=5)
    chosen = asked.parse_args()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for plants in chosen.plants:
            with tempfile.TemporaryDirectory() as folder:
                said = measured(browser, a_season(Path(folder), plants), chosen.times)
                print(said, flush=True)  # noqa: T201
        browser.close()


if __name__ == "__main__":
    main()
