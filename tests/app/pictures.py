"""Pictures of every page in every language, to be looked at: ``python -m tests.app.pictures``.

It is no test: it starts the app, turns to each page of the menu on a laptop, a tablet and a phone,
by day and by night, and keeps what a person would see in a folder; what axe-core finds serious is
said. ``--languages he,ar``, ``--pages today,season``, ``--sizes phone`` and ``--schemes dark`` take
fewer; ``--url`` takes an app that is running.
"""

import argparse
import os
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from urllib.parse import quote

from playwright.sync_api import sync_playwright

from app.state import menu
from app.words.language import LANGUAGES
from tests.app.map_in_browser import faults
from tests.paths import ROOT

SIZES = {
    "laptop": (1440, 900, None),
    "tablet": (1024, 768, None),
    "phone": (390, 844, "Mozilla/5.0 (Android 14) Mobile Safari"),
}
SCHEMES = ("light", "dark")
PAGES = tuple(name for item in menu.MENU.values() for name in item.pages)
STILL = "[data-testid=stApp][data-test-script-state=notRunning]"


@contextmanager
def served(begin=lambda folder: None):  # noqa: ARG005 - none is begun
    """Start the app with seasons of its own, which `begin` may put there; give its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as seasons:
        begin(Path(seasons))
        command = [sys.executable, "-m", "fieldmon", "app", "--no-browser",
                   "--port", str(port), "--seasons", seasons]  # fmt: skip
        server = subprocess.Popen(command, cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)})
        try:
            yield wait_for(f"http://127.0.0.1:{port}")
        finally:
            server.terminate()
            server.wait(180)


def wait_for(url):
    """Return the address once the app answers there."""
    for _ in range(300):
        try:
            urllib.request.urlopen(f"{url}/_stcore/health", timeout=2)  # noqa: S310
        except OSError:
            time.sleep(0.2)
        else:
            return url
    message = f"no app answers at {url}"
    raise SystemExit(message)


def take(page, url, language, name, to, season=""):
    """Turn to a page and take its picture."""
    item = menu.item_of(name)
    page.goto(f"{url}/{'' if item == 'today' else item}?lang={language}{season}")
    page.wait_for_selector(".map[data-shown]", timeout=90_000)
    page.wait_for_selector(STILL, timeout=90_000)
    pages = menu.MENU[item].pages
    if len(pages) > 1:
        box = page.locator(f".st-key-page-{item} button")
        box.nth(pages.index(name)).click()
    page.wait_for_timeout(700)
    page.wait_for_selector(STILL, timeout=90_000)
    # what moves comes to rest
    page.wait_for_timeout(1200)
    page.screenshot(path=to)
    for fault in faults(page):
        print(to.stem, fault)  # noqa: T201


def main():
    """Take the pictures."""
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("--to", type=Path, default=Path(tempfile.gettempdir()) / "fieldmon-pictures")
    ask.add_argument("--languages", default=",".join(LANGUAGES))
    ask.add_argument("--pages", default=",".join(PAGES))
    ask.add_argument("--sizes", default=",".join(SIZES))
    ask.add_argument("--schemes", default=",".join(SCHEMES))
    ask.add_argument("--url", default="")
    ask.add_argument("--season", default="", help="of the app at --url")
    said = ask.parse_args()
    said.to.mkdir(parents=True, exist_ok=True)
    with sync_playwright() as browsers:
        if said.url:
            pictures(browsers, said.url, said)
        else:
            with served() as url:
                pictures(browsers, url, said)
    print(said.to)  # noqa: T201


def pictures(browsers, url, said):
    """Take all pictures that are asked for."""
    chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
    browser = browsers.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
    every = said.sizes.split(","), said.schemes.split(","), said.languages.split(",")
    season = f"&season={quote(said.season)}" if said.season else ""
    for page, language, kind in windows(browser, *every):
        for name in said.pages.split(","):
            take(page, url, language, name, said.to / f"{name}_{kind}.png", season)
    browser.close()


def windows(browser, sizes, schemes, languages):
    """Yield an empty page of each size and scheme for each language; name the kind of picture."""
    for size, scheme, language in product(sizes, schemes, languages):
        width, height, agent = SIZES[size]
        context = browser.new_context(viewport={"width": width, "height": height},
                                      user_agent=agent, color_scheme=scheme)  # fmt: skip
        yield context.new_page(), language, f"{language}_{size}_{scheme}"
        context.close()


if __name__ == "__main__":
    main()
