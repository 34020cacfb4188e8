"""From the command to the first map: ``python -m tests.benchmarks.first_screen [runs] [tree ...]``.

Starts ``fieldmon app`` on the sample estate and opens it in the system's Chromium as soon as the
port answers, as the command does for a person. Each run has a server of its own and a browser
window without anything kept from before. Prints when what happened, in seconds after the command;
several trees (checkouts of fieldmon) are measured in turns. "Map seen" is the second frame after
the first line or area that the browser draws on the map; that there is something to see is checked
in a picture. Processor time is that of all processes until then: it hardly depends on what else the
machine does. Needs ``pip install playwright``.
"""

from __future__ import annotations

import io
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from contextlib import contextmanager, suppress
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright
from streamlit.proto.ForwardMsg_pb2 import ForwardMsg

from tests.conftest import CHROMIUM, FLAGS
from tests.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable

IDLE = "[data-testid=stApp][data-test-script-state=notRunning]"
MAP = ".map"
DRAWN = f"{MAP}[data-shown]"
# when the browser draws on a canvas for the first time, and when the frame after that begins
_WATCH = """
for (const name of ['drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced']) {
  const draw = WebGL2RenderingContext.prototype[name];
  WebGL2RenderingContext.prototype[name] = function (...all) {
    const drawn = draw.apply(this, all);
    if (!window.drawn) {
      window.drawn = Date.now();
      const next = requestAnimationFrame;
      next(() => next(() => { window.seen = Date.now(); }));
    }
    return drawn;
  };
}
"""


class Times:
    """When what happened, in seconds after the beginning; only the first time counts."""

    def __init__(self) -> None:
        self.began, self.of = time.time(), {}

    def note(self, what: str, at: float | None = None) -> None:
        self.of.setdefault(what, (time.time() if at is None else at) - self.began)


@contextmanager
def served(tree: Path, folder: str):
    """Start the app by its command; yield its address at once."""
    command = ["fieldmon", "app", "--no-browser", "--seasons", folder, "--port"]
    with started(lambda port: [*command, str(port)], {"PYTHONPATH": str(tree)}, tree) as url:
        yield url


@contextmanager
def started(program: Callable[[int], list[str]], env: dict[str, str], folder: Path):
    """Start a program of Python's, told a free port, in a folder; yield its address at once."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen(
        [sys.executable, "-m", *program(port)], stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL, start_new_session=True, env=os.environ | env, cwd=folder,
    )  # fmt: skip
    try:
        yield f"http://127.0.0.1:{port}"
    finally:
        os.killpg(server.pid, signal.SIGTERM)
        server.wait(20)


def answers(url: str) -> None:
    """Wait until the port answers."""
    for _ in range(3_000):
        with suppress(OSError), urllib.request.urlopen(url, timeout=1):  # noqa: S310
            return
        time.sleep(0.01)
    raise SystemExit("the app did not answer within 30 s")


def opened(browser, url: str, times: Times) -> None:
    """Open the app in a new window; note what comes until the map is drawn."""
    page = browser.new_context(viewport={"width": 1400, "height": 1000}).new_page()
    page.add_init_script(_WATCH)
    page.on("websocket", lambda line: _listen(line, times))
    page.on("response", lambda got: _loaded(got.url, times))
    page.goto(url, wait_until="commit")
    times.note("page is there")
    page.wait_for_selector(f".first-map, {DRAWN}", timeout=120_000)
    times.note("outline seen")
    page.wait_for_function("window.seen", timeout=120_000, polling=50)
    times.of |= {f"(processor time: {who})": spent for who, spent in processor_s().items()}
    times.note("first drawing", page.evaluate("window.drawn") / 1000)
    times.note("map seen", page.evaluate("window.seen") / 1000)
    page.wait_for_selector(DRAWN, timeout=240_000)
    page.wait_for_selector(IDLE, timeout=240_000)
    times.note("page at rest")
    shot = Image.open(io.BytesIO(page.locator(MAP).first.screenshot())).convert("RGB")
    assert np.ptp(np.array(shot).reshape(-1, 3), axis=0).any(), "the map is empty"
    page.context.close()


def processor_s() -> dict[str, float]:
    """Return the processor time of the server and of the browser that this process started."""
    parents, spent, names = {}, {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            pid, _, rest = stat.read_text().partition(" (")
            name, _, numbers = rest.rpartition(") ")
            fields = numbers.split()
            names[int(pid)], parents[int(pid)] = name, int(fields[1])
            spent[int(pid)] = sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    total = {"server": 0.0, "browser": 0.0}
    for pid, seconds in spent.items():
        line = [pid]
        while line[-1] in parents:
            line.append(parents[line[-1]])
        if os.getpid() in line[1:] and names[pid] not in {"node", "MainThread"}:
            total["browser" if names[pid].startswith("chrom") else "server"] += seconds
    return total


def _loaded(url: str, times: Times) -> None:
    if "/map_view/" in url:
        times.note("map's script is there")
    elif "/map_data/" in url:
        times.note("first of the map's content is there")


def _listen(line, times: Times) -> None:
    times.note("line to the server")
    line.on("framereceived", lambda data: _received(data, times))


def _received(data: bytes | str, times: Times) -> None:
    message = ForwardMsg()
    message.ParseFromString(data if isinstance(data, bytes) else data.encode())
    kind = message.WhichOneof("type")
    if kind == "new_session":
        times.note("first run begins")
    elif kind == "script_finished":
        times.note("first run ended")
    elif kind == "delta" and message.delta.new_element.WhichOneof("type") == "bidi_component":
        times.note("map is sent")


def once(playwright, tree: Path) -> dict[str, float]:
    """Return the timeline of one start."""
    browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
    try:
        with tempfile.TemporaryDirectory() as folder:
            times = Times()
            with served(tree, folder) as url:
                answers(url)
                times.note("port answers")
                opened(browser, url, times)
                again = Times()
                opened(browser, url, again)
                times.of["(the browser alone: map seen at a server at rest)"] = again.of["map seen"]
                return times.of
    finally:
        browser.close()


def main() -> None:
    """Measure the trees in turns; print the median and the least of each time."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    trees = [Path(tree).resolve() for tree in sys.argv[2:]] or [ROOT]
    seen: dict[Path, list[dict[str, float]]] = {tree: [] for tree in trees}
    with sync_playwright() as playwright:
        for _ in range(runs):
            for tree in trees:
                times = once(playwright, tree)
                seen[tree].append(times)
                sys.stdout.write(
                    f"{tree}: map seen after {times['map seen']:.2f} s, load of this machine "
                    f"{os.getloadavg()[0]:.1f} on {os.cpu_count()} cores\n"
                )
                sys.stdout.flush()
    for tree, all_times in seen.items():
        sys.stdout.write(f"{tree}: {runs} starts, seconds after the command\n")
        for what in sorted(all_times[0], key=lambda what: all_times[0][what]):
            own = [times[what] for times in all_times if what in times]
            sys.stdout.write(f"  {what:50s} median {median(own):6.2f}  best {min(own):6.2f}\n")


if __name__ == "__main__":
    main()
