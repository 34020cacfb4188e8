"""A simulated season, day by day."""

from tests.app.driving import go, layer, plants


def test_a_season_is_simulated_and_its_day_slider_moves_the_map(app):
    go(app, "simulate")
    inspected = []
    for day in (1, 5, 12):
        app.slider(key="season_day").set_value(day).run()
        inspected.append(int((plants(app, "plants-state").colour[:, 3] == 255).sum()))
    assert inspected == sorted(set(inspected))
    assert layer(app, "truth") is None
    app.toggle(key="truth").set_value(True).run()
    assert layer(app, "truth") is not None
