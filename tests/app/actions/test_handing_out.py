"""A day's route as a download: one file as it is, several as one archive."""

import io
import zipfile
from datetime import datetime
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest

from app.actions import handing_out
from app.actions.handing_out import made
from app.state import morning_steps, wishes
from app.state.choices import Choices
from fieldmon.compute.wording import worded
from fieldmon.io.writers import FORMATS, HandoffPlan
from fieldmon.io.writers.day_file import RouteNotes
from fieldmon.io.writers.handoff import HandoffFormat
from fieldmon.monitoring.days.day_ahead import WorkPart, planned_again
from fieldmon.monitoring.days.kept_wishes import wishes_kept
from fieldmon.planning.wishes import Wishes
from tests.app.chosen import a_plot, chosen, in_season
from tests.monitoring.seasons import BEGINS, a_season


@pytest.fixture(scope="module")
def plan():
    route = chosen(a_plot()).plan().route
    return HandoffPlan(route, RouteNotes("square", "adaptive", datetime(2026, 11, 16, 6)))


@pytest.mark.parametrize("name", [name for name, one in FORMATS.items() if not one.several])
def test_one_file_is_handed_out_as_it_is(plan, name):
    (alone,) = FORMATS[name].make(plan).values()
    # archives hold the time at which they were made
    assert len(made(FORMATS[name], plan)) == len(alone)


def test_several_files_come_as_one_archive(plan):
    nav2 = FORMATS["nav2"]
    with zipfile.ZipFile(io.BytesIO(made(nav2, plan))) as archive:
        packed = {name.removeprefix("route"): archive.read(name) for name in archive.namelist()}
    assert packed == nav2.make(plan)
    assert len(packed) == 3


def test_a_new_format_is_offered_without_a_line_in_the_app(plan, monkeypatch):
    new = HandoffFormat("gpx:route_gpx", (".new",), worded("whoever reads new files"))
    monkeypatch.setitem(FORMATS, "new", new)
    offered = {}

    def box(_label, names, *_, format_func, **_more):
        offered.update({name: format_func(name) for name in names})
        return names[-1]

    monkeypatch.setattr(handing_out.st, "selectbox", box)
    told = []
    monkeypatch.setattr(
        handing_out.st, "download_button", lambda *said, **_: told.append((said[0], said[2]))
    )
    team = SimpleNamespace(season=SimpleNamespace(path=Path("כרם 3.gpkg")), day="2026-11-16")
    team.whose_day, team.file_name = "Ann/Bo", partial(Choices.file_name, team)
    handing_out._files(team, plan)
    assert next(iter(offered)) == "gpx"  # the commonest first
    assert offered["new"] == "whoever reads new files: new"
    # each of a team has a file of another name, and each season
    assert told == [("Download for whoever reads new files", "route_כרם_3_Ann_Bo_2026-11-16.new")]


def test_a_sheet_to_print_is_in_the_language_of_the_app(monkeypatch, speaking):
    handed = []
    monkeypatch.setattr(handing_out, "_show_address", lambda: None)
    monkeypatch.setattr(handing_out, "_files", lambda _, plan: handed.append(plan))
    choices = chosen(a_plot())
    speaking("he")
    handing_out.show(choices, choices.plan())
    page = made(FORMATS["sheet"], handed[0]).decode()
    assert '<html lang="he" dir="rtl"' in page
    assert "<th>שורה</th>" in page


def test_what_is_used_with_the_plan_holds_for_scouts_and_other_browsers(tmp_path, session):
    season = a_season(tmp_path / "s.gpkg")
    choices = in_season(season, BEGINS)
    out = Wishes(unwanted=tuple(range(len(season.plot.grid) // 2)))
    handing_out.give_out(choices)
    wishes.want(choices.laid, choices.day, out)
    assert choices.are_wishes_unused
    (step,) = (
        one
        for one in morning_steps.steps(choices, choices.plan())
        if one.name == morning_steps.PLAN
    )
    assert not step.done
    assert not wishes_kept(season, BEGINS), "until the plan is used nobody else has it"
    handing_out.give_out(choices)
    assert wishes_kept(season, BEGINS) == out
    rows = (2, int(season.plant_numbers.line.max()))
    led = planned_again(season, BEGINS, WorkPart(rows, "Cat")).plant
    assert len(led)
    assert not {*led.tolist()} & {*out.unwanted}
    session.clear()  # another browser
    other = in_season(season, BEGINS)
    assert other.besides == out
    assert not other.are_wishes_unused
    assert not {*other.plan().route.plant.tolist()} & {*out.unwanted}
    wishes.want(other.laid, other.day, Wishes())
    handing_out.give_out(other)
    assert not wishes_kept(season, BEGINS), "and taken back it holds no more"
