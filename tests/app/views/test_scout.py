"""The page of scouting."""

from datetime import date
from types import SimpleNamespace

import numpy as np
import pytest

from app.show.maps import colours
from app.views import scout
from app.words import texts
from app.words.units import UnitsInLanguage
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


@pytest.mark.parametrize(("is_today", "head"), [(True, "Done for today"), (False, "on Fri 20 Nov")])
def test_another_day_is_not_called_today_where_nothing_is_left_of_it(is_today, head, monkeypatch):
    said, done = [], SimpleNamespace(inspected_today=3, found_today=1)
    monkeypatch.setattr(scout.st, "markdown", said.append)
    monkeypatch.setattr(scout.chosen_day, "progress", lambda _: done)
    monkeypatch.setattr(scout.scouting, "can_be_longer", lambda _: False)
    scout._say_done(
        SimpleNamespace(
            is_today=is_today, on=date(2026, 11, 20), today=date(2026, 11, 30),
            units=UnitsInLanguage(),
        )
    )  # fmt: skip
    assert head in said[0].split("\n")[0]
