"""The page of scouting."""

import numpy as np
import pytest

from app.show.maps import colours
from app.words import texts
from tests.app.driving import go, layer, map_of, plants, tap, texts_of


def test_found_plants_and_clean_ones_show_on_the_map(season_app, season):
    go(season_app, "scout")
    before = plants(season_app, "plants-state")
    tap(season_app, "scout_found")
    tap(season_app, "scout_clean")
    found, clean = season().history.inspections.plant.tolist()
    shown = plants(season_app, "plants-state")
    known, own = season().history.known(0), season().history.states(0)
    assert np.flatnonzero(own == 1).tolist() == [found]
    for colour, state in ((colours.FOUND, own == 1), (colours.CLEAN, known == 0)):
        assert shown.of_colour(colour).tolist() == np.flatnonzero(state).tolist()
    recorded = np.count_nonzero((known == 1) & (own != 1))
    assert len(layer(season_app, "finds-recorded")["data"]) == recorded > 0
    assert set(before.of_colour(colours.NEVER)) - {found, clean} == set(
        shown.of_colour(colours.NEVER)
    )
    assert clean not in shown.of_colour(colours.NEVER)
    tap(season_app, "scout_skip")
    assert " · 3 done, " in "".join(one.value for one in season_app.caption)
    assert len(layer(season_app, "finds0")["data"]) == len(shown.of_colour(colours.FOUND))


def test_the_map_shows_states_first_and_rings_the_next_plant(season_app, season):
    go(season_app, "scout")
    assert map_of(season_app)["shades"][0]["key"] == "state"
    for _ in range(2):
        (ring,) = layer(season_app, "next")["data"]
        plants_of = season().plot.grid.lonlat()
        near = int(np.argmin(np.hypot(*(plants_of - ring["p"]).T)))
        tap(season_app, "scout_clean")
        assert season().history.inspections.plant[-1] == near
        assert ring["p"] == pytest.approx(plants_of[near].tolist(), abs=1e-6)


def test_without_a_season_it_says_what_it_needs(app):
    go(app, "scout")
    assert texts.SCOUT_NEEDS in texts_of(app)
    assert not app.exception
