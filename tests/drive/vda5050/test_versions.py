"""Version 3.0 is written and read by a map of fields."""

import copy
import json

import pytest

from fieldmon.drive.vda5050.messages import decoded, encoded, header_of
from fieldmon.drive.vda5050.rules import problems
from fieldmon.drive.vda5050.versions import as_heard, as_sent, known_version
from fieldmon.errors import ObservationError, SettingError
from tests.drive.vda5050.bodies import CONNECTION, ORDER, STATE

BROKEN = {"connectionState": "CONNECTIONBROKEN"}
BODIES = {"order": ORDER, "state": STATE, "connection": BROKEN}


@pytest.mark.parametrize("kind", BODIES)
def test_what_is_written_as_3_0_keeps_its_rules_and_comes_back_as_it_was(kind):
    header = header_of("fieldmon", "r1", "3.0")
    data = encoded(kind, header, BODIES[kind])
    message = json.loads(data)
    assert message["version"] == "3.0.0"
    assert problems(kind, message, "3.0") == []
    back = decoded(kind, data)
    for name, value in BODIES[kind].items():
        if name != "edges":  # their ends are not said in 3.0: they follow from the order
            assert back[name] == value


@pytest.mark.parametrize("kind", BODIES)
def test_the_two_versions_are_not_taken_for_one_another(kind):
    here = json.loads(encoded(kind, header_of("fieldmon", "r1"), BODIES[kind]))
    later = json.loads(encoded(kind, header_of("fieldmon", "r1", "3.0"), BODIES[kind]))
    assert problems(kind, here, "2.1") == []
    assert problems(kind, here, "3.0")
    assert problems(kind, later, "2.1")


def test_fields_have_the_names_of_the_tables():
    """Tables of VDA 5050 3.0.0, chapter 6 (order, state, connection)."""
    state = as_sent("state", copy.deepcopy(STATE), "3.0")
    assert state["powerSupply"] == {"stateOfCharge": 80.0, "charging": False}
    assert state["mobileRobotPosition"]["localized"] is True
    assert state["actionStates"][0]["actionResult"] == '{"found": true}'
    assert state["safetyState"]["activeEmergencyStop"] == "NONE"
    assert state["information"][0]["infoDescriptor"] == "12.5"
    assert state["instantActionStates"] == []
    order = as_sent("order", copy.deepcopy(ORDER), "3.0")
    place = order["nodes"][0]["nodePosition"]
    assert place["allowedDeviationXY"] == {"a": 0.3, "b": 0.3, "theta": 0.0}
    assert "startNodeId" not in order["edges"][0]
    broken = as_sent("connection", dict(BROKEN), "3.0")
    assert broken == {"connectionState": "CONNECTION_BROKEN"}


def test_what_is_done_at_once_is_told_apart_in_3_0_only():
    ended = {"actionId": "c", "actionType": "cancelOrder", "actionStatus": "FINISHED"}
    actions = [*STATE["actionStates"], ended]
    header = header_of("fieldmon", "r1", "3.0")
    data = encoded("state", header, STATE | {"actionStates": actions})
    message = json.loads(data)
    assert [one["actionId"] for one in message["actionStates"]] == ["a0"]
    assert message["instantActionStates"] == [ended]
    assert decoded("state", data)["actionStates"] == actions


def test_the_stricter_radius_of_an_ellipse_is_taken():
    order = as_sent("order", copy.deepcopy(ORDER), "3.0")
    order["nodes"][0]["nodePosition"]["allowedDeviationXY"]["b"] = 0.1
    assert as_heard("order", order, "3.0")["nodes"][0]["nodePosition"]["allowedDeviationXY"] == 0.1


@pytest.mark.parametrize(
    ("text", "version"), [("2.1.0", "2.1"), ("2.0.0", "2.1"), ("3.0", "3.0"), ("3.0.1", "3.0")]
)
def test_versions_are_known_by_what_headers_say(text, version):
    assert known_version(text) == version


@pytest.mark.parametrize("text", ["1.1.0", "4.0", "", "new"])
def test_other_versions_are_refused_in_a_sentence(text):
    with pytest.raises(SettingError, match=r"2\.0, 2\.1 or 3\.0"):
        known_version(text)
    data = encoded("connection", header_of("fieldmon", "r1"), CONNECTION)
    with pytest.raises(ObservationError, match="cannot be read"):
        decoded("connection", data.replace(b'"2.1.0"', json.dumps(text).encode()))
