"""A planned day is driven by a simulated robot."""

from app.words import texts
from tests.app.driving import fetched, go, map_of, press, until


def test_a_planned_day_is_driven_and_handed_to_the_map_and_nothing_is_recorded(season_app, season):
    before = season().revision
    app = go(season_app, "drive")
    assert not app.exception
    assert map_of(app)["drive"] is None
    press(app, texts.DRIVE_RUN)
    until(lambda: map_of(app.run())["drive"] is not None, every_s=0.5)
    assert b'"stops":[[' in fetched(map_of(app)["drive"])
    assert any(one.value == texts.DRIVE_MADE_UP for one in app.caption)
    assert season().revision == before
