"""A team is told in a season: row by row, or as a table; what cannot be is said beside it."""

from datetime import time
from types import SimpleNamespace

import numpy as np

from app.actions import telling_team
from app.state import told_team
from app.state.told_team import TeamChoice
from app.words import texts
from fieldmon.infestation.inspections import Inspections
from fieldmon.io.sandbox import limits
from fieldmon.plot.robot import Robot, scout
from tests.app.driving import boxed, press, tap, texts_of


def keys(app):
    return [one.key or "" for one in app.button]


def test_a_team_is_told_row_by_row_and_who_is_taken_out_stays_in_the_records(season_app, season):
    boxed(season_app.segmented_control, "who").set_value("Team").run()
    first, second = (one for one in season_app.text_input if one.key.startswith("team_name "))
    first.set_value("Ann, =eye")
    second.set_value("ann, =EYE ").run()
    assert "different names, but they are Ann, =eye, ann, =EYE." in season_app.error[0].value
    assert "first use what you changed" in texts_of(season_app)
    assert "change_setup" not in keys(season_app)
    next(one for one in season_app.text_input if one.value == "ann, =EYE ").set_value("Bo")
    tap(season_app, "team_add_scout")
    press(season_app, texts.CHANGE)
    told = season().settings
    assert [one.name for one in told.team] == ["Ann, =eye", "Bo", "scout 1"]
    assert {one.robot for one in told.team} == {told.robot, scout()}
    assert season_app.segmented_control(key="whose_day").options == [one.name for one in told.team]
    seen = Inspections.of(np.arange(3), np.zeros(3, np.int8), np.datetime64(told.begins))
    season().record(seen, "file", "Ann, =eye")
    season_app.run()
    tap(season_app, next(key for key in keys(season_app) if key.startswith("team_out ")))
    press(season_app, texts.CHANGE)
    assert [one.name for one in season().planned_by(told.begins).team] == ["Bo", "scout 1"]
    assert {*season().inspections.who} == {"Ann, =eye"}
    tap(season_app, "undo_change")
    assert season().settings == told


def place_of(block, label):
    """Return where on the page a box of this label stands, block by block; None: not in this."""
    for k, child in getattr(block, "children", {}).items():
        if getattr(child, "label", "") == label and child.type == "expander":
            return (k,)
        if (below := place_of(child, label)) is not None:
            return (k, *below)
    return None


def test_how_they_work_together_stays_open_below_whatever_is_said_of_the_rows(season_app):
    boxed(season_app.segmented_control, "who").set_value("Team").run()
    before = place_of(season_app.main, texts.TEAM_MORE)
    assert before is not None
    # the browser knows a box by its place: another one there would be closed
    tap(season_app, "team_add_scout")
    assert place_of(season_app.main, texts.TEAM_MORE) == before
    first, second, _ = (one for one in season_app.text_input if one.key.startswith("team_name "))
    second.set_value(first.value).run()
    assert "different names" in season_app.error[0].value
    assert place_of(season_app.main, texts.TEAM_MORE) == before


def test_another_window_s_team_is_not_written_over_unseen(season_app, season):
    settings = season().settings
    boxed(season_app.segmented_control, "who").set_value("Team").run()
    boxed(season_app.text_input, "team_name").set_value("Mine").run()
    theirs = (told_team.TeamMember("Theirs", Robot()),)
    season().change(told_team.replace(settings, team=theirs), settings)
    season_app.button(key="change_setup").click().run()
    assert season().settings.team == theirs


def bring(session, content, name="team.csv"):
    session["box"] = SimpleNamespace(name=name, size=len(content), getvalue=lambda: content)
    telling_team._bring("here", time(6), "box")


def test_a_table_that_is_brought_fills_the_rows_and_one_that_cannot_be_says_why(session):
    now = TeamChoice(starts=time(6))
    told_team.draft("here", now, Robot())
    bring(session, b"name,who,hours,speed_km_h,start\r\n'=Ann,scout,3,,\r\nBo,,,3.6,05:30\r\n")
    told = told_team.draft("here", now, Robot()).told()
    assert [one.name for one in told.team] == ["=Ann", "Bo"]
    assert (told.starts, told.team[0].starts_s) == (time(5, 30), 1800.0)
    assert told.team[0].robot == scout(hours=3.0)
    problem = telling_team._PROBLEM + "here"
    for content, said in (
        (b"name\nAnn\nann\n", "team.csv, line 3: members of a team must have names of their own"),
        (b"name,battery\nAnn,3\n", "battery"),
        (b"name\n" + bytes(limits.MB), "may hold"),
    ):
        bring(session, content)
        assert said in session[problem]
        assert told_team.draft("here", now, Robot()).told() == told
    bring(session, b"name\nMia\n")
    assert problem not in session
