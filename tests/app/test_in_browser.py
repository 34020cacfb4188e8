"""The app in a real browser without internet: what is on the screen is where it should be."""

import io
import json
import re
from contextlib import suppress
from dataclasses import replace
from datetime import date, time
from functools import cache
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread
from urllib.parse import urlsplit

import geopandas as gpd
import numpy as np
import pytest
import shapely
from PIL import Image
from playwright.sync_api import TimeoutError as PlaywrightTimeout
from shapely import box
from streamlit.proto.ForwardMsg_pb2 import ForwardMsg

from app.show.map_view import LOADER
from app.show.maps import colours
from app.state import kept_ground, menu
from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.level_range import first_level_range
from fieldmon.infestation.records import Records
from fieldmon.io.options import PlotOptions, RecordOptions
from fieldmon.io.read import read_lines, read_plots, read_records
from fieldmon.io.writers import FORMATS
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.field import Field
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import scout
from tests.app.driving import until, zipped
from tests.app.map_in_browser import (
    DRAWN,
    MAP,
    asked_of_the_world,
    becomes,
    card,
    click,
    dressed,
    free,
    is_near,
    look,
    opacity,
    open_item,
    open_page,
    picture,
    pixels,
    rest,
    scale_px_of_m,
    shade,
    share_near,
    still,
    switch,
    view,
    zoomed,
)
from tests.monitoring.seasons import a_plot
from tests.paths import SAMPLE_DATA

PHONE = ((390, 844), "Mozilla/5.0 (Linux; Android 14) Chrome/150.0 Mobile Safari/537.36")
LAPTOP = ((1440, 900), None)
# the place of recording among the pages of its item, whatever the language
RECORD = menu.MENU["today"].pages.index("record")
ROUTE, HOT = texts.MAP_LAYERS["route"], texts.MAP_LAYERS["hot"]
BY_STATE, BY_CHANCE = texts.SHADES["state"], texts.SHADES["chance"]
# what a map of the world shows everywhere
GREY = (77, 99, 55)
_TILE = io.BytesIO()
Image.new("RGB", (256, 256), GREY).save(_TILE, "PNG")
TILE = _TILE.getvalue()
# the dark ring round a find
RING = (20, 0, 0)


def shown(page, address):
    """Open the app and wait until its first screen is there."""
    page.goto(address)
    page.get_by_text("Keep this season").wait_for(timeout=240_000)  # compiled first
    rest(page)


@pytest.fixture(scope="module")
def first_screen(new_tab, address):
    """Load the app's first screen once for all who only look at it and switch what it shows."""
    page = new_tab(LAPTOP[0])
    shown(page, address)
    still(page)
    page.first_view = view(page)
    page.opaque = card(page).get_by_role("slider", name="Opacity").input_value()
    yield page
    page.close()


@pytest.fixture
def screen(first_screen):
    """Return the first screen as it came: all layers, every plant by its chance, the whole plot."""
    page = first_screen
    page.bring_to_front()  # one behind another hears of the mouse seconds later
    if not page.locator(".st-key-item_today").count():
        open_item(page, texts.MENU["today"])
    page.set_viewport_size({"width": 1400, "height": 1000})
    page.mouse.move(2, 2)
    for name in (ROUTE, HOT):
        switch(page, name, on=True)
    shade(page, BY_CHANCE)
    opacity(page, page.opaque)
    page.get_by_role("button", name=texts.MAP_WORDS["whole_plot"]).click()
    return page


@cache
def sample():
    """Plan the sample as the app's first screen does."""
    (field,) = read_plots(SAMPLE_DATA / "paran_estate.zip", PlotOptions(feature="Gate")).value
    field = replace(field, paths=read_lines(SAMPLE_DATA / "tracks.geojson").value)
    plot = Plot.of(field)
    records = read_records(SAMPLE_DATA / "mite_records.csv", RecordOptions(), near=field).value
    return plot, first_day(plot, records, np.datetime64("2026-11-16"), PlanSettings())


def season(path, plot, **settings):
    settings = MonitoringSettings(date(2026, 11, 16), **settings)
    return Season.create(path, plot, Records.none(), settings)


def test_plants_and_route_are_drawn_where_they_are(screen):
    page = screen
    for name in (ROUTE, HOT):
        switch(page, name, on=False)
    image = still(page)
    plot, today = sample()
    shade_of = colours.by_chance(today.chance)
    place = pixels(view(page), plot.grid.lonlat())
    classes = colours.of_chance()
    for rank in np.unique(shade_of.rank):
        own = place[np.flatnonzero(shade_of.rank == rank)[::7]]
        assert share_near(image, own, classes[rank], reach=1) > 0.8, f"class {rank}"
    likely, unlikely = np.argmax(today.chance), np.argmin(today.chance)
    assert is_near(image, place[likely], classes[shade_of.rank[likely]])
    assert not is_near(image, place[unlikely], classes[shade_of.rank[likely]])
    switch(page, ROUTE, on=True)
    opacity(page, 0.1)
    image = becomes(page, lambda now: (now != image).any(), "the route")
    line = today.route.line_m
    middle = (line[1:] + line[:-1])[np.hypot(*np.diff(line, axis=0).T) > 6][::9] / 2
    on_line = pixels(view(page), plot.grid.frame.lonlat(middle))
    assert share_near(image, on_line, colours.ROUTE, tolerance=110) > 0.95
    assert share_near(image[:, ::-1], on_line, colours.ROUTE, tolerance=110) < 0.8, "mirrored"
    assert share_near(image[::-1], on_line, colours.ROUTE, tolerance=110) < 0.8, "upside down"


def test_the_map_takes_most_of_the_window_and_the_whole_plot_is_in_its_free_part(screen):
    page = screen
    page.set_viewport_size({"width": 1440, "height": 900})
    still(page)
    box, panel = page.locator(MAP).bounding_box(), page.locator(".st-key-panel").bounding_box()
    left = panel["x"] + panel["width"]
    free_px = (box["x"] + box["width"] - left) * box["height"]
    assert free_px >= 0.6 * 1440 * 900
    assert (box["x"] + box["width"], box["y"] + box["height"]) == (1440, 900)
    plot, _ = sample()
    for seen in (page.first_view, view(page)):
        assert (seen["width"], seen["height"]) == (box["width"], box["height"])
        place = pixels(seen, plot.grid.lonlat())
        low, high = place.min(axis=0), place.max(axis=0)
        assert (low > [left - box["x"], 0]).all()
        assert (high < [box["width"], box["height"]]).all()
        assert ((high - low) / [1440 - left, box["height"]]).max() > 0.7
    page.get_by_role("button", name=texts.MAP_WORDS["fold"]).click()
    page.locator(".st-key-panel").wait_for(state="hidden")
    page.get_by_role("button", name=texts.MAP_WORDS["unfold"]).click()
    page.locator(".st-key-panel").wait_for(state="visible")


