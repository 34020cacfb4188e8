"""Record: what was found is taken in, by what is open."""

from app.words import texts
from tests.app.driving import boxed, go, map_of, press, texts_of


def test_without_a_season_one_can_be_begun(app):
    go(app, "record")
    assert not app.exception
    assert texts.NEEDS_SEASON in texts_of(app)
    assert boxed(app.text_input, "season_name")


def test_what_was_recorded_shows_at_once_with_its_undo(season_app, season):
    go(season_app, "record")
    assert map_of(season_app)["shades"][0]["key"] == "state"
    assert not [one for one in season_app.button if one.label == "Undo"]
    assert not [one for one in season_app.expander if one.label == texts.BATCHES], "an empty box"
    boxed(season_app.number_input, "one_row").set_value(3)
    boxed(season_app.number_input, "one_plant").set_value(4)
    boxed(season_app.segmented_control, "one_result").set_value(1)
    season_app.button(key="record_one").click().run()
    assert len(season().history.inspections) == 1
    press(season_app, "Undo")
    assert len(season().history.inspections) == 0
    assert [one for one in season_app.expander if one.label == texts.BATCHES]
    assert texts.UNDONE in texts_of(season_app)
