"""What the person chose, as every page gets it."""

from dataclasses import replace
from datetime import date

import pytest

from app.state import chosen_day
from fieldmon.planning.members import TeamMember
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from tests.app.chosen import a_plot, chosen, in_season, records_at
from tests.monitoring.seasons import BEGINS, Insects, a_season, clock_on, on


@pytest.fixture(scope="module")
def plot():
    return a_plot()


def test_the_day_is_a_date_and_the_name_keeps_to_itself(plot):
    choices = chosen(plot, day="2026-11-17")
    assert choices.on == date(2026, 11, 17)
    assert choices.name == "\u2068square\u2069"
    assert choices.revision == ""


def test_a_plan_without_a_season_is_made_of_records_once(plot):
    choices = chosen(plot, records_at(plot, [50], [1]))
    plan = choices.plan()
    assert plan.chance.argmax() == 50
    assert choices.plan() is plan
    assert plan.scene.robot == choices.robot


def test_a_day_worked_by_another_team_offers_that_one(tmp_path, monkeypatch):
    team = [TeamMember(name, Robot(hours=0.5)) for name in ("rob1", "Mia", "Noa")]
    season = a_season(tmp_path / "s.gpkg", team=tuple(team[:2]))
    season.plan(BEGINS)
    done = season.plan(BEGINS, keep=False, who="Mia").route.plant[:3]
    season.record(Insects(season).look(0, done), "f", "Mia")
    season.change(replace(season.settings, team=(team[2],)), season.settings)
    clock_on(monkeypatch, 1)
    before, today = in_season(season, BEGINS), in_season(season, on(1))
    assert (before.team_that_day, before.team) == (("rob1", "Mia"), ("Noa",))
    assert (today.team_that_day, today.whose_day) == (("Noa",), "Noa")
    assert before.whose_day == "rob1"
    assert chosen_day.work_begins(before)
    assert before.plan().route.notes.who == "rob1"


def test_a_plan_in_a_season_is_what_is_left_of_the_day(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    choices = in_season(season, BEGINS)
    first, revision = choices.plan().route.plant, choices.revision
    season.record(Insects(season).look(0, first[:4]), "test")
    assert choices.revision != revision
    rest = choices.plan().route.plant
    assert len(rest) < len(first)
    assert not set(rest.tolist()) & set(first[:4].tolist())


def test_a_season_s_sampler_is_the_one_that_was_told_with_its_settings(tmp_path, plot):
    season = a_season(tmp_path / "s.gpkg", sampler="bouncy", sampler_settings={"every": 3})
    assert in_season(season, BEGINS).decides == sampler("bouncy", every=3)
    choices = chosen(plot)
    assert choices.decides == sampler(choices.sampler)
