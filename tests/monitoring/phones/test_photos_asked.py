"""A photo is asked for until one of its plant has come, and the day's route leads by."""

import shutil
from dataclasses import replace

import pytest

from fieldmon.errors import LimitError, ObservationError, SettingError
from fieldmon.monitoring import Season
from fieldmon.monitoring.days.day_ahead import DayAhead, WorkPart, planned_again, route_ahead
from fieldmon.monitoring.phones import photos_asked, scouts
from fieldmon.monitoring.phones.findings import take
from fieldmon.monitoring.phones.photos import Photo, keep
from fieldmon.monitoring.phones.photos_asked import ask_no_more, ask_photo
from fieldmon.planning.members import team_of
from tests.monitoring.phone import JPEG, NOW, a_finding
from tests.monitoring.rules import keeps_the_rules
from tests.monitoring.seasons import BEGINS, a_season


def asked(season):
    return [one.plant for one in photos_asked.photos_asked(season)]


@pytest.fixture
def season(path):
    return Season(path)


def test_it_is_asked_for_until_a_photo_of_the_plant_counts(season):
    key = scouts.let_in(season, "Ann")
    ask_photo(season, 30, " webs  here? ", "Office")
    one = photos_asked.photos_asked(season)[0]
    assert (one.plant, one.note, one.who) == (30, "webs here?", "Office")
    told = a_finding(30)
    take(season, key, [told], NOW)
    assert asked(season) == [30], "without a photo it was not taken"
    keep(season, key, Photo("one", told.id, JPEG, NOW))
    assert asked(season) == []
    take(season, key, [a_finding(None, None, undoes=told.id)], NOW)
    assert asked(season) == [30], "what was taken back does not count"
    keeps_the_rules(season.path)


def test_asking_again_by_the_same_id_asks_once_and_it_can_be_taken_back(season):
    first = ask_photo(season, 30, name="mine")
    assert ask_photo(season, 30, name="mine") == first
    with pytest.raises(ObservationError, match="id of its own"):
        ask_photo(season, 31, name="mine")
    assert ask_no_more(season, "mine")
    assert not ask_no_more(season, "mine")
    assert asked(season) == []


def test_what_cannot_be_asked_for_is_said_and_nothing_is_written(season, monkeypatch):
    with pytest.raises(ObservationError, match="A plant must be 0 to"):
        ask_photo(season, len(season.plot.grid))
    with pytest.raises(SettingError, match="200 letters"):
        ask_photo(season, 3, "x" * 201)
    monkeypatch.setattr(photos_asked, "MOST_OPEN", 1)
    ask_photo(season, 3)
    with pytest.raises(LimitError, match="at once"):
        ask_photo(season, 4)
    assert asked(season) == [3]


def test_the_route_given_out_leads_by_what_is_asked_for(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    plain = set(season.plan(BEGINS, keep=False).route.plant.tolist())
    missed = next(k for k in range(len(season.plot.grid)) if k not in plain)
    ask_photo(season, missed)
    assert missed in route_ahead(season, BEGINS).plant
    low = int(season.plant_numbers.line[missed])
    far = WorkPart(rows=(low + 2, low + 3))
    assert missed not in planned_again(season, BEGINS, far).plant, "a part is a part"


def test_of_a_team_or_of_parts_one_person_is_to_take_each(tmp_path):
    season = a_season(tmp_path / "season.gpkg")
    alone, n = season.settings, len(season.plot.grid)
    team = tuple(
        replace(one, name=name)
        for one, name in zip(team_of(2, alone.robot), ("Ann", "Ben"), strict=True)
    )
    season.change(replace(alone, team=team), alone)
    ann = season.plan(BEGINS, who="Ann").route.plant
    ben = season.plan(BEGINS, who="Ben").route.plant
    nobodys = min({*range(n)} - {*ann.tolist()} - {*ben.tolist()})
    for plant in (ann[0], ben[0], nobodys):
        ask_photo(season, int(plant))
    asked = DayAhead.of(season, BEGINS).asked_of
    to_take = {name: [one.plant for one in asked(WorkPart(name=name))] for name in ("Ann", "Ben")}
    assert to_take == {"Ann": [ann[0], nobodys], "Ben": [ben[0]]}
    low = int(season.plant_numbers.line[ann[0]])
    rows = DayAhead.of(season, BEGINS).asked_of(WorkPart(rows=(low, low), name="Cem"))
    assert {int(season.plant_numbers.line[one.plant]) for one in rows} == {low}


def test_copies_that_are_merged_ask_for_all_that_neither_took_back(path, tmp_path):
    here = Season(path)
    ask_photo(here, 3, name="both")
    there = Season(shutil.copy(path, tmp_path / "copy.gpkg"))
    ask_photo(here, 4, name="here")
    ask_photo(there, 5, name="there")
    ask_no_more(there, "both")
    here.merge(there)
    assert asked(here) == [4, 5]
