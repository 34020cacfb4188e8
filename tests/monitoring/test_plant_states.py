"""What was seen of a plant since its last treatment is what is known of it."""

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.plant_states import (
    TREATED_SINCE,
    hot_spots_on,
    latest_states,
    shown_states,
)
from tests.monitoring.seasons import a_season, on


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
