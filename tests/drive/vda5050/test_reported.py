"""What is read from a robot's state."""

from datetime import UTC, datetime, timedelta

import pytest

from fieldmon.drive.vda5050.reported import Reported
from tests.drive.vda5050.bodies import STATE

SENT = datetime(2026, 7, 1, 6, tzinfo=UTC)
FATAL = {"errorType": "wheel", "errorLevel": "FATAL"}


def reported(order_id="day", **more):
    return Reported({**STATE, "timestamp": SENT.isoformat(), **more}, order_id)


def test_what_is_left_of_our_own_order_keeps_no_robot_busy():
    assert not reported().is_busy()
    assert reported("next day").is_busy()
    assert not reported("next day", nodeStates=[], edgeStates=[]).is_busy()
    running = [{"actionId": "a0", "actionStatus": "RUNNING"}]
    assert reported("next day", nodeStates=[], edgeStates=[], actionStates=running).is_busy()


@pytest.mark.parametrize(
    ("order_id", "began_s", "ends"),
    [("day", 60, True), ("next day", -60, True), ("next day", 60, False)],
)
def test_an_error_of_a_day_before_ends_no_day(order_id, began_s, ends):
    told = reported(order_id, errors=[FATAL]).broken(SENT + timedelta(seconds=began_s))
    assert bool(told) is ends
    assert not told or "cannot mend: wheel." in told


def test_a_warning_ends_no_day():
    assert reported().broken(SENT) == ""


def test_an_action_that_a_broken_robot_let_go_is_not_over():
    let_go = [{"actionId": "a0", "actionStatus": "FAILED"}]
    assert reported(actionStates=let_go).finished("a0", SENT) == let_go[0]
    assert reported(actionStates=let_go, errors=[FATAL]).finished("a0", SENT) is None
    assert reported(errors=[FATAL]).finished("a0", SENT) == STATE["actionStates"][0]


def test_an_earlier_update_of_an_order_is_not_the_one_that_was_sent():
    assert reported().has_taken({"orderId": "day", "orderUpdateId": 1})
    assert not reported().has_taken({"orderId": "day", "orderUpdateId": 2})
    assert not reported().has_taken({"orderId": "next day", "orderUpdateId": 0})


def test_how_an_instant_action_stands_is_that_of_this_run():
    asked = [{"actionId": "day-cancel", "actionStatus": "FINISHED"}]
    assert reported(actionStates=asked).status("cancel") == "FINISHED"
    assert reported("next day", actionStates=asked).status("cancel") is None


@pytest.mark.parametrize(("charge", "told"), [(14.97, "14.9"), (9, "9")])
def test_a_battery_that_is_too_low_is_never_rounded_to_one_that_would_do(charge, told):
    said = reported(batteryState={"batteryCharge": charge}).low(15.0)
    assert said.startswith(f"The robot's battery is at {told} %, under 15 %: ")


def test_a_battery_that_would_do_ends_no_day():
    assert reported(batteryState={"batteryCharge": 15.0}).low(15.0) == ""


def test_a_complaint_is_an_error_another_order_or_that_nothing_is_said():
    assert reported().complaint() == "; it reports: lens"
    assert "order day, which is not ours" in reported("next day", errors=[]).complaint()
    assert reported(errors=[]).complaint() == ", and does not say why"


def test_a_robot_that_is_lost_says_no_place():
    assert reported().place_m.tolist() == [[1.0, 2.0]]
    lost = {**STATE["agvPosition"], "positionInitialized": False}
    assert reported(agvPosition=lost).place_m is None
    assert reported(agvPosition=None).place_m is None