def test_a_switch_on_the_map_changes_pixels_and_asks_nothing_of_the_server(screen):
    page = screen
    before = still(page)
    lines, asked = [], len(page.requests)
    page.on("websocket", lambda line: lines.append(line))  # noqa: PLW0108 - a builtin is refused
    sent = page.evaluate(_COUNT_SENT)
    with_all = before
    for name in (ROUTE, HOT):
        switch(page, name, on=False)
        before = becomes(page, lambda now, was=before: differs(now, was) > 0.002, name)
    for name in (ROUTE, HOT):
        switch(page, name, on=True)
    before = becomes(page, lambda now: (now == with_all).all(), "all layers again")
    shade(page, BY_STATE)
    becomes(page, lambda now: differs(now, before) > 0.02, "another shade")
    assert page.requests[asked:] == []
    assert lines == []
    assert page.evaluate("window.sentToServer") == sent == 0


def differs(image, other):
    """Return the share of pixels in which two pictures differ."""
    return (image != other).any(axis=2).mean()


# counts what goes over the line to the server
_COUNT_SENT = """() => {
  window.sentToServer = 0;
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (...all) {
    window.sentToServer++;
    return send.apply(this, all);
  };
  return window.sentToServer;
}"""


def test_a_page_is_shown_again_over_a_line_so_slow_that_another_was_turned_to_meanwhile(
    page, address
):
    on_the_way, done, line = [], [], []

    def say(message):
        if is_slow:
            on_the_way.append(message)
        else:
            line[0].send(message)
        if ForwardMsg.FromString(message).WhichOneof("type") == "script_finished":
            done.append(message)

    def connected(socket):
        line[:] = [socket]
        socket.connect_to_server().on_message(say)

    def turn(name, runs):
        page.get_by_role("link", name=texts.MENU[name]).first.click()
        until(lambda: page.wait_for_timeout(10) or len(done) == runs)

    is_slow = False
    page.route_web_socket("**/_stcore/stream", connected)
    shown(page, address)
    turn("plots", len(done) + 1)
    rest(page)
    is_slow = True
    for name in ("season", "today"):
        turn(name, len(done) + 1)
    for message in on_the_way:
        line[0].send(message)
    broken = page.get_by_role("dialog")
    page.get_by_text("Keep this season").or_(broken).first.wait_for()
    assert broken.count() == 0


#: as Streamlit does when new data come while the first call is not through: it is ended last, and
#: may begin last
_OVERTAKEN = """async (order) => {
  const { default: call } = await import("/loader.js"), ends = {};
  const host = document.body.appendChild(document.createElement("div")), place = host.attachShadow({ mode: "open" });
  for (const data of order) ends[data] = call({ parentElement: place, data });
  ends[1]();
  await import("/map.js");
  await new Promise((done) => setTimeout(done));
  const mounted = window.mounted;
  host.remove();
  ends[2]();
  return [mounted, window.mounted];
}"""  # noqa: E501
_MAP = """export const mount = ({ data }) => {
  window.mounted = data;
  return () => { window.mounted = null; };
}"""


@pytest.mark.parametrize("order", [[1, 2], [2, 1]])
def test_the_map_is_shown_by_the_last_call_though_an_earlier_one_ends_or_begins_after_it(
    page, order
):
    files = {"/": ("text/html", ""), "/map.js": ("text/javascript", _MAP),
             "/loader.js": ("text/javascript", LOADER % "/map.js")}  # fmt: skip

    def answer(asked):
        kind, body = files[urlsplit(asked.request.url).path]
        asked.fulfill(content_type=kind, body=body)

    page.route("http://fieldmon.test/**", answer)
    page.goto("http://fieldmon.test/")
    assert page.evaluate(_OVERTAKEN, order) == [2, None]


def test_the_route_is_downloaded_and_read(screen):
    page = screen
    route = {"features": route_of(page)}
    _, today = sample()
    line = np.array(route["features"][0]["geometry"]["coordinates"])
    assert line == pytest.approx(today.route.line_lonlat(), abs=1e-8)


def states_season(folder, name):
    """Keep a season of two days with known finds; return its plot, and found, clean, never."""
    plot, _ = sample()
    project = season(folder / f"{name}.gpkg", plot)
    found, clean, never = (np.arange(k, len(plot.grid), 97) for k in (0, 31, 62))
    plants, result = np.concatenate([found, clean]), np.repeat([1, 0], [len(found), len(clean)])
    project.record(Inspections.of(plants, result, np.datetime64("2026-11-16")), "test")
    later = found[:30] + 80
    project.record(Inspections.of(later, np.ones(30, int), np.datetime64("2026-11-17")), "test")
    return (
        plot,
        np.concatenate([found, later]),
        np.setdiff1d(clean, later),
        np.setdiff1d(never, later),
    )


def only_states(page):
    """Show plants by their states, and nothing else."""
    shade(page, BY_STATE)
    for name in (ROUTE, HOT):
        box = page.locator(f"{MAP} .card").get_by_role("checkbox", name=name, exact=True)
        if box.count():
            box.set_checked(False)


@pytest.fixture(scope="module")
def states_tab(new_tab, address, served_seasons):
    """Load such a season once for all who look at its states."""
    page = new_tab()
    page.states = states_season(served_seasons, "States")
    page.goto(f"{address}/season?season=States")
    rest(page)
    yield page
    page.close()


@pytest.fixture
def states(states_tab):
    """Return that tab, with states and the whole plot on its map."""
    page = states_tab
    page.bring_to_front()
    if not page.locator(".st-key-item_season").count():
        open_item(page, texts.MENU["season"])
    only_states(page)
    page.get_by_role("button", name=texts.MAP_WORDS["whole_plot"]).click()
    return page


def test_found_clean_and_never_inspected_are_told_apart_by_pixels(states):
    page = states
    plot, found, clean, never = page.states
    image = still(page)
    place = pixels(view(page), plot.grid.lonlat())
    for own, colour, others in (
        (found, colours.FOUND, (colours.CLEAN,)),
        (clean, colours.CLEAN, (colours.FOUND, RING)),
        (never, None, (colours.FOUND, colours.CLEAN, RING)),
    ):
        if colour is not None:
            assert share_near(image, place[own], colour, reach=1) > 0.9
        for other in others:
            assert share_near(image, place[own], other, reach=1) < 0.1
    assert share_near(image, place[found], RING, reach=6) > 0.9
    assert share_near(image[::-1], place[found], colours.FOUND, reach=1) < 0.3


def test_the_scale_bar_is_as_long_as_it_says_near_and_far(screen):
    page = screen
    plot, _ = sample()
    far = None
    for _ in range(2):
        still(page)
        place = pixels(view(page), plot.grid.lonlat())
        px_of_m = np.hypot(*np.ptp(place, axis=0)) / np.hypot(
            *np.ptp(east_north(plot.grid), axis=0)
        )
        assert scale_px_of_m(page) == pytest.approx(px_of_m, rel=0.02)
        assert far is None or px_of_m > 1.9 * far
        far = px_of_m
        zoomed(page)


def east_north(grid):
    """Return metres to the east and north, near enough for a small plot."""
    lonlat = grid.lonlat()
    return lonlat * 111_320.0 * [np.cos(np.deg2rad(lonlat[:, 1].mean())), 1.0]


