"""The scout's page in a real browser: ``python -m tests.benchmarks.scout_page``.

Begins a season on a plot of so many plants (``--plants``, 8 000 and 100 000 unless told), loads
its day on a phone's browser, ends the server, and prints what a scout waits for in the field:

open
    from a killed browser's first request to a page that can be touched
tap
    from the finger that leaves Clean to the picture with the next plant (Event Timing, in steps of
    8 ms; less than 16 ms is not told and counts as 16), what of it is the page's own work, and the
    longest task on the way
kept
    from the same to the word that it is on the disk
memory
    of the process that draws the page, and what the phone stores

The kernel's load is printed too: beside other work all of it takes longer. ``--slower 4`` lets the
browser's processor be four times slower, as many a phone's is.
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
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.monitoring.phones import scouts
from fieldmon.plot.field import Field
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import scout
from tests.app.scouting import Line, PhoneBrowser
from tests.conftest import CHROMIUM, FLAGS

# plants that stand on a square degree of a plot without gaps, three metres by two
_PER_DEGREE = 1_000_000_000
_DAY = date(2026, 11, 16)
_LEAST_MS = 16
# what a browser tells of itself: events by the time to their picture, and long tasks
_WATCH = """() => {
  window.seen = { events: [], tasks: [], taps: [] };
  const watch = (type, keep, more) => new PerformanceObserver((list) => {
    for (const one of list.getEntries()) keep(one);
  }).observe({ type, ...more });
  watch("event", (one) => seen.events.push([one.interactionId, one.duration,
    one.processingEnd - one.processingStart]), { durationThreshold: 16 });
  watch("longtask", (one) => seen.tasks.push([one.startTime, one.duration]));
  addEventListener("click", (event) => {
    const began = event.timeStamp, was = document.querySelector("#place")?.dataset.plant;
    const one = { began, shown: null, kept: null };
    seen.taps.push(one);
    const look = () => {
      const now = document.querySelector("#place")?.dataset.plant;
      const last = document.querySelector("#last")?.dataset;
      if (one.shown === null && now !== was) one.shown = performance.now() - began;
      if (last?.plant === was && last.kept === "true") one.kept = performance.now() - began;
      if (one.kept !== null) watching.disconnect();
    };
    const watching = new MutationObserver(look);
    watching.observe(document.body, { subtree: true, childList: true, attributes: true });
  }, true);
}"""
_SEEN = """() => new Promise((done) => setTimeout(() => done(seen), 200))"""


def a_season(folder: Path, plants: int) -> Season:
    """Begin a season on about so many plants."""
    side = float(np.sqrt(plants / _PER_DEGREE))
    boundary = MultiPolygon([box(35.15, 30.36, 35.15 + 1.16 * side, 30.36 + side)])
    plot = Plot.of(Field("Large", boundary, gate=(35.15, 30.36)))
    settings = MonitoringSettings(_DAY, robot=scout())
    return Season.create(folder / "large.gpkg", plot, Records.none(), settings)


def measured(browser, season: Season, asked: argparse.Namespace) -> str:
    """Return what opening, tapping and keeping cost, in a line."""
    folder = season.path.parent
    os.environ["FIELDMON_SEASONS"] = str(folder)
    line = Line()
    line.come()
    phone = PhoneBrowser(browser, folder / "phone")
    try:
        _load(phone, line, season)
        line.go()
        opened = np.array([_opened(phone, line) for _ in range(asked.times)]) / 1000
        taps = _tapped(phone, asked)
        stored = phone.page.evaluate("navigator.storage.estimate().then((one) => one.usage)")
        drawing = max(_renderers(folder / "phone"))
    finally:
        phone.close()
        line.go()
    return (
        f"{len(season.plot.grid):,} plants: open {np.median(opened):.2f} s "
        f"({opened.min():.2f} to {opened.max():.2f}), {taps}, memory {drawing / 1e6:.0f} MB, "
        f"stored {stored / 1e6:.1f} MB, load {os.getloadavg()[0]:.1f}"
    )


def _load(phone: PhoneBrowser, line: Line, season: Season) -> None:
    """Bring the day onto the phone, and the page for good."""
    key = scouts.let_in(season, "Ann")
    phone.page.goto(invitation(line.address, "large", key, str(_DAY), "en"))
    phone.page.locator("#clean").wait_for(timeout=300_000)
    phone.page.evaluate("navigator.serviceWorker.ready.then(() => null)")
    phone.page.wait_for_function("() => navigator.serviceWorker.controller !== null")


def _opened(phone: PhoneBrowser, line: Line) -> int:
    """Return the milliseconds of a cold start without a network."""
    phone.kill()
    phone.page.goto(f"{line.address}/scouting/")
    ready = phone.page.locator("html[data-ready]")
    ready.wait_for(state="attached", timeout=120_000)
    return int(ready.get_attribute("data-ready"))


def _tapped(phone: PhoneBrowser, asked: argparse.Namespace) -> str:
    """Tap Clean so often as a finger does; return what the browser itself says of it."""
    page = phone.page
    if asked.slower > 1:
        session = phone.window.new_cdp_session(page)
        session.send("Emulation.setCPUThrottlingRate", {"rate": asked.slower})
    page.evaluate(_WATCH)
    for _ in range(asked.taps):
        at = page.locator("#clean").bounding_box()
        page.touchscreen.tap(at["x"] + at["width"] / 2, at["y"] + at["height"] / 2)
        page.wait_for_timeout(300)
    seen = page.evaluate(_SEEN)
    kept = np.array([one["kept"] for one in seen["taps"] if one["kept"] is not None])
    if len(kept) < asked.taps:
        raise SystemExit(f"{asked.taps} taps must be kept, but {len(kept)} were: {seen['taps']}")
    told: dict[int, float] = {}  # of a finger that comes, goes and clicks the longest counts
    work = [0.0]
    for finger, took, own in seen["events"]:
        told[finger] = max(took, told.get(finger, 0.0))
        work.append(own)
    told.pop(0, None)
    events = np.array([*told.values(), *[_LEAST_MS] * (asked.taps - len(told))])
    tasks = [took for _, took in seen["tasks"]]
    return (
        f"tap {np.median(events):.0f} ms (95 %: {np.percentile(events, 95):.0f}, of it the page's "
        f"own work {max(work):.0f} at most, longest task {max(tasks, default=0):.0f}), "
        f"kept {np.median(kept):.0f} ms "
        f"(95 %: {np.percentile(kept, 95):.0f})"
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
    asked.add_argument("--taps", type=int, default=40)
    asked.add_argument("--slower", type=float, default=1)
    chosen = asked.parse_args()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for plants in chosen.plants:
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
                said = measured(browser, a_season(Path(folder), plants), chosen)
                print(said, flush=True)  # noqa: T201
        browser.close()


if __name__ == "__main__":
    main()
