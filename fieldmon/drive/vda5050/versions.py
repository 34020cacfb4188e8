"""Versions of VDA 5050: here all is said as in 2.1, and 3.0 is written and read by a map of fields.

Of 3.0 what 2.1 has is spoken: zones, shared paths, requests and responses are not used.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    Message = dict[str, Any]

USUAL_VERSION = "2.1"
#: by version: what stands in a header, and what topics begin with
VERSIONS = {"2.1": ("2.1.0", "uagv/v2"), "3.0": ("3.0.0", "vda5050/v3")}

#: actions that a robot is asked for beside its order, and does at once
AT_ONCE = {"startPause", "stopPause", "stateRequest", "cancelOrder"}


class _Field(NamedTuple):
    """A field that has another name, or another form, in 3.0.

    Parameters
    ----------
    where
        Names of the objects and lists that it is in.
    now, later
        Its name in 2.1 and in 3.0; None: it is not there.
    words
        Words of its enumeration that differ: 2.1 to 3.0.
    written, read
        Its value from 2.1 to 3.0, and back.
    """

    where: tuple[str, ...]
    now: str | None
    later: str | None
    words: Mapping[str, str] = {}
    written: Callable[[Any], Any] = lambda value: value
    read: Callable[[Any], Any] = lambda value: value


def _ellipse(radius_m: float) -> Message:
    return {"a": radius_m, "b": radius_m, "theta": 0.0}


def _radius(ellipse: Message) -> float:
    return float(min(ellipse["a"], ellipse["b"]))


#: from the tables of both versions; deepest first, so that a place is found under its name of 2.1
MAP_OF_FIELDS: dict[str, tuple[_Field, ...]] = {
    "order": (
        _Field(("nodes", "nodePosition"), "allowedDeviationXY", "allowedDeviationXY", {},
               _ellipse, _radius),
        _Field(("edges",), "startNodeId", None),
        _Field(("edges",), "endNodeId", None),
    ),
    "state": (
        _Field(("batteryState",), "batteryCharge", "stateOfCharge"),
        _Field(("agvPosition",), "positionInitialized", "localized"),
        _Field(("actionStates",), "resultDescription", "actionResult"),
        _Field(("information",), "infoDescription", "infoDescriptor"),
        _Field(("safetyState",), "eStop", "activeEmergencyStop", {"AUTOACK": "MANUAL"}),
        _Field((), "operatingMode", "operatingMode", {"TEACHIN": "TEACH_IN"}),
        _Field((), "batteryState", "powerSupply"),
        _Field((), "agvPosition", "mobileRobotPosition"),
    ),
    "connection": (
        _Field((), "connectionState", "connectionState", {"CONNECTIONBROKEN": "CONNECTION_BROKEN"}),
    ),
    "visualization": (
        _Field(("agvPosition",), "positionInitialized", "localized"),
        _Field((), "agvPosition", "mobileRobotPosition"),
    ),
    "instantActions": (),
}  # fmt: skip


def known_version(text: str) -> str:
    """Return a version as it is known here, "2.1" or "3.0".

    Raises
    ------
    SettingError
        If it is another one.

    Examples
    --------
    >>> known_version("3.0.0")
    '3.0'
    """
    found = re.match(r"(2)(?:\.[01])?(?:\.\d+)?$|(3)(?:\.\d+)*$", text.strip())
    if found is None:
        raise SettingError(
            f"A version of VDA 5050 must be 2.0, 2.1 or 3.0 here, but it is {text!r}."
        )
    return "2.1" if found.group(1) else "3.0"


def as_sent(kind: str, message: Message, version: str) -> Message:
    """Return a message of 2.1 as a version has it; the given one may be changed."""
    if version == USUAL_VERSION:
        return message
    for one in MAP_OF_FIELDS[kind]:
        for inside in _places(message, one.where):
            if one.now in inside:
                value = inside.pop(one.now)
                if one.later is not None:
                    inside[one.later] = one.written(_in_other_words(value, one.words))
    if kind == "state":
        told = message["actionStates"]
        message["actionStates"] = [one for one in told if one.get("actionType") not in AT_ONCE]
        message["instantActionStates"] = [one for one in told if one.get("actionType") in AT_ONCE]
    return message


def as_heard(kind: str, message: Message, version: str) -> Message:
    """Return a message of a version as 2.1 has it; the given one may be changed.

    What 2.1 has no word for stays as it is.
    """
    if version == USUAL_VERSION:
        return message
    if kind == "state":  # 2.1 has one list of both
        message["actionStates"] = [*message["actionStates"], *message.pop("instantActionStates")]
    for one in reversed(MAP_OF_FIELDS[kind]):
        back = {later: now for now, later in one.words.items() if now != "AUTOACK"}
        for inside in _places(message, one.where):
            if one.now is not None and one.later is not None and one.later in inside:
                value = inside.pop(one.later)
                inside[one.now] = one.read(_in_other_words(value, back))
    return message


def _in_other_words(value: Any, words: Mapping[str, str]) -> Any:  # noqa: ANN401 - any value
    return words.get(value, value) if isinstance(value, str) else value


def _places(message: Message, where: tuple[str, ...]) -> list[Message]:
    """Return the objects at a place; a list stands for each of its objects."""
    found: list[Message] = [message]
    for name in where:
        inner = [one[name] for one in found if name in one]
        found = [one for held in inner for one in (held if isinstance(held, list) else [held])]
    return found
