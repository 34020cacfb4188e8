"""Seven tasks in clicks and seconds: ``python -m tests.benchmarks.seven_tasks [--tree FOLDER]``.

The system's Chromium does what a grower does, in the app of this tree or, with ``--tree``, in that
of another one: where the other is from before the map became the page, by the way that led there
then (``--before``). A click is a press, a key, a number typed or a file chosen. Seconds are from
the first click until what was wanted is there, with nobody thinking in between. Beside them stands
the processor time of the server and of the browser, which hardly depends on what else runs.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from playwright.sync_api import sync_playwright

from tests.benchmarks.first_screen import IDLE, ROOT, answers, processor_s, served
from tests.conftest import CHROMIUM, FLAGS

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Locator, Page

PLOT = ROOT / "sample_data" / "paran_estate.zip"
_REST_MS, _MOST_MS = 250, 240_000


class Hand:
    """Does what a person does on a page, and counts it."""

    def __init__(self, page: Page, address: str) -> None:
        self.page, self.address, self.clicks = page, address, 0

    def open(self, path: str = "") -> None:
        """Open a page, which is no click, and wait until it is at rest."""
        self.page.goto(f"{self.address}/{path}")
        self.page.locator("[data-testid=stApp]").wait_for(timeout=_MOST_MS)
        self.rest()
        self.page.get_by_text("Plants to inspect").first.wait_for(timeout=_MOST_MS)
        self.rest()

    def rest(self) -> None:
        """Wait until the page is at rest."""
        self.page.wait_for_timeout(_REST_MS)
        self.page.wait_for_selector(IDLE, timeout=_MOST_MS)

    def click(self, what: Locator) -> None:
        """Press it."""
        self.clicks += 1
        what.first.click(timeout=_MOST_MS)
        self.rest()

    def button(self, name: str) -> None:
        """Press the button of this name."""
        self.click(self.page.get_by_role("button", name=name))

    def link(self, name: str) -> None:
        """Turn to a page."""
        self.click(self.page.get_by_role("link", name=name, exact=True))

    def fill(self, name: str, value: str) -> None:
        """Type into a box."""
        self.clicks += 1
        self.page.get_by_role("spinbutton", name=name).locator("visible=true").first.fill(value)

    def file(self, path: Path) -> None:
        """Choose a file in the first box."""
        self.clicks += 1
        self.page.locator("input[type=file]").first.set_input_files(path)

    def download(self, press: Callable[[], None]) -> None:
        """Press what downloads, and wait for the file."""
        with self.page.expect_download(timeout=_MOST_MS) as waiting:
            press()
        assert waiting.value.path().stat().st_size > 0

    def plant(self, seen: Callable[[], bool]) -> None:
        """Tap a plant in the middle of the map, until it is `seen` that one was tapped."""
        self.clicks += 1
        box = self.page.locator("canvas").last.bounding_box()
        assert box is not None
        x, y = box["x"] + 0.62 * box["width"], box["y"] + 0.5 * box["height"]
        for step in range(12):  # between two plants there is nothing to tap
            self.page.mouse.click(x + 3 * step, y + 3 * step)
            for _ in range(6):
                self.page.wait_for_timeout(_REST_MS)
                if seen():
                    self.rest()
                    return
        raise AssertionError("no plant was tapped")

    def history(self) -> bool:
        """Return whether a plant's history is there."""
        said = self.page.get_by_text("Chance of infestation now")
        return said.or_(self.page.get_by_text("History of a plant")).count() > 0


# -- as they are done now


def route_now(hand: Hand) -> None:
    """A shapefile to the first route."""
    hand.button("My plot")
    hand.file(PLOT)
    hand.page.get_by_text("Plants to inspect").first.wait_for(timeout=_MOST_MS)
    hand.page.wait_for_selector(".map[data-shown]", timeout=_MOST_MS)


def hours(hand: Hand) -> None:
    """Half an hour more or less."""
    slider = hand.page.get_by_role("slider", name="Working hours").first
    slider.scroll_into_view_if_needed()
    said = hand.page.locator("[data-testid=stMetricValue]").nth(1)
    before = said.inner_text()
    hand.clicks += 1
    slider.press("ArrowLeft")
    # it takes a fifth of a second: to look each quarter would measure the looking
    hand.page.wait_for_function(
        "([all, before]) => document.querySelectorAll(all)[1].innerText !== before",
        arg=["[data-testid=stMetricValue]", before], polling="raf", timeout=_MOST_MS,
    )  # fmt: skip


def gpx_now(hand: Hand) -> None:
    """The route as GPX."""
    hand.button("Send to phone")
    hand.download(lambda: hand.button("Download for GPS"))


def record_now(hand: Hand) -> None:
    """A find on one plant."""
    hand.plant(hand.history)
    hand.button("Record as found")
    hand.page.get_by_text("1 recorded").first.wait_for(timeout=_MOST_MS)


def why_now(hand: Hand) -> None:
    """Why a plant is on the route."""
    hand.plant(hand.history)


def compare_now(hand: Hand) -> None:
    """Two strategies."""
    hand.link("Plan ahead")
    _compared(hand, "One season so far")


def report_now(hand: Hand) -> None:
    """The day on paper."""
    hand.download(lambda: hand.button("Print (PDF)"))


# -- as they were done before the map became the page


def route_before(hand: Hand) -> None:
    """A shapefile to the first route."""
    hand.click(hand.page.get_by_role("combobox", name="Plot or season"))
    hand.click(hand.page.get_by_role("option", name="My own files"))
    hand.file(PLOT)
    hand.page.get_by_text("Plants to inspect").first.wait_for(timeout=_MOST_MS)
    hand.page.locator("canvas").first.wait_for(timeout=_MOST_MS)


