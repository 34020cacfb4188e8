"""The page of scouting."""

from tests.app.driving import go, layer, tap


def test_found_plants_and_clean_ones_show_on_the_map(season_app):
    go(season_app, "scout")
    tap(season_app, "scout_found")
    tap(season_app, "scout_clean")
    assert len(layer(season_app, "finds0")["data"]) == 1
    shown = [p["c"] for p in layer(season_app, "plants")["data"]]
    assert sum(c == [213, 30, 30, 255] for c in shown) == 1
    assert sum(c == [90, 160, 230, 255] for c in shown) == 1
