"""For everybody: pages that axe-core finds nothing serious in, and tasks done by keys alone.

All are of a season whose files are full of texts that do harm: a browser shows them as text.
The suite lets axe-core look at the first page of each item of the menu, and at one in the dark;
``FIELDMON_AXE=all`` at every page, and at every item of the menu in the dark.
"""

import io
import os
from contextlib import contextmanager, suppress

import numpy as np
import pytest
from PIL import Image

from app.state import kept_ground, menu
from app.state.kept_ground import GroundPicture
from app.words import texts
from fieldmon.io.rasters.read import Backdrop
from fieldmon.plot.robot import Robot
from tests.app.driving import until
from tests.app.map_in_browser import (
    IDLE,
    MAP,
    asked_of_the_world,
    faults,
    in_scheme,
    open_item,
    open_page,
    rest,
    still,
    tab_to,
)
from tests.app.test_hostile_texts import EVIL, hostile_season
from tests.paths import ROOT

EVERYTHING = os.environ.get("FIELDMON_AXE") == "all"
#: the item of the menu that the suite sees in the dark: the one with a map, a route and figures
DARK = "today"
NAVIGATION = "ul[data-testid=stSidebarNavItems]"
# two messages to the server leave together
HELD = """() => {
  const { send } = WebSocket.prototype, held = [];
  WebSocket.prototype.send = function (said) {
    if (held.push([this, said]) < 2) return;
    WebSocket.prototype.send = send;
    for (const [line, one] of held) send.call(line, one);
  };
}"""


@pytest.fixture(scope="module")
def kept(served_seasons):
    """Keep such a season with a picture of the ground under it; return how an address names it."""
    path = served_seasons / "Everybody.gpkg"
    plot = hostile_season(path, robot=Robot(hours=2.0)).plot
    (west, south), (east, north) = plot.grid.lonlat().min(axis=0), plot.grid.lonlat().max(axis=0)
    corners = np.array([[west, south], [west, north], [east, north], [east, south]])
    file = io.BytesIO()
    stripes = np.indices((64, 64)).sum(axis=0)[..., None] % 16 * np.array([16, 14, 8])
    Image.fromarray(stripes.astype(np.uint8)).save(file, "PNG")
    kept_ground.keep(
        path, GroundPicture("air.tif", Backdrop(file.getvalue(), "image/png", corners))
    )
    return "season=Everybody"


@pytest.fixture(scope="module")
def tab(new_tab, address, kept):
    """Return a tab of the app on the season, which stays open from test to test.

    It begins in the dark, as who looks at that first then turns the light on once, and not twice.
    """
    page = new_tab((1400, 1000))
    page.emulate_media(color_scheme="dark")
    page.goto(f"{address}/?{kept}")
    rest(page)
    yield page
    page.close()


def at(page, name):
    """Turn to the first page of an item of the menu, if that is not shown."""
    first, *more = menu.MENU[name].pages
    if not page.locator(f".st-key-item_{name}").count():
        open_item(page, texts.MENU[name])
    if more and not page.get_by_role("radio", name=texts.PAGES[first], exact=True).is_checked():
        open_page(page, texts.PAGES[first])


@pytest.fixture
def lit(tab):
    """Return that tab in front, and in the light."""
    tab.bring_to_front()
    in_scheme(tab, "light")
    return tab


@pytest.fixture
def today(lit):
    """Return that tab on the page that it began on."""
    at(lit, "today")
    return lit


@pytest.fixture
def ahead(lit):
    """Return that tab where strategies are compared."""
    at(lit, "ahead")
    return lit


def left(page, *rules):
    """Return the faults of a page that has come to rest: colours fade in for a moment."""
    found = []

    def none():
        found[:] = faults(page, *rules)
        return not found

    with suppress(AssertionError):
        until(none, 5.0)
    return found


def is_text(page):
    """Hold a page to elements and addresses of our own; tell whether it shows what does harm."""
    assert page.evaluate("window.hit") is None
    assert page.locator(f'[src*="{EVIL}"], [href*="{EVIL}"], [onerror]').count() == 0
    return page.get_by_text("onerror").count() > 0


def test_axe_finds_nothing_serious_nor_in_the_dark_and_what_does_harm_is_text_on_any_page(
    tab, address
):
    found, seen = [], 0
    tab.bring_to_front()
    for name in (DARK, *(other for other in menu.MENU if other != DARK)):
        at(tab, name)
        if EVERYTHING or name == DARK:
            in_scheme(tab, "dark")  # it began so
            found += left(tab, "color-contrast")
            in_scheme(tab, "light")
        found += left(tab)
        seen += is_text(tab)
        for shown in menu.MENU[name].pages[1:]:
            open_page(tab, texts.PAGES[shown])
            found += left(tab) if EVERYTHING else []
            seen += is_text(tab)
        if name == "ahead":  # for who comes next, by keys alone
            at(tab, name)
    assert found == []
    assert seen >= 2
    assert tab.complaints == []
    assert asked_of_the_world(tab, address) == []


