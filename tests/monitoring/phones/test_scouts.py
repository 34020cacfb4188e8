"""Keys: who has one may tell findings of one season, until it is taken back."""

import shutil
from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import AccessError, SettingError
from fieldmon.monitoring import Season
from fieldmon.monitoring.phones import scouts
from fieldmon.planning.members import team_of
from tests.monitoring.seasons import a_plot, a_season


@pytest.fixture
def season(path):
    return Season(path)


def test_a_key_says_whose_it_is_and_of_which_rows(season):
    key = scouts.let_in(season, " Ann ", (1, 3))
    scout = scouts.key_owner(season, key)
    assert (scout.name, scout.rows) == ("Ann", (1, 3))
    assert [one.name for one in scouts.scouts_of(season)] == ["Ann"]


def test_the_file_holds_no_key(season):
    key = scouts.let_in(season, "Ann")
    assert key.encode() not in season.path.read_bytes()
    assert len(key) == 24


@pytest.mark.parametrize("key", ["", "x", "a" * 24])
def test_no_key_opens_nothing(season, key):
    scouts.let_in(season, "Ann")
    with pytest.raises(AccessError):
        scouts.key_owner(season, key)


def test_a_key_of_one_season_opens_no_copy_of_it(season, tmp_path):
    key = scouts.let_in(season, "Ann")
    with pytest.raises(AccessError):
        scouts.key_owner(Season(shutil.copy(season.path, tmp_path / "copy.gpkg")), key)


def test_a_key_taken_back_ends_and_a_new_one_of_that_name_ends_the_old(season):
    first = scouts.let_in(season, "Ann")
    second = scouts.let_in(season, "Ann")
    with pytest.raises(AccessError):
        scouts.key_owner(season, first)
    assert scouts.key_owner(season, second).name == "Ann"
    scouts.withdraw_key(season, "Ann")
    with pytest.raises(AccessError):
        scouts.key_owner(season, second)
    assert scouts.scouts_of(season) == ()
    with pytest.raises(SettingError, match="Ann must have a key"):
        scouts.withdraw_key(season, "Ann")


def test_who_got_a_key_in_each_of_two_copies_is_one_person_and_both_keys_hold(season, tmp_path):
    (tmp_path / "other").mkdir()
    other = Season(shutil.copy(season.path, tmp_path / "other"))
    first = scouts.let_in(season, "Ann", (1, 9))
    last = scouts.let_in(other, "ann", (5, 12))
    done = season.merge(other)
    assert (done.codes, done.overlaps) == (("Ann",), ())
    (one,) = scouts.scouts_of(season)
    assert one.rows == (5, 12)
    assert [scouts.key_owner(season, key) for key in (first, last)] == [one, one]
    scouts.withdraw_key(season, "Ann")
    for key in (first, last):
        with pytest.raises(AccessError):
            scouts.key_owner(season, key)


@pytest.mark.parametrize("name", ["", "  ", "n" * 61])
def test_a_scout_has_a_name(season, name):
    with pytest.raises(SettingError, match="1 to 60 letters"):
        scouts.let_in(season, name)


@pytest.mark.parametrize("rows", [(0, 2), (0, 0), (1, 10_000)])
def test_a_part_is_rows_of_the_plot(season, rows):
    with pytest.raises(SettingError, match="rows from 1 to"):
        scouts.let_in(season, "Ann", rows)


def test_rows_are_ones_own_or_the_same_as_anothers(season):
    scouts.let_in(season, "Ann", (1, 9))
    with pytest.raises(SettingError, match=r"overlap with 1 to 9, which are Ann's"):
        scouts.let_in(season, "Ben", (9, 12))
    with pytest.raises(SettingError, match="overlap"):
        scouts.let_in(season, "Ben")
    scouts.let_in(season, "Ben", (10, 12))
    scouts.let_in(season, "Cem", (1, 9))
    scouts.let_in(season, "Ann", (13, 14))


def test_who_was_invited_a_moment_ago_has_their_rows_already(season, monkeypatch):
    writing = season.store.writing

    def after_another():
        monkeypatch.undo()
        scouts.let_in(season, "Ben", (4, 9))
        return writing()

    monkeypatch.setattr(season.store, "writing", after_another)
    with pytest.raises(SettingError, match="overlap"):
        scouts.let_in(season, "Ann", (1, 6))


def test_a_name_of_the_team_is_written_as_there_and_any_other_needs_rows(season):
    before = season.settings
    season.change(replace(before, team=team_of(2)), before)
    with pytest.raises(SettingError, match=r"must be one of the team \(robot-1, robot-2\)"):
        scouts.let_in(season, "robot-3")
    first = scouts.let_in(season, "Robot-1")
    assert scouts.key_owner(season, first).name == "robot-1"
    scouts.let_in(season, "ROBOT-1")
    with pytest.raises(AccessError):
        scouts.key_owner(season, first)
    scouts.let_in(season, "Anna", (1, 2))
    assert [one.name for one in scouts.scouts_of(season)] == ["robot-1", "Anna"]
    with pytest.raises(SettingError, match="robot-2 is of it: the team's plan"):
        scouts.let_in(season, "robot-2", (3, 4))


def test_parts_are_of_the_rows_that_the_file_of_plants_names(tmp_path):
    plot = a_plot()
    called = 101 + 2 * np.arange(len(plot.grid.line_number))
    grid = replace(plot.grid, line_called=np.stack([called, called], axis=1))
    plot = replace(plot, aisles=replace(plot.aisles, grid=grid))
    season, last = a_season(tmp_path / "own.gpkg", plot), int(called[-1])
    assert scouts.key_owner(season, scouts.let_in(season, "Ann", (103, 105))).rows == (103, 105)
    assert scouts.key_owner(season, scouts.let_in(season, "Ann", (101, last))).rows is None
    with pytest.raises(SettingError, match=f"rows from 101 to {last} on this plot"):
        scouts.let_in(season, "Ann", (1, 3))


def test_rows_whose_ends_are_exchanged_are_said_to_be_so(season):
    with pytest.raises(SettingError, match="Exchange them: 3 to 8"):
        scouts.let_in(season, "Ann", (8, 3))
