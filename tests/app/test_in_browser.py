"""The app in a real browser without internet: what is on the screen is where it should be."""

import io
import json
import re
from contextlib import suppress
from dataclasses import replace
from datetime import date

import geopandas as gpd
import numpy as np
import pytest
import shapely
from PIL import Image
from playwright.sync_api import TimeoutError as PlaywrightTimeout

from app.show.maps import colours, deck
from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.observations import Observations
from fieldmon.io.options import PlotOptions, RecordOptions
from fieldmon.io.read import read_lines, read_plots, read_records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.plot import Plot
from tests.app.driving import zipped
from tests.paths import SAMPLE_DATA

PHONE = ((390, 844), "Mozilla/5.0 (Linux; Android 14) Chrome/150.0 Mobile Safari/537.36")
MAP = "[data-testid=stDeckGlJsonChart]"
IDLE = "[data-testid=stApp][data-test-script-state=notRunning]"
# what only one page says
OWN_WORDS = {
    **{name: f": {name}" for name in ("Map", "Season", "Compare", "Plot & records", "Report")},
    "Scout": texts.SCOUT_NEEDS.splitlines()[0].strip("# "),
    "Simulate": f": {texts.SIMULATE}",
    "Study": texts.STUDY_TITLE,
    "Today": "Keep this season",
}
# settled when the browser has drawn so many frames
FRAMES = """n => new Promise(done => {
    const draw = () => n-- > 0 ? requestAnimationFrame(draw) : done()
    draw()
})"""


def shown(page, address):
    """Open the app and wait until its first screen is there."""
    page.goto(address)
    page.get_by_text("Keep this season").wait_for(timeout=240_000)  # compiled first


def still(page):
    """Return the map's pixels once the server has answered and two looks at it are the same."""
    chart = page.locator(MAP).first
    before = None
    for _ in range(100):
        page.evaluate(FRAMES, 12)  # as many on a busy machine, where they take longer
        page.wait_for_selector(IDLE, timeout=60_000)
        now = np.array(Image.open(io.BytesIO(chart.screenshot())).convert("RGB")).astype(int)
        if before is not None and np.array_equal(now, before) and np.ptp(now) > 0:
            return now
        before = now
    pytest.fail("the map did not come to rest")


def becomes(page, as_wanted, what):
    """Wait until the map at rest is as wanted: the server may not have begun to answer."""
    for _ in range(60):
        if as_wanted(still(page)):
            return
    pytest.fail(f"{what} did not show as it should: the zoom is lost, or nothing changed")


def zoomed(page):
    """Turn the wheel over the map; return its pixels."""
    box = page.locator(MAP).first.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    for _ in range(2):
        before = still(page)
        page.mouse.wheel(0, -300)
        becomes(page, lambda now, old=before: not np.array_equal(now, old), "a turn of the wheel")
    page.mouse.move(box["x"], box["y"] - 25)
    return still(page)


def click(page, across, down, says=None):
    """Click on the map, at a share of its width and height; wait for what the page then says.

    The map takes no press for a click where the machine is so busy that a quarter of a second
    passes until the release is heard of: then, as a person would, click again.
    """
    chart = page.locator(MAP).first
    box = chart.bounding_box()
    for _ in range(3):
        chart.click(position={"x": across * box["width"], "y": down * box["height"]})
        if says is None:
            break
        with suppress(PlaywrightTimeout):
            page.get_by_text(says).wait_for(timeout=20_000)
            break
    else:
        pytest.fail(f"three clicks, and the page does not say {says!r}")
    still(page)


def sample():
    """Plan the sample as the app's first screen does."""
    (field,) = read_plots(SAMPLE_DATA / "paran_estate.zip", PlotOptions(feature="Gate")).value
    field = replace(field, paths=read_lines(SAMPLE_DATA / "tracks.geojson").value)
    plot = Plot.of(field)
    records = read_records(SAMPLE_DATA / "mite_records.csv", RecordOptions(), near=field).value
    return plot, first_day(plot, records, np.datetime64("2026-11-16"), PlanSettings())


