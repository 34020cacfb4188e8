"""What is assumed is marked at the figures that rest on it, and changed there."""

import numpy as np

from app.words import texts
from fieldmon.infestation.inspections import Inspections
from tests.app.driving import go, metric, press, square, texts_of, upload, zipped


def starred(app):
    return {one.label.removesuffix(" *") for one in app.metric if one.label.endswith(" *")}


def test_a_plot_laid_at_the_usual_spacings_says_so_beside_its_figures(app, tmp_path):
    upload(app, plot=("plot.zip", zipped(tmp_path, square())))
    assert {"Plants", "Rows / plants apart"} <= starred(app)
    go(app, "today")
    assert "assumed: rows 4 m apart, plants 3 m apart, the rows " in texts_of(app)
    assert "° from north, 1 % of plants infested" in texts_of(app)
    assert {texts.PLANTS_TO_INSPECT, texts.FINDS} <= starred(app)
    before = metric(app, texts.PLANTS_TO_INSPECT)
    for box, value in ((texts.ROW_SPACING, 6.0), (texts.PLANT_SPACING, 5.0)):
        label = box.format(unit="m")
        next(one for one in app.number_input if one.label == label).set_value(value).run()
    assert not app.exception
    assert metric(app, texts.PLANTS_TO_INSPECT) != before
    assert texts.PLANTS_TO_INSPECT not in starred(app)
    assert "rows 4 m apart" not in texts_of(app)
    go(app, "plot")
    assert metric(app, "Rows / plants apart") == "6.0 m / 5.0 m"
    assert "Rows / plants apart" not in starred(app)


def test_the_background_chance_is_changed_where_the_finds_are_expected(app):
    before = float(metric(app, texts.FINDS))
    app.number_input(key="background_pct").set_value(5.0).run()
    assert not app.exception
    assert float(metric(app, texts.FINDS)) > before
    assert "where nothing is known" not in texts_of(app)


def test_a_season_keeps_what_was_assumed_and_is_told_otherwise(season_app, season):
    assert [one.setting for one in season().assumed()] == [
        *(one.setting for one in season().plot.assumed),
        "background_chance", "speed_m_s", "row_change_s", "stop_s", "detects", "rate_per_day",
        "treated",
    ]  # fmt: skip
    go(season_app, "season")
    before = metric(season_app, texts.EXPECTED_LEFT)
    assert texts.EXPECTED_LEFT in starred(season_app)
    season_app.number_input(key="season_background").set_value(4.0)
    season_app.number_input(key="season_spread").set_value(5.0)
    press(season_app, texts.ASSUMED_USE)
    assert not season_app.exception
    assert metric(season_app, texts.EXPECTED_LEFT) != before
    assert season().settings.prior.background_chance == 0.04
    assert season().settings.belief.spread.rate_per_day == 0.05
    assert season().verify() == ()
    assert "of plants infested where nothing is known" not in texts_of(season_app)


def test_whether_finds_are_treated_is_assumed_and_told_otherwise(season_app, season):
    day = np.datetime64(season().settings.begins)
    season().record(Inspections.of(np.arange(9), np.arange(9) % 2, day))
    go(season_app, "season")
    assert "plants found infested are treated at once" in texts_of(season_app)
    season_app.radio(key="season_finds").set_value(False)
    press(season_app, texts.ASSUMED_USE)
    assert not season_app.exception
    assert not season().settings.belief.treated
    assert "treated" not in {one.setting for one in season().assumed()}
    assert "plants found infested are treated at once" not in texts_of(season_app)
    assert "plants are expected to be still infested" in season_app.success[0].value
    press(season_app, "Take back")
    said = season_app.success[0].value
    assert "finds only flagged (now treated at once again)" in said
    assert "before this change it was" in said
    assert season().settings.belief.treated
