"""A photo is asked for on the map, the route leads by, and it is there once it has come."""

import base64

from app.words import texts
from fieldmon.monitoring.phones import findings, photos, scouts
from fieldmon.monitoring.phones.photos_asked import photos_asked
from tests.app.actions.test_picking import select, stops
from tests.app.driving import press, texts_of
from tests.monitoring.phone import JPEG, NOW, a_finding

# the first of row 16 of the season: beyond what a day reaches
PLANT = 15 * 50


def asked(season):
    return [(one.plant, one.note) for one in photos_asked(season())]


def test_a_photo_of_a_picked_plant_is_asked_for_and_taken_back(season_app, season):
    before = stops(season_app)
    select(season_app, [PLANT], season().plot)
    season_app.text_input(key="ask_photo_note").set_value("webs?").run()
    press(season_app, texts.ASK_PHOTO_BUTTON.format(plants=texts.PLANTS_COUNTED.format(n=1)))
    assert asked(season) == [(PLANT, "webs?")]
    assert (16, 1) in set(zip(stops(season_app)["row"], stops(season_app)["plant"], strict=True))
    assert "Row 16, plant 1." in texts_of(season_app)
    press(season_app, texts.ASK_NO_MORE)
    assert asked(season) == []
    assert stops(season_app).equals(before)


def test_a_photo_that_has_come_is_shown_with_its_plant_though_it_does_not_open(season_app, season):
    key, one = scouts.let_in(season(), "Ann"), a_finding(PLANT, on=season().settings.begins)
    findings.take(season(), key, [one], NOW)
    photos.keep(season(), key, photos.Photo("one", one.id, JPEG, NOW))
    season_app.session_state["history row"], season_app.session_state["history plant"] = 16, 1
    season_app.session_state["history tapped"] = True
    season_app.run()
    assert not season_app.exception
    sent = f"data:image/jpeg;base64,{base64.b64encode(JPEG).decode()}"
    shown = [one.value for one in season_app.get("html") if "<figure" in one.value]
    assert len(shown) == 1
    assert sent in shown[0]
    assert "Ann" in shown[0]


def test_without_a_season_nothing_is_asked_for(app):
    select(app, [PLANT])
    assert [one for one in app.button if one.key == "ask_photo"] == []
