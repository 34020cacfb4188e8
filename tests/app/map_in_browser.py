"""What a browser shows of the map: its pixels, where plants are in them, and its switches."""

import base64
import io
import json
import time
from contextlib import suppress
from pathlib import Path

import axe_playwright_python
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import TimeoutError as PlaywrightTimeout

from tests.app.driving import until

MAP = ".map"
#: axe-core, as its package brings it
AXE = Path(axe_playwright_python.__file__).with_name("axe.min.js")
# styles and media are not fetched again for it: no rule asks for them of which a fault is serious
_FAULTS = """async (runOnly) => {
  const found = await axe.run(document, { resultTypes: ["violations"], preload: false, ...(runOnly ? { runOnly } : {}) });
  return found.violations.filter((one) => ["serious", "critical"].includes(one.impact)).flatMap((one) =>
    one.nodes.map((node) => `${one.id}: ${node.html.slice(0, 120)} (${(node.any[0] ?? node.all[0])?.message})`));
}"""  # noqa: E501
#: the map with all that is wanted on it, while the server has nothing more to say
IDLE = "[data-testid=stApp][data-test-script-state=notRunning]"
DRAWN = f"{MAP}[data-shown]"
#: and nothing of it moves or is still to be drawn
RESTING = f"{DRAWN}[data-resting]"
# what lies on the map is not the map: from the first look on it cannot be seen, but still be used
_BARE = """() => {
  const roots = [document, ...[...document.querySelectorAll("*")].flatMap((one) => one.shadowRoot ?? [])];
  const fresh = roots.filter((root) => !root.querySelector("style.bare"));
  for (const root of fresh) {
    const style = Object.assign(document.createElement("style"), { className: "bare" });
    style.textContent = ".tools,.card,.legend,.foot,.labels,.tip,.drawbar,.st-key-panel,"
      + ".fieldmon-shape,[data-testid=stToastContainer]{opacity:0!important;transition:none!important}";
    (root.head ?? root).append(style);
  }
  const drawn = (done) => requestAnimationFrame(() => requestAnimationFrame(done));
  return fresh.length ? new Promise(drawn) : null;
}"""  # noqa: E501
_DRESSED = """() => [document, ...[...document.querySelectorAll("*")].flatMap((one) => one.shadowRoot ?? [])]
  .forEach((root) => root.querySelector("style.bare")?.remove())"""  # noqa: E501
# how far a map has come that is not drawn: its place, whether it was called, what it was to show
_COME = """() => [...document.querySelectorAll(".stBidiComponent")].map((one) => {
  const place = [...one.querySelectorAll("*")].map((each) => each.shadowRoot).find(Boolean);
  const map = place?.mapPage, wanted = map?.data?.layers?.length;
  return { place: Boolean(place), called: Boolean(place?.last), made: Boolean(map), turn: map?.turn, wanted };
})"""  # noqa: E501
_REST_MS = 180_000


def asked_of_the_world(page, address):
    """Return the addresses a tab asked that are not the app's own."""
    own = (address, address.replace("http", "ws"), "data:", "blob:", "about:")
    return [url for url in page.requests if not url.startswith(own)]


def rest(page):
    """Wait until the server has answered and a map is drawn."""
    try:
        page.wait_for_selector(DRAWN, timeout=240_000)  # compiled first
        page.wait_for_selector(IDLE, timeout=_REST_MS)
    except PlaywrightTimeout as late:
        come = page.evaluate(_COME)
        late.add_note(f"{page.url}: {come}: {page.locator('body').inner_text()[:2000]}")
        raise


def picture(page):
    """Return a picture of the window as a PNG.

    It takes a third of what Playwright's own does, which is packed as tightly as it can be.
    """
    if not hasattr(page, "devtools"):
        page.devtools = page.context.new_cdp_session(page)
    shot = page.devtools.send("Page.captureScreenshot", {"optimizeForSpeed": True})
    return base64.b64decode(shot["data"])


def look(page):
    """Return the map's pixels ``(h, w, 3)``, without what lies on it."""
    page.evaluate(_BARE)
    pixel = np.array(Image.open(io.BytesIO(picture(page))).convert("RGB"), np.int16)
    box = page.locator(MAP).bounding_box()
    x, y, width, height = (round(box[side]) for side in ("x", "y", "width", "height"))
    return pixel[max(y, 0) : y + height, max(x, 0) : x + width]


def dressed(page):
    """Let what lies on the map be seen again."""
    page.evaluate(_DRESSED)


def still(page):
    """Return the map's pixels once it rests."""
    for _ in range(100):
        rest(page)
        page.wait_for_selector(RESTING, timeout=_REST_MS)
        pixel = look(page)
        if np.ptp(pixel) > 0:
            return pixel
    pytest.fail("the map did not come to rest")


def becomes(page, as_wanted, what):
    """Return the map's pixels once they are as wanted."""
    pixel = still(page)
    end = time.monotonic() + 120.0
    while not as_wanted(pixel):
        assert time.monotonic() < end, f"{what} did not show as it should"
        page.wait_for_timeout(100)
        pixel = still(page)
    return pixel


def view(page):
    """Return what the map shows: longitude and latitude of its middle, zoom, width and height."""
    # the first picture is drawn a moment after the map has what it shows
    page.wait_for_selector(f"{MAP}[data-view]", timeout=_REST_MS)
    return json.loads(page.locator(MAP).get_attribute("data-view"))