def test_the_zoom_stays_over_layers_days_and_rooms(states):
    page = states
    far = still(page)
    near = zoomed(page)
    seen = view(page)
    assert (near != far).any(axis=2).mean() > 0.1
    day = page.get_by_role("slider", name=texts.MAP_WORDS["day"], exact=True)
    for key, changed in (("Home", True), ("End", False)):
        day.press(key)
        becomes(page, lambda now, new=changed: (now != near).any() == new, f"the day's {key}")
    switch(page, ROUTE, on=True)
    becomes(page, lambda now: (now != near).any(), "the route")
    assert view(page) == seen, "the zoom is lost with the route"
    for name in ("today", "plot", "season"):
        open_item(page, texts.MENU[name])
        still(page)
        assert view(page) == seen, f"the zoom is lost in {name}"


def test_hot_spots_bear_their_numbers_beside_those_of_stops(screen):
    page = screen
    hot, stops = (page.locator(f"{MAP} .label.{kind}:visible") for kind in ("hot", "leg"))
    hot.first.wait_for()
    numbers = [int(text) for text in hot.all_inner_texts()]
    assert numbers == sorted(set(numbers))
    assert numbers[0] == 1
    rectangles = [
        [box(r["x"], r["y"], r["x"] + r["width"], r["y"] + r["height"])
         for r in (one.bounding_box() for one in some.all())]
        for some in (hot, stops)
    ]  # fmt: skip
    assert not shapely.intersects(np.array(rectangles[0])[:, None], np.array(rectangles[1])).any()
    switch(page, HOT, on=False)
    hot.first.wait_for(state="hidden")


def test_pointing_at_a_plant_says_which_it_is_and_its_chance(screen):
    page = screen
    switch(page, HOT, on=False)
    still(page)
    plot, today = sample()
    place, box = pixels(view(page), plot.grid.lonlat()), page.locator(MAP).bounding_box()
    x, y = free(page)
    plant = int(np.argmin(np.hypot(*(place - [x - box["x"], y - box["y"]]).T)))
    page.mouse.move(box["x"] + place[plant][0], box["y"] + place[plant][1])
    numbered = plant_numbers(plot.grid, np.array([plant]))
    tip = page.locator(f"{MAP} .tip")
    tip.wait_for()
    said = f"row {numbered.line[0]}, plant {numbered.number[0]}"
    assert tip.inner_text().startswith(said)
    of_it = today.chance[[plant]]
    low, high = first_level_range(plot.grid, today.chance).of(of_it)
    between = f"{100 * of_it[0]:.1f} % chance ({100 * low[0]:.1f} to {100 * high[0]:.1f} %)"
    assert between in tip.inner_text().replace("\N{NO-BREAK SPACE}", " ")


@pytest.fixture(scope="module")
def asked_tab(new_tab, address, served_seasons):
    """Load a season once for all who ask about its plants, which alone are pointed at, or type.

    The first two times that it asks for a part of the map, it gets none.
    """
    page = new_tab()
    page.kept = season(served_seasons / "Asked.gpkg", a_plot())
    page.failures = [lambda asked: asked.abort(), lambda asked: asked.fulfill(status=404)]

    def answer(asked):
        page.failures.pop()(asked) if page.failures else asked.continue_()

    page.route("**/map_data/*", answer)
    page.goto(f"{address}/?season=Asked&day=2026-11-18")
    rest(page)
    page.unroute("**/map_data/*")
    page.complaints.clear()  # of these two
    switch(page, ROUTE, on=False)
    yield page
    page.close()


def turned(page, part):
    """Return a tab on this page of today, with what was done before."""
    page.bring_to_front()
    if not page.locator(".st-key-item_today").count():
        open_item(page, texts.MENU["today"])
    if not page.get_by_role("radio", name=texts.PAGES[part], exact=True).is_checked():
        open_page(page, texts.PAGES[part])
    return page


@pytest.fixture
def asked_screen(asked_tab):
    """Return that tab on its first page, with the whole plot on its map."""
    page = turned(asked_tab, "today")
    page.get_by_role("button", name=texts.MAP_WORDS["whole_plot"]).click()
    return page


@pytest.fixture
def record_page(asked_tab):
    """Return that tab where it is recorded."""
    return turned(asked_tab, "record")


def test_a_map_comes_though_the_network_fails_and_the_server_has_let_go_of_a_part(asked_tab):
    assert not asked_tab.failures, "it was asked for, and did fail"


def test_a_tap_shows_the_history_of_the_very_plant_with_a_ring_round_it(asked_screen):
    page = asked_screen
    still(page)
    zoomed(page)
    plot = page.kept.plot
    place = pixels(view(page), plot.grid.lonlat())
    x, y = free(page)
    box = page.locator(MAP).bounding_box()
    plant = int(np.argmin(np.hypot(*(place - [x - box["x"], y - box["y"]]).T)))
    click(page, place[plant], says=texts.HISTORY)
    numbered = plant_numbers(plot.grid, np.array([plant]))
    until(lambda: history(page) == (str(numbered.line[0]), str(numbered.number[0])))
    image = becomes(
        page, lambda now: share_near(now, place[[plant]], (255, 190, 0), reach=45) == 1, "the ring"
    )
    yellow = np.argwhere(np.abs(image - (255, 190, 0)).max(axis=2) < 30)
    assert yellow.mean(axis=0)[::-1] == pytest.approx(place[plant], abs=2)


def test_rows_are_selected_by_their_numbers_and_the_map_is_driven_by_keys(asked_screen):
    page = asked_screen
    still(page)
    numbers = page.kept.plant_numbers.line
    seen = [int(text) for text in page.locator(".label.row:visible").all_inner_texts()]
    of = {row: int((numbers == row).sum()) for row in (seen[0], seen[-1])}
    assert len(of) == 2
    for row, n in ((seen[0], of[seen[0]]), (seen[-1], sum(of.values())), (seen[-1], of[seen[0]])):
        page.locator(".label.row:visible", has_text=re.compile(f"^{row}$")).first.click()
        page.get_by_text(f"{n} plants selected").wait_for(timeout=60_000)
    page.get_by_role("application").focus()
    middle = view(page)
    page.keyboard.press("ArrowRight")
    page.keyboard.press("+")
    until(lambda: view(page)["zoom"] > middle["zoom"] + 0.99)
    still(page)
    assert view(page)["longitude"] > middle["longitude"]
    said = page.locator(f"{MAP} [role=status]")
    for _ in range(20):  # the middle may lie between plants
        if "chance" in said.text_content():
            break
        page.keyboard.press("Shift+ArrowDown")
        still(page)
    row, plant = re.search(r"row (\d+), plant (\d+)", said.text_content()).groups()
    page.keyboard.press("Enter")
    until(lambda: history(page) == (row, plant))


def history(page):
    """Return of which plant the history is shown, its row and number as they stand there."""
    page.get_by_text(texts.HISTORY).first.wait_for()
    return tuple(
        page.get_by_role("spinbutton", name=name, exact=True).input_value()
        for name in (texts.HISTORY_ROW, texts.HISTORY_PLANT)
    )


