"""A thousand clicks by somebody who reads nothing: no page may fail.

The suite clicks 20 times; ``FIELDMON_MONKEY=1000`` clicks as often as it says (seeded alike, or
as ``FIELDMON_MONKEY_SEED`` says). Languages are among what is chosen. What was recorded must stay:
batches are taken back, never lost.
"""

import os
import random
from datetime import date

import numpy as np
import pytest
from rasterio.io import MemoryFile
from rasterio.transform import from_bounds

from app.state import chosen_language, menu
from app.words import texts
from app.words.language import LANGUAGES
from fieldmon.monitoring import Season
from tests.app.driving import PAGES, begun, go, opened

CLICKS = int(os.environ.get("FIELDMON_MONKEY", "20"))
SEED = int(os.environ.get("FIELDMON_MONKEY_SEED", "20261121"))
TAPS = {f"click scout_{name}" for name in ("clean", "found", "skip")}
# a comparison of 500 seasons or a table of the thesis takes minutes, as it should
SMALL = {"seeds": 3, "n_days": 5, "study_replicates": 3}
NASTY = [
    "",
    " ",
    "x",
    "35.1501,30.3601",
    "35,30 36,31 36,30",
    "../../x",
    "שדה",
    "<b>1</b>",
    "9" * 400,
]
RASTERS = {"missing_plants_file": 1.0, "risk_file": 0.1, "ground_file": 9.0}


def raster(value):
    """Return a raster about plot Gate as the bytes of a GeoTIFF; its western half is lower."""
    values = np.full((40, 40), value, np.float32)
    values[:, :20] = value / 4
    with MemoryFile() as memory:
        shape = {"width": 40, "height": 40, "count": 1, "dtype": "float32", "driver": "GTiff"}
        place = from_bounds(35.146, 30.348, 35.151, 30.351, 40, 40)
        with memory.open(**shape, crs="EPSG:4326", transform=place) as tif:
            tif.write(values[None])
        return memory.read()


FILES = {
    "plot_file": [("a.zip", b"no"), ("a.geojson", b"{}"), ("a.kml", b"<kml/>")],
    "record_file": [("a.csv", b"lon,lat,date\n35.15,30.36,2026-01-01\n"), ("a.csv", b"\xff\xfe")],
    "plant_file": [("a.csv", b"lon,lat\n35.15,30.36\n35.1501,30.36\n"), ("a.csv", b"")],
    "rows_file": [("r.geojson", b"{}"), ("r.csv", b"\xff")],
    "blocks_file": [("b.geojson", b"[]"), ("b.kml", b"<kml/>")],
    "findings_file": [("f.csv", b"row,plant,found\n1,1,yes\n"), ("f.geojson", b"[1]")],
    "treat": [("z.geojson", b"{}"), ("z.zip", b"no")],
    "thresholds_file": [("t.csv", b"pest,crop,threshold\nmites,dates,0.1\n"), ("t.csv", b"\xff")],
    "labels_file": [("l.csv", b"product,pest\nOil,mites\n"), ("l.csv", b"\xff")],
    "pest_file": [("p.toml", b"name = 'x'"), ("p.toml", b"\xff")],
    "weather_file": [("w.csv", b"date,tmin,tmax\n2026-11-01,10,25\n"), ("w.csv", b"\xff")],
    **{name: [("r.tif", raster(v)), ("r.tif", b"II*\0no")] for name, v in RASTERS.items()},
}
DRIVES = [("d.mcap", b"\x89MCAP0\r\n"), ("d.csv", b"stop,arrive\n1,6:00\n"), ("d.csv", b"")]


