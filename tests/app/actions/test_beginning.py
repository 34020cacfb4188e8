"""A season begins, and is found again."""

from datetime import date

import pytest

from tests.app.driving import begun, headline, layer, opened, plants, plot_name, texts_of


def test_a_season_begins_and_is_found_again_by_a_new_session(season):
    app = opened()
    route = layer(app, "route")["data"]
    begun(app)
    assert layer(app, "route")["data"] == route
    assert "has begun" in app.success[0].value
    assert app.selectbox(key="season").value == "Gate 2026"
    assert season().settings.begins == date(2026, 11, 16)
    assert season().messages()
    again = opened("Gate 2026")
    assert plot_name(again) == "Gate"
    assert "on Mon 16 Nov, " in headline(again)
    assert "first day of the season" in texts_of(again)
    assert plants(again).rank.tolist() == plants(app).rank.tolist()
    assert plants(again).lonlat == pytest.approx(plants(app).lonlat, abs=1e-9)


def test_a_season_is_never_begun_over_another_and_its_name_stays_in_the_folder(season_app, season):
    before = season().path.read_bytes()
    for name, says in (("Gate 2026", "new file"), ("../up", "name must be"), ("", "name must be")):
        season_app.selectbox(key="season").set_value("Sample estate").run()
        begun(season_app, name)
        assert not season_app.exception
        assert says in season_app.error[0].value
    assert season().path.read_bytes() == before
    assert [p.name for p in season().path.parent.iterdir()] == ["Gate 2026.gpkg"]