def test_a_day_begins_with_files_and_ends_with_tomorrows_route(
    page, address, shared, tmp_path, served_seasons
):
    """What is pressed twice is done once."""
    kept_before = {*served_seasons.glob("*.gpkg")}
    own = an_orchard(shared)
    lon, lat = own.to_crs(4326).geometry.iloc[0].representative_point().coords[0]
    plot = {"name": "plot.zip", "mimeType": "", "buffer": zipped(tmp_path, own, without=".prj")}
    mites = f"date;lat;lon;count\n14.11.2026;{lat:.6f};{lon:.6f};12\n"
    page.goto(f"{address}/plot?season=My+own+files")
    boxes = page.locator("[data-testid=stFileUploaderDropzoneInput]")
    boxes.nth(0).wait_for(state="attached", timeout=180_000)
    boxes.nth(0).set_input_files([plot])
    page.get_by_text(texts.CHOOSE_ON_MAP).wait_for(timeout=180_000)
    ask = page.get_by_role("combobox", name=texts.CHOOSE_OTHER)
    ask.click()
    ask.fill("EPSG:25831")
    page.get_by_role("option", name="EPSG:25831").click()
    page.get_by_role("button", name="Use this").click()
    page.get_by_role("img", name="Map of plot מטע הדרים").wait_for(timeout=180_000)
    west, _, east, _ = own.to_crs(4326).total_bounds
    middle = pytest.approx((west + east) / 2, abs=2 * (east - west))
    until(lambda: view(page)["longitude"] == middle)
    box = {"name": "mites.csv", "mimeType": "", "buffer": mites.encode()}
    boxes.nth(1).set_input_files([box])
    page.get_by_text("1 of 1 records shown").wait_for(timeout=180_000)
    clicked, drawn_in = drawn_by_clicks(page), view(page)
    open_item(page, texts.MENU["today"])
    far = still(page)
    features = route_of(page)
    first = plants_of(features)
    assert len(first) > 10
    assert features[0]["geometry"]["coordinates"][0] == pytest.approx(list(clicked[0]), abs=1e-6)
    assert (zoomed(page) != far).any()
    seen, said = view(page), page.locator(".st-key-lead").inner_text()
    page.get_by_label("Name of the season").fill("עונה 2026")
    begun_by_a_double_press(page)
    assert view(page) == seen, "a season of the same plot is seen from where the plot was"
    assert page.locator(".st-key-lead").inner_text() == said
    (file,) = {*served_seasons.glob("*.gpkg")} - kept_before
    assert file.stem == "עונה 2026"
    project = Season(file)
    assert project.plot.field.gate == pytest.approx(clicked[0], abs=1e-6)
    path_is_where_it_was_clicked(project.plot.field, clicked[1:], drawn_in)
    record_eight(page)
    open_page(page, texts.PAGES["today"])
    page.get_by_text("8 plants inspected so far").wait_for(timeout=180_000)
    remaining = stops(page)
    # planned anew, the rest is another route of about as many stops
    assert abs(len(remaining) - len(first)) < 20
    assert not set(remaining) & set(first[:8])
    planned_by_a_double_press(page, project)


def an_orchard(shared):
    """Return a real parcel with a Hebrew name."""
    parcels = gpd.read_file(next(shared.glob("parcels_orchards_vineyards/**/*lleida*.gpkg")))
    own = parcels[(parcels.area > 8_000) & (parcels.area < 15_000)].head(1)
    return own.to_crs(25831).assign(name="מטע הדרים")[["name", "geometry"]]


def begun_by_a_double_press(page):
    """Begin a season whose rows were assumed; a second press chose nothing."""
    page.get_by_role("button", name="Begin the season").click()
    page.get_by_role("button", name=texts.BEGIN_RIGHT).dblclick()
    page.get_by_text("has begun").wait_for(timeout=180_000)
    still(page)
    assert page.get_by_text("was pressed before").count() == 0


def planned_by_a_double_press(page, project):
    """Keep the day's plan, once."""
    page.locator(".st-key-do_plan button").dblclick()
    page.get_by_text("This is the plan for").first.wait_for(timeout=60_000)
    rest(page)
    assert sum(one.kind == "planned" for one in project.log()) == 1


def test_a_plot_is_drawn_by_four_taps_corrected_and_has_a_route(page, address):
    page.goto(f"{address}/plot?season=My+own+files")
    page.get_by_role("button", name=texts.OUTLINE_BEGIN).click()
    rest(page)
    click(page, free(page))
    page.get_by_text(texts.MAP_WORDS["closer"]).first.wait_for()
    place = page.get_by_role("textbox", name=texts.OUTLINE_PLACE)
    place.fill("https://www.openstreetmap.org/#map=17/31.5012/34.9034")
    place.press("Enter")
    until(lambda: view(page)["zoom"] > 15)
    still(page)
    x, y = free(page)
    top = page.locator(MAP).bounding_box()["y"]
    places = [(x + dx, y - top + dy) for dx, dy in ((-90, 120), (90, 120), (90, -120), (-90, -120))]
    for number, corner in enumerate(places, start=1):
        says = f"{number} corners, " if number > 2 else f"Points: {number}"
        click(page, corner, says=says)
        rest(page)
    seen = view(page)
    assert len(page.locator(".label.edge:visible").all()) == 4
    dressed(page)
    start, end = (np.add(one, (0, top)) for one in (places[1], np.add(places[1], (60, 0))))
    area = page.locator(".drawbar span").inner_text()
    page.mouse.move(*start)
    page.mouse.down()
    edge = page.locator(".label.edge:visible").first
    before = edge.inner_text()
    page.mouse.move(*end, steps=4)
    assert edge.inner_text() != before, "the length of an edge follows the finger"
    page.mouse.up()
    until(lambda: page.locator(".drawbar span").inner_text() != area)
    page.reload()
    page.get_by_role("button", name=texts.OUTLINE_USE).wait_for(timeout=180_000)
    page.locator(".drawbar").get_by_role("button", name="Finish").click()
    page.get_by_role("img", name="Map of plot My plot").wait_for(timeout=240_000)
    with page.expect_download() as kept:
        page.get_by_role("button", name=texts.OUTLINE_DOWNLOAD).click()
    boundary = gpd.read_file(kept.value.path()).geometry.iloc[0]
    corners = pixels(seen, shapely.get_coordinates(boundary)[:-1])
    wanted = np.array([places[0], np.add(places[1], (60, 0)), *places[2:]])
    assert len(corners) == 4
    assert np.linalg.norm(corners[:, None] - wanted, axis=2).min(axis=0).max() < 3
    open_item(page, texts.MENU["today"])
    page.locator(".st-key-lead").get_by_text("Inspect ").first.wait_for()
    assert asked_of_the_world(page, address) == []
    assert page.complaints == []


