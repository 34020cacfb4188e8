"""Messages of VDA 5050: made here as 2.1 has them, and checked on both ways as they are sent."""

from __future__ import annotations

import copy
import json
import math
from datetime import UTC, datetime
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from fieldmon.drive.vda5050.rules import problems
from fieldmon.drive.vda5050.versions import (
    USUAL_VERSION,
    VERSIONS,
    as_heard,
    as_sent,
    known_version,
)
from fieldmon.errors import ObservationError, SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.drive.errand import Errand

    Float = NDArray[np.float64]

ACTION = "inspectPlant"
#: how an action stands that is through
OVER = frozenset({"FINISHED", "FAILED"})
#: information of a robot that is simulated, faster than the clock: how many times
FASTER = "faster"
MAP = "map"
#: what was sent so much before what was heard last is not late: a clock was put back
LATE_S = 60.0
# what is less to the side stands ahead
_AHEAD_M = 0.05
# words for true and false
_PLAIN = {"true": 1, "yes": 1, "1": 1, "false": 0, "no": 0, "0": 0}


def encoded(kind: str, header: dict[str, Any], body: dict[str, Any]) -> bytes:
    """Return a message as it goes over the wire, checked; `header` is changed: it counts on.

    The body is said as in 2.1 and written as the header's version has it.
    """
    header["headerId"] += 1
    version = known_version(header["version"])
    now = datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
    message = as_sent(kind, {**header, "timestamp": now, **_copy(body, version)}, version)
    if wrong := problems(kind, message, version):
        raise ValueError("; ".join(wrong))  # a mistake of ours
    return json.dumps(message, separators=(",", ":")).encode()


def _copy(body: dict[str, Any], version: str) -> dict[str, Any]:
    """Return a body that may be changed, where that is needed."""
    return body if version == USUAL_VERSION else copy.deepcopy(body)


def decoded(kind: str, data: bytes) -> dict[str, Any]:
    """Return a message from the wire, as 2.1 has it.

    Raises
    ------
    ObservationError
        If it is none of the standard's, in the version that it names.
    """
    try:
        message = json.loads(data)
    except ValueError as error:
        raise ObservationError(f"A message {kind!r} must be JSON, but it is not.") from error
    said = (
        str(message.get("version", USUAL_VERSION)) if isinstance(message, dict) else USUAL_VERSION
    )
    try:
        version = known_version(said)
    except SettingError as error:
        raise ObservationError(f"A message {kind!r} cannot be read. {error}") from error
    wrong = problems(kind, message, version)
    if wrong or _moment(message["timestamp"]) is None:
        wrong = wrong or [f"{kind}.timestamp is {message['timestamp']!r}"]
        raise ObservationError(
            f"A message {kind!r} must be as VDA 5050 {version} has it, but {'; '.join(wrong)}."
        )
    return as_heard(kind, message, version)


def is_stopped(state: dict[str, Any]) -> bool:
    """Return whether somebody has stopped the robot of a state, or drives it by hand."""
    return bool(state.get("paused")) or state["operatingMode"] != "AUTOMATIC"


def sent_at(message: dict[str, Any]) -> datetime:
    """Return when a message was sent, by the clock of who sent it."""
    at = _moment(message["timestamp"])
    assert at is not None  # noqa: S101 - looked at when it was read
    return at


def _moment(text: str) -> datetime | None:
    try:
        at = datetime.fromisoformat(text)
    except ValueError:
        return None
    return at.replace(tzinfo=UTC) if at.tzinfo is None else at


def header_of(manufacturer: str, serial: str, version: str = USUAL_VERSION) -> dict[str, Any]:
    """Return the header of a robot's messages, before the first one."""
    return {
        "headerId": 0,
        "timestamp": "",
        "version": VERSIONS[version][0],
        "manufacturer": manufacturer,
        "serialNumber": serial,
    }