def pixels(seen, lonlat):
    """Return where lon/lat positions ``(n, 2)`` are on the map's picture, by Web Mercator."""
    world = 512 * 2.0 ** seen["zoom"]

    def project(lon, lat):
        y = np.log(np.tan(np.pi / 4 + np.deg2rad(lat) / 2))
        return world * (lon + 180) / 360, world * (0.5 - y / (2 * np.pi))

    x0, y0 = project(seen["longitude"], seen["latitude"])
    x, y = project(*np.atleast_2d(np.asarray(lonlat, float)).T)
    return np.stack([x - x0 + seen["width"] / 2, y - y0 + seen["height"] / 2], axis=1)


def is_near(image, place, colour, reach=2, tolerance=40):
    """Tell whether a colour is within some pixels of a place."""
    x, y = np.round(place).astype(int)
    window = image[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1]
    if not window.size:
        return False
    return bool((np.abs(window - np.array(colour)).max(axis=2) < tolerance).any())


def share_near(image, places, colour, **more):
    """Return the share of places that have a colour near."""
    return float(np.mean([is_near(image, place, colour, **more) for place in places]))


# -- for everybody


def faults(page, *rules):
    """Return what axe-core finds serious or critical on a page, by these rules or by all."""
    if not page.evaluate("Boolean(window.axe)"):
        page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate(_FAULTS, {"type": "rule", "values": rules} if rules else None)
    return [f"{one} on {page.url}" for one in found]


def in_scheme(page, scheme):
    """Let the device be light or dark; wait until the page and its map are so."""
    page.emulate_media(color_scheme=scheme)
    dark = f"{MAP}.dark" if scheme == "dark" else f"{MAP}:not(.dark)"
    page.wait_for_selector(dark, state="attached", timeout=_REST_MS)
    rest(page)


def tab_to(page, target, most=120):
    """Press Tab until what is wanted has the keyboard."""
    for _ in range(most):
        if target.evaluate_all("([first]) => Boolean(first?.matches(':focus'))"):
            return
        page.keyboard.press("Tab")
    pytest.fail(f"{target} is not reached by {most} times Tab")


# -- what lies on the map


def card(page):
    """Open the card of the layers, if it is not open."""
    tool = page.get_by_role("button", name="Layers", exact=True)
    if tool.get_attribute("aria-expanded") != "true":
        tool.click()
    return page.locator(f"{MAP} .card")


def switch(page, name, *, on):
    """Switch a layer on or off."""
    card(page).get_by_role("checkbox", name=name, exact=True).set_checked(on)


def shade(page, name):
    """Shade plants by what is named so."""
    card(page).get_by_role("radio", name=name, exact=True).check()


def opacity(page, share):
    """Let plants be so opaque."""
    card(page).get_by_role("slider", name="Opacity").fill(f"{share}")


def zoomed(page):
    """Turn the wheel over the middle of the free map; return its pixels."""
    still(page)
    seen, (x, y) = view(page), free(page)
    for _ in range(50):
        page.mouse.move(x, y)
        before = view(page)
        page.mouse.wheel(0, -300)
        with suppress(AssertionError):  # a turn may be lost
            until(lambda was=before: view(page) != was, 5.0, every_s=0.05)
        if view(page)["zoom"] > seen["zoom"] + 1.0:
            return still(page)
    pytest.fail(f"the wheel does not zoom: {seen}")


def free(page):
    """Return the middle of what the panel leaves free of the map, in the window's pixels."""
    box, panel = page.locator(MAP).bounding_box(), page.locator(".st-key-panel").bounding_box()
    if panel["width"] > 0.9 * box["width"]:
        return box["width"] / 2, (box["y"] + panel["y"]) / 2
    return (panel["width"] + box["width"]) / 2, box["y"] + box["height"] / 2


def click(page, place, says=None):
    """Click on the map at a place in its own pixels; wait for what the page then says.

    The browser may be so busy that a press and its release are far apart: then, as a person would,
    click again.
    """
    box = page.locator(MAP).bounding_box()
    for _ in range(3):
        page.mouse.click(box["x"] + place[0], box["y"] + place[1])
        if says is None:
            return
        with suppress(PlaywrightTimeout):
            page.get_by_text(says).first.wait_for(timeout=20_000)
            return
    pytest.fail(f"three clicks, and the page does not say {says!r}")


def scale_px_of_m(page):
    """Return how many pixels a metre has by the scale bar on the map."""
    scale = page.get_by_role("img", name="The scale bar is")
    text = scale.locator(".text").inner_text().strip()
    metres = float(text.removesuffix("\u00a0m"))
    return scale.locator(".bar").bounding_box()["width"] / metres


# -- the menu


def open_item(page, name):
    """Turn to an item of the menu by its link, and wait until it is there."""
    page.get_by_role("link", name=name).first.click()
    here = page.locator("a[aria-current=page]").filter(has_text=name)
    here.first.wait_for(state="attached", timeout=_REST_MS)
    rest(page)


def open_page(page, name):
    """Show a page of that item."""
    box = page.get_by_role("radio", name=name, exact=True)
    box.click()
    box.and_(page.locator("[aria-checked=true]")).wait_for()
    rest(page)
