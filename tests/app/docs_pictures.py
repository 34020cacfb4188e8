"""The pictures of README, docs/app and docs/scouting: ``python -m tests.app.docs_pictures NAMES``.

A season of a week is begun on a plot of the sample estate, with made-up insects that are found and
treated; today is planned. On two more plots a season has just begun. Pictures go to `docs/images`.
Those of maps below the plot, of drives and of before and after are made by hand.
"""

import math
import os
import sys
import tempfile
import zipfile
from datetime import timedelta
from io import BytesIO
from pathlib import Path

import geopandas as gpd
import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

import fieldmon as fm
from app.state import seasons_folder
from app.state.scout_page import invitation
from app.words import texts
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.phones.photos_asked import ask_photo
from fieldmon.plot.local_clock import local_clock
from tests.app import pictures
from tests.app.scouting import Line, PhoneBrowser
from tests.app.test_scouting import plant_of, told_now
from tests.paths import ROOT

IMAGES = ROOT / "docs" / "images"
DAYS, NAME = 7, "Gate"
#: the grid in which the records without one are written
METRES = 2039
#: plots of the estate on which a season has just begun
OTHERS = ("Pond", "Wadi")
#: where insects begin, as shares of the rows and of a row, and how far they reach in metres
SPOTS = ((0.30, 0.10, 9.0), (0.25, 0.75, 12.0), (0.45, 0.60, 7.0))
#: by name: page, window, scheme, language, and how wide the picture is
SHOTS = {
    "today": ("today", "laptop", "light", "en", 1200),
    "season": ("season", "laptop", "light", "en", 1200),
    "dark": ("today", "laptop", "dark", "en", 1080),
    "today_he": ("today", "laptop", "light", "he", 1080),
    "phone": ("today", "phone", "light", "en", 390),
    "phone_he_dark": ("today", "phone", "dark", "he", 390),
    "scout": ("scout", "phone", "light", "en", 390),
    "plots": ("plots", "laptop", "light", "en", 1080),
    "compare": ("compare", "laptop", "light", "en", 1200),
    "answers": ("plot", "laptop", "light", "en", 1080),
    "answers_of_records": ("plot", "laptop", "light", "en", 1080),
    "send": ("today", "laptop", "light", "en", 1080),
}
#: of the scout's page, by name: language, scheme, taps before it, and which tap is a find; None:
#: none, and there is a network
SCOUTED = {
    "scouting": ("en", "light", 4, 4),
    "scouting_asked": ("en", "light", 2, None),
    "scouting_dark": ("en", "dark", 1, 2),
    "scouting_hebrew": ("he", "light", 2, 0),
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
    for other in OTHERS:
        plot = fm.read_plot(estate / "paran_estate.zip", feature=other)
        records = fm.read_records(estate / "mite_records.csv", near=plot)
        fm.Season.create(folder / f"{other}.gpkg", plot, records, begins=today)


def compared(page):
    """Compare the strategies that are chosen, and turn to what it came to."""
    page.locator(".st-key-run button").click()
    page.locator("[data-testid=stTable]").first.wait_for(timeout=600_000)
    page.locator(".st-key-run_stop button:disabled").wait_for(timeout=600_000)
    page.wait_for_selector(pictures.STILL)
    curves = page.locator("[data-testid=stVegaLiteChart]").first
    curves.evaluate("one => one.scrollIntoView({ block: 'end' })")


def bring(page, box, file):
    """Bring a file of one's own, and wait until the map shows what it says."""
    page.locator(f".st-key-{box} input[type=file]").set_input_files(file)
    page.wait_for_timeout(3000)
    page.wait_for_selector(pictures.STILL, timeout=90_000)
    page.wait_for_selector(".map[data-shown]", timeout=90_000)


def own_files(page):
    """Turn to files of one's own."""
    page.locator(".st-key-season input").click()
    page.get_by_role("option", name=str(texts.UPLOAD)).click()
    page.wait_for_selector(pictures.STILL)


def asked(page):
    """Bring a plot whose file names no coordinate system."""
    own_files(page)
    with tempfile.TemporaryDirectory() as folder:
        to = Path(folder) / "paran_estate.zip"
        with (
            zipfile.ZipFile(ROOT / "sample_data" / "paran_estate.zip") as whole,
            zipfile.ZipFile(to, "w") as made,
        ):
            for name in whole.namelist():
                if not name.endswith(".prj"):
                    made.writestr(name, whole.read(name))
        bring(page, "plot_file", to)


def asked_of_records(page):
    """Bring a plot, and records in metres that name no coordinate system."""
    own_files(page)
    plot = fm.read_plot(ROOT / "sample_data" / "paran_estate.zip", feature=NAME)
    rng = np.random.default_rng(5)
    plants = rng.choice(len(plot.grid), 120, replace=False)
    places = gpd.GeoSeries.from_xy(*plot.grid.lonlat(plants).T, crs=4326).to_crs(METRES)
    lines = [f"{place.x:.2f},{place.y:.2f},2026-11-{1 + k % 20:02d},{int(rng.random() < 0.2)}"
             for k, place in enumerate(places)]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        own, records = Path(folder) / "gate.geojson", Path(folder) / "records.csv"
        boundary = gpd.GeoDataFrame({"name": [NAME]}, geometry=[plot.field.boundary], crs=4326)
        boundary.to_file(own)
        records.write_text("\n".join(["x,y,date,count", *lines]), encoding="utf-8")
        bring(page, "plot_file", own)
        bring(page, "record_file", records)


def sent(page):
    """Make a code for a person."""
    page.get_by_role("button", name=texts.STEP_BUTTONS["send"]).first.click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_label(texts.INVITE_NAME).fill("Ann")
    dialog.get_by_role("button", name=texts.INVITE_BUTTON).click()
    dialog.locator(".qr").wait_for()
    page.wait_for_selector(pictures.STILL)


#: by the picture's name: what is done before it is taken
ACTS = {"compare": compared, "answers": asked, "answers_of_records": asked_of_records, "send": sent}


def taken(page, url, name, of, language):
    """Return the picture of a page as bytes."""
    with tempfile.TemporaryDirectory() as folder:
        to = Path(folder) / f"{of}.png"
        pictures.take(page, url, language, of, to, f"&season={NAME}")
        if name in ACTS:
            ACTS[name](page)
            page.wait_for_timeout(2000)
            page.screenshot(path=to)
        return to.read_bytes()


def scouted(browser, names):
    """Take pictures of the scout's page, without a network but where a photo is asked for."""
    with tempfile.TemporaryDirectory() as folder:
        begun(Path(folder))
        os.environ[seasons_folder.FOLDER] = folder
        season, line = fm.Season(Path(folder) / f"{NAME}.gpkg"), Line()
        today, lonlat = local_clock(season.plot.field).today(), season.plot.grid.lonlat()
        ask_photo(season, int(season.plan(today).route.plant[2]), "webs under the leaf?", "Eli")
        for name in names:
            language, scheme, taps, found = SCOUTED[name]
            line.come()
            phone = PhoneBrowser(browser, Path(folder) / name, color_scheme=scheme,
                                 device_scale_factor=2)  # fmt: skip
            key = scouts.let_in(season, f"Ann {name}")
            phone.page.goto(invitation(line.address, NAME, key, str(today), language))
            phone.page.locator("#clean").wait_for(timeout=120_000)
            if found is not None:
                phone.page.evaluate("navigator.serviceWorker.ready.then(() => null)")
                phone.page.wait_for_function("() => navigator.serviceWorker.controller !== null")
                line.go()
            for k in range(taps + 1):
                lon, lat = lonlat[plant_of(phone.page)].tolist()
                at = {"longitude": lon + 1e-5, "latitude": lat + 1e-5, "accuracy": 4}
                phone.window.set_geolocation(at)
                if k < taps:
                    told_now(phone.page, "found" if k + 1 == found else "clean", 3)
            if found == taps + 1:
                phone.page.locator("#found").click()
                phone.page.locator("#count").fill("4")
            phone.page.wait_for_timeout(2500)
            kept(phone.page.screenshot(), name, 468)
            phone.close()
            line.go()


def kept(shot, name, wide):
    """Keep a picture, so wide."""
    image = Image.open(BytesIO(shot)).convert("RGB")
    high = round(image.height * wide / image.width)
    image = image.resize((wide, high), Image.Resampling.LANCZOS)
    # in all their colours: a palette of 256 shows chances in others than the map
    image.save(IMAGES / f"{name}.webp", quality=92, method=6)


def main():
    """Take the pictures."""
    wanted = sys.argv[1:] or [*SHOTS, *SCOUTED]
    with sync_playwright() as browsers:
        chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
        browser = browsers.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        if of_app := [name for name in wanted if name in SHOTS]:
            with pictures.served(begun) as url:
                for name in of_app:
                    of, size, scheme, language, wide = SHOTS[name]
                    for page, _, _ in pictures.windows(browser, [size], [scheme], [language]):
                        shot = taken(page, url, name, of, language)
                    kept(shot, name, wide)
        if of_phone := [name for name in wanted if name in SCOUTED]:
            scouted(browser, of_phone)
        browser.close()


if __name__ == "__main__":
    main()