@pytest.mark.parametrize("page", [PHONE], indirect=True)
def test_on_a_phone_corners_are_walked_to_and_two_taps_cut_the_plot_into_blocks(page, address):
    """A rough position is no corner."""
    window, words = page.context, texts.MAP_WORDS
    window.grant_permissions(["geolocation"], origin=address)
    page.goto(f"{address}/plot?season=My+own+files")
    page.get_by_role("button", name=texts.OUTLINE_BEGIN).click()
    rest(page)
    here = page.get_by_role("button", name=words["corner_here"])
    lonlat = [(34.9, 31.5), (34.902, 31.5), (34.902, 31.502)]
    for number, (lon, lat) in enumerate(lonlat, start=1):
        window.set_geolocation({"longitude": lon, "latitude": lat, "accuracy": 3.2})
        here.click()
        says = f"{number} corners, " if number > 2 else f"Points: {number}"
        page.locator(".drawbar", has_text=says).wait_for()
        assert "to about 4 m" in page.locator(".map .tip").inner_text()
    rest(page)
    bar = page.locator(".drawbar").bounding_box()
    inside = [(0 < x < 390, 0 < y < bar["y"]) for x, y in pixels(view(page), lonlat)]
    assert all(map(all, inside)), "all corners are in view, none is behind the bar"
    grip = page.get_by_role("button", name=words["sheet"])
    for is_seen in (False, True):
        grip.click()
        until(lambda: page.locator(".drawbar").is_visible() == is_seen)  # noqa: B023 - at once
    window.set_geolocation({"longitude": 34.9, "latitude": 31.502, "accuracy": 900})
    here.click()
    page.locator(".map .tip", has_text="you are seen to 900 m only").wait_for()
    page.locator(".drawbar", has_text="3 corners").wait_for()
    page.get_by_role("button", name=words["here"], exact=True).click()
    until(lambda: abs(pixels(view(page), [[34.9, 31.502]])[0] - (195, 300)).max() < 150)
    window.clear_permissions()
    here.click()
    page.locator(".map .tip", has_text="The browser says no position").wait_for()
    page.get_by_role("button", name="Finish").click()
    page.get_by_role("img", name="Map of plot My plot").wait_for(timeout=240_000)
    open_drawing(page)
    draw_by_click(page, "a cut into blocks")
    across = [(lon, 31.501) for lon in (34.9005, 34.90215)]
    for number, place in enumerate(pixels(view(page), across), start=1):
        click(page, place, says=f"Points: {number}")
    bar, sheet = page.locator(".drawbar").bounding_box(), page.locator(".st-key-panel")
    assert bar["y"] + bar["height"] <= sheet.bounding_box()["y"], "what is asked is under the sheet"
    page.get_by_role("button", name="Finish").click()
    page.get_by_text("a cut into blocks: 2").wait_for(timeout=180_000)


def record_eight(page):
    """Record the first eight stops of the route as clean."""
    open_page(page, texts.PAGES["record"])
    page.get_by_role("tab", name=texts.RECORD_ROUTE).click()
    box = page.get_by_role("spinbutton", name=texts.RECORD_STOPS)
    box.wait_for(timeout=180_000)
    box.fill("8")
    box.press("Enter")
    page.get_by_role("tabpanel").get_by_role("button", name="Record", exact=True).first.click()
    page.get_by_text("8 recorded").wait_for(timeout=180_000)


def drawn_by_clicks(page):
    """Draw a path and the gate; return the clicks, gate first.

    That areas are drawn and taken back, see `actions/test_editing_plot`.
    """
    open_drawing(page)
    draw_by_click(page, "points of a path")
    path = [at_share(page, share) for share in ((0.2, 0.2), (0.5, 0.25), (0.8, 0.2))]
    page.get_by_text("Points: 3").wait_for()
    page.get_by_role("button", name="Finish").click()
    page.get_by_text("points of a path: 3").wait_for(timeout=180_000)
    rest(page)
    draw_by_click(page, "the gate")
    gate = at_share(page, (0.3, 0.3), says="the gate: 1")
    rest(page)
    draw_by_click(page, "nothing")
    return gate, *path


def open_drawing(page):
    """Open what can be drawn on the plot."""
    rest(page)
    for _ in range(3):
        page.get_by_text("Gate, paths, no-go areas").click()
        # what stands above may still come, and move it from under the pointer
        with suppress(PlaywrightTimeout):
            page.get_by_role("combobox", name="A click on the map sets").wait_for(timeout=20_000)
            return
    pytest.fail("three clicks, and the tools for drawing do not open")


def path_is_where_it_was_clicked(field, clicked, seen):
    corners = shapely.get_coordinates(field.boundary)
    wanted = np.array([snapped(one, corners, seen) for one in clicked])
    assert shapely.get_coordinates(field.paths) == pytest.approx(wanted, abs=1e-6)


def snapped(lonlat, corners, seen):
    """Return the corner of the outline within ten pixels of a place, or the place itself."""
    far = np.hypot(*(pixels(seen, corners) - pixels(seen, [lonlat])).T)
    return tuple(corners[far.argmin()]) if far.min() <= 10 else lonlat


def at_share(page, share, says=None):
    """Click at a share of the free part of the map; return where that is, lon/lat."""
    box, panel = page.locator(MAP).bounding_box(), page.locator(".st-key-panel").bounding_box()
    left = panel["width"]
    place = np.array([left + share[0] * (box["width"] - left), share[1] * box["height"]]).round()
    lonlat = at_pixel(view(page), place)
    click(page, place, says)
    return lonlat


def at_pixel(seen, place):
    """Return where a pixel of the map is, lon/lat: the way back from `pixels`."""
    world = 512 * 2.0 ** seen["zoom"]
    lon = seen["longitude"] + (place[0] - seen["width"] / 2) * 360 / world
    y = np.log(np.tan(np.pi / 4 + np.deg2rad(seen["latitude"]) / 2))
    y -= (place[1] - seen["height"] / 2) * 2 * np.pi / world
    return lon, float(np.rad2deg(2 * np.arctan(np.exp(y)) - np.pi / 2))


def choose(page, name, what):
    """Choose in a list what is called so."""
    box = page.get_by_role("combobox", name=name, exact=True)
    option = page.get_by_role("option", name=what)
    for _ in range(60):
        # the page may be drawn again, or its panel still scroll: then the list closes
        if box.get_attribute("aria-expanded") != "true":
            box.click()
        with suppress(PlaywrightTimeout):
            option.click(timeout=1_000)
            return
    pytest.fail(f"{what!r} is not offered in the list")


def draw_by_click(page, what):
    choose(page, "A click on the map sets", what)
    if what != "nothing":
        page.locator(f"{MAP}.drawing").wait_for(timeout=180_000)
    still(page)


def route_of(page):
    """Take the route along as GeoJSON."""
    page.get_by_role("button", name=texts.STEP_BUTTONS["send"]).click()
    page.get_by_role("dialog").get_by_role("combobox").click()
    page.get_by_role("option", name="geojson").click()
    button = page.get_by_role("button", name=FORMATS["geojson"].reader)
    button.wait_for()
    # until the page is at rest, the button may be drawn again under the press
    rest(page)
    taken = []

    def is_taken():
        # a press under which the button is drawn again is none: a person presses again, too
        with suppress(PlaywrightTimeout), page.expect_download(timeout=30_000) as download:
            button.click()
        with suppress(PlaywrightTimeout):
            taken.append(download.value)
        return bool(taken)

    until(is_taken)
    page.get_by_role("dialog").get_by_label("Close").click()
    page.get_by_role("dialog").wait_for(state="hidden")
    return json.loads(taken[0].path().read_text(encoding="utf-8"))["features"]