def pixels(grid, lonlat, shape, room_px=deck.PAGE_PX):
    """Return where lon/lat positions are on the map's picture, by Web Mercator."""
    view = deck.deck(grid, [], room_px).initial_view_state
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
    shown(page, address)
    page.get_by_role("button", name="stop numbers").click()
    page.get_by_role("button", name="hot spots").click()
    page.get_by_role("button", name="route", exact=True).click()
    image = still(page)
    plot, today = sample()
    shade = colours.by_chance(today.chance)
    place = pixels(plot.grid, plot.grid.lonlat(), image.shape)
    for rank in np.unique(shade.rank):
        own = np.flatnonzero(shade.rank == rank)[::7]
        right = [is_near(image, place[k], colours.CHANCE_COLOURS[rank], reach=1) for k in own]
        assert np.mean(right) > 0.8, f"class {rank} is not in its colour"
    likely, unlikely = np.argmax(today.chance), np.argmin(today.chance)
    assert is_near(image, place[likely], colours.CHANCE_COLOURS[shade.rank[likely]])
    assert not is_near(image, place[unlikely], colours.CHANCE_COLOURS[shade.rank[likely]])
    page.get_by_role("button", name="route", exact=True).click()
    page.get_by_role("button", name="plants", exact=True).click()
    image = still(page)
    line = today.route.line_m
    middle = (line[1:] + line[:-1])[np.hypot(*np.diff(line, axis=0).T) > 6][::9] / 2
    on_line = pixels(plot.grid, plot.grid.frame.lonlat(middle), image.shape)
    assert np.mean([is_near(image, at, colours.ROUTE, tolerance=110) for at in on_line]) > 0.95
    mirrored = image[:, ::-1]
    assert np.mean([is_near(mirrored, at, colours.ROUTE, tolerance=110) for at in on_line]) < 0.8


def test_nothing_is_asked_of_the_world(page, address):
    shown(page, address)
    for name, says in OWN_WORDS.items():
        page.get_by_role("link", name=name, exact=True).click()
        page.get_by_role("link", name=name, exact=True).and_(
            page.locator("[aria-current=page]")
        ).wait_for()
        page.get_by_text(says).first.wait_for(timeout=60_000)
        page.wait_for_selector(IDLE, timeout=60_000)
    still(page)
    assert len(page.requests) > 30
    own = (address, address.replace("http", "ws"), "data:", "blob:", "about:")
    assert [url for url in page.requests if not url.startswith(own)] == []


def test_the_route_is_downloaded_and_read(page, address):
    shown(page, address)
    with page.expect_download() as download:
        page.get_by_role("button", name="Download the route").click()
    route = json.loads(download.value.path().read_text(encoding="utf-8"))
    _, today = sample()
    line = np.array(route["features"][0]["geometry"]["coordinates"])
    assert line == pytest.approx(today.route.line_lonlat(), abs=1e-8)


