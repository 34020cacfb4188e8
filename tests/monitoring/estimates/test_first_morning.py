"""The first morning: the same from the season's file or worked out, and that once a choice."""

import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates import first_morning
from fieldmon.monitoring.season import open_season as in_season
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture
def season_file(recorded, tmp_path):
    return shutil.copy(recorded, tmp_path / "season.gpkg")


def _change(path, statement):
    with closing(sqlite3.connect(path)) as db:
        db.execute(statement)
        db.commit()


@pytest.mark.parametrize("damage", ["SET chances = X'00'", "SET content = ''", "SET causes = ''"])
def test_the_first_morning_is_the_same_from_the_file_and_from_what_it_follows(season_file, damage):
    kept_one = Season(season_file).history.first_morning.chance
    _change(season_file, f"UPDATE mornings {damage}")
    again = Season(season_file).history.first_morning.chance
    np.testing.assert_array_equal(again, kept_one)


def test_the_first_morning_is_worked_out_once_for_each_choice(season_file, monkeypatch):
    season = Season(season_file)
    chosen = replace(season.settings, prior=PriorSettings(edge_chance=0.3))
    asked, prior_chance = [], in_season.prior_chance
    monkeypatch.setattr(
        in_season, "prior_chance", lambda *of: asked.append(of) or prior_chance(*of)
    )
    before = Season(season_file).history.first_morning
    assert asked == []
    Season(season_file).change(chosen, season.settings)
    assert len(asked) == 1
    after = Season(season_file).history.first_morning
    assert len(asked) == 1
    assert (after.chance > before.chance).any()


def test_another_program_works_the_first_morning_out_by_its_own_rules(season_file, monkeypatch):
    asked, prior_chance = [], in_season.prior_chance
    monkeypatch.setattr(first_morning, "_rules", lambda: "of another version")
    monkeypatch.setattr(
        in_season, "prior_chance", lambda *of: asked.append(of) or prior_chance(*of)
    )
    assert Season(season_file).history.first_morning is not None
    assert len(asked) == 1


def test_a_season_that_was_just_begun_has_its_first_morning_in_the_file(tmp_path, monkeypatch):
    monkeypatch.setattr(in_season, "prior_chance", None)  # who opens it would call that
    season = a_season(tmp_path / "season.gpkg")
    assert len(season.morning(BEGINS)) == len(season.plot.grid)
