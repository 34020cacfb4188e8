"""A team as it is told in boxes: what they make of settings, and what becomes of it meanwhile."""

import json
from dataclasses import replace
from datetime import time

import pytest

from app.state import told_team, widget_memory
from app.state.told_team import TeamChoice
from fieldmon.errors import SettingError
from fieldmon.planning.members import TeamMember, Teamwork
from fieldmon.plot.robot import Robot, rover, scout

ANN = TeamMember("Ann", scout(hours=2.5, detection=0.4), (35.1, 30.3), 1800.0)
NOW = TeamChoice((ANN, TeamMember("Rob", rover(hours=6), None, 0.1)), time(6, 30, 15))


def draft(now=NOW):
    return told_team.draft("here", now, Robot())


def say(row, **boxes):
    for box, value in boxes.items():
        widget_memory.put(row.key(box), value)


@pytest.mark.usefixtures("session")
def test_what_nobody_touched_is_the_team_to_the_last_bit():
    for team in (NOW, NOW._replace(team=(ANN,))):  # of the second nobody starts with the team
        assert draft(team).told() == team
        assert not draft(team).is_told()


@pytest.mark.usefixtures("session")
def test_a_row_changes_what_its_boxes_say_and_keeps_the_rest():
    ann, rob = draft().rows
    say(ann, name=" Noa ", hours=3.0, look=25.0, start=time(6, 0))
    told = draft().told()
    assert told.team[0] == replace(
        ANN, name="Noa", starts_s=0.0, robot=replace(ANN.robot, hours=3.0, look_s=25.0)
    )
    assert (told.starts, told.team[1].starts_s) == (time(6), pytest.approx(1815.1))
    assert told.team[1].robot == rob.member.robot


@pytest.mark.usefixtures("session")
def test_of_another_kind_somebody_has_its_numbers_and_keeps_the_hours():
    rob = draft().rows[1]
    say(rob, who=told_team.SCOUT)
    told_team.turn_kind(rob)
    assert draft().told().team[1].robot == scout(hours=6.0)
    say(rob, who=told_team.ROBOT)
    told_team.turn_kind(rob)
    assert draft().told().team[1].robot == rover(hours=6.0)


@pytest.mark.usefixtures("session")
def test_where_one_works_two_of_the_kind_are_proposed():
    told = draft(TeamChoice(starts=time(5))).told()
    assert [one.name for one in told.team] == ["robot 1", "robot 2"]
    assert ({one.robot for one in told.team}, told.starts) == ({Robot()}, time(5))


@pytest.mark.usefixtures("session")
def test_who_is_added_is_like_the_last_of_the_kind_and_has_a_name_of_its_own():
    ann, rob = draft().rows
    say(ann, name="SCOUT 1", hours=3.5)
    told_team.add("here", told_team.SCOUT)
    told_team.take_out("here", rob.number)
    told_team.add("here", told_team.ROBOT)
    told = {one.name: one.robot for one in draft().told().team}
    assert told == {"SCOUT 1": (noa := replace(ANN.robot, hours=3.5)), "scout 2": noa,
                    "robot 1": Robot()}  # fmt: skip


@pytest.mark.usefixtures("session")
@pytest.mark.parametrize(
    ("boxes", "said"),
    [
        ({"name": "rob "}, "must have members of different names, but they are rob, Rob"),
        ({"name": "  "}, "must have a name"),
        ({"hours": 0.0}, "Ann: The robot's hours must be above 0, not 0.0"),
        ({"name": "", "look": 0.0}, "The robot's look_s must be above 0"),
    ],
)
def test_what_cannot_be_is_said_in_the_library_s_words(boxes, said):
    say(draft().rows[0], **boxes)
    with pytest.raises(SettingError, match=said):
        draft().told()
    assert draft().is_told()


@pytest.mark.usefixtures("session")
def test_how_they_work_together_is_told_in_minutes_and_the_units_of_the_page():
    odd = NOW._replace(teamwork=Teamwork(together=False, contact_s=100.0))
    made = draft(odd)
    assert made.told() == odd
    widget_memory.put(made.key("contact"), 5.0)
    widget_memory.put(made.key("passing"), 4.5)
    assert made.told().teamwork == Teamwork(together=False, contact_s=300.0, passing_m=4.5)


@pytest.mark.usefixtures("session")
def test_what_another_window_changed_is_shown_unless_something_was_told_here():
    first, other = draft(), NOW._replace(team=(ANN,))
    assert draft(other).seen == other
    say(draft(other).rows[0], hours=1.0)
    late = draft(NOW)
    assert (late.seen, late.told().team[0].robot.hours) == (other, 1.0)
    told_team.go_on("here", NOW)
    assert draft(NOW).seen == NOW
    assert draft(NOW).told() == late.told()
    told_team.drop("here")
    assert draft(NOW).told() == first.told()


@pytest.mark.usefixtures("session")
def test_the_team_of_a_table_is_told_and_not_in_use():
    draft()
    told_team.bring("here", (TeamMember("Mia"),), time(7))
    assert draft().told() == TeamChoice((TeamMember("Mia"),), time(7))
    assert (draft().seen, draft().is_told()) == (NOW, True)


def test_what_is_told_and_not_used_outlives_a_reload_to_the_last_bit(session):
    draft()
    assert told_team.said() == {}, "nobody told anything"
    ann, rob = draft().rows
    say(ann, name="Mia", start=time(5, 45))
    say(rob, who=told_team.SCOUT)
    told_team.add("here", told_team.ROBOT)
    widget_memory.put(draft().key("contact"), 7.0)
    told, rows = draft().told(), [row.number for row in draft().rows]
    written = json.dumps(told_team.said())
    session.clear()
    told_team.take(json.loads(written))
    assert draft().told() == told
    assert (draft().seen, [row.number for row in draft().rows]) == (NOW, rows)
    told_team.add("here", told_team.SCOUT)
    assert draft().rows[-1].number not in rows, "a new row has boxes of its own"
