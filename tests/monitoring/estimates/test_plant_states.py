"""What was seen of a plant since its last treatment is what is known of it."""

from dataclasses import replace
from datetime import date

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.estimates.plant_states import (
    TREATED_SINCE,
    finds_apart,
    hot_spots_on,
    latest_states,
    shown_apart,
    shown_states,
)
from fieldmon.monitoring.treating.treatment import Treatment
from tests.monitoring.seasons import a_plot, a_season, on

PLOT = a_plot()
N = len(PLOT.grid)
BEGINS = date(2026, 4, 6)
MORNING = PairApproximation.of(PLOT.grid, np.full(N, 0.02))


def seen(season, day, **results):
    """Record what was seen of plants, which are given by lists of their numbers."""
    codes = {"found": FOUND, "clean": CLEAN, "skipped": SKIPPED}
    plants = np.concatenate([np.array(some, int) for some in results.values()])
    told = np.repeat([codes[name] for name in results], [len(some) for some in results.values()])
    season.record(Inspections.of(plants, told, np.datetime64(on(day))), f"{day}.csv", "Ann")


def treated(season, day, plants):
    which = np.isin(np.arange(len(season.plot.grid)), plants)
    season.treat(on(day), 0.9, plants=which)


@pytest.fixture
def season(tmp_path):
    """Give a season: 100 to 103 and 200 found, 105 clean; all but 200 treated; some seen again."""
    season = a_season(tmp_path / "season.gpkg")
    seen(season, 0, found=[100, 101, 102, 103, 200], clean=[105])
    treated(season, 0, np.arange(90, 150))
    seen(season, 3, clean=[100, 110, 200], found=[101], skipped=[102])
    return season


def test_a_result_counts_no_more_once_a_plant_was_treated_and_seen_again(season):
    before, after = (latest_states(season.history, day, own=True) for day in (0, 3))
    assert before[[100, 103, 105, 110, 200]].tolist() == [TREATED_SINCE, TREATED_SINCE, 0, -1, 1]
    assert after[[100, 101, 102, 103, 105, 110, 200]].tolist() == [
        *(CLEAN, FOUND, TREATED_SINCE, TREATED_SINCE, CLEAN, CLEAN, FOUND),
    ]
    shown = shown_states(season.history, 3, own=True)
    assert shown[[100, 101, 102, 103, 110]].tolist() == [CLEAN, FOUND, FOUND, FOUND, CLEAN]


def test_a_later_treatment_puts_a_find_in_doubt_again(season):
    treated(season, 3, [101, 200])
    assert latest_states(season.history, 3)[[101, 200]].tolist() == [TREATED_SINCE] * 2
    seen(season, 4, clean=[101])
    assert latest_states(season.history, 4)[[101, 200]].tolist() == [CLEAN, TREATED_SINCE]


def test_what_was_seen_later_on_the_day_of_a_treatment_counts_after_it():
    done = Inspections.of(
        np.array([5, 6, 7, 8]), np.array([FOUND, FOUND, CLEAN, FOUND]), np.datetime64(BEGINS),
        second=np.array([21_600.0, 43_200.0, 43_200.0, np.nan]),
    )  # fmt: skip
    at_7, at_10 = (Treatment(0, np.ones(N, bool), 0.5, hour * 3600.0) for hour in (7, 10))
    history = History(PLOT.grid, BEGINS, MORNING, done, (at_10, at_7))
    assert latest_states(history, 0)[[5, 6, 7, 8, 9]].tolist() == [
        *(TREATED_SINCE, FOUND, CLEAN, TREATED_SINCE, -1),
    ]
    untold = replace(history, treatments=(Treatment(0, np.ones(N, bool), 0.5), at_7))
    assert latest_states(untold, 0)[[5, 6, 7]].tolist() == [TREATED_SINCE, TREATED_SINCE, CLEAN]


def test_records_of_before_count_as_seen_before_a_treatment(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    (plant, *_) = np.flatnonzero(season.history.recorded == 1)
    assert latest_states(season.history, 0)[plant] == FOUND
    assert latest_states(season.history, 0, own=True)[plant] == -1
    treated(season, 0, [plant])
    assert latest_states(season.history, 0)[plant] == TREATED_SINCE
    seen(season, 1, clean=[plant])
    assert latest_states(season.history, 1)[plant] == CLEAN
    assert season.history.known(1)[plant] == FOUND


def test_finds_that_were_treated_make_no_hot_spot(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    seen(season, 0, found=np.arange(100, 112), clean=np.arange(150, 400))
    assert len(hot_spots_on(season.history, 0))
    assert len(season.status(on(0)).hot_spots)
    treated(season, 1, np.arange(90, 130))
    assert not len(hot_spots_on(season.history, 1))
    assert not len(season.status(on(1)).hot_spots)
    with season.store.reading() as db:
        assert db.execute("SELECT count(*) FROM hot_spots").fetchone()[0] == 0


def test_a_find_known_from_records_alone_and_one_that_was_treated_are_told_apart(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    here, there = np.flatnonzero(season.history.recorded == 1)
    seen(season, 0, found=[100, 101, 102, 103], clean=[105])
    treated(season, 1, [there, 100, 101, 102])
    seen(season, 2, clean=[100], found=[101])
    brought, treated_since = finds_apart(season.history, 2)
    assert np.flatnonzero(brought).tolist() == [here]
    assert set(np.flatnonzero(treated_since)) == {there, 100, 102}


def test_what_is_shown_as_found_is_what_the_season_found_and_records_are_apart(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    here, there = np.flatnonzero(season.history.recorded == 1)
    seen(season, 0, found=[100], clean=[there])
    state, recorded = shown_apart(season.history, 0)
    assert np.flatnonzero(state == FOUND).tolist() == [100]
    assert np.flatnonzero(recorded).tolist() == [here, there]
    assert state[[here, there]].tolist() == [-1, CLEAN]
    seen(season, 1, found=[here])
    state, recorded = shown_apart(season.history, 1)
    assert (state[here], recorded[here]) == (FOUND, False)


def test_the_file_says_what_is_known_since_the_treatment(season):
    kept = Season(season.path)
    with kept.store.reading() as db:
        said = dict(db.execute("SELECT fid - 1, state FROM plant_state").fetchall())
    assert [said[plant] for plant in (100, 101, 103, 110, 111, 200)] == [
        *("looked clean", "found infested", "found, treated since"),
        *("looked clean", "never inspected", "found infested"),
    ]
    assert kept.status(on(3)).found == 5
    assert kept.verify() == ()