def order_of(
    errand: Errand,
    places: Callable[[Float], Float],
    known: dict[str, Any],
    action_id: str,
    stands: tuple[Float, str] | None = None,
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return an order for an errand, and its last released node, at which the next one begins.

    Parameters
    ----------
    errand
        The way to the plant is the base; what comes after it, the horizon.
    places
        Plot's metres ``(k, 2)`` to metres east and north of the datum.
    known
        ``orderId``, ``orderUpdateId``, as ``strays_m`` how far from a node the robot may pass, and
        as ``node`` the last released node of the order before; None: there was none.
    action_id
        Name of the inspection.
    stands
        Where the plant stands, ``(2,)`` in the plot's metres, and on which side; None: not said.
    """
    look = {
        "actionId": action_id,
        "actionType": ACTION,
        "blockingType": "HARD",
        "actionParameters": [
            {"key": "plant", "value": errand.stop.plant},
            {"key": "row", "value": errand.stop.row},
            {"key": "number", "value": errand.stop.number},
            {"key": "seconds", "value": round(errand.look_s, 3)},
            *([] if stands is None else _stands(places(stands[0][None])[0], stands[1])),
        ],
    }
    return _order([(errand.line_m, [look]), *((line, []) for _, line in errand.ahead)],
                  places, known)  # fmt: skip


def side_of(plant_m: Float, at_m: Float, towards_m: Float) -> str:
    """Return on which side a plant is of who came to a place in a direction, each ``(2,)``.

    Examples
    --------
    >>> import numpy as np
    >>> from fieldmon.drive.vda5050.messages import side_of
    >>> side_of(np.array([5.0, 1.0]), np.array([5.0, 0.0]), np.array([2.0, 0.0]))
    'left'
    """
    (dx, dy), (east, north) = (plant_m - at_m).tolist(), towards_m.tolist()
    left_m = (east * dy - north * dx) / math.hypot(east, north)
    return "ahead" if abs(left_m) < _AHEAD_M else "left" if left_m > 0 else "right"


def _stands(place_m: Float, side: str) -> list[dict[str, Any]]:
    """Return the parameters that say where a plant stands."""
    (x, y), sides = place_m.round(3).tolist(), [{"key": "side", "value": side}] if side else []
    return [*sides, {"key": "x", "value": x + 0.0}, {"key": "y", "value": y + 0.0}]


def home_order(
    line_m: Float, places: Callable[[Float], Float], known: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return an order for the way back to the gate, and its last node."""
    return _order([(line_m, [])], places, known)


def at_once(action_type: str, action_id: str) -> dict[str, Any]:
    """Return what a robot is asked for beside its order: an instant action."""
    action = {"actionId": action_id, "actionType": action_type, "blockingType": "NONE"}
    return {"actions": [{**action, "actionParameters": []}]}


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
            sequence = nodes[-1]["sequenceId"] + 2 if nodes else 0
            nodes.append(_node(corner, known["strays_m"], sequence, k == 0))
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


def _node(
    place: list[float],
    strays_m: float,
    sequence: int,
    released: bool,  # noqa: FBT001
) -> dict[str, Any]:
    x, y = place
    return {
        "nodeId": f"n{sequence}",
        "sequenceId": sequence,
        "released": released,
        "nodePosition": {
            "x": round(x, 3) + 0.0,
            "y": round(y, 3) + 0.0,
            "mapId": MAP,
            "allowedDeviationXY": strays_m,
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


class Result(NamedTuple):
    """What a robot said of a plant.

    Parameters
    ----------
    found
        Whether it is infested; None: it could not be inspected, or nothing of it can be read.
    day_s
        When, by the robot's own clock, as it said it; None: it did not.
    wrong
        What must hold and does not, as the end of a sentence; "" if all is plain.
    """

    found: bool | None = None
    day_s: object = None
    wrong: str = ""


def result_of(action: dict[str, Any], plant: int) -> Result:
    """Return what a robot said of a plant that it was ordered to inspect.

    Examples
    --------
    >>> result_of({"resultDescription": '{"found": "yes", "day_s": 41.1}'}, 7)
    Result(found=True, day_s=41.1, wrong='')
    >>> result_of({"resultDescription": '{"found": true, "plant": 8}'}, 7).wrong
    'must be of plant 7, but it names plant 8'
    """
    text = action.get("resultDescription", "")
    try:
        said = json.loads(text)
    except (ValueError, RecursionError):
        said = None
    if not isinstance(said, dict) or "found" not in said:
        return Result(wrong=f'must be JSON as {{"found": true}}, but it is {text[:40]!r}')
    told = said.get("plant", plant)
    if told != plant and str(told).strip() != str(plant):
        return Result(wrong=f"must be of plant {plant}, but it names plant {str(told)[:20]}")
    found, at_s = said["found"], said.get("day_s")
    if isinstance(found, str):
        found = _PLAIN.get(found.strip().casefold(), found)
    if found is None or (isinstance(found, bool | int | float) and found in {0, 1}):
        return Result(None if found is None else bool(found), at_s)
    return Result(None, at_s, f"must have true, false or null as found, but it is {found!r:.40}")
