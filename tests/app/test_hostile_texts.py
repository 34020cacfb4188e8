"""What stands in files is shown as text on every page: it runs nothing and leads nowhere."""

import re
from dataclasses import replace
from datetime import date

import numpy as np

from app.state import menu
from app.words import language, texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.records import Records
from fieldmon.monitoring import KeptMessage, MonitoringSettings, Season
from tests.app.driving import PAGES, go, opened
from tests.app.map_in_browser import IDLE, asked_of_the_world, open_item, open_page, rest
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


def hostile_season(path, name=EVERY):
    """Keep a season in whose every text field stands what does harm where it is not text."""
    plot = a_plot()
    plot = replace(plot, field=replace(plot.field, name=name))
    on = np.datetime64("2026-11-16")
    records = Records.of(
        plot.grid.lonlat()[[3]], np.ones(1, np.int8), np.array([on]),
        species=np.array([name]), stage=np.array([name]),
    )  # fmt: skip
    said = [KeptMessage(name, "repaired", name, f"Something about {name}.", "--crs")]
    season = Season.create(path, plot, records, MonitoringSettings(date(2026, 11, 16)), said)
    found = Inspections.of(
        np.arange(6), np.arange(6) % 2, on,
        who=np.array([name] * 6, object), notes=np.array([name] * 6, object),
    )  # fmt: skip
    season.record(found, name, name)
    # a product may have 2 000 letters; a longer one is refused
    season.treat(date(2026, 11, 16), 0.5, product=name[:2000])
    return season


def test_no_name_becomes_a_link_or_a_picture_and_all_of_it_can_be_read():
    for name in NAMES:
        for shown in (texts.isolated(name), language.in_words(f"Something about {name}.")):
            assert not LEADS.search(shown), shown
            assert set(re.findall(r"\w", name)) <= set(shown)
    assert "\u202e" not in texts.isolated(NAMES[6])
    assert language.in_words("Give a number (1 to 5).") == "Give a number (1 to 5)."


def test_every_page_shows_such_a_season_as_text(seasons_folder):
    hostile_season(seasons_folder / "Harm.gpkg", f"{EVERY} {'x' * 10_000}")
    app = opened("Harm")
    shown = 0
    for page in PAGES:
        go(app, page)
        assert not app.exception, page
        for kind in ("markdown", "caption", "error", "warning", "info", "success", "subheader"):
            for element in getattr(app, kind):
                about = EVIL in element.value
                shown += about
                assert not (about and LEADS.search(element.value)), (page, element.value[:300])
    assert shown >= 3


def test_in_a_browser_nothing_runs_nothing_is_fetched_and_nothing_leads_out(
    page, address, served_seasons
):
    hostile_season(served_seasons / "Harm.gpkg")
    for name in ("study", "prior"):
        page.goto(f"{address}/{name}")
        page.wait_for_selector(IDLE, timeout=240_000)
    page.goto(f"{address}/?season=Harm")
    rest(page)
    seen = 0
    for name, item in menu.MENU.items():
        open_item(page, texts.MENU[name])
        for shown in ("", *item.pages[1:]):
            if shown:
                open_page(page, texts.PAGES[shown])
                page.wait_for_selector(IDLE, timeout=180_000)
            assert page.evaluate("window.hit") is None
            assert page.locator(f'[src*="{EVIL}"], [href*="{EVIL}"], [onerror]').count() == 0
            seen += page.get_by_text("onerror").count() > 0
    assert seen >= 2
    assert page.complaints == []
    assert asked_of_the_world(page, address) == []
    # and if a picture were there: the page fetches from its own server, and maps by https only
    foreign = "fetch('http://a.example/').then(() => 'sent', () => 'refused')"
    refused = []
    page.on("console", lambda said: refused.append(said.text))
    assert page.evaluate(foreign) == "refused"
    assert any("Content Security Policy" in said for said in refused)