def test_studies_have_nothing_serious_and_a_page_fetches_from_its_own_server_alone(
    page, address, kept
):
    page.goto(f"{address}/prior")
    page.wait_for_selector(IDLE, timeout=240_000)
    page.goto(f"{address}/study?{kept}")
    page.wait_for_selector(IDLE, timeout=240_000)
    assert left(page) == []
    is_text(page)
    assert page.complaints == []
    assert asked_of_the_world(page, address) == []
    # its own server, and of maps https only: if a picture of another were there, it would not come
    foreign = "fetch('http://a.example/').then(() => 'sent', () => 'refused')"
    refused = []
    page.on("console", lambda said: refused.append(said.text))
    assert page.evaluate(foreign) == "refused"
    assert any("Content Security Policy" in said for said in refused)


@contextmanager
def phone(page):
    """Let the window be a phone's for a while."""
    page.set_viewport_size({"width": 390, "height": 844})
    yield
    page.set_viewport_size({"width": 1400, "height": 1000})


def test_axe_finds_nothing_serious_on_a_phone(today):
    page = today
    with phone(page):
        rest(page)
        page.wait_for_selector(f"{NAVIGATION} [role=listitem]", state="attached")
        assert left(page) == []


def test_words_on_a_picture_of_the_ground_stand_on_a_ground_of_their_own(today):
    page = today
    still(page)
    bare = page.evaluate("""() => [...document.querySelectorAll("*")].flatMap((one) =>
      [...(one.shadowRoot?.querySelectorAll(".label:not([hidden]),.scale") ?? [])]
        .filter((label) => ["transparent", "rgba(0, 0, 0, 0)"].includes(getComputedStyle(label).backgroundColor))
        .map((label) => label.textContent))""")  # noqa: E501
    assert bare == []


def test_a_wait_of_over_a_second_is_said_in_words(today):
    app = "document.querySelector('[data-testid=stApp]')"
    state = f"{app}.dataset.testScriptState"
    said = f"(({{content, opacity}}) => [content, opacity])(getComputedStyle({app}, '::after'))"
    today.wait_for_function(f"() => {said}[0] === 'none'")
    # by the animation's own clock, as a browser without a screen draws no frame for seconds
    seen = today.evaluate(f"""() => {{
      {state} = "running";
      const wait = {app}.getAnimations({{subtree: true}})
        .find((one) => one.animationName === "said");
      wait.pause();
      return [0, 999, 1002].map((ms) => {{ wait.currentTime = ms; return {said}; }}); }}""")
    assert seen == [[f'"{texts.WORKING}"', opacity] for opacity in ("0", "0", "1")]
    assert today.evaluate(f"() => {{ {state} = 'notRunning'; return {said}[0]; }}") == "none"


def test_a_day_is_done_by_keys_alone(today):
    page = today
    # who comes by keys sees where they are in the menu
    tab_to(page, page.get_by_test_id("stTopNavLink").nth(2))
    assert page.evaluate("getComputedStyle(document.activeElement).outline").endswith("solid 3px")
    # hours
    said = page.locator("[data-testid=stMetricValue]").nth(1)
    before = said.inner_text()
    tab_to(page, page.get_by_role("slider", name=texts.HOURS))
    page.keyboard.press("ArrowLeft")
    change = page.locator(".st-key-change_setup button")
    change.wait_for()
    tab_to(page, change)
    page.keyboard.press("Enter")
    until(lambda: said.inner_text() != before, 120)
    rest(page)
    # why a plant is on the route
    tab_to(page, page.get_by_role("application"))
    said = page.locator(f"{MAP} [role=status]")
    for _ in range(20):  # the middle may lie between plants
        page.keyboard.press("Shift+ArrowDown")
        still(page)
        if "chance" in said.text_content():
            break
    page.keyboard.press("Enter")
    page.get_by_text(texts.HISTORY).first.wait_for()
    # the route, handed out
    press(page, texts.STEP_BUTTONS["send"])
    with page.expect_download() as file:
        press(page, "Download for GPS")
    assert b"<gpx" in file.value.path().read_bytes()[:300]
    tab_to(page, page.get_by_role("dialog").get_by_role("button", name="Close"))
    page.keyboard.press("Enter")
    page.get_by_role("dialog").wait_for(state="hidden")
    rest(page)
    # the day on paper
    with page.expect_download() as file:
        press(page, texts.STEP_BUTTONS["report"])
    assert file.value.path().read_bytes().startswith(b"%PDF")
    # a find
    press(page, texts.STEP_BUTTONS["record"])
    page.locator(".st-key-record_one button").wait_for()
    rest(page)
    for name, number in ((texts.HISTORY_ROW, "3"), (texts.HISTORY_PLANT, "4")):
        tab_to(page, page.get_by_role("spinbutton", name=name, exact=True))
        page.keyboard.type(number)
    radio = page.get_by_role("radio", name="found", exact=True)
    tab_to(page, page.get_by_role("radio", name="clean", exact=True).or_(radio))
    for _ in range(5):
        if radio.evaluate("(one) => one.matches(':focus')"):
            break
        page.keyboard.press("ArrowRight")
    page.keyboard.press("Space")
    press(page, texts.RECORD_BUTTON)
    page.get_by_text("1 recorded").wait_for()
    page.get_by_role("button", name="Undo", exact=True).first.wait_for()


