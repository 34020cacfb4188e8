"""The page Decide: the answer in one sentence at its top, and what follows from it."""

import shutil

import numpy as np
import pytest

from app.state import deciding
from app.words import texts
from fieldmon.decisions.labels import ProductLabel
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.estimates.treatment_effect import learnt_efficacy
from tests.app.driving import go, map_of, metric, opened, texts_of


@pytest.fixture
def recorded(season_app, season):
    """Return the app on a season in which a corner was found infested."""
    of = season()
    near = of.plot.grid.xy_m - of.plot.grid.xy_m.min(axis=0)
    plants = np.flatnonzero((near < 40).all(axis=1))[::2]
    found = (near[plants] < 14).all(axis=1)
    of.record(Inspections.of(plants, found.astype(int), np.datetime64("2026-11-16")), "day")
    for name, value in (("works", 60.0), ("per_ha", 1.0), ("per_zone", 0.0)):
        season_app.session_state[f"decide {name}"] = value
    return season_app


def test_without_a_season_it_says_what_it_needs(app):
    go(app, "decide")
    assert not app.exception
    assert texts.DECIDE_NEEDS_SEASON in texts_of(app)


def test_the_answer_stands_at_the_top_and_the_zones_on_the_map(recorded):
    recorded.session_state["decide per_zone"] = 1.0
    go(recorded, "decide")
    assert not recorded.exception
    said = texts_of(recorded)
    assert said.startswith("**Treat the whole plot")
    assert "Treating pays if it is 5.0 % or more" in said.split("\n")[1]
    assert said.split("\n")[1].endswith(" *"), "it rests on what is assumed, said below"
    ids = {layer["id"] for layer in map_of(recorded)["layers"]}
    assert {"zones", "zones-edge"} <= ids
    assert metric(recorded, texts.DECIDE_ENOUGH).endswith("%")


def test_costs_are_of_the_area_in_which_the_plot_is_said_and_the_answer_follows(recorded):
    go(recorded, "decide")
    area = metric(recorded, texts.DECIDE_AREA)
    assert "to treat 1 ha costs 1, a zone" in texts_of(recorded)
    recorded.selectbox(key="area").set_value("dunam").run()
    assert not recorded.exception
    assert "to treat 1 dunam costs 0.1, a zone" in texts_of(recorded)
    box = recorded.number_input(key="decide per_ha")
    assert (box.label, box.value) == ("1 dunam: product, water, work", 0.1)
    assert recorded.number_input(key="decide rate").value == 30.0
    now = metric(recorded, texts.DECIDE_AREA)
    assert now.split()[1] == "dunam"
    # the same share of the plot
    assert now.split()[2:] == area.split()[2:]
    box.set_value(0.0).run()
    assert not recorded.exception
    before = metric(recorded, texts.DECIDE_AREA)
    assert "(100 %)" in before
    recorded.number_input(key="decide reserve").set_value(50.0).run()
    assert metric(recorded, texts.DECIDE_AREA) != before
    recorded.number_input(key="decide level").set_value(0.1).run()
    assert "Treat" in texts_of(recorded)
    assert not recorded.exception


def test_how_well_treating_works_is_as_learnt_until_somebody_says(
    begun_file, seasons_folder, season
):
    shutil.copy(begun_file, seasons_folder)
    of, plants = season(), np.arange(60)
    for day, result in (("2026-11-16", 1), ("2026-11-17", 1)):
        of.record(Inspections.of(plants, np.full(60, result), np.datetime64(day)), day)
        if day == "2026-11-16":
            of.treat(np.datetime64(day).item(), 0.6, product="soap")
    told = learnt_efficacy(of.effects(np.datetime64("2026-11-17").item()))
    assert told.efficacy < 0.1
    app = opened("Gate 2026", day="2026-11-17")
    go(app, "decide")
    box = app.number_input(key="decide works")
    assert (box.value, box.placeholder) == (None, f"{100 * told.efficacy:.3g}")
    learnt = "As this season learnt of soap: treating cleans 4 %."
    assert learnt in texts_of(app)
    box.set_value(70.0).run()
    assert not app.exception
    assert learnt not in texts_of(app)
    assert "As you said: treating cleans 70 %" in texts_of(app)
    box.set_value(1.0).run()
    assert "1 was given, which is hardly any. Give 100 for 100 %" in texts_of(app)


def test_what_a_label_says_of_what_is_to_be_sprayed_is_told_before_it_is(
    begun_file, seasons_folder, season
):
    shutil.copy(begun_file, seasons_folder)
    of, day = season(), "2026-11-16"
    of.keep_labels([ProductLabel("soap", max_uses=1, waiting_days=0)])
    of.treat(np.datetime64(day).item(), 0.6, product="soap")
    app = opened("Gate 2026", day="2026-11-17")
    go(app, "decide")
    assert "Use 2 in this season" not in texts_of(app)
    app.text_input(key=deciding.PRODUCT).set_value("Soap").run()
    assert not app.exception
    assert "Use 2 in this season on" in texts_of(app)
    assert "Its label allows 1." in texts_of(app)