def plants_of(features):
    """Return the route's plants in order."""
    return [f["properties"]["plant"] for f in features if f["properties"]["kind"] == "stop"]


def stops(page):
    """Take the route along; return its plants in order."""
    return plants_of(route_of(page))


def contrast(button):
    """Return the contrast of a button's words with its ground (WCAG's formula)."""
    shades = ("",)
    while not all(shades):  # a button that is drawn anew in this moment has none
        shades = button.evaluate(_SHADES)
    light = []
    for one in shades:
        parts = np.array([float(n) for n in re.findall(r"[\d.]+", one)[:3]]) / 255
        linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
        light.append(float(linear @ [0.2126, 0.7152, 0.0722]) + 0.05)
    return max(light) / min(light)


_SHADES = """b => { const words = b.querySelector("p") || b; let ground = b, shade;
        do { shade = getComputedStyle(ground).backgroundColor; ground = ground.parentElement; }
        while (ground && /^rgba.*, 0\\)$/.test(shade));
        return [getComputedStyle(words).color, shade]; }"""


def plants_show(page):
    """Wait until a good part of the map has the colours of chances."""
    shades = np.array(colours.of_chance())

    def coloured(image):
        near = [(np.abs(image - one).max(axis=2) < 12).mean() for one in shades[1:4]]
        return sum(near) > 0.02

    becomes(page, coloured, "the plants")


# a hand that bounces: as long as the same plant is shown, it is tapped again
_TAPPED_WHILE_SHOWN = """(button, place) => {
  const again = setInterval(() => {
    if (document.querySelector("h2")?.innerText === place) button.click();
    else clearInterval(again);
  }, 20);
}"""


@pytest.mark.parametrize("page", [PHONE], indirect=True)
def test_a_scout_works_on_a_phone_and_goes_on_after_a_reload(page, address, served_seasons):
    # taps are told the hour, and the server's clock is the real one: the whole day is worked
    whole = {"starts": time(), "robot": scout().with_hours(24.0)}
    project = season(served_seasons / "Phone.gpkg", a_plot(), **whole)
    page.goto(f"{address}/?season=Phone&part=scout")
    rest(page)
    place = page.locator("h2")
    place.wait_for(timeout=240_000)
    for name in ("Clean", "Found", "Could not inspect"):
        button = page.get_by_role("button", name=name, exact=True)
        if name != "Could not inspect":
            size = button.bounding_box()
            assert size["y"] + size["height"] <= 844, f"{name} must be scrolled to"
        button.scroll_into_view_if_needed()
        size = button.bounding_box()
        assert size["height"] >= 48
        assert size["x"] + size["width"] <= 390
        before = place.inner_text()
        button.hover()
        assert contrast(button) > 4.5, f"{name} cannot be read while it is pointed at"
        button.evaluate(_TAPPED_WHILE_SHOWN, before)
        page.wait_for_function("t => document.querySelector('h2')?.innerText !== t", arg=before,
                               timeout=180_000)  # fmt: skip
        assert contrast(button) > 4.5, f"{name} cannot be read after it was tapped"
    assert project.history.inspections.result.tolist() == [0, 1, 2]
    here = place.inner_text()
    page.reload()
    rest(page)
    place.wait_for(timeout=180_000)
    assert place.inner_text() == here
    page.get_by_role("button", name="Undo").click()
    page.wait_for_function("t => document.querySelector('h2')?.innerText !== t", arg=here,
                           timeout=180_000)  # fmt: skip
    assert project.history.inspections.result.tolist() == [0, 1]
    assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_what_is_being_typed_as_record_empties_its_box_is_typed_on_in_the_empty_one(record_page):
    page = record_page
    forms = page.get_by_role("tabpanel")
    row, plant = (forms.get_by_label(name, exact=True).first for name in ("Row", "Plant"))
    for typed in (row, plant):
        typed.fill("1")
        typed.press("Enter")
    forms.get_by_role("radio", name=texts.RESULTS_OF[0]).first.click()
    rest(page)
    row.press_sequentially("2")
    # pressed from afar: the box is not left, as by what is typed just after a press
    page.evaluate("document.querySelector('[class*=st-key-record_one] button').click()")
    page.get_by_text("1 recorded").wait_for(timeout=180_000)
    rest(page)
    assert len(page.kept.history.inspections) == 1
    assert plant.input_value() == ""
    page.keyboard.type("3")
    assert row.input_value() == "123"


def test_a_day_typed_counts_by_enter_and_by_tab_and_back_leads_to_the_item_before(record_page):
    page = record_page
    typed = page.get_by_test_id("stDateInput").first.get_by_role("spinbutton").last
    typed.click()
    rest(page)  # what was typed elsewhere before is taken
    for key, day in (("Enter", "20"), ("Tab", "22")):
        typed.click()
        page.keyboard.type(day)
        page.keyboard.press(key)
        page.wait_for_url(f"**day=2026-11-{day}*")
        rest(page)
    here, day = page.url, re.search(r"day=([\d-]+)", page.url)[1]
    open_item(page, texts.MENU["season"])
    page.wait_for_url(f"**/season?*day={day}*")
    rest(page)
    page.go_back()
    page.get_by_role("tab", name=texts.RECORD_ROUTE).wait_for()
    page.wait_for_url(here)


@pytest.fixture
def world():
    """Stand for a server of maps somewhere in the world; remember what it is asked."""
    asked = []

    class Answers(BaseHTTPRequestHandler):
        def do_GET(self):
            asked.append(self.path)
            self.send_response(200)
            self.send_header("Access-Control-Allow-Origin", "*")
            self.end_headers()
            self.wfile.write(TILE)

        def log_message(self, *_):
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Answers) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}", asked
        server.shutdown()


def test_a_map_of_the_world_is_asked_only_once_it_is_agreed_to_and_no_longer_than_that(
    page, address, world, served_seasons
):
    season(served_seasons / "World.gpkg", sample()[0])
    url, asked = world
    page.goto(f"{address}/plot?season=World")
    rest(page)
    page.get_by_text(texts.GROUND, exact=True).click()
    rest(page)
    choose(page, texts.WEB_MAP, texts.WEB_MAPS["other"])
    box = page.get_by_role("textbox", name=texts.WEB_MAP_ADDRESS)
    box.fill(f"{url}/{{z}}/{{x}}/{{y}}.png")
    box.press("Enter")
    agree = page.get_by_role("button", name=re.compile("^Agree: show pictures from"))
    agree.wait_for(timeout=180_000)
    before = still(page)
    assert asked == [], "nothing is asked before anybody agreed"
    agree.click()
    becomes(page, lambda now: (np.abs(now - GREY).max(axis=2) < 6).mean() > 0.15, "the map")
    assert asked
    assert all(re.fullmatch(r"/\d+/\d+/\d+\.png", path) for path in asked), "nothing but tiles"
    ask = "url => fetch(url).then(() => 'asked', () => 'refused')"
    assert page.evaluate(ask, f"{url}/season") == "refused", "a script in the page asks no server"
    switch(page, texts.MAP_LAYERS["ground"], on=False)
    becomes(page, lambda now: (now == before).mean() > 0.99, "the map without it")
    n = len(asked)
    zoomed(page)
    assert len(asked) == n, "what is switched off is not asked for"
    switch(page, texts.MAP_LAYERS["ground"], on=True)
    becomes(page, lambda now: (np.abs(now - GREY).max(axis=2) < 6).mean() > 0.15, "it again")
    assert len(asked) > n, "nearer by, there are other pictures"
    page.get_by_role("button", name=re.compile("^Stop asking")).click()
    again = agree.or_(page.get_by_role("combobox", name=texts.WEB_MAP)).first
    again.wait_for(timeout=180_000)
    still(page)
    assert again.is_visible(), "the box is not folded under the hand"
    n = len(asked)
    zoomed(page)
    assert len(asked) == n
    kept = kept_ground.agreement(served_seasons / "World.gpkg")
    assert kept is None, "nor is anything asked after a reload"


