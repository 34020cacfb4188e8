"""The map of a large plot in a real browser: ``python -m tests.benchmarks.browser_map``.

Serves the app, uploads a crooked plot of about a million plants (or ``--plants``) with 10,000
records, opens Today in Chromium, changes the day and the sampler, and prints for each how long it
took from the act until the map stood still with its new picture, and where the seconds went:

asked
    from the act until the server begins to answer: the click, the page's own delays
plan
    the server's seconds for what is believed and for the sampler's route
map
    the server's other seconds until the map is handed to the network
sent
    from there until the page has the map
drawn
    from there until the picture stands, with what the page fetches of it (looked at by screenshots,
    which cost a tenth of a second)

the whole, the sum of the last three (m+s+d), and the seconds that the server went on with tables
and downloads, while the map was drawn. Drawing is by software: a browser with a graphics card is
quicker.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import io
import json
import os
import sys
import tempfile
import threading
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely
from PIL import Image
from playwright.sync_api import Error, sync_playwright

from fieldmon.plot.layout import lay
from fieldmon.plot.planting import Planting
from tests.benchmarks.first_screen import DRAWN, IDLE, MAP, ROOT, answers, started
from tests.benchmarks.test_bench_grid import crooked_plot
from tests.conftest import CHROMIUM, FLAGS

if TYPE_CHECKING:
    from collections.abc import Callable

AT_MOST_S = 40.0
# the picture is the last one if it stays for so long
STILL_S = 1.5
SAMPLERS = ("Naive", "Dynamic", "Adaptive")
LOG = "FIELDMON_BENCHMARK_LOG"
# when each message came to the page, and how long it was
LISTEN = """
window.came = []
window.WebSocket = class extends WebSocket {
  constructor(...all) {
    super(...all)
    this.addEventListener("message", ({data}) => window.came.push(
      [(performance.timeOrigin + performance.now()) / 1000, data.byteLength ?? data.size]))
  }
}
"""


class Took(NamedTuple):
    """Seconds of each part, as the module says; the whole; and the map's bytes as sent."""

    asked: float
    plan: float
    map: float
    sent: float
    drawn: float
    whole: float
    tables: float
    size: int


# -- the server's side


def serve():
    """Run the app as ``fieldmon app`` does, and note when it runs, plans, and hands over maps."""
    from streamlit.runtime.scriptrunner.script_runner import ScriptRunner
    from streamlit.runtime.scriptrunner_utils.script_run_context import ScriptRunContext

    from app.startup import serve as app_server
    from fieldmon.infestation.prior import prior
    from fieldmon.planning import plan as plan_module

    running = threading.local()

    def noted(what, function):
        @functools.wraps(function)
        def timed(*arguments, **named):
            # planning ahead in other threads is nobody's waiting; a plan within a plan is one plan
            if what == "plan" and getattr(running, "what", None) != "run":
                return function(*arguments, **named)
            before, running.what = getattr(running, "what", None), what
            begun = time.time()
            try:
                return function(*arguments, **named)
            finally:
                running.what = before
                note(what, begun, time.time())

        return timed

    enqueue = ScriptRunContext.enqueue

    def enqueued(context, message):
        enqueue(context, message)
        kind = message.delta.new_element.WhichOneof("type")
        if message.WhichOneof("type") == "delta" and kind == "bidi_component":
            note("map", time.time(), time.time(), message.ByteSize())

    ScriptRunContext.enqueue = enqueued
    ScriptRunner._run_script = noted("run", ScriptRunner._run_script)
    for module in (prior, plan_module):
        for name in ("prior_chance", "first_day", "plan_from"):
            if hasattr(module, name):
                setattr(module, name, noted("plan", getattr(module, name)))
    os.environ |= {app_server.ADDRESS: "127.0.0.1", app_server.PORT: sys.argv[1]}
    app_server.main()


def note(what, begun, ended, size=0):
    with Path(os.environ[LOG]).open("a") as log:
        log.write(f"{json.dumps([what, begun, ended, size])}\n")


@contextlib.contextmanager
def served(folder):
    """Start the app; give its address, and the file of its notes."""
    log = Path(folder) / "log"
    env = {LOG: str(log), "FIELDMON_SEASONS": folder}
    with started(lambda port: ["tests.benchmarks.browser_map", str(port)], env, ROOT) as url:
        answers(url)
        yield url, log


# -- the browser's side


def files(n_plants):
    """Return a plot of about so many plants, and records on it, as files to upload."""
    field = crooked_plot(n_plants)
    rng, today = np.random.default_rng(5), datetime.now(tz=UTC).date()
    lonlat = lay(field, Planting()).lonlat()
    lines = ["date;lat;lon;count"]
    for lon, lat in lonlat[rng.integers(0, len(lonlat), 10_000)]:
        when = today - timedelta(days=int(rng.integers(1, 200)))
        lines.append(f"{when:%d.%m.%Y};{lat:.6f};{lon:.6f};{int(rng.random() < 0.02)}")
    plot = shapely.to_geojson(field.boundary).encode()
    return len(lonlat), [
        {"name": "plot.geojson", "mimeType": "", "buffer": plot},
        {"name": "mites.csv", "mimeType": "", "buffer": "\n".join(lines).encode()},
    ]


