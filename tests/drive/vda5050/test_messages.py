"""Orders and states by the rules of VDA 5050."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldmon.drive.errand import Errand
from fieldmon.drive.vda5050.messages import (
    decoded,
    encoded,
    header_of,
    home_order,
    order_of,
    result_of,
    side_of,
)
from fieldmon.drive.vda5050.rules import problems
from fieldmon.errors import ObservationError
from fieldmon.monitoring.estimates.asked_day import PlantToInspect

STOP = PlantToInspect(7, 2, 3, (35.0, 30.0), 100.0, 41.0, 0.84)
FIRST = {"orderId": "day", "orderUpdateId": 0, "node": None, "strays_m": 0.1}


def line(*corners):
    return np.array(corners, float)


def errand(*ahead):
    return Errand(1, STOP, line((0, 0), (5, 0), (5, 3)), ahead)


def as_it_is(line_m):
    return line_m


def test_the_way_to_the_plant_is_released_and_what_comes_after_is_not():
    after = (9, line((5, 3), (5, 8)))
    order, last = order_of(errand(after), as_it_is, FIRST, "a1")
    assert [node["released"] for node in order["nodes"]] == [True, True, True, False]
    assert [edge["released"] for edge in order["edges"]] == [True, True, False]
    assert last == order["nodes"][2]
    (look,) = last["actions"]
    assert (look["actionType"], look["blockingType"], look["actionId"]) == (
        *("inspectPlant", "HARD", "a1"),
    )
    told = {one["key"]: one["value"] for one in look["actionParameters"]}
    assert told == {"plant": 7, "row": 2, "number": 3, "seconds": 41.0}


@pytest.mark.parametrize(
    ("plant_m", "side"),
    [((4, 3), "left"), ((6.5, 2.5), "right"), ((5.01, 4.5), "ahead"), ((9, 9), "")],
)
def test_an_order_says_where_a_plant_stands_and_on_which_side(plant_m, side):
    way, plant_m = errand().line_m, np.array(plant_m, float)
    assert side in {"", side_of(plant_m, way[-1], way[-1] - way[-2])}
    order, _ = order_of(errand(), as_it_is, FIRST, "a1", (plant_m, side))
    look = order["nodes"][-1]["actions"][0]["actionParameters"]
    told = {one["key"]: one["value"] for one in look}
    assert (told["x"], told["y"], told.get("side", "")) == (*plant_m, side)


def test_an_order_says_seconds_as_people_do():
    stop = STOP._replace(inspect_s=130.0 - 88.87)
    assert stop.inspect_s != 41.13
    for stop_s, seconds in ((0.0, 41.13), (1.13, 40.0)):  # it stops besides
        asked = errand()._replace(stop=stop, stop_s=stop_s)
        order, _ = order_of(asked, as_it_is, FIRST, "a1")
        told = order["nodes"][-1]["actions"][0]["actionParameters"]
        assert [one["value"] for one in told if one["key"] == "seconds"] == [seconds]


def test_an_update_begins_at_the_last_released_node_and_goes_on_counting():
    _, last = order_of(errand(), as_it_is, FIRST, "a1")
    known = FIRST | {"orderUpdateId": 1, "node": {**last, "actions": []}}
    order, _ = home_order(line((5, 3), (0, 3)), as_it_is, known)
    assert order["nodes"][0]["nodeId"] == last["nodeId"]
    assert [node["sequenceId"] for node in order["nodes"]] == [4, 6]
    assert [edge["sequenceId"] for edge in order["edges"]] == [5]
    assert order["nodes"][0]["actions"] == []


@settings(max_examples=20)
@given(n=st.integers(2, 6), ahead=st.integers(0, 2))
def test_every_order_keeps_the_rules(n, ahead):
    way = np.cumsum(np.ones((n, 2)), axis=0)
    after = tuple((k, way[-1] + np.array([[0, 0], [k + 1.0, 0]])) for k in range(ahead))
    order, _ = order_of(Errand(1, STOP, way, after), as_it_is, FIRST, "a")
    header = header_of("fieldmon", "r1")
    message = json.loads(encoded("order", header, order))
    assert problems("order", message) == []
    ids = [one["sequenceId"] for one in (*message["nodes"], *message["edges"])]
    assert sorted(ids) == list(range(len(ids)))  # nodes even, edges odd, none left out
    for edge, a, b in zip(message["edges"], message["nodes"], message["nodes"][1:], strict=False):
        assert (edge["startNodeId"], edge["endNodeId"]) == (a["nodeId"], b["nodeId"])


def test_headers_count_on():
    header = header_of("fieldmon", "r1")
    counted = [
        json.loads(encoded("connection", header, {"connectionState": "ONLINE"}))["headerId"]
        for _ in range(3)
    ]
    assert counted == [1, 2, 3]


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"{", "must be JSON"),
        (b"[]", "is no object"),
        (b'{"headerId": 1}', "connectionState is missing"),
        (b'{"headerId": true, "connectionState": "GONE"}', "none of ONLINE"),
    ],
)
def test_a_message_that_is_none_is_refused_with_what_is_wrong(data, said):
    with pytest.raises(ObservationError, match=said):
        decoded("connection", data)


def test_what_is_nested_is_looked_at_too():
    order, _ = order_of(errand(), as_it_is, FIRST, "a1")
    message = json.loads(encoded("order", header_of("fieldmon", "r1"), order))
    message["nodes"][2]["actions"][0]["blockingType"] = "MAYBE"
    del message["edges"][0]["endNodeId"]
    assert len(problems("order", message)) == 2


@pytest.mark.parametrize(
    ("said", "found"),
    [
        *(("true", True), ("1", True), ("1.0", True), ('"true"', True), ('" Yes"', True)),
        *(("false", False), ("0", False), ('"no"', False), ("null", None)),
    ],
)
def test_a_result_that_is_plain_is_read(said, found):
    result = result_of({"resultDescription": f'{{"found": {said}, "plant": "7"}}'}, 7)
    assert result == (found, None, "")


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ('{"found": []}', "but it is []"),
        ('{"found": ""}', "but it is ''"),
        ('{"found": 2}', "but it is 2"),
        ('{"found": "infested"}', "true, false or null as found, but it is 'infested'"),
        ('{"plant": 7}', """must be JSON as {"found": true}, but it is '{"plant": 7}'"""),
        ("found", "but it is 'found'"),
        (None, "but it is ''"),
        ('{"found": true, "plant": 9999}', "must be of plant 7, but it names plant 9999"),
    ],
)
def test_a_result_that_is_not_plain_is_refused_with_what_is_wrong(text, wrong):
    action = {} if text is None else {"resultDescription": text}
    result = result_of(action, 7)
    assert result.found is None
    assert wrong in result.wrong