def gpx_before(hand: Hand) -> None:
    """The route as GPX."""
    hand.button("Robot, phone, paper")
    hand.click(hand.page.get_by_role("combobox", name="Format"))
    hand.click(hand.page.get_by_role("option", name="gpx"))
    hand.download(lambda: hand.button("Download for GPS"))


def record_before(hand: Hand) -> None:
    """A find on one plant."""
    hand.link("Season")
    hand.click(hand.page.get_by_role("tab", name="One plant"))
    hand.fill("Row", "3")
    hand.fill("Plant", "4")
    shown = hand.page.locator("[data-testid=stForm]").locator("visible=true")
    if hand.page.get_by_role("radio", name="found", exact=True).locator("visible=true").count():
        hand.click(hand.page.get_by_role("radio", name="found", exact=True).locator("visible=true"))
    else:
        hand.click(shown.get_by_text("found", exact=True).locator("visible=true"))
    hand.click(_record(hand))
    hand.page.get_by_text("recorded").first.wait_for(timeout=_MOST_MS)


def why_before(hand: Hand) -> None:
    """Why a plant is on the route."""
    hand.link("Map")
    hand.plant(hand.history)


def compare_before(hand: Hand) -> None:
    """Two strategies."""
    hand.link("Compare")
    _compared(hand)


def report_before(hand: Hand) -> None:
    """The day on paper, to be printed by the browser."""
    hand.link("Report")
    hand.download(lambda: hand.button("Download"))


def _record(hand: Hand) -> Locator:
    button = hand.page.get_by_role("button", name="Record", exact=True)
    return button.locator("visible=true")


def _compared(hand: Hand, first: str = "95 % interval") -> None:
    """Take one of the three samplers away, compare the two others, and wait for a first verdict.

    The tree of before speaks of an interval after one season already, when there is none.
    """
    samplers = hand.page.locator("[data-testid=stMultiSelect]").first.locator("[data-tag]")
    hand.click(samplers.last.locator("svg"))
    hand.click(hand.page.get_by_role("button", name="Compare", exact=True))
    said = hand.page.get_by_text(first).or_(hand.page.get_by_text("95 % interval"))
    said.first.wait_for(timeout=_MOST_MS)


#: by their names: as they are done now, as they were done before, and whether in a season
TASKS: dict[str, tuple[Callable[[Hand], None], Callable[[Hand], None], bool]] = {
    "first route from a shapefile": (route_now, route_before, False),
    "change hours": (hours, hours, False),
    "hand out GPX": (gpx_now, gpx_before, True),
    "record a find": (record_now, record_before, True),
    "see why a plant is on the route": (why_now, why_before, True),
    "compare two strategies": (compare_now, compare_before, True),
    "print the report": (report_now, report_before, True),
}


def begin(hand: Hand) -> str:
    """Begin a season on the sample's first plot; return its name."""
    hand.open()
    first = hand.page.get_by_role("button", name="Begin a season")
    button = first if first.count() else hand.page.get_by_role("button", name="Begin the season")
    hand.click(button)
    hand.page.get_by_text("has begun").first.wait_for(timeout=_MOST_MS)
    return "Gate 2026"


class Taken(NamedTuple):
    """What a task took: clicks, seconds, processor time of the server and of the browser."""

    clicks: int
    seconds: float
    server_s: float
    browser_s: float

    def line(self, name: str) -> str:
        """Say it."""
        return (
            f"{name:34s}{self.clicks:3d} clicks{self.seconds:8.2f} s"
            f"{self.server_s:8.1f} s server{self.browser_s:8.1f} s browser\n"
        )


def measured(hand: Hand, task: Callable[[Hand], None], path: str) -> Taken:
    """Return what a task took, done from a page at rest."""
    hand.open(path)
    hand.clicks, before, began = 0, processor_s(), time.perf_counter()
    task(hand)
    seconds, after = time.perf_counter() - began, processor_s()
    return Taken(hand.clicks, seconds, *(after[who] - before[who] for who in ("server", "browser")))


def main() -> None:
    """Do all tasks and say what they took."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--tree", type=Path, default=ROOT)
    parser.add_argument("--before", action="store_true")
    parser.add_argument("--only", default="")
    told = parser.parse_args()
    with (
        tempfile.TemporaryDirectory() as folder,
        served(told.tree, folder) as address,
        sync_playwright() as playwright,
    ):
        answers(address)
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        hand = Hand(chromium.new_page(viewport={"width": 1440, "height": 900}), address)
        season = begin(hand)
        sys.stdout.write(f"load of this machine {os.getloadavg()[0]:.1f}\n")
        done: list[Taken] = []
        for name, (now, before, kept) in TASKS.items():
            if told.only and told.only not in name:
                continue
            path = f"?season={season.replace(' ', '+')}" if kept else ""
            try:
                done.append(measured(hand, before if told.before else now, path))
                sys.stdout.write(done[-1].line(name))
            except Exception as error:  # noqa: BLE001 - the others still count
                sys.stdout.write(f"{name:34s}not done: {str(error)[:300]!r}\n")
                hand.page.screenshot(path=f"{tempfile.gettempdir()}/{name}.png")
            sys.stdout.flush()
        if done:
            sys.stdout.write(Taken(*map(sum, zip(*done, strict=True))).line("all"))
        chromium.close()


if __name__ == "__main__":
    main()
