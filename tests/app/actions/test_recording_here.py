"""A plant that was tapped is recorded where it is shown, by a press that says what was seen."""

import shutil
from datetime import date

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.monitoring import Season
from tests.app.driving import tap, texts_of


@pytest.fixture
def tapped(season_app):
    """Return the app on Today, where plant 4 of row 3 was tapped."""
    state = season_app.session_state
    state["history row"], state["history plant"], state["history tapped"] = 3, 4, True
    return season_app.run()


def keys(app):
    return {button.key for button in app.button} & {"here_0", "here_1", "here_undo"}


def test_nothing_is_offered_before_a_plant_was_tapped_or_a_season_began(app, season_app):
    assert keys(season_app) == set()
    app.session_state["history row"], app.session_state["history plant"] = 3, 4
    app.session_state["history tapped"] = True
    assert keys(app.run()) == set()


def test_one_press_records_the_plant_and_day_shown_and_is_known_contradicted_or_taken_back(
    tapped, season
):
    assert "**Row 3, plant 4**" in texts_of(tapped)
    assert not len(season().history.inspections)
    assert "here_undo" not in keys(tapped)
    tap(tapped, "here_1")
    assert "1 recorded" in tapped.success[0].value
    kept = season().history.inspections
    assert kept.result.tolist() == [FOUND]
    numbered = season().plant_numbers
    (plant,) = kept.plant.tolist()
    assert (numbered.line[plant], numbered.number[plant]) == (3, 4)
    assert kept.date[0].item() == date(2026, 11, 16)
    tap(tapped, "here_1")
    assert "0 recorded, 1 known" in tapped.success[0].value
    # what contradicts waits for a word
    tap(tapped, "here_0")
    assert season().history.inspections.result.tolist() == [FOUND]
    assert "contradict" in tapped.warning[0].value
    tap(tapped, "record_none")
    assert season().history.inspections.result.tolist() == [FOUND]
    assert not tapped.warning
    # another plant is looked at meanwhile
    tapped.session_state["history plant"] = 5
    tapped.run()
    assert "**Row 3, plant 5**" in texts_of(tapped)
    assert "Last: row 3, plant 4: found" in texts_of(tapped)
    assert len(season().history.inspections) == 1
    tap(tapped, "here_undo")
    assert not len(season().history.inspections)
    assert "here_undo" not in keys(tapped)
    tap(tapped, "here_0")
    assert season().history.inspections.result.tolist() == [CLEAN]


def test_after_a_merge_it_is_still_what_is_taken_back(tapped, season, tmp_path):
    there = Season(shutil.copy(season().path, tmp_path / "other.gpkg"))
    on = np.datetime64("2026-11-16")
    there.record(Inspections.of(np.array([9]), np.array([FOUND]), on), "there", "Ben")
    tap(tapped, "here_1")
    season().merge(there)
    tapped.run()
    tap(tapped, "here_undo")
    assert season().history.inspections.plant.tolist() == [9]


def test_a_day_that_has_not_come_is_not_recorded(tapped):
    tapped.date_input(key="day Gate 2026").set_value(date(2026, 11, 17)).run()
    assert keys(tapped) == set()
