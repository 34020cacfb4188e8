"""Rules of our own for messages, held to the VDA's published schemas of 2.1."""

import copy
import json
from importlib import resources

import jsonschema
import pytest

from fieldmon.drive.vda5050.messages import encoded, header_of
from fieldmon.drive.vda5050.rules import RULES, problems
from tests.drive.vda5050.bodies import CONNECTION, ORDER, STATE

BODIES = {"order": ORDER, "state": STATE, "connection": CONNECTION}


@pytest.fixture(scope="session")
def published():
    """Return what checks a message by the VDA's schema of its kind, from a package of the tests."""
    folder = resources.files("vda5050.validation") / "schemas"
    return {
        kind: jsonschema.Draft202012Validator(json.loads((folder / f"{kind}.json").read_text()))
        for kind in RULES["2.1"]
    }


def message_of(kind):
    return json.loads(encoded(kind, header_of("fieldmon", "r1"), BODIES[kind]))


def everything_in(value, way=()):
    """Yield the way to every value of a message."""
    inner = value.items() if isinstance(value, dict) else enumerate(value)
    for name, one in inner:
        yield (*way, name)
        if isinstance(one, (dict, list)):
            yield from everything_in(one, (*way, name))


def spoilt(message, way, spoil):
    bad = copy.deepcopy(message)
    inside = bad
    for name in way[:-1]:
        inside = inside[name]
    spoil(inside, way[-1])
    return bad


@pytest.mark.parametrize("kind", BODIES)
def test_our_messages_are_right_by_the_published_schemas(published, kind):
    assert list(published[kind].iter_errors(message_of(kind))) == []


@pytest.mark.parametrize("kind", BODIES)
def test_whatever_is_left_out_or_spoilt_is_wrong_by_ours_if_it_is_by_theirs(published, kind):
    """Every field of a message left out in turn, and made a thing that it is not."""
    message, refused = message_of(kind), 0

    def gone(inside, name):
        del inside[name]

    def other(inside, name):
        inside[name] = None

    for way in everything_in(message):
        for spoil in (gone, other):
            if isinstance(way[-1], int) and spoil is gone:
                continue
            bad = spoilt(message, way, spoil)
            theirs = not published[kind].is_valid(bad)
            ours = bool(problems(kind, bad))
            refused += theirs
            assert ours or not theirs, way
    assert refused > 5


def test_a_truth_is_no_number_and_a_number_no_word():
    message = message_of("state")
    message["lastNodeSequenceId"] = True
    message["batteryState"]["batteryCharge"] = False
    message["orderId"] = 3
    assert len(problems("state", message)) == 3