@pytest.mark.parametrize("page", [PHONE], indirect=True)
def test_on_a_phone_in_hebrew_lists_keep_apart_undo_is_beside_its_line_and_the_map_stays(
    page, address, served_seasons
):
    two = Inspections.of([0, 1], [1, 0], np.datetime64("2026-11-16"))
    season(served_seasons / "Right.gpkg", a_plot()).record(two, "test")
    page.goto(f"{address}/?season=Right&lang=he&part=today")
    rest(page)
    gaps = page.evaluate("""() => [...document.querySelectorAll(
        ".st-key-panel [data-testid=stMarkdownContainer]>:is(ul,ol):last-child")].map((list) =>
      list.closest("[data-testid=stElementContainer]").nextElementSibling?.getBoundingClientRect().top
        - list.getBoundingClientRect().bottom).filter((gap) => !Number.isNaN(gap))""")
    assert gaps
    assert min(gaps) >= 8
    sheet = round(page.locator(".st-key-panel").bounding_box()["y"])
    page.locator(".st-key-item_today").get_by_role("radio").nth(RECORD).click()
    batch = page.locator("[class*=st-key-batch_]").first
    batch.wait_for()
    rest(page)
    undo = batch.get_by_role("button").bounding_box()
    line = batch.locator("p").first.bounding_box()
    assert undo["x"] + undo["width"] <= line["x"], "the button is under its line"
    batch.get_by_role("button").scroll_into_view_if_needed()
    batch.get_by_role("button").click()
    page.locator("[class*=st-key-undo_yes] button").click()  # it is of another day
    said = page.locator(".st-key-panel_notice [data-testid=stAlert]")
    said.wait_for()
    place = said.bounding_box()
    assert place["y"] >= sheet, "what was done is said where one looks"
    assert place["y"] + place["height"] <= 844
    page.goto(f"{address}/season?season=Right&lang=he&part=report")
    page.locator(".st-key-panel iframe").wait_for()
    still(page)
    dressed(page)

    def above():
        return np.array(Image.open(io.BytesIO(picture(page))).convert("RGB"), np.int16)[:sheet]

    before = above()
    page.evaluate("document.querySelector('.st-key-panel iframe').scrollIntoView({block: 'end'})")
    page.evaluate("() => new Promise((done) => setTimeout(() => requestAnimationFrame(done), 200))")
    assert (np.abs(above() - before).max(axis=2) > 30).mean() < 0.01, "the report hides the map"
    page.goto(f"{address}/plot?season=My+own+files&lang=he")
    title = page.locator(".st-key-panel h1")
    title.wait_for()
    gap = """(one) => { const words = document.createRange(); words.selectNodeContents(one);
      return one.getBoundingClientRect().right - words.getBoundingClientRect().right; }"""
    # a heading of Latin letters begins where the others do
    until(lambda: title.evaluate(gap) < 5, 60.0)


# tools whose middle another thing lies over or that cannot be pressed, as a press would find them:
# a trial press of each waits a second for frames that a map at rest does not draw
_COVERED = """(tools) => tools.filter((tool) => {
  const { x, y, width, height } = tool.getBoundingClientRect();
  const [left, top] = [x + width / 2, y + height / 2];
  let hit = document.elementFromPoint(left, top);
  for (let within; (within = hit?.shadowRoot?.elementFromPoint(left, top)) && within !== hit;) hit = within;
  return tool.disabled || !tool.contains(hit);
}).map((tool) => tool.ariaLabel ?? tool.outerHTML)"""  # noqa: E501
_LID = """() => document.body.append(Object.assign(document.createElement("div"),
  { id: "lid", style: "position:fixed;inset:0;z-index:2147483647" }))"""


def fills_its_place(page):
    """Tell whether the map is as large as its place."""
    seen, box = view(page), page.locator(MAP).bounding_box()
    return (seen["width"], seen["height"]) == (box["width"], box["height"])


def test_in_a_low_window_or_a_zoomed_one_all_tools_of_the_map_can_be_pressed(screen):
    page = screen
    tools = page.locator(f"{MAP} .tools .tool")
    # 1440 x 900 at 150 and 200 %, 1366 x 768 at 200 %, half a window, the smallest
    for width, height in ((960, 600), (720, 450), (683, 384), (1366, 400), (360, 560), (320, 480)):
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_function("(wide) => innerWidth === wide", arg=width)
        until(lambda: fills_its_place(page))
        assert tools.count() >= 7
        assert tools.evaluate_all(_COVERED) == [], f"{width} x {height}"
    page.evaluate(_LID)
    assert len(tools.evaluate_all(_COVERED)) == tools.count(), "what lies over them is noticed"
    page.evaluate("document.getElementById('lid').remove()")


@pytest.mark.parametrize("page", [LAPTOP], indirect=True)
def test_on_the_map_of_all_no_plot_lies_behind_the_legend_and_any_can_be_opened(
    page, address, served_seasons
):
    """Those under one dot are counted on it; plants show after a plot drawn as a picture, too."""
    # the farthest away of all seasons that other tests keep: the map of all has them in its corners
    small, files = (0.0005, 0.0005), []
    for name, (lon, lat), (width, height) in (
        ("North-west", (34.0, 32.0), small), ("South-east", (37.0, 28.9), small),
        ("Last year", (36.0, 31.0), small), ("This year", (36.0, 31.0), small),
        # over 20 000 plants, too near each other on the screen to be points
        ("Large", (35.15, 30.36), (0.0105, 0.0024)),
    ):  # fmt: skip
        area = shapely.MultiPolygon([box(lon, lat, lon + width, lat + height)])
        files.append(served_seasons / f"{name}.gpkg")
        Season.create(files[-1], Plot.of(Field(name, area)), begins=date(2026, 11, 16))
    try:
        page.goto(f"{address}/plots")
        rest(page)
        corner, both = pixels(view(page), [[37.0, 28.9], [36.00025, 31.00025]])
        legend = page.locator(f"{MAP} .legend").bounding_box()
        top = page.locator(MAP).bounding_box()["y"]
        behind = corner[0] > legend["x"] and top + corner[1] > legend["y"]
        assert not behind, f"it is at {corner}, the legend at {legend}"
        page.locator(f"{MAP} .label.plots", has_text="2").wait_for()
        click(page, both)
        page.locator(f"{MAP} .choice button", has_text="This year").click()
        box_of_plots = page.locator(".st-key-season input")
        until(lambda: box_of_plots.count() and box_of_plots.input_value() == "This year", 60.0)
        rest(page)
        for name in ("Large", "This year"):
            box_of_plots.click()
            page.get_by_role("option", name=name).click()
            page.get_by_role("img", name=f"Map of plot {name}").wait_for(timeout=180_000)
            plants_show(page)
    finally:
        for file in files:
            file.unlink()