def test_found_clean_and_never_inspected_are_told_apart_by_pixels(page, address, served_seasons):
    plot, _ = sample()
    project = season(served_seasons / "States.gpkg", plot)
    found, clean, never = (np.arange(k, len(plot.grid), 97) for k in (0, 31, 62))
    plants, result = np.concatenate([found, clean]), np.repeat([1, 0], [len(found), len(clean)])
    project.record(Inspections.of(plants, result, np.datetime64("2026-11-16")), "test")
    later = found[:30] + 80
    project.record(Inspections.of(later, np.ones(30, int), np.datetime64("2026-11-17")), "test")
    page.goto(f"{address}/map?season=States")
    page.wait_for_selector(f"{MAP} canvas", timeout=120_000)
    page.get_by_text("found, clean, never inspected", exact=True).click()
    page.get_by_role("button", name="route", exact=True).click()
    page.get_by_role("button", name="hot spots", exact=True).click()
    image = still(page)
    place = pixels(plot.grid, plot.grid.lonlat(), image.shape, deck.MOST_PX)
    ring = (20, 0, 0)
    for own, colour, others in (
        (found, colours.FOUND, (colours.CLEAN,)),
        (clean, colours.CLEAN, (colours.FOUND, ring)),
        (never, None, (colours.FOUND, colours.CLEAN, ring)),
    ):
        if colour is not None:
            assert np.mean([is_near(image, place[k], colour, reach=1) for k in own]) > 0.9
        for other in others:
            assert np.mean([is_near(image, place[k], other, reach=1) for k in own]) < 0.1
    assert np.mean([is_near(image, place[k], ring, reach=6) for k in found]) > 0.9
    flipped = image[::-1]
    assert np.mean([is_near(flipped, place[k], colours.FOUND, reach=1) for k in found]) < 0.3
    px_of_m = np.hypot(*np.ptp(place, axis=0)) / np.hypot(*np.ptp(east_north(plot.grid), axis=0))
    far_px_of_m = scale_px_of_m(page)
    assert far_px_of_m == pytest.approx(px_of_m, rel=0.02)
    near = zoomed(page)
    assert (near != image).any(axis=2).mean() > 0.1
    assert scale_px_of_m(page) > 2 * far_px_of_m
    day = page.get_by_role("slider", name="Day")
    for key, changed in (("ArrowLeft", True), ("ArrowRight", False)):
        day.press(key)
        becomes(page, lambda now, new=changed: (now != near).any() == new, f"the day's {key}")
    for changed in (True, False):
        page.get_by_role("button", name="route", exact=True).click()
        becomes(page, lambda now, new=changed: (now != near).any() == new, "the layer")
    for place in (0.5, 0.51, 0.52, 0.53):  # one of them meets a plant
        click(page, place, place)
    assert page.get_by_role("spinbutton", name="Row").input_value() != "1"
    ring = (255, 190, 0)
    becomes(page, lambda now: (np.abs(now - ring).max(axis=2) < 30).sum() > 50, "the ring")


def east_north(grid):
    """Return metres to the east and north, near enough for a small plot."""
    lonlat = grid.lonlat()
    return lonlat * 111_320.0 * [np.cos(np.deg2rad(lonlat[:, 1].mean())), 1.0]


def scale_px_of_m(page):
    """Return how many pixels a metre has by the scale bar beside the map."""
    scale = page.get_by_role("img", name="The scale bar is")
    metres = re.fullmatch(r"(\d+) m", scale.inner_text().strip()).group(1)
    return scale.locator(".bar").bounding_box()["width"] / float(metres)


def season(path, plot):
    return Season.create(path, plot, Observations.none(), MonitoringSettings(date(2026, 11, 16)))


