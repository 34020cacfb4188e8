"""Driving the app without a browser."""

import json
import sqlite3
import time
import zipfile
from contextlib import closing
from io import BytesIO

import geopandas as gpd
from rasterio.io import MemoryFile
from rasterio.transform import from_bounds
from shapely import MultiPolygon, box
from streamlit.testing.v1 import AppTest
from streamlit.util import calc_hash

from app.state import menu, plot_source
from app.state.map_store import STORE
from app.words import texts
from tests.app.shown_plants import shown_plants
from tests.monitoring.seasons import a_season
from tests.paths import ROOT

ESTATE = ROOT / "sample_data"
SQUARE = MultiPolygon([box(35.15, 30.36, 35.1506, 30.3606)])
#: how long a run of a page may take where other programs have the machine's processors
PATIENCE_S = 400
PAGES = tuple(page for item in menu.MENU.values() for page in item.pages)


def until(is_so, within_s=180.0, every_s=0.02):
    """Wait for a state that another thread or the browser brings about."""
    end = time.monotonic() + within_s
    while not is_so():
        assert time.monotonic() < end, "it did not come about in time"
        time.sleep(every_s)


class Session(AppTest):
    """A session that begins once it is looked at: until then `go` can say where."""

    has_begun = True

    def __init__(self, address):
        super().__init__(ROOT / "app" / "streamlit_app.py", default_timeout=PATIENCE_S)
        self.query_params = address
        self.has_begun = False

    def __getattribute__(self, name):
        if name in {"_tree", "session_state", "query_params"} and not self.has_begun:
            self.has_begun = True
            self.run()
        return super().__getattribute__(name)


def opened(season=None, **address):
    """Return a new session of the app, with a season open if one is named."""
    return Session(({} if season is None else {"season": season}) | address)


def word_of(app):
    """Return the word in the address that leads back to what a session brought."""
    word = app.query_params["files"]
    return word[0] if isinstance(word, list) else word


def go(app, page, **address):
    """Turn to a page by its address: it says nothing else, the next run is its own.

    A session that nobody has looked at begins there; its address may say more.
    """
    item = menu.item_of(page)
    app._page_hash = calc_hash("" if item == "today" else item)
    if app.has_begun:
        app.session_state[menu.key(item)] = page
        app.query_params.clear()
    app.has_begun = True
    app.query_params.update({menu.KEY: page} | address)
    return app.run()


def begun(app, name="Gate 2026"):
    """Begin a season on the plot that is open; rows that were assumed are right."""
    if not app.has_begun or not any(one.key == "do_begin" for one in app.button):
        go(app, "today")
    boxed(app.text_input, "season_name").set_value(name)
    press(app, "Begin the season")
    asked = any(button.key == "begin_right" for button in app.button)
    return press(app, texts.BEGIN_RIGHT) if asked else app


def press(app, label):
    """Press the button with this label."""
    next(button for button in app.button if apart(button.label) == label).click()
    return app.run()


def map_of(app):
    """Return what the map's component is sent, with each layer's JSON in its place."""
    named = (one.proto for one in app.get("bidi_component"))
    (sent,) = (one for one in named if one.component_name == "fieldmon_map")
    data = json.loads(sent.bytes)
    data["layers"] = [{**one, **json.loads(fetched(one["url"]))} for one in data["layers"]]
    return data


def fetched(address):
    """Return the bytes that the server has under an address."""
    return STORE.get(address)[1]


def row_box(app, name):
    """Return the box in which a plot's rows are set by hand."""
    return next(one for one in app.number_input if one.key.startswith(name))


def boxed(boxes, name):
    """Return the box of this name, of those of a kind, in a form that is empty for each day."""
    return next(one for one in boxes if one.key and one.key.startswith(f"{name} "))


def layer(app, name):
    """Return a layer as the browser gets it, or None."""
    return next((one for one in map_of(app)["layers"] if one["id"] == name), None)


def plants(app, name="plants-chance"):
    """Return the plants on the map, in one of their shades."""
    sent = layer(app, name)
    arrays = {kind: fetched(sent[kind]) for kind in ("places", "ranks", "values") if kind in sent}
    return shown_plants(arrays, sent["table"])


def metric(app, label):
    found = next(m.value for m in app.metric if apart(m.label).removesuffix(" *") == label)
    return apart(found)


def apart(text):
    """Return a text with plain spaces where numbers and their units stay on one line."""
    return text.replace("\u00a0", " ")


def plot_name(app):
    """Return what the map calls the plot."""
    return map_of(app)["alt"].removeprefix("Map of plot ").split(". Plants: ")[0]


def heading(app):
    """Return which plot and which day the page is about."""
    day = next(box.value for box in app.date_input if box.key.startswith("day "))
    return f"{plot_name(app)} · {day}"


def headline(app):
    """Return the sentence at the top of Today: what there is to do."""
    leads = ("Inspect ", "Nothing to inspect", "Done on ")
    (said,) = (text.value for text in app.markdown if text.value.startswith(leads))
    return apart(said)


def texts_of(app):
    """Return everything the page says."""
    parts = [*app.markdown, *app.caption, *app.error, *app.warning, *app.success, *app.info]
    return apart("\n".join(part.value for part in parts))


def upload(app, **files):
    """Bring files to the page of plots."""
    if app.has_begun:
        app.selectbox(key=plot_source.KEY).set_value(plot_source.FILES).run()
        go(app, "plot")
    else:
        go(app, "plot", **{plot_source.KEY: plot_source.FILES})
    for key, data in files.items():
        # another box, once what was in it was taken out
        box = next(one for one in app.file_uploader if one.key.split()[0] == f"{key}_file")
        box.upload(*data)
    return app.run()


def zipped(folder, plots, name="plot", without=""):
    """Return plots as the bytes of a zipped shapefile."""
    plots.to_file(folder / f"{name}.shp")
    data = BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for part in folder.glob(f"{name}.*"):
            if part.suffix != without:
                archive.write(part, part.name)
    return data.getvalue()


def tap(app, key):
    """Press the button with this key; it must work."""
    app.button(key=key).click().run()
    assert not app.exception
    assert not app.error


def geotiff(values, edges=(35.1, 30.3, 35.2, 30.4)):
    """Return a raster ``(h, w)`` over the sample estate as the bytes of a GeoTIFF."""
    high, wide = values.shape
    with MemoryFile() as memory:
        shape = {"width": wide, "height": high, "count": 1, "dtype": values.dtype}
        place = from_bounds(*edges, wide, high)
        with memory.open(**shape, driver="GTiff", crs="EPSG:4326", transform=place) as raster:
            raster.write(values[None])
        return memory.read()


def broken(path):
    """Leave a season that a later fieldmon wrote, as far as its file says."""
    a_season(path)
    with closing(sqlite3.connect(path)) as file:
        file.execute("UPDATE fieldmon SET value = '99' WHERE key = 'version'")
        file.commit()


def square(size=0.001, name="square"):
    shape = box(35.15, 30.36, 35.15 + size, 30.36 + size)
    return gpd.GeoDataFrame([{"name": name, "geometry": shape}], crs="EPSG:4326")