@pytest.fixture(scope="module")
def phone_tab(new_tab, address):
    """Load the app's first screen once on a phone, for all who leave it as it was."""
    page = new_tab(*PHONE)
    shown(page, address)
    yield page
    page.close()


@pytest.fixture
def on_a_phone(phone_tab):
    """Return that screen."""
    phone_tab.bring_to_front()
    return phone_tab


def test_a_phone_shows_the_whole_plot_above_the_days_work(on_a_phone):
    page = on_a_phone
    image = still(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    sheet = page.locator(".st-key-panel").bounding_box()
    assert sheet["y"] >= 0.5 * 844, "the map is half of the screen"
    assert page.locator(MAP).bounding_box()["y"] == 0
    next_step = page.get_by_role("button", name="Begin a season").bounding_box()
    assert next_step["y"] + next_step["height"] <= 844, "what to do next is on the first screen"
    said = page.get_by_text(re.compile("^Inspect .* plants")).first
    assert said.bounding_box()["y"] < next_step["y"]
    plot, _ = sample()
    place = pixels(view(page), plot.grid.lonlat())
    assert (place > 0).all()
    assert (place < [390, sheet["y"]]).all(), "the plot runs under the sheet, or over the edge"
    assert share_near(image, place[::7], colours.of_chance()[3], tolerance=130) > 0.8


def test_on_a_phone_plot_and_day_are_one_line_that_unfolds(on_a_phone):
    page = on_a_phone
    line = page.locator(".st-key-where_and_when")
    assert line.bounding_box()["height"] < 60
    assert "Gate" in line.inner_text()
    boxes = page.locator("[data-testid=stPopoverBody]")
    assert not boxes.is_visible()
    line.get_by_role("button").click()
    boxes.get_by_role("combobox", name=texts.WHICH_PLOT).wait_for(timeout=60_000)
    assert boxes.get_by_text("there it is always").is_visible()
    assert boxes.get_by_role("slider", name=texts.HOURS).is_visible()
    page.keyboard.press("Escape")
    boxes.wait_for(state="hidden", timeout=60_000)


def test_on_a_phone_the_map_s_tools_are_as_large_as_a_thumb_and_layers_lie_above_the_legend(
    on_a_phone,
):
    page = on_a_phone
    for tool in page.locator(".tools .tool").all():
        size = tool.bounding_box()
        assert min(size["width"], size["height"]) >= 44
    page.get_by_role("button", name=texts.MAP_WORDS["layers"]).click()
    title = page.locator(".card .title").first
    title.wait_for()
    seen = title.evaluate(
        "(one) => { const { x, y } = one.getBoundingClientRect();"
        " return one.getRootNode().elementFromPoint(x + 4, y + 6) === one; }"
    )
    assert seen, "the legend lies over it"
    page.get_by_role("button", name=texts.MAP_WORDS["layers"]).click()
    route = page.locator(".legend").get_by_text(texts.LEGEND_ROUTE)
    assert not route.is_visible()
    page.get_by_role("button", name=texts.MAP_WORDS["legend"]).click()
    assert route.is_visible(), "every sign is explained on a phone too"
    page.get_by_role("button", name=texts.MAP_WORDS["legend"]).click()


def test_the_sheet_is_pulled_up_and_let_down_again(on_a_phone):
    page = on_a_phone
    dressed(page)
    sheet, grip = page.locator(".st-key-panel"), page.get_by_role("button", name="Pull the day")
    half = sheet.bounding_box()["y"]
    for up in (True, False):
        grip.click()
        page.wait_for_function(
            "([half, up]) => (document.querySelector('.st-key-panel').getBoundingClientRect().y"
            " < half / 2) === up", arg=[half, up],
        )  # fmt: skip
    assert sheet.bounding_box()["y"] == half
    assert look(page).shape[1] == 390
    assert page.locator(DRAWN).count() == 1


def test_a_robot_drives_by_the_space_bar_stands_at_a_find_and_the_find_lights_up(screen, address):
    page = screen
    for name in (ROUTE, HOT):
        switch(page, name, on=False)
    open_item(page, texts.MENU["ahead"])
    open_page(page, texts.PAGES["drive"])
    still(page)
    plan = view(page)
    page.get_by_role("button", name=texts.DRIVE_RUN).click()
    bar = page.locator(f"{MAP} .drive[data-now]")
    bar.wait_for(timeout=120_000)
    rest(page)
    now = lambda: json.loads(bar.get_attribute("data-now"))  # noqa: E731
    sent = [fetch(page, one) for one in [*page.requests] if "/map_data/" in one]
    day = next(one for one in sent if "stops" in one)
    red = lambda image: (np.abs(image - [190, 25, 25]).max(axis=2) < 40).sum()  # noqa: E731
    before = look(page)
    slider = page.get_by_role("slider", name=texts.MAP_WORDS["time_of_day"])
    slider.fill(f"{day['stops'][0][0] - 60:.0f}")
    begins = now()
    assert begins["stops"] == 0
    page.locator(f"{MAP} .canvas").focus()
    page.keyboard.press("Space")
    until(lambda: now()["stops"] > 0)
    page.keyboard.press("Space")
    assert not now()["playing"]
    assert (now()["lon"], now()["lat"]) != (begins["lon"], begins["lat"])
    find = next(one for one in day["stops"] if one[2])
    standing = []
    for second in (find[0] - 8, find[0] - 3, find[0] + 1):
        slider.fill(f"{second:.0f}")
        standing.append(now())
    places = {(one["lon"], one["lat"]) for one in standing[:2]}
    assert len(places) == 1, "it stands while it looks"
    assert [one["found"] for one in standing] == [0, 0, 1]
    becomes(page, lambda image: red(image) > red(before) + 100, "the find")
    assert view(page)["bearing"] != 0
    page.get_by_role("radio", name=texts.DRIVE_SOURCES["recorded"]).click()
    # no robot is shown any more: the whole plot, and north is up
    until(lambda: view(page) == plan, within_s=30.0, every_s=0.2)
    assert asked_of_the_world(page, address) == []
    assert page.complaints == []


def test_nothing_is_asked_of_the_world_nor_complained_of_on_any_console(
    first_screen, phone_tab, address
):
    """By all that was done before in tabs without a season.

    Every page is turned to in a season, see `test_accessible`; drawing and driving say it above.
    """
    assert len(first_screen.requests) > 30
    for page in (first_screen, phone_tab):
        assert asked_of_the_world(page, address) == []
        assert page.complaints == []


def fetch(page, url):
    """Return what the browser finds at an address, as JSON; empty if it is none."""
    return page.evaluate("url => fetch(url).then((a) => a.json()).catch(() => ({}))", url)
