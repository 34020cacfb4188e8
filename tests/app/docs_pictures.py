"""The pictures of README and docs/app: ``python -m tests.app.docs_pictures [names]``.

A season of a week is begun on a plot of the sample estate, with made-up insects that are found and
treated; today is planned. Pictures go to `docs/images`. Those of questions about a file, of maps
below the plot, of drives and of before and after are made by hand.
"""

import math
import os
import sys
import tempfile
from datetime import timedelta
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

import fieldmon as fm
from fieldmon.plot.local_clock import local_clock
from tests.app import pictures
from tests.paths import ROOT

IMAGES = ROOT / "docs" / "images"
DAYS, NAME = 7, "Gate"
#: where insects begin, as shares of the rows and of a row, and how far they reach in metres
SPOTS = ((0.30, 0.10, 9.0), (0.25, 0.75, 12.0), (0.45, 0.60, 7.0))
#: by name: part, window, scheme, language, and how wide the picture is
SHOTS = {
    "today": ("today", "laptop", "light", "en", 1200),
    "season": ("season", "laptop", "light", "en", 1200),
    "dark": ("today", "laptop", "dark", "en", 1080),
    "today_he": ("today", "laptop", "light", "he", 1080),
    "phone": ("today", "phone", "light", "en", 390),
    "phone_he_dark": ("today", "phone", "dark", "he", 390),
    "scout": ("scout", "phone", "light", "en", 390),
}


def begun(folder):
    """Begin the season and let its days pass up to yesterday; today is planned."""
    estate = ROOT / "sample_data"
    plot = fm.read_plot(estate / "paran_estate.zip", feature=NAME)
    records = fm.read_records(estate / "mite_records.csv", near=plot)
    today = local_clock(plot.field).today()
    begins = today - timedelta(days=DAYS)
    season = fm.Season.create(folder / f"{NAME}.gpkg", plot, records, begins=begins)
    grid, rng = plot.grid, np.random.default_rng(5)
    low, high = grid.xy_m.min(axis=0), grid.xy_m.max(axis=0)
    left = np.ones(len(grid), np.bool_)
    for day in range(DAYS):
        on = begins + timedelta(days=day)
        there = np.zeros(len(grid), np.bool_)
        for across, along, reach_m in SPOTS:
            x, y = low + (high - low) * (along, across)
            far_m = [math.hypot(*(at - (x, y))) for at in grid.xy_m]
            there |= np.array(far_m) < reach_m + 0.5 * day
        plants = season.plan(on).route.plant
        found = (there & left & (rng.random(len(grid)) < 0.8))[plants]
        season.record(fm.Inspections.of(plants, found.astype(np.int8), on))
        left[plants[found]] = False
    season.plan(today)


def taken(page, url, part, language):
    """Return the picture of a part as bytes."""
    with tempfile.TemporaryDirectory() as folder:
        to = Path(folder) / f"{part}.png"
        pictures.take(page, url, language, part, to, f"&season={NAME}")
        return to.read_bytes()


def main():
    """Take the pictures."""
    wanted = sys.argv[1:] or list(SHOTS)
    with pictures.served(begun) as url, sync_playwright() as browsers:
        chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
        browser = browsers.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        for name in wanted:
            part, size, scheme, language, wide = SHOTS[name]
            for page, _, _ in pictures.windows(browser, [size], [scheme], [language]):
                shot = taken(page, url, part, language)
            image = Image.open(BytesIO(shot)).convert("RGB")
            high = round(image.height * wide / image.width)
            image = image.resize((wide, high), Image.Resampling.LANCZOS)
            # in all their colours: a palette of 256 shows chances in others than the map
            image.save(IMAGES / f"{name}.webp", quality=92, method=6)
        browser.close()


if __name__ == "__main__":
    main()
