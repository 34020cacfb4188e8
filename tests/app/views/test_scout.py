"""The page of scouting."""

import numpy as np

from tests.app.driving import go, layer, tap


def test_found_plants_and_clean_ones_show_on_the_map(season_app, season):
    go(season_app, "scout")
    tap(season_app, "scout_found")
    tap(season_app, "scout_clean")
    found, clean = season().history.inspections.plant.tolist()
    known = season().history.known(0)
    shown = {p["i"]: p["c"] for p in layer(season_app, "plants")["data"]}
    assert shown[found] == [213, 30, 30, 255]
    assert shown[clean] == [[90, 160, 230, 255], [213, 30, 30, 255]][known[clean]]
    assert {i for i, c in shown.items() if c == [213, 30, 30, 255]} == set(
        np.flatnonzero(known == 1).tolist()
    )
    assert len(layer(season_app, "finds0")["data"]) == (known == 1).sum()
