"""The page of a season."""

from datetime import date

import numpy as np

from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring.estimates import figures_of_day
from tests.app.driving import boxed, go, metric, texts_of


def test_without_a_season_one_can_be_begun(app):
    go(app, "season")
    assert not app.exception
    assert texts.NEEDS_SEASON in texts_of(app)
    assert boxed(app.text_input, "season_name")


def test_a_season_just_begun_has_found_nothing_and_says_what_is_expected(season_app):
    app = go(season_app, "season")
    assert not app.exception
    assert metric(app, texts.FOUND_EVER) == "0"
    assert metric(app, texts.INSPECTED_EVER).startswith("0 / ")
    assert metric(app, texts.DETECTED) == texts.NOT_KNOWN_YET
    assert 0.0 < float(metric(app, texts.CLEAN_CHANCE).split(" ")[0]) < 1.0
    interval = metric(app, texts.EXPECTED_LEFT).split("(")[1].rstrip(")").replace(",", "")
    low, high = map(int, interval.split("–"))
    assert 0 <= low < high
    assert len(app.get("vega_lite_chart")) == 2, "of what was not done there is no chart"


def test_the_season_says_why_days_sum_to_more_than_the_plants_found(season_app, season):
    for day in (0, 1):
        on = np.datetime64("2026-11-16") + day
        season().record(Inspections.of(np.arange(3), np.ones(3, int), on), f"day {day}")
    season_app.date_input(key="day Gate 2026").set_value(date(2026, 11, 17)).run()
    go(season_app, "season")
    assert "6 finds on 3 plants: 3 of them on plants that had been found" in texts_of(season_app)


def test_the_season_says_how_many_plants_are_only_flagged(season_app, season, monkeypatch):
    # of what was just recorded nothing is kept yet
    season().record(Inspections.of([3], [0], date(2026, 11, 16)), "file")
    monkeypatch.setattr(figures_of_day, "flagged", lambda *_: 20.0)
    go(season_app, "season")
    assert not season_app.exception
    assert "are not found yet, and 20 were found and only flagged." in texts_of(season_app)