def test_a_day_begins_with_files_and_ends_with_tomorrows_route(
    page, address, shared, tmp_path, served_seasons
):
    parcels = gpd.read_file(next(shared.glob("parcels_orchards_vineyards/**/*lleida*.gpkg")))
    own = parcels[(parcels.area > 8_000) & (parcels.area < 15_000)].head(1)
    own = own.to_crs(25831).assign(name="מטע הדרים")[["name", "geometry"]]
    lon, lat = own.to_crs(4326).geometry.iloc[0].representative_point().coords[0]
    plot = {"name": "plot.zip", "mimeType": "", "buffer": zipped(tmp_path, own, without=".prj")}
    mites = f"date;lat;lon;count\n14.11.2026;{lat:.6f};{lon:.6f};12\n"
    page.goto(f"{address}/plot?season=My+own+files")
    boxes = page.locator("[data-testid=stFileUploaderDropzoneInput]")
    boxes.nth(0).wait_for(state="attached", timeout=60_000)
    boxes.nth(0).set_input_files([plot])
    page.get_by_text("The file leaves this open").wait_for(timeout=60_000)
    ask = page.get_by_role("combobox", name="The file leaves this open: crs")
    ask.fill("EPSG:25831")
    ask.press("Enter")
    page.get_by_role("button", name="Use this").click()
    page.get_by_role("heading", name="מטע הדרים").wait_for(timeout=60_000)
    box = {"name": "mites.csv", "mimeType": "", "buffer": mites.encode()}
    boxes.nth(1).set_input_files([box])
    page.get_by_text("1 of 1 records shown").wait_for(timeout=60_000)
    title = page.get_by_role("heading", name="מטע הדרים").bounding_box()
    assert title["width"] > 50
    gate, size = a_gate_and_an_area_are_drawn_by_clicks(page)
    page.get_by_role("link", name="Today").click()
    far = still(page)
    first = stops(page)
    assert len(first) > 10
    near = zoomed(page)
    page.get_by_label("Name of the season").fill("עונה 2026")
    page.get_by_role("button", name="Begin the season").click()
    page.get_by_text("has begun").wait_for(timeout=60_000)
    after = still(page)
    moved = [np.mean(np.abs(after - other).max(axis=2) > 30) for other in (near, far)]
    assert moved[0] < 0.2 * moved[1], f"what is said above the map lost its zoom: {moved}"
    assert stops(page) == first
    project = Season(served_seasons / "עונה 2026.gpkg")
    what_was_drawn_is_where_the_clicks_were(project.plot, gate, size)
    page.get_by_role("link", name="Season").click()
    box = page.get_by_role("spinbutton", name="Stops done")
    box.wait_for(timeout=60_000)
    box.fill("8")
    box.press("Enter")
    page.get_by_role("tabpanel").get_by_role("button", name="Record", exact=True).first.click()
    page.get_by_text("8 recorded").wait_for(timeout=60_000)
    page.reload()
    page.get_by_role("link", name="Today").click()
    page.get_by_text("8 plants inspected today so far").wait_for(timeout=60_000)
    rest = stops(page)
    assert len(first) - 20 < len(rest) < len(first)
    assert not set(rest) & set(first[:8])


def a_gate_and_an_area_are_drawn_by_clicks(page):
    """Draw both, take the area back; return the gate and the map's size in pixels."""
    plants = page.get_by_test_id("stMetric").filter(has_text="Plants").first
    before = plants.inner_text()
    page.get_by_text("Gate, paths, no-go areas").click()
    draw_by_click(page, "corners of a no-go area")
    for number, corner in enumerate([(0.4, 0.4), (0.6, 0.4), (0.5, 0.65)], start=1):
        click(page, *corner, says=f"{number} point(s) so far")
    page.get_by_role("button", name="Finish").click()
    page.get_by_text("corners of a no-go area: 3").wait_for(timeout=60_000)
    assert plants.inner_text() != before
    page.get_by_role("button", name="Undo the last one").click()
    page.get_by_text("corners of a no-go area: 3").wait_for(state="detached", timeout=60_000)
    a_path_is_drawn_by_clicks_that_do_not_wait(page)
    draw_by_click(page, "the gate")
    click(page, 0.3, 0.3, says="the gate: 1")
    assert plants.inner_text() == before
    size = still(page).shape
    with page.expect_download() as download:
        page.get_by_role("link", name="Today").click()
        page.get_by_role("button", name="Download the route").click()
    route = json.loads(download.value.path().read_text(encoding="utf-8"))
    return tuple(route["features"][0]["geometry"]["coordinates"][0]), size


def what_was_drawn_is_where_the_clicks_were(plot, gate, size):
    assert plot.field.gate == pytest.approx(gate, abs=1e-6)
    drawn = [gate, *shapely.get_coordinates(plot.field.paths)]
    clicked = [(0.3, 0.3), (0.2, 0.2), (0.5, 0.25), (0.8, 0.2)]
    on_map = pixels(plot.grid, drawn, size, deck.HALF_PX)
    assert on_map == pytest.approx(np.array(clicked) * [size[1], size[0]], abs=1.5)


