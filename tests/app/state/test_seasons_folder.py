"""The seasons on this machine: files of one folder, by names that stay in it."""

import sqlite3
from contextlib import closing

import pytest

from app.state import seasons_folder as folder
from fieldmon.errors import FileProblem, SettingError
from fieldmon.monitoring import Season
from tests.monitoring.seasons import a_season


def held(path):
    """Return all that a season holds but the project for QGIS, which names the file."""
    with closing(sqlite3.connect(path)) as db:
        return [line for line in db.iterdump() if '"qgis_projects"' not in line]


@pytest.mark.parametrize("name", ["..", "../x", "a/b", "a\\b", "", ".hidden", "x" * 90])
def test_names_that_lead_out_of_the_folder_are_refused(name):
    with pytest.raises(SettingError):
        folder.path_of(name)


def test_a_name_of_any_script_is_a_file_of_the_folder(seasons_folder):
    path = folder.path_of("מטע 2026")
    assert (path.parent, path.name) == (seasons_folder, "מטע 2026.gpkg")


def test_only_seasons_are_named_in_order_and_no_folder_is_none(seasons_folder, monkeypatch):
    for name in ("b", "a"):
        a_season(folder.new_path(f" {name} "))
    (seasons_folder / "c.gpkg").write_bytes(b"SQLite format 3\0")
    (seasons_folder / "d.txt").write_text("no season", encoding="utf-8")
    assert folder.names() == ["a", "b"]
    monkeypatch.setenv(folder.FOLDER, str(seasons_folder / "nowhere"))
    assert folder.names() == []
    assert folder.new_path("first").parent.is_dir()


def test_a_link_out_of_the_folder_is_neither_named_nor_followed(seasons_folder, tmp_path):
    outside = tmp_path / "elsewhere"
    outside.mkdir()
    a_season(outside / "private.gpkg")
    seasons_folder.mkdir(exist_ok=True)
    (seasons_folder / "leak.gpkg").symlink_to(outside / "private.gpkg")
    assert folder.names() == []
    with pytest.raises(SettingError, match="leak"):
        folder.path_of("leak")


@pytest.mark.usefixtures("seasons_folder")
def test_a_renamed_season_is_whole_under_its_new_name_and_takes_nobody_elses():
    for name in ("old", "other"):
        a_season(folder.new_path(name))
    before = held(folder.path_of("old"))
    folder.rename("old", " new ")
    assert folder.names() == ["new", "other"]
    assert held(folder.path_of("new")) == before
    with pytest.raises(FileProblem, match="exists already"):
        folder.rename("new", "other")
    with pytest.raises(SettingError):
        folder.rename("new", "../new")
    assert folder.names() == ["new", "other"]


def test_a_season_off_the_list_lies_aside_whole_and_never_over_another(seasons_folder):
    for n in (1, 2):
        made = a_season(folder.new_path("gone"))
        data = held(made.path)
        aside = folder.set_aside("gone")
        assert folder.names() == []
        assert held(aside) == data
        assert len(list((seasons_folder / folder.REMOVED).iterdir())) == n


@pytest.mark.usefixtures("seasons_folder")
def test_a_season_off_the_list_comes_back_whole_under_a_name_that_is_free():
    a_season(folder.new_path("gone"))
    before = held(folder.path_of("gone"))
    assert folder.removed() == []
    folder.set_aside("gone")
    a_season(folder.new_path("gone"))
    assert folder.removed() == ["gone"]
    assert folder.bring_back("gone") == "gone (2)"
    assert (folder.names(), folder.removed()) == (["gone", "gone (2)"], [])
    assert held(folder.path_of("gone (2)")) == before
    with pytest.raises(SettingError):
        folder.bring_back("../gone")


@pytest.mark.usefixtures("seasons_folder")
def test_the_file_of_a_season_is_taken_in_under_a_name_that_it_can_have(tmp_path):
    data = a_season(tmp_path / "s.gpkg").path.read_bytes()
    assert folder.is_of_season(data)
    assert not folder.is_of_season(data[:100])
    assert not folder.is_of_season(b"name,lon,lat")
    names = [folder.take_in(data, name) for name in ("North", "North", "a/b: c", "..", "x" * 99)]
    assert names == ["North", "North (2)", "a-b- c", "season", "x" * 75]
    assert folder.names() == sorted(names)
    assert Season(folder.path_of("North")).plot.n_plants


@pytest.mark.usefixtures("seasons_folder")
@pytest.mark.parametrize(
    ("plot", "season"),
    [
        ('חלקה ב/3 "ליד הבאר"', "חלקה ב-3 ליד הבאר 2026"),
        ('O\'Brien / "East" <b>7</b>', "O'Brien - East b7-b 2026"),
        ('חב"ל 7', "חב״ל 7 2026"),
        ("..", "season 2026"),
        ("x" * 99, f"{'x' * 70} 2026"),
    ],
)
def test_from_any_plots_name_a_name_is_made_that_a_season_can_have(plot, season):
    assert folder.plain_name(plot, " 2026") == season
    assert folder.path_of(folder.free_name(season)).stem == season


@pytest.mark.usefixtures("seasons_folder")
def test_a_name_that_is_free_has_a_number_behind_it_where_others_have_it(tmp_path):
    assert folder.free_name("North 1.5") == "North 1.5"
    for name in ("North 1.5", "North 1.5 (2)", "South"):
        folder.new_path(name).touch()
    assert folder.free_name("North 1.5") == "North 1.5 (3)"
    assert folder.free_name("South") == "South (2)"
    assert folder.free_name("South", tmp_path) == "South"
