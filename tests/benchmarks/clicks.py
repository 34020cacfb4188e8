"""How long a click in the app takes: ``python -m tests.benchmarks.clicks [plants ...]``.

Uploads two crooked plots with records, turns pages, changes day, hours, sampler and plot,
begins a season and records in it, in the system's Chromium, which draws without a graphics card
here. For each click: seconds of the server, from the browser's question to the end of its answer,
and of the whole, from the press until the page is at rest and the frame after that is drawn.
Clicks are made twice, one round after the other: "anew" may compute, "again" need not. Switches of
layers are not among them: they are the browser's own and ask nothing of the server.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import NamedTuple

import geopandas as gpd
import numpy as np
from playwright.sync_api import sync_playwright
from streamlit.proto.ForwardMsg_pb2 import ForwardMsg

from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from tests.benchmarks.first_screen import DRAWN, IDLE, ROOT, answers, served
from tests.benchmarks.test_bench_grid import crooked_plot
from tests.conftest import CHROMIUM, FLAGS

SIZES = (8_281, 100_000)
N_RECORDS = 2_000
MENU = ("Today", "Season", "Plan ahead", "Plot & data")
PAGES = {
    "Today": ("Scout", "Record", "Plan"),
    "Season": ("Plants & hot spots", "Report", "How it goes"),
}
# when the last press was, when the last question was sent, and when the page was at rest after it
WATCH = """
const send = WebSocket.prototype.send;
WebSocket.prototype.send = function (...all) {
  window.asked = performance.now();
  return send.apply(this, all);
};
for (const kind of ['pointerdown', 'keydown']) {
  addEventListener(kind, (event) => { window.pressed = event.timeStamp; }, true);
}
window.rests = () => {
  const app = document.querySelector('[data-testid=stApp]');
  return window.asked > window.pressed && app?.dataset.testScriptState === 'notRunning';
};
window.answered = () => new Promise((resolve) => {
  let since = null;
  const look = () => {
    const now = performance.now();
    if (!window.rests()) since = null;
    else if (since === null) since = now;
    if (since !== null && now - since > 400) resolve((since - window.pressed) / 1000);
    else if (now - window.pressed > 60000) resolve(NaN);
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(() => requestAnimationFrame(look));
});
"""


class Click(NamedTuple):
    """A click: what it is called, what is done before it, and the press itself."""

    what: str
    press: object
    before: object = None


class Server:
    """When the server was asked last, and when its last answer was complete."""

    def __init__(self, page) -> None:
        self.asked = self.answered = 0.0
        page.on("websocket", self._listen)

    def _listen(self, line) -> None:
        line.on("framesent", lambda _: self._ask())
        line.on("framereceived", self._hear)

    def _ask(self) -> None:
        if self.answered >= self.asked:
            self.asked = time.perf_counter()

    def _hear(self, data) -> None:
        message = ForwardMsg()
        message.ParseFromString(data)
        if message.WhichOneof("type") == "script_finished":
            self.answered = time.perf_counter()


def files(folder: Path, n_plants: int) -> tuple[int, Path, Path]:
    """Write two plots of about so many plants, and records on the first; return its plants."""
    rng, today = np.random.default_rng(5), datetime.now(tz=UTC).date()
    fields = [crooked_plot(n_plants), crooked_plot(int(n_plants * 0.9))]
    grid = lay(fields[0], Planting())
    rows = {"name": ["First", "Second"]}
    plots = gpd.GeoDataFrame(rows, geometry=[f.boundary for f in fields], crs=4326)
    plots.to_file(folder / "plots.geojson")
    lines = ["date;lat;lon;count"]
    for lon, lat in grid.lonlat(rng.integers(0, len(grid), N_RECORDS)):
        when = today - timedelta(days=int(rng.integers(1, 60)))
        lines.append(f"{when:%d.%m.%Y};{lat:.6f};{lon:.6f};{int(rng.random() < 0.05)}")
    (folder / "mites.csv").write_text("\n".join(lines))
    return len(grid), folder / "plots.geojson", folder / "mites.csv"


def bring(page, address: str, plots: Path, records: Path) -> None:
    """Bring the files, and wait until they are understood."""
    page.goto(f"{address}/plot?season=My+own+files")
    boxes = page.locator("[data-testid=stFileUploaderDropzoneInput]")
    boxes.nth(0).wait_for(state="attached", timeout=240_000)
    boxes.nth(0).set_input_files(plots)
    page.locator(DRAWN).wait_for(timeout=240_000)
    boxes.nth(1).set_input_files(records)
    page.get_by_text("records shown").wait_for(timeout=120_000)
    page.wait_for_selector(IDLE, timeout=120_000)


def turning(page, name: str) -> Click:
    link = page.get_by_role("link", name=name, exact=True)
    return Click(f"menu: {name}", link.click, link.hover)


def pages(page, item: str) -> list[Click]:
    """Return turning to an item of the menu, then to each of its pages, the first one last."""
    shown = [page.get_by_role("radio", name=name, exact=True) for name in PAGES[item]]
    turned = [Click(f"{item}: {name}", box.click, box.hover)
              for name, box in zip(PAGES[item], shown, strict=True)]  # fmt: skip
    return [turning(page, item), *turned]


def opened(page) -> None:
    """Open the box of who inspects, if it is shut."""
    if not page.get_by_role("slider", name="Working hours").first.is_visible():
        page.get_by_text("Who inspects", exact=True).click()


def picking(page, box: str, option: str, what: str) -> Click:
    options = page.get_by_role("option", name=option)

    def before() -> None:
        if box == "Who chooses the plants":
            opened(page)
        chooser = page.get_by_role("combobox", name=box)
        chooser.scroll_into_view_if_needed()
        page.wait_for_timeout(300)  # a box that opens while the panel still moves shuts again
        chooser.click()

    return Click(what, options.first.click, before)


def unsaved(page):
    """Return the clicks on a plot that was brought."""
    month = page.get_by_role("spinbutton", name="month").first
    slider = page.get_by_role("slider", name="Working hours").first
    return [
        *(turning(page, name) for name in MENU),
        *(click for item in PAGES for click in pages(page, item)),
        turning(page, "Today"),
        Click("Today: another day", partial(page.keyboard.press, "Escape"),
              lambda: (month.click(), page.keyboard.press("ArrowDown"))),
        Click("Today: other hours", partial(slider.press, "ArrowRight"),
              partial(opened, page)),
        picking(page, "Who chooses the plants", "Naive", "Today: another sampler (Naive)"),
        picking(page, "Who chooses the plants", "Adaptive", "Today: back to Adaptive"),
        picking(page, "Which plot", "Second", "Today: another plot"),
        picking(page, "Which plot", "First", "Today: back to the plot"),
    ]  # fmt: skip


def kept(page):
    """Return the clicks in a season: a record, and each page after it."""
    record = page.get_by_role("tabpanel").get_by_role("button", name="Record", exact=True)
    return [
        *pages(page, "Today")[:3],
        Click("Record: one plant", record.locator("visible=true").first.click,
              page.get_by_role("tab", name="One plant").click),
        *(turning(page, name) for name in MENU),
        *(click for item in PAGES for click in pages(page, item)),
    ]  # fmt: skip


def timed(page, server: Server, click: Click) -> tuple[float, float]:
    """Return the server's seconds of a click, and the whole."""
    if click.before is not None:
        click.before()
        page.wait_for_timeout(300)
    page.wait_for_selector(IDLE, timeout=120_000)
    click.press()
    whole = page.evaluate("answered()")
    return server.answered - server.asked, whole


def told(rounds: list[list[tuple[float, float]]], clicks: list[Click]) -> None:
    sys.stdout.write(f"{'':34s}{'server':>8s}{'whole':>8s}{'server':>10s}{'whole':>8s}\n")
    for k, click in enumerate(clicks):
        numbers = "  ".join("".join(f"{s:8.2f}" for s in one[k]) for one in rounds)
        sys.stdout.write(f"{click.what:34s}{numbers}\n")
    sys.stdout.flush()


def measure(playwright, n_plants: int) -> None:
    """Measure all clicks on a plot of about so many plants."""
    with tempfile.TemporaryDirectory() as folder, served(ROOT, folder) as address:
        plants, plots, records = files(Path(folder), n_plants)
        answers(address)
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page = chromium.new_page(viewport={"width": 1400, "height": 1000})
        page.add_init_script(WATCH)
        server = Server(page)
        bring(page, address, plots, records)
        sys.stdout.write(f"{plants:,} plants, load of this machine {os.getloadavg()[0]:.1f}\n")
        clicks = unsaved(page)
        told([[timed(page, server, click) for click in clicks] for _ in range(2)], clicks)
        page.get_by_role("link", name="Today", exact=True).click()
        page.get_by_role("button", name="Begin the season").click()
        page.get_by_text("has begun").wait_for(timeout=240_000)
        clicks = kept(page)
        told([[timed(page, server, click) for click in clicks] for _ in range(2)], clicks)
        chromium.close()


def main() -> None:
    with sync_playwright() as playwright:
        for n_plants in map(int, sys.argv[1:] or SIZES):
            measure(playwright, n_plants)


if __name__ == "__main__":
    main()
