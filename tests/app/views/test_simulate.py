"""A simulated season, day by day."""

from tests.app.driving import go, layer, metric, plants, texts_of


def test_a_season_is_simulated_and_its_day_slider_moves_the_map(season_app):
    go(season_app, "simulate")
    inspected = []
    for day in (1, 5, 12):
        season_app.slider(key="season_day").set_value(day).run()
        inspected.append(int((plants(season_app, "plants-state").colour[:, 3] == 255).sum()))
    assert inspected == sorted(set(inspected))
    assert layer(season_app, "truth") is None
    season_app.toggle(key="truth").set_value(True).run()
    assert layer(season_app, "truth") is not None


def test_a_season_of_visits_says_which_day_has_one(season_app):
    go(season_app, "simulate")
    season_app.number_input(key="visit_every").set_value(3).run()
    season_app.slider(key="season_day").set_value(6).run()
    said = texts_of(season_app)
    assert "Visits on 9 of 25 days: 1, 4, 7, 10, …, 25." in said
    assert "No visit on this day. The last one, visit 2 of 9, was on day 4." in said
    assert metric(season_app, "Found that day") == "0"
    season_app.slider(key="season_day").set_value(7).run()
    assert "Visit 3 of 9." in texts_of(season_app)
