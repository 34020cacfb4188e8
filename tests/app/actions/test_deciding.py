"""What can be done on the page Decide: leaves, and the files."""

import re
from contextlib import nullcontext
from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from app.actions import deciding as acting
from app.words import texts
from fieldmon.decisions.thresholds import published
from fieldmon.infestation.inspections import FOUND, Inspections
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.io.writers.treatment_map import MAP_FORMATS
from fieldmon.monitoring.estimates.last_days import default_date
from tests.app.chosen import a_plot, chosen
from tests.app.driving import boxed, go, press, texts_of


def test_every_file_that_the_library_writes_is_offered_by_name():
    assert {ending[1:] for ending in acting._ENDINGS} == {ending[1:] for ending in MAP_FORMATS}
    assert set(texts.DECIDE_FILES) == {ending[1:] for ending in MAP_FORMATS}
    assert set(texts.DECIDE_THRESHOLDS) == {one.name for one in published()}


def test_leaves_that_were_counted_have_a_verdict_with_its_source(season_app):
    go(season_app, "decide")
    season_app.number_input(key="decide leaves").set_value(40).run()
    season_app.number_input(key="decide counted").set_value(20).run()
    assert not season_app.exception
    assert re.search(r"40 leaves, 20 counted: treat", texts_of(season_app))
    assert "Zalom" in texts_of(season_app)
    season_app.number_input(key="decide counted").set_value(50).run()
    assert "No more leaves can be infested" in season_app.warning[0].value


def test_of_a_threshold_for_another_pest_than_the_season_s_it_is_said(season_app, season):
    before = season().settings
    season().change(replace(before, pest=shipped_pest("whitefly")), before)
    go(season_app, "decide")
    assert "'almond' is for" in season_app.warning[0].value
    table = b"name,measure,level,source,pest\ntomato,share of plants,0.2,our adviser,whitefly\n"
    season_app.file_uploader(key="thresholds_file").upload("own.csv", table, "text/csv").run()
    press(season_app, texts.DECIDE_OWN_TAKE)
    box = season_app.selectbox(key="decide leaves of")
    assert (box.value, box.options[0]) == ("tomato", "tomato")
    assert not season_app.warning


def test_thresholds_of_ones_own_are_brought_and_the_answer_takes_them(season_app):
    table = b"name,measure,level,source\ntomato,share of plants,0.2,our adviser\n"
    go(season_app, "decide")
    season_app.file_uploader(key="thresholds_file").upload("own.csv", table, "text/csv").run()
    press(season_app, texts.DECIDE_OWN_TAKE)
    assert "1 threshold can be chosen" in season_app.success[0].value
    assert season_app.selectbox(key="decide leaves of").value == "tomato"
    assert "our adviser" in texts_of(season_app)
    press(season_app, "Treat once 20.0 % of the plants are infested")
    assert season_app.number_input(key="decide level").value == 20.0
    assert "Treating pays if it is 20.0 % or more" in texts_of(season_app)
    wrong = b"name,measure,level,source\ntomato,mites,1,we\n"
    season_app.file_uploader(key="thresholds_file").set_value([]).run()
    season_app.file_uploader(key="thresholds_file").upload("bad.csv", wrong, "text/csv").run()
    press(season_app, texts.DECIDE_OWN_TAKE)
    assert "bad.csv, line 2" in season_app.error[0].value


def test_zones_noted_as_treated_are_those_on_the_page_whatever_another_session_found_since(
    season_app, season
):
    go(season_app, "decide")
    seen = season().advice(default_date(season())).sprayed
    assert 0 < seen.sum() < seen.size
    caption = next(one.value for one in season_app.caption if one.value.startswith("Noted are"))
    assert f"{seen.sum():,} plants" in caption
    far = np.flatnonzero(~seen)[[0, 40, 80]]
    season().record(Inspections.of(far, np.full(3, FOUND), np.datetime64("2026-11-16")))
    assert (season().advice(default_date(season())).sprayed != seen).any()
    boxed(season_app.number_input, "efficacy").set_value(80)
    press(season_app, texts.TREAT_BUTTON)
    assert not season_app.exception
    (one,) = season().treatments()
    assert one.place.plants.tolist() == seen.tolist()
    advised, treated = season().log()[-2:]
    assert (advised.kind, treated.kind) == ("advised", "treated")
    assert advised.what["date"] == str(one.on)


def test_of_plants_with_two_faces_each_is_counted_once(monkeypatch):
    plot, said = a_plot(faces=2), []
    zones = type("Zones", (), {"m2": 100.0, "__len__": lambda _: 1})()
    advice = SimpleNamespace(grid=plot.grid, zones=zones, sprayed=np.ones(len(plot.grid), bool))
    monkeypatch.setattr(acting.treating, "show", lambda *_: None)
    monkeypatch.setattr(acting, "st", SimpleNamespace(
        expander=lambda _: nullcontext(), caption=said.append,
    ))  # fmt: skip
    acting.treated(chosen(plot), advice)
    assert f": {len(plot.grid) // 2:,} plants" in said[0]


def test_cells_are_told_of_and_by_boxes_changed_since_the_page_was_drawn_nothing_is_noted(
    season_app, season
):
    go(season_app, "decide")
    assert "beside the zones" not in texts_of(season_app)
    season_app.selectbox(key="decide file").set_value(".tif").run()
    assert re.search(r"Cells of .* beside the zones and miss ", texts_of(season_app))
    season_app.number_input(key="decide ring").set_value(3)
    boxed(season_app.number_input, "efficacy").set_value(80)
    press(season_app, texts.TREAT_BUTTON)
    assert "was changed since these zones were drawn" in season_app.error[0].value
    assert season().treatments() == ()