def a_path_is_drawn_by_clicks_that_do_not_wait(page):
    """Click thrice, although the server has not answered yet."""
    draw_by_click(page, "points of a path")
    chart = page.locator(MAP).first
    chart.scroll_into_view_if_needed()
    box = chart.bounding_box()
    for across, down in ((0.2, 0.2), (0.5, 0.25), (0.8, 0.2)):
        page.mouse.click(box["x"] + across * box["width"], box["y"] + down * box["height"])
    page.get_by_text("3 point(s) so far").wait_for(timeout=60_000)
    page.get_by_role("button", name="Finish").click()
    page.get_by_text("points of a path: 3").wait_for(timeout=60_000)


def draw_by_click(page, what):
    still(page)
    page.get_by_role("combobox", name="A click on the map sets").click()
    page.get_by_role("option", name=what).click()
    still(page)


def stops(page):
    """Download the route and return its plants in order."""
    with page.expect_download() as download:
        page.get_by_role("button", name="Download the route").click()
    route = json.loads(download.value.path().read_text(encoding="utf-8"))
    return [
        f["properties"]["plant"] for f in route["features"] if f["properties"]["kind"] == "stop"
    ]


def test_three_samplers_are_compared_while_the_page_stays_usable(page, address):
    page.goto(f"{address}/compare")
    seeds = page.get_by_role("spinbutton", name="Seasons each")
    seeds.wait_for(timeout=240_000)
    seeds.fill("60")
    seeds.press("Enter")
    page.get_by_role("button", name="Compare", exact=True).click()
    page.get_by_text("seasons simulated").wait_for(timeout=60_000)
    page.get_by_text(re.compile("is best|comes out best")).wait_for(timeout=60_000)
    page.get_by_role("button", name="Stop").click()
    page.get_by_role("button", name="Go on").wait_for(timeout=60_000)
    done = page.get_by_text("of 180 seasons simulated").inner_text()
    assert 3 <= int(done.split(" ")[0]) < 180


@pytest.mark.parametrize("page", [PHONE], indirect=True)
def test_a_scout_works_on_a_phone_and_goes_on_after_a_reload(page, address, served_seasons):
    plot, _ = sample()
    project = season(served_seasons / "Phone.gpkg", plot)
    page.goto(f"{address}/scout?season=Phone")
    place = page.locator("h2")
    place.wait_for(timeout=240_000)
    for name in ("Clean", "Found", "Could not inspect"):
        button = page.get_by_role("button", name=name, exact=True)
        size = button.bounding_box()
        assert size["height"] >= 48
        assert size["x"] + size["width"] <= 390
        before = place.inner_text()
        button.click()
        page.wait_for_function("t => document.querySelector('h2')?.innerText !== t", arg=before,
                               timeout=60_000)  # fmt: skip
    assert project.history.inspections.result.tolist() == [0, 1, 2]
    here = place.inner_text()
    page.reload()
    place.wait_for(timeout=60_000)
    assert place.inner_text() == here
    page.get_by_role("button", name="Undo").click()
    page.wait_for_function("t => document.querySelector('h2')?.innerText !== t", arg=here,
                           timeout=60_000)  # fmt: skip
    assert project.history.inspections.result.tolist() == [0, 1]
    assert page.evaluate("document.documentElement.scrollWidth") <= 390


@pytest.mark.parametrize("page", [PHONE], indirect=True)
def test_a_phone_shows_the_figures_and_the_whole_plot(page, address):
    shown(page, address)
    image = still(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert page.get_by_text("Plants to inspect").is_visible()
    edge = np.concatenate([image[:, :3].reshape(-1, 3), image[:, -3:].reshape(-1, 3)])
    assert (edge > 235).all(), "the plot runs over the phone's edge"
    assert (image < 200).any()