def test_a_fraction_typed_with_a_comma_in_spanish_is_not_ten_times_as_much(ahead):
    page = ahead
    box = page.get_by_role("spinbutton", name=texts.INFESTED)
    for language, typed in (("es", "2.5"), ("en", "25")):
        # a map that is just shown says the page's language, too
        page.evaluate(
            """(spoken) => Object.defineProperty(document.documentElement, "lang",
          { get: () => spoken, set() {}, configurable: true })""",
            language,
        )
        box.press("Control+a")
        page.keyboard.type("2,5")
        assert box.input_value() == typed
    page.evaluate("() => { delete document.documentElement.lang; }")


def test_a_number_typed_just_before_a_page_is_turned_is_there_again(ahead):
    page = ahead
    box = page.get_by_role("spinbutton", name=texts.INFESTED)
    for way in ("click", "keys", "back"):
        typed = str(int(float(box.input_value())) + 7)
        box.press("Control+a")
        page.keyboard.type(typed)
        # what is typed reaches the server with the turn, not a moment before
        page.evaluate(HELD)
        if way == "back":
            page.go_back()
        else:
            link = page.get_by_role("link", name=texts.MENU["today"]).first
            link.click() if way == "click" else link.press("Enter")
        here = page.locator("a[aria-current=page]").filter(has_text=texts.MENU["today"])
        here.first.wait_for(state="attached")
        rest(page)
        open_item(page, texts.MENU["ahead"])
        assert box.input_value() == typed, way


def test_strategies_are_compared_and_a_plot_is_brought_by_keys_alone(today):
    page = today
    tab_to(page, page.get_by_role("link", name=texts.MENU["ahead"]).locator("visible=true"))
    page.keyboard.press("Enter")
    samplers = page.get_by_role("combobox", name=texts.STRATEGY_SAMPLERS)
    samplers.wait_for()
    rest(page)
    tab_to(page, samplers)
    page.keyboard.press("Backspace")  # takes the last of three away
    tags = page.locator("[data-testid=stMultiSelect]").first.locator("[data-tag]")
    until(lambda: tags.count() == 2, 120)
    page.keyboard.press("Escape")
    tab_to(page, page.get_by_role("spinbutton", name=texts.SEEDS))
    page.keyboard.press("Control+a")
    page.keyboard.type("500")
    page.keyboard.press("Enter")
    press(page, texts.RUN, exact=True)
    first = page.get_by_text(texts.VERDICT_ONE.split("**")[0])
    first.or_(page.get_by_text("95 % interval")).first.wait_for()
    press(page, texts.STOP, exact=True)
    page.get_by_role("button", name=texts.GO_ON).wait_for()
    done = page.get_by_text("of 1000 seasons simulated").inner_text()
    assert 2 <= int(done.split(" ")[0]) < 1000, "the page is usable meanwhile"
    # a shapefile to the first route: last here, since the tab then shows another plot
    tab_to(page, page.get_by_role("link", name=texts.MENU["plots"]).locator("visible=true"))
    page.keyboard.press("Enter")
    press(page, texts.WAYS_IN["file"])
    with page.expect_file_chooser() as chosen:
        press(page, "Upload")
    chosen.value.set_files(ROOT / "sample_data" / "paran_estate.zip")
    page.locator(".st-key-lead").get_by_text("Inspect ").first.wait_for()
    rest(page)


def press(page, name, *, exact=False):
    """Press a button by the keyboard."""
    button = page.get_by_role("button", name=name, exact=exact).locator("visible=true")
    button.first.wait_for()
    tab_to(page, button)
    button.first.press("Enter")  # a dialog that closes gives the keyboard back when it likes
