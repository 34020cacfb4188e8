"""The frame: every page opens, whatever is chosen."""

import re
import subprocess
import sys
from datetime import date

from app.words import texts
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from tests.app.driving import PAGES, go, map_of, opened, press, texts_of
from tests.monitoring.seasons import a_small_plot
from tests.paths import ROOT


def idle_digits(app):
    """Return the boxes that write a whole number, or a half, with zeros behind it."""
    written = [(box.label, box.proto.format % number) for box in app.number_input
               for number in (box.value, 2.0, 2.5) if number is not None]  # fmt: skip
    return [one for one in written if re.search(r"\.\d*0$", one[1])]


def test_every_part_opens_on_the_sample_over_one_map_and_no_box_writes_digits_that_nobody_needs(
    app,
):
    boxes, place = set(), map_of(app)["place"]
    for page in PAGES:
        go(app, page)
        assert not app.exception, page
        assert not app.error, page
        assert texts_of(app), page
        ids = [one["id"] for one in map_of(app)["layers"]]
        assert ids, page
        if page != "plots":
            assert map_of(app)["place"] == place, page
            assert ids[:4] == ["headland", "rows-ground", "aisles", "boundary"], page
        assert idle_digits(app) == [], page
        boxes |= {box.label for box in app.number_input}
    assert len(boxes) > 10


def test_every_part_asks_for_a_plot_where_nothing_was_brought(app):
    app.selectbox(key="season").set_value(texts.UPLOAD).run()
    for page in PAGES:
        if page == "plots":
            continue
        go(app, page)
        assert not app.exception, page
        assert "Bring a plot" in texts_of(app), page
        assert app.file_uploader(key="plot_file"), page
        assert app.get("bidi_component") == [], page


def test_every_part_of_a_season_opens_marks_another_day_and_folds_away_who_inspects(
    seasons_folder,
):
    """On the season's first day all open in another language: see `words/test_languages.py`."""
    begins = MonitoringSettings(date(2026, 11, 16))
    Season.create(seasons_folder / "Gate 2026.gpkg", a_small_plot(), Records.none(), begins)
    app = opened("Gate 2026")
    app.date_input(key="day Gate 2026").set_value(date(2026, 11, 20)).run()
    for page in PAGES:
        go(app, page)
        assert not app.exception, page
        assert not app.error, page
        assert idle_digits(app) == [], page
        # unfolded where a day is planned
        who = [box for box in app.expander if box.label == texts.WHO]
        assert [box.proto.expanded for box in who] == [page == "today"] * len(who), page
        if page == "plots":
            continue  # each plot has a today of its own there
        assert "**Fri 20 Nov**" in app.warning[0].value, page
        assert "not today (Mon 16 Nov)" in app.warning[0].value
        records = page in {"today", "scout", "record", "decide"}
        assert ("is recorded for" in app.warning[0].value) == records, page
    assert "2026-11-20" in app.query_params["day"]
    press(app, texts.BACK_TO_TODAY)
    assert not app.warning
    assert app.date_input(key="day Gate 2026").value == date(2026, 11, 16)
    assert "day" not in app.query_params


def test_a_box_for_files_speaks_the_language_of_the_page():
    for code, upload in (("en", None), ("he", "להעלות קובץ"), ("es", "Subir archivo")):
        styles = "".join(one.proto.body for one in opened(texts.UPLOAD, lang=code).get("html"))
        assert ("--upload:" in styles) == (code != "en")
        assert upload is None or f'--upload:"{upload}"' in styles
        assert upload is None or "200 MB" in styles


def test_a_process_that_a_page_starts_runs_the_script_without_a_page():
    """As `multiprocessing` does, and Dask's workers."""
    start = "import multiprocessing.spawn as s; s._fixup_main_from_path({!r})"
    script = str(ROOT / "app" / "streamlit_app.py")
    done = subprocess.run(
        [sys.executable, "-c", start.format(script)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def noting(name):
    """Return a method of a list that notes what it is given."""

    def noted(self, *told):
        self.done.append((name, *told))
        return getattr(list, name)(self, *told)

    return noted


class NotedPath(list):
    """The path of modules, which notes what is done to it."""

    append, insert, remove = map(noting, ("append", "insert", "remove"))
    __setitem__ = noting("__setitem__")

    def __init__(self, folders):
        super().__init__(folders)
        self.done = []


def test_a_run_leaves_the_path_of_modules_alone_on_which_others_look_meanwhile(app, monkeypatch):
    """Two runs at once took folders off it for good, and pages failed until the server ended."""
    path = NotedPath(sys.path)
    monkeypatch.setattr(sys, "path", path)
    app.run()
    path.done.clear()
    app.run()
    assert path.done == []
