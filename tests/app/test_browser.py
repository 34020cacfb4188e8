"""The app in a real browser without internet: what is on the screen is where it should be."""

import io
import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from app import maps
from fieldmon.geodata.options import PlotOptions, RecordOptions
from fieldmon.geodata.reading import read_lines, read_plots, read_records
from fieldmon.monitor import Plans, Plot, first_day

PHONE = ((390, 844), "Mozilla/5.0 (Linux; Android 14) Chrome/150.0 Mobile Safari/537.36")
MAP = "[data-testid=stDeckGlJsonChart]"
ESTATE = maps.__file__.replace("app/maps.py", "sample_data/")


def shown(page, address):
    """Open the app and wait until the map is drawn and still."""
    page.goto(address)
    page.wait_for_selector(f"{MAP} canvas", timeout=120_000)
    page.get_by_text("Chance that a plant is infested").wait_for(timeout=60_000)
    return still(page)


def still(page):
    """Return the map's pixels once two looks at it are the same."""
    chart = page.locator(MAP).first
    before = None
    for _ in range(40):
        page.wait_for_timeout(500)
        now = np.array(Image.open(io.BytesIO(chart.screenshot())).convert("RGB")).astype(int)
        if before is not None and np.array_equal(now, before) and np.ptp(now) > 0:
            return now
        before = now
    pytest.fail("the map did not come to rest")


def sample():
    """Plan the sample as the app's first screen does."""
    (field,) = read_plots(ESTATE + "paran_estate.zip", PlotOptions(feature="Gate")).value
    field = replace(field, paths=read_lines(ESTATE + "tracks.geojson").value)
    plot = Plot.of(field)
    records = read_records(ESTATE + "mite_records.csv", RecordOptions(), near=field).value
    return plot, first_day(plot, records, np.datetime64("2026-11-16"), Plans())


def pixels(grid, lonlat, shape):
    """Return where lon/lat positions are on the map's picture, by Web Mercator."""
    view = maps.view(grid)
    world = 512 * 2.0**view.zoom

    def project(lon, lat):
        y = np.log(np.tan(np.pi / 4 + np.deg2rad(lat) / 2))
        return world * (lon + 180) / 360, world * (0.5 - y / (2 * np.pi))

    x0, y0 = project(view.longitude, view.latitude)
    x, y = project(*np.asarray(lonlat, float).T)
    return np.stack([x - x0 + shape[1] / 2, y - y0 + shape[0] / 2], axis=1)


def is_near(image, place, colour, reach=2, tolerance=40):
    """Tell whether a colour is within some pixels of a place."""
    x, y = np.round(place).astype(int)
    window = image[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1]
    return bool((np.abs(window - np.array(colour)).max(axis=2) < tolerance).any())


def test_plants_and_route_are_drawn_where_they_are(page, address):
    image = shown(page, address)
    page.get_by_role("button", name="stop numbers").click()
    page.get_by_role("button", name="hot spots").click()
    page.get_by_role("button", name="route", exact=True).click()
    image = still(page)
    plot, today = sample()
    shade = maps.by_chance(today.chance)
    place = pixels(plot.grid, plot.grid.lonlat(), image.shape)
    for rank in np.unique(shade.rank):
        own = np.flatnonzero(shade.rank == rank)[::7]
        right = [is_near(image, place[k], maps.CHANCE_COLOURS[rank], reach=1) for k in own]
        assert np.mean(right) > 0.8, f"class {rank} is not in its colour"
    likely, unlikely = np.argmax(today.chance), np.argmin(today.chance)
    assert is_near(image, place[likely], maps.CHANCE_COLOURS[shade.rank[likely]])
    assert not is_near(image, place[unlikely], maps.CHANCE_COLOURS[shade.rank[likely]])
    page.get_by_role("button", name="route", exact=True).click()
    page.get_by_role("button", name="plants", exact=True).click()
    image = still(page)
    line = today.route.line_m
    middle = (line[1:] + line[:-1])[np.hypot(*np.diff(line, axis=0).T) > 6][::9] / 2
    on_line = pixels(plot.grid, plot.grid.frame.lonlat(middle), image.shape)
    assert np.mean([is_near(image, at, maps.ROUTE, tolerance=110) for at in on_line]) > 0.95
    mirrored = image[:, ::-1]
    assert np.mean([is_near(mirrored, at, maps.ROUTE, tolerance=110) for at in on_line]) < 0.8


def test_nothing_is_asked_of_the_world(page, address):
    shown(page, address)
    page.get_by_role("link", name="Season").click()
    page.get_by_text("On the map").wait_for(timeout=120_000)
    still(page)
    elsewhere = [url for url in page.requests if not url.startswith((address, "data:", "blob:"))]
    assert elsewhere == []


def test_the_route_is_downloaded_and_read(page, address):
    shown(page, address)
    with page.expect_download() as download:
        page.get_by_role("button", name="Download the route").click()
    route = json.loads(download.value.path().read_text(encoding="utf-8"))
    _, today = sample()
    line = np.array(route["features"][0]["geometry"]["coordinates"])
    assert line == pytest.approx(today.route.line_lonlat(), abs=1e-8)


def test_a_day_of_the_season_moves_the_map(page, address):
    page.goto(f"{address}/season")
    page.get_by_text("On the map").wait_for(timeout=120_000)
    page.wait_for_selector(f"{MAP} canvas", timeout=120_000)
    before = still(page)
    slider = page.get_by_role("slider", name="Day")
    slider.focus()
    for _ in range(6):
        slider.press("ArrowRight")
    page.wait_for_timeout(1000)
    after = still(page)
    clean = [
        (np.abs(image - np.array(maps.CLEAN)).max(axis=2) < 30).sum() for image in (before, after)
    ]
    assert clean[1] > 1.1 * clean[0]


@pytest.mark.parametrize("page", [PHONE], indirect=True)
def test_a_phone_shows_the_figures_and_the_whole_plot(page, address):
    image = shown(page, address)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.get_by_text("Plants to inspect").is_visible()
    edge = np.concatenate([image[:, :3].reshape(-1, 3), image[:, -3:].reshape(-1, 3)])
    assert (edge > 235).all(), "the plot runs over the phone's edge"
    assert (image < 200).any()
