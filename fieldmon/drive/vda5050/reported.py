"""What a robot's state says: of the order of this run, of others, and whether it can go on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fieldmon.drive.vda5050.messages import OVER, is_stopped, sent_at

if TYPE_CHECKING:
    from datetime import datetime

    from numpy.typing import NDArray

# errors with which a robot cannot go on with its order; 2.1 has only the last
_ENDS = {"CRITICAL", "FATAL"}


class Reported(NamedTuple):
    """A state as 2.1 has it, and the order of this run by which it is read."""

    state: dict[str, Any]
    order_id: str

    @property
    def is_of_ours(self) -> bool:
        """Whether the robot reports the order of this run."""
        return bool(self.state["orderId"] == self.order_id)

    @property
    def other_order(self) -> str:
        """Which order the robot reports, if it is none of this run; "": it has none."""
        return "" if self.is_of_ours else str(self.state["orderId"])

    @property
    def stands(self) -> bool:
        """Whether somebody has stopped the robot."""
        return is_stopped(self.state)

    @property
    def place_m(self) -> NDArray[np.float64] | None:
        """Where it says that it is, ``(1, 2)`` metres of its map; None: it does not say."""
        place = self.state.get("agvPosition")
        if place is None or not place["positionInitialized"]:
            return None
        return np.array([[place["x"], place["y"]]])

    def is_busy(self) -> bool:
        """Tell whether something is left of an order that is not of this run."""
        left = [one for one in self.state["actionStates"] if one["actionStatus"] not in OVER]
        return not self.is_of_ours and bool(
            self.state["nodeStates"] or self.state["edgeStates"] or left
        )

    def has_taken(self, order: dict[str, Any]) -> bool:
        """Tell whether the robot has said that it has this order."""
        return bool(
            self.state["orderId"] == order["orderId"]
            and self.state["orderUpdateId"] >= order["orderUpdateId"]
        )

    def status(self, name: str) -> str | None:
        """Return how far an instant action of this run is; None: the robot does not know it."""
        wanted = f"{self.order_id}-{name}"
        told = [one["actionStatus"] for one in self.state["actionStates"]
                if one["actionId"] == wanted]  # fmt: skip
        return told[-1] if told else None

    def finished(self, action: str, began: datetime) -> dict[str, Any] | None:
        """Return the state of an action that is over; one that a broken robot let go is not."""
        over = {"FINISHED"} if self.broken(began) else OVER
        for one in self.state["actionStates"]:
            if one["actionId"] == action and one["actionStatus"] in over:
                done: dict[str, Any] = one
                return done
        return None

    def broken(self, began: datetime) -> str:
        """Say that the robot cannot go on, if it says so of this run, which `began`, or since."""
        fatal = [one for one in self.state["errors"] if one["errorLevel"] in _ENDS]
        if not fatal or not (self.is_of_ours or sent_at(self.state) >= began):
            return ""
        told = fatal[0].get("errorDescription") or fatal[0]["errorType"]
        return f"The robot reports an error that it cannot mend: {told}."

    def low(self, least: float) -> str:
        """Say that the battery holds less than `least` percent, if it does."""
        charge = self.state["batteryState"]["batteryCharge"]
        if charge >= least:
            return ""
        low = math.floor(10 * charge) / 10  # never rounded up to what would do
        return (
            f"The robot's battery is at {low:g} %, under {least:g} %: the day ends here. Charge it."
        )

    def complaint(self) -> str:
        """Return in words what the robot reports, to be put at the end of a sentence."""
        told = [one.get("errorDescription") or one["errorType"] for one in self.state["errors"]]
        if told:
            return f"; it reports: {', '.join(told)}"
        other = self.other_order
        return (
            f": it has the order {other}, which is not ours" if other else ", and does not say why"
        )
