"""A thousand clicks by somebody who reads nothing: no page may fail.

The suite clicks 120 times; ``FIELDMON_MONKEY=1000`` clicks as often as it says (seeded alike).
"""

import os
import random

import pytest
from app_driving import PAGES, begun, go, opened

CLICKS = int(os.environ.get("FIELDMON_MONKEY", "120"))
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
FILES = {
    "plot_file": [("a.zip", b"no"), ("a.geojson", b"{}"), ("a.kml", b"<kml/>")],
    "record_file": [("a.csv", b"lon,lat,date\n35.15,30.36,2026-01-01\n"), ("a.csv", b"\xff\xfe")],
    "plant_file": [("a.csv", b"lon,lat\n35.15,30.36\n35.1501,30.36\n"), ("a.csv", b"")],
    "findings_file": [("f.csv", b"row,plant,found\n1,1,yes\n"), ("f.geojson", b"[1]")],
}


def widgets(app):
    kinds = ["button", "selectbox", "multiselect", "slider", "number_input", "toggle", "radio",
             "text_input", "date_input", "button_group", "file_uploader", "checkbox"]  # fmt: skip
    found = [(kind, one) for kind in kinds for one in getattr(app, kind, [])]
    return [(kind, one) for kind, one in found if not getattr(one, "disabled", False)]


def poke(rng, kind, widget):
    """Do something with a widget that a person could do; return what."""
    key = getattr(widget, "key", None) or getattr(widget, "label", "?")
    if kind == "button":
        widget.click()
        return f"click {key}"
    if kind == "file_uploader":
        value = rng.choice(FILES[key])
        widget.upload(*value)
        return f"upload {key} {value[0]}"
    value = chosen(rng, kind, widget, key)
    if value is not None:
        widget.set_value(value)
    return f"{kind} {key} = {value!r}"


def chosen(rng, kind, widget, key):
    if kind in ("selectbox", "radio"):
        # options are shown as text, values are chosen by their place
        widget.select_index(rng.randrange(len(widget.options))) if kind == "selectbox" else None
        return rng.choice(widget.options) if kind == "radio" else None
    if kind in ("multiselect", "button_group"):
        return None
    if kind == "toggle" or kind == "checkbox":
        return rng.random() < 0.5
    if kind == "text_input":
        return rng.choice(NASTY)
    if kind == "date_input":
        return None
    low = widget.min if widget.min is not None else 0
    high = min(widget.max if widget.max is not None else 10**6, SMALL.get(key, 10**6))
    step = widget.step or 1
    value = low + step * rng.randrange(max(1, int((high - low) / step) + 1))
    if isinstance(widget.value, (list, tuple)):
        return (value, high)
    return type(widget.value or 1.0)(value)


@pytest.mark.timeout(60 + 10 * CLICKS)
def test_random_clicks_raise_nothing():
    rng = random.Random(20261121)
    app = begun(opened())
    done = []
    for _ in range(CLICKS):
        if rng.random() < 0.12:
            page = rng.choice(PAGES)
            done.append(f"go {page}")
            go(app, page)
        else:
            done.append(poke(rng, *rng.choice(widgets(app))))
            app.run()
        assert not app.exception, "\n".join([*done[-12:], str(app.exception[0].message)])
    assert len(set(done)) > CLICKS / 3
