"""Which clock counts: a robot's own where it can be true, and none goes backwards."""

import pytest

from fieldmon.drive.vda5050.robot_clock import RobotClock


@pytest.mark.parametrize("odd", ["nan", "inf", "1.79e9", "-5", "noon"])
def test_a_clock_that_counts_no_day_is_said_once_and_ours_goes_on(odd):
    said = []
    clock = RobotClock(said.append)
    clock.begin(100.0)
    assert clock.result_s("110") == 110.0
    assert 110.0 <= clock.result_s(odd) <= clock.result_s(odd) < 86_400.0
    assert clock.result_s("86400") == 86_400.0
    assert [odd in one for one in said] == [True]


def test_a_clock_that_is_hours_ahead_with_the_first_result_is_said_once():
    said = []
    clock = RobotClock(said.append)
    clock.begin(0.0)
    assert [clock.result_s("9000"), clock.result_s("20000")] == [9000.0, 20_000.0]
    assert ["2.5 h more of the day" in one for one in said] == [True]


def test_the_clock_of_a_robot_that_was_started_anew_is_counted_on_and_said():
    said = []
    clock = RobotClock(said.append)
    clock.begin(3600.0)
    first = clock.result_s("40.0")
    assert first >= 3600.0
    assert [clock.result_s(told) - first for told in ("70.5", "95.0", None)][:2] == [30.5, 55.0]
    assert ["behind the last result" in one for one in said] == [True]


def test_a_clock_that_goes_back_within_the_day_is_counted_on_each_time_and_said_once():
    said = []
    clock = RobotClock(said.append)
    clock.begin(0.0)
    assert [clock.result_s(told) for told in (40, 85, 1478.7)] == [40.0, 85.0, 1478.7]
    for told, later in ((5, (50, 95)), (3, (63, 1400))):
        before = clock.result_s(None)
        there = clock.state_s({"information": [{"infoType": "day_s", "infoDescription": "2"}]})
        first = clock.result_s(told)
        assert before <= there <= first < before + 60.0
        assert [clock.result_s(one) - first for one in later] == pytest.approx(
            [one - told for one in later]
        )
    assert ["went back" in one for one in said] == [True]
