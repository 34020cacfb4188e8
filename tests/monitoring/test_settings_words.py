"""What a change of a season did, in words."""

from dataclasses import replace
from datetime import date, time

import pytest

from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring import MonitoringSettings
from fieldmon.monitoring.settings_words import taken_back, worker_in_words
from fieldmon.planning.members import TeamMember, team_of
from fieldmon.plot.robot import Robot, scout

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


def test_members_of_a_team_are_told_one_by_one():
    two = replace(FIRST, team=team_of(2))
    said = taken_back(replace(FIRST, team=(ANN,)), two)
    assert worker_in_words(ANN) in said
    assert "robot-1 12 h" in said
    assert "robot-2 12 h" in said
