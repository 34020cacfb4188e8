"""Every page before the map became the page, and after, side by side.

``python -m tests.app.before_after TREE`` takes the pictures of an earlier tree, given by its folder
(``git worktree add TREE 93716160``), and of this one: on a laptop, a tablet and a phone, by day and
by night, after in English and in Hebrew. Both stand in a season of one day with results. It is no
test; it makes a sheet for each size, scheme and language, to be looked at.
"""

import argparse
import subprocess
import sys
import tempfile
from itertools import product
from pathlib import Path

from PIL import Image, ImageDraw
from playwright.sync_api import sync_playwright

from tests.app.pictures import PAGES, SCHEMES, SIZES, STILL, take, windows
from tests.benchmarks.first_screen import answers, served
from tests.benchmarks.seven_tasks import Hand, begin
from tests.conftest import CHROMIUM, FLAGS
from tests.paths import ROOT

#: a page, and the page that had its place before; what has none is new
BEFORE = {
    "today": "", "field": "map", "scout": "scout", "record": "season", "season": "season",
    "compare": "compare", "plot": "plot", "report": "report", "simulate": "simulate",
    "study": "study", "prior": "prior",
}  # fmt: skip
RESEARCH = ("study", "prior")
SHOWN = (*PAGES, *RESEARCH)
LANGUAGES = ("en", "he")
_WORKED = """
import sys
from pathlib import Path
import numpy as np
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
season = Season(next(Path(sys.argv[1]).glob("*.gpkg")))
day = season.settings.begins
plants = season.plan(day, keep=False).route.plant[:300]
found = (np.arange(300) % 9 == 4).astype(np.int8)
season.record(Inspections.of(plants, found, np.datetime64(day)), "route table")
"""
_COLUMNS, _WIDE = 2, {"laptop": 720, "tablet": 512, "phone": 390}


def worked(tree, folder):
    """Record 300 stops of the season's first day, as its own tree does."""
    subprocess.run([sys.executable, "-c", _WORKED, folder], cwd=tree, check=True)


def plainly(page, address, to):
    """Turn to a page that may have no map and take its picture."""
    page.goto(address)
    page.locator("[data-testid=stApp]").wait_for(timeout=90_000)
    for _ in range(3):
        page.wait_for_timeout(900)
        page.wait_for_selector(STILL, timeout=90_000)
    page.screenshot(path=to)


def pictures(browser, tree, folder, languages):
    """Take all pictures of a tree; return nothing, they are in the folder."""
    before = tree != ROOT
    with tempfile.TemporaryDirectory() as seasons, served(tree, seasons) as url:
        answers(url)
        season = begin(Hand(browser.new_page(), url)).replace(" ", "+")
        worked(tree, seasons)
        for page, language, kind in windows(browser, SIZES, SCHEMES, languages):
            for name in SHOWN:
                to = folder / f"{name}_{kind}.png"
                try:
                    if before and name in BEFORE:
                        plainly(page, f"{url}/{BEFORE[name]}?season={season}", to)
                    elif name in RESEARCH:
                        plainly(page, f"{url}/{name}?lang={language}&season={season}", to)
                    elif not before:
                        take(page, url, language, name, to, f"&season={season}")
                except Exception as error:  # noqa: BLE001 - the others still count
                    sys.stdout.write(f"{to.name}: {str(error)[:200]!r}\n")


def sheet(before, after, size, scheme, language):
    """Return pairs of pictures, two pairs a line."""
    wide, (width, height, _) = _WIDE[size], SIZES[size]
    high = wide * height // width
    made = Image.new("RGB", ((2 * wide + 24) * _COLUMNS, (high + 30) * -(-len(SHOWN) // _COLUMNS)))
    draw = ImageDraw.Draw(made)
    for k, name in enumerate(SHOWN):
        x, y = (k % _COLUMNS) * (2 * wide + 24), k // _COLUMNS * (high + 30)
        draw.text((x + 4, y + 8), f"{name}: before, after", fill="white")
        shots = (before, "en"), (after, language)
        for side, (folder, tongue) in enumerate(shots):
            path = folder / f"{name}_{tongue}_{size}_{scheme}.png"
            if path.is_file():
                with Image.open(path) as shot:
                    made.paste(shot.convert("RGB").resize((wide, high)), (x + side * wide, y + 28))
    return made


def main():
    """Take the pictures and put them side by side."""
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("tree", type=Path)
    ask.add_argument("--to", type=Path, default=Path(tempfile.gettempdir()) / "fieldmon-sheets")
    said = ask.parse_args()
    folders = said.to / "before", said.to / "after"
    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for tree, folder, languages in zip(
            (said.tree, ROOT), folders, (("en",), LANGUAGES), strict=True
        ):
            folder.mkdir(parents=True, exist_ok=True)
            pictures(browser, tree, folder, languages)
        browser.close()
    for size, scheme, language in product(SIZES, SCHEMES, LANGUAGES):
        sheet(*folders, size, scheme, language).save(
            said.to / f"sheet_{size}_{scheme}_{language}.webp", quality=80
        )
    sys.stdout.write(f"{said.to}\n")


if __name__ == "__main__":
    main()
