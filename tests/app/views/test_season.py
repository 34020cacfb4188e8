"""The page of a season."""

from app.words import texts
from tests.app.driving import begun, go, metric, texts_of


def test_without_a_season_one_can_be_begun(app):
    go(app, "season")
    assert not app.exception
    assert texts.NEEDS_SEASON in texts_of(app)
    assert app.text_input(key="season_name")


def test_a_season_just_begun_has_found_nothing_and_says_what_is_expected(app):
    begun(app)
    go(app, "season")
    assert not app.exception
    assert metric(app, texts.FOUND_EVER) == "0"
    assert metric(app, texts.INSPECTED_EVER).startswith("0 / ")
    low, high = metric(app, texts.EXPECTED_LEFT).split("(")[1].rstrip(")").split("-")
    assert 0 <= int(low) < int(high)
