"""What is shown of advice: a row a zone, an outline a zone on the map, each with its number."""

from types import SimpleNamespace

import numpy as np
import pytest

from app.show import advice as shown
from app.show.map_view import MapContent
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.compute.units import Units
from fieldmon.compute.wording import share_figure
from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.io.spray_rate import litres_figure
from fieldmon.monitoring.advice.advice import advice
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.reports import words
from fieldmon.reports.advice import _figures
from tests.app.driving import apart

GRID = rectangle(12, 30, Planting(90.0, 4.0, 2.0))


@pytest.fixture(scope="module")
def made():
    chance = np.full(len(GRID), 1e-4)
    chance[[31, 32, 33, 34, 200, 201, 202, 203]] = 0.9
    belief = PairApproximation.of(GRID, chance)
    costs = TreatmentCosts(per_ha=50.0, per_zone=0.1)
    return advice(GRID, belief, AdviceSettings(0.05, sprayer=Sprayer(1), costs=costs))


def test_each_zone_has_a_row_with_its_place_and_how_often_it_is_wrong(made):
    table = shown.table(made)
    assert table[texts.DECIDE_ZONE].tolist() == [1, 2]
    assert table[texts.DECIDE_ROWS].tolist() == ["2", "7"]
    assert table[texts.DECIDE_PLANTS].tolist() == ["2-5", "21-24"]
    assert set(table[texts.DECIDE_ITSELF]) == {"treat"}
    assert set(table[texts.DECIDE_WRONG]) == {"under 1\u00a0%"}


def test_each_zone_is_outlined_and_numbered_on_the_map(made):
    tint, edge = shown._layers(made, dark=False)
    assert (tint.id, edge.id) == ("zones", "zones-edge")
    assert len(edge.data) == 2
    numbers = shown._numbers(made)
    assert [(one["t"], one["k"]) for one in numbers] == [("1", "zone"), ("2", "zone")]
    for number, zone in zip(numbers, edge.data, strict=True):
        corners = np.array(zone["p"])
        assert (corners.min(axis=0) <= number["p"]).all()
        assert (corners.max(axis=0) >= number["p"]).all()


def test_the_map_has_the_zones_of_its_own_advice_though_results_came_before_it(made, monkeypatch):
    bare = MapContent("here", [0, 0, 1, 1], "a map", [])
    monkeypatch.setattr(shown.map_layers, "day_map", lambda *_, **__: bare)
    # the advice of before, then the one of now, at one revision of the file
    choices = SimpleNamespace(key="test zones", revision="2", day="2026-11-16", dark=False)
    assert len(shown.zone_map(choices, made).labels) == 2
    now = advice(GRID, PairApproximation.of(GRID, np.full(len(GRID), 1e-4)), made.asked)
    assert shown.zone_map(choices, now).layers == []


def test_a_share_and_litres_are_said_as_in_the_sentence_and_on_paper(made, monkeypatch):
    said = {}
    monkeypatch.setattr(shown.st, "metric", lambda label, value, **_: said.update({label: value}))
    choices = SimpleNamespace(units=UnitsInLanguage())
    monkeypatch.setattr(shown.assumptions, "of", lambda _: ())
    shown.figures(choices, made, "")
    of_plot = share_figure(made.zones.m2 / made.zones.plot_m2)
    assert apart(of_plot) in apart(made.headline(choices.units))
    assert apart(said[texts.DECIDE_AREA]).endswith(f"({of_plot})")
    liquid = f"{litres_figure(made.litres)} l"
    assert apart(said[texts.DECIDE_LIQUID]) == liquid
    on_paper = {one.label: one for one in _figures(made, "", Units()).figures}
    assert on_paper[words.AREA_SPRAYED].note.startswith(of_plot)
    assert on_paper[words.LIQUID].value == liquid
