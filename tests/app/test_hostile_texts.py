"""What stands in files is shown as text on every page: it runs nothing and leads nowhere.

On every page: see `words/test_languages`; in a browser: `test_accessible`.
"""

import re
from dataclasses import replace
from datetime import date

import numpy as np

from app.words import language, texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.records import Records
from fieldmon.monitoring import KeptMessage, MonitoringSettings, Season
from tests.monitoring.seasons import a_plot

EVIL = "evil.example"
NAMES = (
    '<img src="x" onerror="window.hit=1">',
    "<script>window.hit=1</script>",
    f"[open]( http://{EVIL}/a )",
    f"![seen](http://{EVIL}/b.png)",
    f"http://{EVIL}/c www.{EVIL} me@{EVIL}",
    f"[d]: http://{EVIL}/d\n\n![e][d] [f][d]",
    "a\u202egpj.exe",
    ":material/home: :red[hot] $x^2$ `code` **bold**",
)
EVERY = " ".join(NAMES)
#: what Markdown makes a link or a picture of, and what a browser makes a link of by itself
LEADS = re.compile(r"\]\(|\]\[|\]:|://|www\.|\w@\w", re.IGNORECASE)


def hostile_season(path, name=EVERY, **settings):
    """Keep a season in whose every text field stands what does harm where it is not text."""
    plot = a_plot()
    plot = replace(plot, field=replace(plot.field, name=name))
    on = np.datetime64("2026-11-16")
    records = Records.of(
        plot.grid.lonlat()[[3]], np.ones(1, np.int8), np.array([on]),
        species=np.array([name]), stage=np.array([name]),
    )  # fmt: skip
    said = [KeptMessage(name, "repaired", name, f"Something about {name}.", "--crs")]
    settings = MonitoringSettings(date(2026, 11, 16), **settings)
    season = Season.create(path, plot, records, settings, said)
    found = Inspections.of(
        np.arange(6), np.arange(6) % 2, on,
        who=np.array([name] * 6, object), notes=np.array([name] * 6, object),
    )  # fmt: skip
    season.record(found, name, name)
    # a product may have 2 000 letters; a longer one is refused
    season.treat(date(2026, 11, 16), 0.5, product=name[:2000])
    return season


def harm_shown(app):
    """Hold all that a page says to be text; return how often it says what does harm."""
    kinds = ("markdown", "caption", "error", "warning", "info", "success", "subheader")
    said = [one.value for kind in kinds for one in getattr(app, kind) if EVIL in one.value]
    assert [text[:300] for text in said if LEADS.search(text)] == []
    return len(said)


def test_no_name_becomes_a_link_or_a_picture_and_all_of_it_can_be_read():
    for name in NAMES:
        for shown in (texts.isolated(name), language.in_words(f"Something about {name}.")):
            assert not LEADS.search(shown), shown
            assert set(re.findall(r"\w", name)) <= set(shown)
    assert "\u202e" not in texts.isolated(NAMES[6])
    assert language.in_words("Give a number (1 to 5).") == "Give a number (1 to 5)."
