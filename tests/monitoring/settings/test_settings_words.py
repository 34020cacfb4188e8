"""What a change of a season did, in words."""

from dataclasses import replace
from datetime import date, time

import pytest

from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import MonitoringSettings
from fieldmon.monitoring.settings.settings import as_json
from fieldmon.monitoring.settings.settings_words import differences, taken_back, worker_in_words
from fieldmon.planning.members import TeamMember, Teamwork, team_of
from fieldmon.plot.robot import Robot, Viewpoints, scout

FIRST = MonitoringSettings(date(2026, 11, 1))
ANN = TeamMember("Ann", scout())


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"robot": Robot(hours=4)}, "hours 4 (now 12 again)"),
        ({"robot": Robot(look_s=30.0)},
         "look 30 s (now 40 s again), detection 69 % (now 84 % again)"),
        ({"robot": Robot().with_times("thesis")},
         "row changes, turns and stops thesis (now measured again)"),
        ({"pest": shipped_pest("spider-mite")}, "pest spider-mite (now none again)"),
        ({"team": (ANN,), "robot": Robot(hours=4)},
         "team Ann 4 h, 30 s a plant, 4 km/h, finds 69 % (now none again)"),
        ({"starts": time(7), "harvest": date(2026, 12, 1)},
         "start 07:00 (now 06:00 again), harvest 2026-12-01 (now none again)"),
        ({"robot": Robot(returns=False)},
         "way back to the gate within the hours no (now yes again)"),
        ({"robot": Robot(viewpoints=Viewpoints(((40.0, 0.84),), 1.0))},
         ("detection by seconds 84 % in 40 s to 100 % in over 40 s "
         "(now 50 % in 20 s to 90 % in over 40 s again)")),
        ({"robot": Robot(detection=0.84)}, "robot detection 0.84 (now none again)"),
        ({"prior": replace(FIRST.prior, edge_chance=0.1)},
         "prior edge chance 0.1 (now 0.05 again)"),
        ({"seed": 7}, "season seed 7 (now 1 again)"),
        ({"language": "he"}, "language he (now en again)"),
        ({"belief": replace(FIRST.belief, traces=False)}, "traces no (now yes again)"),
        ({"belief": replace(FIRST.belief, treated=False)},
         "finds only flagged (now treated at once again)"),
        ({"prior": replace(FIRST.prior, background_chance=0.04)},
         "infested where nothing is known 0.04 (now 0.01 again)"),
    ],
)  # fmt: skip
def test_what_is_taken_back_is_named_with_what_counts_again(chosen, said):
    changed = replace(FIRST, **chosen)
    assert taken_back(changed, FIRST) == f"The last change was taken back: {said}."
    assert taken_back(FIRST, changed) != taken_back(changed, FIRST)


def test_what_is_long_and_alike_at_its_ends_is_said_by_its_name_alone():
    steps = tuple((s, p + 0.01 * (s == 30.0)) for s, p in Viewpoints().steps)
    changed = replace(FIRST, robot=Robot(viewpoints=Viewpoints(steps)))
    assert taken_back(changed, FIRST) == "The last change was taken back: detection by seconds."


def test_how_a_team_works_together_is_said_in_words():
    told = replace(FIRST, team=(ANN,), teamwork=Teamwork(contact_s=600.0, passing_m=5.0))
    said = "contact every 10 min (now at once again), headland to pass each other 5 m"
    assert said in taken_back(told, replace(FIRST, team=(ANN,)))
    assert "contact" not in taken_back(told, FIRST)  # it goes with the team


def test_the_log_says_a_team_in_words_with_all_that_came_with_it():
    told = replace(FIRST, team=(ANN,), teamwork=Teamwork(contact_s=600.0), robot=Robot(hours=4))
    assert differences(as_json(FIRST), as_json(told)) == [
        "team none to Ann 4 h, 30 s a plant, 4 km/h, finds 69 %",
        "hours 12 to 4",
        "contact none to every 10 min",
    ]
    alone = replace(told, teamwork=Teamwork(contact_s=600.0, together=False))
    assert differences(as_json(told), as_json(alone)) == [
        "rows shared out by what is believed yes to no"
    ]


def test_of_a_member_all_is_told_that_is_not_usual():
    slow = replace(ANN.robot, row_change_s=8.0, width_m=0.5)
    late = TeamMember("Ann", slow, (35.1, 30.25), 900.0)
    assert worker_in_words(late) == (
        "Ann 4 h, 30 s a plant, 4 km/h, finds 69 %, row changes, turns and stops 8, 2 and 5 s, "
        "on foot yes, width 0.5 m, begins 15 min later, gate 35.100000, 30.250000"
    )
    said = taken_back(replace(FIRST, team=(late,)), replace(FIRST, team=(ANN,)))
    assert "gate 35.100000, 30.250000 (now Ann 4 h" in said


def test_a_robot_beside_a_team_that_stays_is_told():
    team = replace(FIRST, team=(ANN,))
    said = taken_back(replace(team, robot=Robot(hours=4)), team)
    assert said == "The last change was taken back: hours 4 (now 12 again)."


def test_members_of_a_team_are_told_one_by_one():
    two = replace(FIRST, team=team_of(2))
    said = taken_back(replace(FIRST, team=(ANN,)), two)
    assert worker_in_words(ANN) in said
    assert "robot-1 12 h" in said
    assert "robot-2 12 h" in said
