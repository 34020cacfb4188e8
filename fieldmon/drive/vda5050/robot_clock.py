"""The seconds of a day that are gone: by the plot's clock, by what a robot tells, or by our own."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

from fieldmon.compute.ranges import AllowedRange

if TYPE_CHECKING:
    from collections.abc import Callable

_DAY_S = AllowedRange(0.0, 86_400.0)
# seconds by which its first result may be ahead of our clock before that is said
_AHEAD_S = 1800.0


class RobotClock:
    """How many seconds of its day are gone for a robot; they never go backwards.

    Parameters
    ----------
    say
        Told what people should know of a clock that is odd, behind or ahead.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say, self._is_odd, self._went_back = say, False, False
        #: seconds of the day that are gone by the plot's clock; None: by the robot's own
        self.of_plot: Callable[[], float] | None = None
        self._begun, self._order_s = time.monotonic(), math.nan

    def begin(self, gone_s: float) -> None:
        """Begin a day of which so many seconds are gone."""
        self._gone_s, self._begun = gone_s, time.monotonic()
        self._is_own, self._behind_s, self._order_s = False, 0.0, math.nan

    @property
    def waited_s(self) -> float:
        """Seconds since the day began, or since its last result."""
        return time.monotonic() - self._begun

    def hear_order(self, state: dict[str, Any]) -> None:
        """Note by its own clock when a robot first told that it has an order of the day."""
        if math.isnan(self._order_s):
            self._order_s = _seconds(day_s(state))
            self._behind_s = max(0.0, self._gone_s - self._order_s)

    def state_s(self, state: dict[str, Any]) -> float:
        """Return when a state was told, as `result_s` counts, where the robot told its clock."""
        told_s = math.nan if self.of_plot is not None else _seconds(day_s(state))
        at_s = told_s + self._behind_s
        # behind the last result it went back, and is counted on from the next one
        went_back = self._is_own and at_s < self._gone_s
        return self.now_s() if went_back or _DAY_S.broken(told_s) else at_s

    def result_s(self, told_s: object) -> float:
        """Return the robot's own clock if it says one and it counts; else ours.

        It never goes backwards.
        """
        if self.of_plot is not None:
            self._gone_s = self.now_s()
        if self.of_plot is not None or told_s is None:
            return self.now_s()
        at_s = _seconds(told_s)
        if _DAY_S.broken(at_s):
            if not self._is_odd:
                self._is_odd = True
                self._say(
                    "The robot's day_s must be the seconds since its day began, 0 to 86400, but it "
                    f"is {str(told_s)[:20]}. Where it is not, our own clock counts."
                )
            return self.now_s()
        if not self._is_own and at_s < self._gone_s:  # as of one that was started anew
            took_s = at_s - self._order_s  # by its own clock, if it told that before
            is_told = took_s >= 0.0
            self._behind_s = (self._gone_s + took_s if is_told else self.now_s()) - at_s
            self._say(
                "The robot's clock (day_s) is behind the last result of the day: it is counted on "
                "from there."
            )
        elif self._is_own and at_s + self._behind_s < self._gone_s:
            self._behind_s = self.now_s() - at_s
            if not self._went_back:
                self._went_back = True
                self._say(
                    "The robot's clock (day_s) went back, as of a robot that was started anew: it "
                    "is counted on from the last result, each time that it does."
                )
        ahead_s = at_s - self.now_s()
        if not self._is_own and ahead_s > _AHEAD_S:
            self._say(
                f"By the robot's clock (day_s) {ahead_s / 3600.0:.1f} h more of the day have gone "
                "than by ours: they count as worked. If its day begins with this drive, so must "
                "its day_s."
            )
        self._is_own = True
        at_s += self._behind_s
        self._gone_s, self._begun = max(at_s, self._gone_s), time.monotonic()
        return self._gone_s

    def now_s(self) -> float:
        """Return the seconds that are gone now by the plot's clock, or by ours."""
        if self.of_plot is not None:
            return max(self.of_plot(), self._gone_s)
        return self._gone_s + self.waited_s


def day_s(state: dict[str, Any]) -> object:
    """Return what a state says of the robot's own clock; None: nothing."""
    told = [one for one in state.get("information", []) if one.get("infoType") == "day_s"]
    return told[-1].get("infoDescription") if told else None


def _seconds(told: object) -> float:
    """Return seconds that were told; NaN where they are none."""
    try:
        return float(str(told))
    except ValueError:
        return math.nan
