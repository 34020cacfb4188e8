"""Messages of VDA 5050, version 2.1: made here, and checked on both ways.

The rules are those of the standard's JSON schemas (VDA 5050, 2.1.0, January 2025), as far as its
fields are used here: what must be there, of which type, and which words an enumeration knows.
"""

from __future__ import annotations

import json
from datetime import UTC, datetime
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from fieldmon.errors import ObservationError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.drive.errand import Errand

    Float = NDArray[np.float64]

VERSION = "2.1.0"
ACTION = "inspectPlant"
MAP = "map"
_DEVIATION_M = 0.3
_NUMBER = (int, float)
_HEADER: dict[str, Any] = {
    "headerId": int, "timestamp": str, "version": str, "manufacturer": str, "serialNumber": str,
}  # fmt: skip
_ACTION: dict[str, Any] = {
    "actionId": str, "actionType": str, "blockingType": ("NONE", "SOFT", "HARD"),
}  # fmt: skip
#: what each message must hold: a type, the words of an enumeration, or what each of a list holds
RULES: dict[str, dict[str, Any]] = {
    "order": _HEADER
    | {
        "orderId": str,
        "orderUpdateId": int,
        "nodes": [{"nodeId": str, "sequenceId": int, "released": bool, "actions": [_ACTION]}],
        "edges": [
            {
                "edgeId": str,
                "sequenceId": int,
                "released": bool,
                "startNodeId": str,
                "endNodeId": str,
                "actions": [_ACTION],
            }
        ],
    },
    "state": _HEADER
    | {
        "orderId": str,
        "orderUpdateId": int,
        "lastNodeId": str,
        "lastNodeSequenceId": int,
        "driving": bool,
        "nodeStates": [{"nodeId": str, "sequenceId": int, "released": bool}],
        "edgeStates": [{"edgeId": str, "sequenceId": int, "released": bool}],
        "actionStates": [
            {
                "actionId": str,
                "actionStatus": (
                    *("WAITING", "INITIALIZING", "RUNNING", "PAUSED", "FINISHED", "FAILED"),
                ),
            }
        ],
        "batteryState": {"batteryCharge": _NUMBER, "charging": bool},
        "operatingMode": ("AUTOMATIC", "SEMIAUTOMATIC", "MANUAL", "SERVICE", "TEACHIN"),
        "errors": [{"errorType": str, "errorLevel": ("WARNING", "FATAL")}],
        "safetyState": {
            "eStop": ("AUTOACK", "MANUAL", "REMOTE", "NONE"),
            "fieldViolation": bool,
        },
    },
    "connection": _HEADER | {"connectionState": ("ONLINE", "OFFLINE", "CONNECTIONBROKEN")},
    "instantActions": _HEADER | {"actions": [_ACTION]},
}


def encoded(kind: str, header: dict[str, Any], body: dict[str, Any]) -> bytes:
    """Return a message as it goes over the wire, checked; `header` is changed: it counts on."""
    header["headerId"] += 1
    now = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
    message = {**header, "timestamp": now, **body}
    if wrong := problems(kind, message):
        raise ValueError("; ".join(wrong))  # a mistake of ours
    return json.dumps(message, separators=(",", ":")).encode()


def decoded(kind: str, data: bytes) -> dict[str, Any]:
    """Return a message from the wire; raise `ObservationError` where it is none of the standard."""
    try:
        message = json.loads(data)
    except ValueError as error:
        raise ObservationError(f"A message {kind!r} must be JSON, but it is not.") from error
    if wrong := problems(kind, message):
        raise ObservationError(
            f"A message {kind!r} must be as VDA 5050 {VERSION} has it, but {'; '.join(wrong)}."
        )
    held: dict[str, Any] = message
    return held


def problems(kind: str, message: object) -> list[str]:
    """Return what is wrong with a message, a clause each."""
    found: list[str] = []
    _check(RULES[kind], message, kind, found.append)
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
    elif not isinstance(value, rule) or (isinstance(value, bool) and rule is not bool):
        say(f"{where} is {value!r}")


def _check_object(
    rule: dict[str, Any], value: object, where: str, say: Callable[[str], None]
) -> None:
    if not isinstance(value, dict):
        say(f"{where} is no object")
        return
    for name, inner in rule.items():
        if name in value:
            _check(inner, value[name], f"{where}.{name}", say)
        else:
            say(f"{where}.{name} is missing")


def header_of(manufacturer: str, serial: str) -> dict[str, Any]:
    """Return the header of a robot's messages, before the first one."""
    return {
        "headerId": 0,
        "timestamp": "",
        "version": VERSION,
        "manufacturer": manufacturer,
        "serialNumber": serial,
    }


def order_of(
    errand: Errand, places: Callable[[Float], Float], known: dict[str, Any], action_id: str
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return an order for an errand, and its last released node, at which the next one begins.

    Parameters
    ----------
    errand
        The way to the plant is the base; what comes after it, the horizon.
    places
        Plot's metres ``(k, 2)`` to metres east and north of the datum.
    known
        ``orderId``, ``orderUpdateId``, and as ``node`` the last released node of the order before;
        None: there was none.
    action_id
        Name of the inspection.
    """
    look = {
        "actionId": action_id,
        "actionType": ACTION,
        "blockingType": "HARD",
        "actionParameters": [
            {"key": "plant", "value": errand.stop.plant},
            {"key": "row", "value": errand.stop.row},
            {"key": "number", "value": errand.stop.number},
            {"key": "seconds", "value": errand.stop.inspect_s},
        ],
    }
    return _order([(errand.line_m, [look]), *((line, []) for _, line in errand.ahead)],
                  places, known)  # fmt: skip


def home_order(
    line_m: Float, places: Callable[[Float], Float], known: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return an order for the way back to the gate, and its last node."""
    return _order([(line_m, [])], places, known)


def _order(
    legs: Sequence[tuple[Float, list[dict[str, Any]]]],
    places: Callable[[Float], Float],
    known: dict[str, Any],
) -> tuple[dict[str, Any], dict[str, Any]]:
    nodes: list[dict[str, Any]] = []
    last = known["node"]
    if last is not None:
        nodes.append(last)
    begins = 0 if last is None else 1
    for k, (line_m, actions) in enumerate(legs):
        corners = places(line_m).tolist()
        for corner in corners[begins if k == 0 else 1 :]:
            nodes.append(_node(corner, nodes[-1]["sequenceId"] + 2 if nodes else 0, k == 0))
        nodes[-1]["actions"] = [*nodes[-1]["actions"], *actions]
        if k == 0:
            base_ends = len(nodes) - 1
    order = {
        "orderId": known["orderId"],
        "orderUpdateId": known["orderUpdateId"],
        "nodes": nodes,
        "edges": [_edge(a, b) for a, b in pairwise(nodes)],
    }
    return order, nodes[base_ends]


def _node(place: list[float], sequence: int, released: bool) -> dict[str, Any]:  # noqa: FBT001
    x, y = place
    return {
        "nodeId": f"n{sequence}",
        "sequenceId": sequence,
        "released": released,
        "nodePosition": {
            "x": round(x, 3) + 0.0,
            "y": round(y, 3) + 0.0,
            "mapId": MAP,
            "allowedDeviationXY": _DEVIATION_M,
        },
        "actions": [],
    }


def _edge(a: dict[str, Any], b: dict[str, Any]) -> dict[str, Any]:
    sequence = a["sequenceId"] + 1
    return {
        "edgeId": f"e{sequence}",
        "sequenceId": sequence,
        "released": b["released"],
        "startNodeId": a["nodeId"],
        "endNodeId": b["nodeId"],
        "actions": [],
    }
