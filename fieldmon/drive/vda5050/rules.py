"""What a message of VDA 5050 must hold: rules of our own, written from the standard's tables.

VDA 5050, versions 2.1.0 (January 2025) and 3.0.0 (2026), chapter 6, as far as fields are used here.
The VDA's own schema files are not in this repository; tests hold messages of 2.1 to them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

Rules = dict[str, dict[str, Any]]

_NUMBER, _ANY = (int, float), (str, int, float, list, dict, bool)
_HEADER: dict[str, Any] = {
    "headerId": int, "timestamp": str, "version": str, "manufacturer": str, "serialNumber": str,
}  # fmt: skip
_PLACE: dict[str, Any] = {"x": _NUMBER, "y": _NUMBER, "mapId": str, "theta?": _NUMBER}
_NODE: dict[str, Any] = {"nodeId": str, "sequenceId": int, "released": bool}
_EDGE: dict[str, Any] = {"edgeId": str, "sequenceId": int, "released": bool}
_STATUS = ("WAITING", "INITIALIZING", "RUNNING", "PAUSED", "FINISHED", "FAILED")


def _action(*blocking: str) -> dict[str, Any]:
    return {
        "actionId": str,
        "actionType": str,
        "blockingType": blocking,
        "actionParameters?": [{"key": str, "value": _ANY}],
    }


def _order(action: dict[str, Any], deviation: object, ends: dict[str, Any]) -> dict[str, Any]:
    place = _PLACE | {"allowedDeviationXY?": deviation}
    return _HEADER | {
        "orderId": str,
        "orderUpdateId": int,
        "nodes": [_NODE | {"nodePosition?": place, "actions": [action]}],
        "edges": [_EDGE | ends | {"actions": [action]}],
    }


def _state(modes: tuple[str, ...], levels: tuple[str, ...], own: dict[str, Any]) -> dict[str, Any]:
    common = {
        "orderId": str,
        "orderUpdateId": int,
        "lastNodeId": str,
        "lastNodeSequenceId": int,
        "driving": bool,
        "paused?": bool,
        "nodeStates": [_NODE],
        "edgeStates": [_EDGE],
        "operatingMode": modes,
        "errors": [{"errorType": str, "errorLevel": levels, "errorDescription?": str}],
    }
    return _HEADER | common | own


_ACTION_2, _ACTION_3 = _action("NONE", "SOFT", "HARD"), _action("NONE", "SINGLE", "SOFT", "HARD")
_AT_ONCE = _action("NONE")
_MODES_2 = ("AUTOMATIC", "SEMIAUTOMATIC", "MANUAL", "SERVICE", "TEACHIN")
_MODES_3 = ("STARTUP", "AUTOMATIC", "SEMIAUTOMATIC", "INTERVENED", "MANUAL", "SERVICE", "TEACH_IN")
_POSE_2 = {"agvPosition?": _PLACE | {"theta": _NUMBER, "positionInitialized": bool}}
_POSE_3 = {"mobileRobotPosition?": _PLACE | {"theta": _NUMBER, "localized": bool}}
_STATE_2 = _POSE_2 | {
    "actionStates": [{"actionId": str, "actionStatus": _STATUS, "resultDescription?": str}],
    "batteryState": {"batteryCharge": _NUMBER, "charging": bool},
    "safetyState": {"eStop": ("AUTOACK", "MANUAL", "REMOTE", "NONE"), "fieldViolation": bool},
    "information?": [
        {"infoType": str, "infoLevel": ("INFO", "DEBUG"), "infoDescription?": str},
    ],
}
_DONE_3 = {"actionId": str, "actionStatus": (*_STATUS, "RETRIABLE"), "actionResult?": str}
_STATE_3 = _POSE_3 | {
    "actionStates": [_DONE_3],
    "instantActionStates": [_DONE_3],
    "powerSupply": {"stateOfCharge": _NUMBER, "charging": bool},
    "safetyState": {"activeEmergencyStop": ("MANUAL", "REMOTE", "NONE"), "fieldViolation": bool},
    "information?": [
        {"infoType": str, "infoLevel": ("INFO", "DEBUG"), "infoDescriptor?": str},
    ],
}
_ELLIPSE = {"a": _NUMBER, "b": _NUMBER, "theta": _NUMBER}

#: by version and kind: a type, the words of an enumeration, what each of a list holds, or what an
#: object must hold; a name that ends in "?" may be left out
RULES: dict[str, Rules] = {
    "2.1": {
        "order": _order(_ACTION_2, _NUMBER, {"startNodeId": str, "endNodeId": str}),
        "state": _state(_MODES_2, ("WARNING", "FATAL"), _STATE_2),
        "connection": _HEADER | {"connectionState": ("ONLINE", "OFFLINE", "CONNECTIONBROKEN")},
        "instantActions": _HEADER | {"actions": [_ACTION_2]},
        "visualization": _HEADER | _POSE_2,
    },
    "3.0": {
        "order": _order(_ACTION_3, _ELLIPSE, {}),
        "state": _state(_MODES_3, ("WARNING", "URGENT", "CRITICAL", "FATAL"), _STATE_3),
        "connection": _HEADER
        | {"connectionState": ("ONLINE", "OFFLINE", "HIBERNATING", "CONNECTION_BROKEN")},
        "instantActions": _HEADER | {"actions": [_AT_ONCE]},
        "visualization": _HEADER | _POSE_3,
    },
}


def problems(kind: str, message: object, version: str = "2.1") -> list[str]:
    """Return what is wrong with a message, a clause each.

    Examples
    --------
    >>> problems("connection", {"connectionState": "GONE"})[-1]
    "connection.connectionState is 'GONE', which is none of ONLINE, OFFLINE, CONNECTIONBROKEN"
    """
    found: list[str] = []
    _check(RULES[version][kind], message, kind, found.append)
    return found


def _check(rule: Any, value: object, where: str, say: Callable[[str], None]) -> None:  # noqa: ANN401
    if isinstance(rule, dict):
        _check_object(rule, value, where, say)
    elif isinstance(rule, list):
        if not isinstance(value, list):
            say(f"{where} is no list")
            return
        for k, one in enumerate(value):
            _check(rule[0], one, f"{where}[{k}]", say)
    elif isinstance(rule, tuple) and isinstance(rule[0], str):
        if value not in rule:
            say(f"{where} is {value!r}, which is none of {', '.join(rule)}")
    elif not isinstance(value, rule) or (isinstance(value, bool) and rule in (int, _NUMBER)):
        say(f"{where} is {value!r}")


def _check_object(
    rule: dict[str, Any], value: object, where: str, say: Callable[[str], None]
) -> None:
    if not isinstance(value, dict):
        say(f"{where} is no object")
        return
    for name, inner in rule.items():
        plain = name.removesuffix("?")
        if plain in value:
            _check(inner, value[plain], f"{where}.{plain}", say)
        elif plain == name:
            say(f"{where}.{name} is missing")