# what can be chosen, by key; other boxes are chosen from by place
CHOICES = {
    chosen_language.KEY: list(LANGUAGES),
    "who": [texts.ROBOT, texts.SCOUT],
    "one_result": [0, 1, 2],
    "strategy_samplers": list(texts.SAMPLERS),
    "compared": list(texts.SAMPLERS),
    **{menu.key(name): list(item.pages) for name, item in menu.MENU.items()},
}
DAYS = [date(2026, 11, 16), date(2026, 11, 17), date(2026, 12, 24), date(2026, 11, 20)]
NUMBERS = ("slider", "number_input")
KINDS = ("button", "selectbox", "multiselect", "toggle", "radio", "text_input", "date_input",
         "pills", "segmented_control", "file_uploader", "checkbox", *NUMBERS)  # fmt: skip


def widgets(app):
    found = [(kind, one) for kind in KINDS for one in getattr(app, kind)]
    return [(kind, one) for kind, one in found if not one.disabled]


def poke(rng, kind, widget):
    """Do something with a widget that a person could do; return what."""
    key = widget.key or widget.label
    if kind == "button":
        widget.click()
        return f"click {key}"
    if kind == "file_uploader":
        # a box takes only files of the kinds that it names, as in a browser
        value = rng.choice(FILES[widget.key.split(" ")[0]] if widget.key else DRIVES)
        widget.upload(*value)
        return f"upload {key} {value[0]}"
    if kind == "selectbox" and key not in CHOICES:
        place = rng.randrange(len(widget.options))
        widget.select_index(place)
        return f"choose {key} {widget.options[place]}"
    value = wanted(rng, kind, widget, key)
    widget.set_value(value)
    return f"{kind} {key} = {value!r}"


def wanted(rng, kind, widget, key):
    if kind in NUMBERS:
        return number(rng, widget, key)
    if kind in {"toggle", "checkbox"}:
        return rng.random() < 0.5
    if kind == "text_input":
        return rng.choice(NASTY)
    if kind == "date_input":
        return rng.choice(DAYS)
    # what is empty for each day has the day in its key
    some = CHOICES.get(key) or CHOICES.get(key.split(" ")[0])
    if some is None:
        return widget.value
    several = kind in {"pills", "multiselect"}
    return rng.sample(some, rng.randrange(4)) if several else rng.choice(some)


def number(rng, widget, key):
    if isinstance(widget.value, date):
        return widget.value
    low = 0 if widget.min is None else widget.min
    high = min(10**6 if widget.max is None else widget.max, SMALL.get(key, 10**6))
    step = widget.step or 1
    value = type(low)(low + step * rng.randrange(max(1, int((high - low) / step) + 1)))
    return (value, high) if isinstance(widget.value, (list, tuple)) else value


class Recorded:
    """What the seasons of a folder hold: nothing of it may go, and each tap adds to it."""

    def __init__(self, folder):
        self.folder, self.kept = folder, {}

    def check(self, *, tapped):
        now = {
            (path.name, batch.number): batch.rows
            for path in sorted(self.folder.glob("*.gpkg"))
            for batch in Season(path).batches()
        }
        assert now.items() >= self.kept.items(), "a record was lost"
        assert not tapped or len(now) > len(self.kept), "a tap was not recorded"
        self.kept = now


@pytest.mark.timeout(60 + 20 * CLICKS)
def test_random_clicks_raise_nothing_and_lose_no_record(seasons_folder, speaking):
    rng = random.Random(SEED)
    app = begun(opened())
    recorded, done = Recorded(seasons_folder), []
    for step in range(CLICKS):
        if rng.random() < 0.12:
            page = rng.choice(PAGES)
            done.append(f"go {page}")
            go(app, page)
        else:
            done.append(poke(rng, *rng.choice(widgets(app))))
            app.run()
        for box in app.selectbox:
            if box.key == chosen_language.KEY:
                speaking(box.value)  # the harness asks boxes for the names of what they hold
        assert not app.exception, "\n".join([*done[-12:], str(app.exception[0].message)])
        tapped = done[-1] in TAPS and not app.error
        if tapped or step % 10 == 0:
            recorded.check(tapped=tapped)
    recorded.check(tapped=False)
    assert len(set(done)) > min(CLICKS / 3, 200)