def look(page):
    """Return the map's pixels, or None while it is not there."""
    try:
        place = page.locator(MAP).first.bounding_box(timeout=1_000)
        shot = page.screenshot(clip=place)
    except Error:
        return None
    return np.array(Image.open(io.BytesIO(shot)).convert("RGB")).astype(np.int16)


def redrawn(page, log, act):
    """Return where the seconds went from an act until the map was new; infinite where it was not.

    It counts as new at the end of the first look that shows what it shows at last.
    """
    before = look(page)
    page.evaluate("came = []")
    log.write_text("")
    start = time.time()
    act()
    while not _notes(log, "map") and time.time() - start < AT_MOST_S:
        time.sleep(0.01)
    first, seen, quiet = np.inf, None, start
    while time.time() - start < AT_MOST_S:
        image, now = look(page), time.time()
        if not _same(image, seen):
            first, seen, quiet = now, image, now
        new = image is not None and np.ptp(image) > 0 and not _same(image, before)
        if not new or not page.locator(IDLE).count():
            quiet = now
        if now - quiet > STILL_S:
            return _parts(page, log, start, first)
    return Took(*[np.inf] * 7, 0)


def _same(image, other):
    if image is None or other is None:
        return image is other
    return image.shape == other.shape and np.array_equal(image, other)


def _notes(log, what):
    notes = [json.loads(line) for line in log.read_text().splitlines()]
    return [note[1:] for note in notes if note[0] == what]


def _parts(page, log, start, stood):
    runs, plans, handed = (_notes(log, what) for what in ("run", "plan", "map"))
    # a click may be answered by more runs than one: the last map is the one that stands
    sent, _, size = handed[-1]
    begun, plan = min(run[0] for run in runs), sum(ended - begun for begun, ended, _ in plans)
    came = page.evaluate("came")
    there = min(at for at, length in came if at > sent - 0.05 and length >= size)
    return Took(
        asked=begun - start, plan=plan, map=sent - begun - plan, sent=there - sent,
        drawn=stood - there, whole=stood - start, tables=max(run[1] for run in runs) - sent,
        size=size,
    )  # fmt: skip


class Act(NamedTuple):
    """What is done, its last movement apart from those before."""

    what: str
    reach: Callable
    act: Callable


def acts(page):
    """Return what is done, in order."""

    def picked(name):
        who, option = ("combobox", "Who chooses the plants"), ("option", name)

        def reach():
            box = page.get_by_role(who[0], name=who[1])
            if not box.is_visible():
                page.get_by_text("Who inspects", exact=True).click()
            box.click()

        choose = page.get_by_role(option[0], name=option[1]).first.click
        return Act(f"another sampler: {name}", reach, choose)

    def month_before():
        page.get_by_role("spinbutton", name="month").first.click()
        page.keyboard.press("ArrowDown")

    close = functools.partial(page.keyboard.press, "Escape")
    link = page.get_by_role("link", name="Today", exact=True)
    return [
        Act("opening Today", link.hover, link.click),
        *map(picked, SAMPLERS),
        Act("another day: Adaptive", month_before, close),
        picked("Naive"),
        Act("another day: Naive", month_before, close),
        Act("another day: Naive", month_before, close),
    ]


def bring(page, address, uploads):
    """Bring the files, and wait until they are understood."""
    page.goto(f"{address}/plot?season=My+own+files")
    boxes = page.locator("[data-testid=stFileUploaderDropzoneInput]")
    boxes.nth(0).wait_for(state="attached", timeout=120_000)
    boxes.nth(0).set_input_files([uploads[0]])
    page.locator(DRAWN).wait_for(timeout=120_000)
    page.wait_for_selector(IDLE, timeout=120_000)
    boxes.nth(1).set_input_files([uploads[1]])
    page.get_by_text("records shown").wait_for(timeout=120_000)
    page.wait_for_selector(IDLE, timeout=120_000)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--plants", type=int, default=1_000_000)
    parser.add_argument("--shots", type=Path, help="folder for pictures of what was seen")
    asked = parser.parse_args()
    n_plants, uploads = files(asked.plants)
    sys.stdout.write(f"{n_plants:,} plants\n")
    columns = ("asked", "plan", "map", "sent", "drawn", "whole", "m+s+d", "tables", "kB")
    sys.stdout.write(f"{'':28s}{''.join(f'{name:>8s}' for name in columns)}\n")
    with contextlib.ExitStack() as stack:
        address, log = stack.enter_context(
            served(stack.enter_context(tempfile.TemporaryDirectory()))
        )
        playwright = stack.enter_context(sync_playwright())
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        stack.callback(chromium.close)
        page = chromium.new_page(viewport={"width": 1400, "height": 1000})
        page.add_init_script(LISTEN)
        bring(page, address, uploads)
        for number, (what, reach, act) in enumerate(acts(page)):
            reach()
            took = redrawn(page, log, act)
            seconds = (*took[:6], took.map + took.sent + took.drawn, took.tables)
            told = "".join(f"{second:8.2f}" for second in seconds)
            sys.stdout.write(f"{what:28s}{told}{took.size / 1000:8.0f}\n")
            sys.stdout.flush()
            if asked.shots:
                page.screenshot(path=asked.shots / f"{number}.png")


if __name__ == "__main__":
    serve() if LOG in os.environ else main()
