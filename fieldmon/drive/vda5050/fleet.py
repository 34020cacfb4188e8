"""Fleet control: a robot that speaks VDA 5050 is asked for plants, one after the other."""

from __future__ import annotations

import math
import queue
import time
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Any

from fieldmon.drive.errand import Visit
from fieldmon.drive.vda5050.crossing import Crossing
from fieldmon.drive.vda5050.messages import (
    FASTER,
    LATE_S,
    OVER,
    at_once,
    decoded,
    encoded,
    header_of,
    home_order,
    order_of,
    result_of,
    sent_at,
    side_of,
)
from fieldmon.drive.vda5050.mqtt import Wire
from fieldmon.drive.vda5050.reported import Reported
from fieldmon.drive.vda5050.robot_clock import RobotClock, day_s
from fieldmon.errors import FieldmonError, ObservationError, SettingError
from fieldmon.plot.clearance import STRAY_M
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.travel import GATE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fieldmon.drive.aisle_keeper import AisleKeeper
    from fieldmon.drive.errand import Errand, Float
    from fieldmon.drive.vda5050.mqtt import Broker, RobotName
    from fieldmon.plot.travel import Aisles

# an order that nobody acknowledged is sent again; robots take the same one once
_AGAIN_S = 5.0
_POLL_S = 0.2
# a robot that is there says so every 30 s by the standard; without a word for so long, it may not
_SILENT_S = 45.0
# so often, heard each time, a robot may leave a thing undone
_MOST_TRIES = 24
# so often in a row our connection is lost as soon as it is made before that is said
_MOST_CUT_OFF = 3
# how far from a node it may pass where nobody said how wide it is, and nothing more is known
_FREE_M = 0.3


class Vda5050Robot:
    """Sends orders and waits for what the robot tells.

    One order a run, with an update for each plant: its base is the way to that plant, its horizon
    what comes after. The robot answers in the action's ``resultDescription``, as JSON: ``found``
    (true, false, or null where it could not look) and, if its clock is not ours, ``day_s``, the
    seconds since the day began.

    Parameters
    ----------
    wire
        The robot's topics.
    order_id
        A name that no order had before.
    say
        Told what people should know: lost connections, pauses, messages that are none.
    traffic
        Who may be in which aisle; None: the robot is alone. Its way is released up to the end of
        its own aisle until all aisles on the way to the next plant are free.
    patience_s
        Seconds without any word of the robot after which the day ends; a pause is a word.
    least_battery
        Percent below which the day ends after the plant in hand.
    """

    def __init__(
        self,
        wire: Wire,
        order_id: str,
        say: Callable[[str], None] = lambda _: None,
        *,
        traffic: AisleKeeper | None = None,
        patience_s: float = 600.0,
        least_battery: float = 15.0,
    ) -> None:
        self._wire, self._say = wire, say
        self._header, self._name = header_of(*wire.robot), wire.robot.serial
        self._actions_header = header_of(*wire.robot)
        self._known: dict[str, Any] = {"orderId": order_id, "orderUpdateId": -1, "node": None}
        self._patience_s, self._least_battery = patience_s, least_battery
        #: returns how often somebody asked for a stop: once, a robot that has no order is not
        #: waited for; twice, no robot is
        self.stops: Callable[[], int] = lambda: 0
        self._has_order, self._is_lost, self._told_until = False, False, False
        self._state: dict[str, Any] | None = None
        self._told = ""
        #: what is said once a run, however often it holds
        self._told_once_a_run: set[str] = set()
        self._had_ours = False
        self._traffic = traffic
        self._day_clock = RobotClock(say)
        #: told where the robot says that it is: seconds, and ``(2,)`` metres of the plot's frame
        self.sees: Callable[[float, Float], None] | None = None
        self._began = datetime.now(UTC)

    def begin(self, aisles: Aisles, at_m: Float, gone_s: float) -> None:
        """Take the plot's metres for those east and north of its datum."""
        frame = aisles.grid.frame
        east_north = frame.turned(90.0)
        self._places = lambda line_m: east_north.xy_m(frame.lonlat(line_m))
        self._east_north, self._grid = east_north, aisles.grid
        self._known["strays_m"] = _FREE_M if aisles.clearance is None else STRAY_M
        self._day_clock.begin(gone_s)
        self._began, self._heard_at = datetime.now(UTC), time.monotonic()
        self._towards_m: Float | None = None
        if self._traffic is not None:
            self._crossing = Crossing(self._traffic, self._name, aisles, at_m)

    @property
    def clock(self) -> Callable[[], float] | None:
        """Seconds of the day that are gone by the plot's clock; None: by the robot's own."""
        return self._day_clock.of_plot

    @clock.setter
    def clock(self, of_plot: Callable[[], float] | None) -> None:
        self._day_clock.of_plot = of_plot

    @property
    def has_order(self) -> bool:
        """Whether it was sent one in this run."""
        return self._has_order

    def is_faster(self) -> bool:
        """Wait until the robot is heard; tell whether it says that its clock is no real one."""
        state = self._told_once()
        if isinstance(state, str):
            return False
        return any(one.get("infoType") == FASTER for one in state.get("information", []))

    def visit(self, errand: Errand) -> Visit:
        """Send the robot to a plant, and wait for what it found."""
        line_m, why = self._cleared(errand.line_m, errand.stop.plant)
        if why is not None:
            return self._not_there(why)
        self._known["orderUpdateId"] += 1
        update = self._known["orderUpdateId"]
        action = f"{self._known['orderId']}-{update}-{errand.stop.plant}"
        stands = self._plant_at(errand)
        errand = errand._replace(line_m=line_m)
        order, node = order_of(errand, self._places, self._known, action, stands)
        there: list[float] = []

        def finished(state: dict[str, Any]) -> dict[str, Any] | None:
            if not there and state["lastNodeSequenceId"] >= node["sequenceId"]:
                there.append(self._day_clock.state_s(state))
            return self._reported(state).finished(action, self._began)

        said = self._done(order, finished)
        # the next update begins at the node where it stands; what was done there is not done again
        self._known["node"] = {**node, "actions": []}
        if isinstance(said, str):
            return self._not_there(said)
        if self._traffic is not None:
            self._crossing.arrived(errand.stop.plant)
        result = result_of(said, errand.stop.plant)
        is_done = said["actionStatus"] == "FINISHED"
        if is_done and result.wrong:
            self._say(
                f"The robot's result of row {errand.stop.row}, plant {errand.stop.number} "
                f"{result.wrong}: the plant counts as not inspected."
            )
        found = result.found if is_done else None
        done_s = self._day_clock.result_s(result.day_s)
        there_s = min(there[0], done_s) if there else None
        return Visit(found, done_s, stuck=self._ended(self._over()), there_s=there_s)

    def _plant_at(self, errand: Errand) -> tuple[Float, str]:
        """Return where a plant stands, metres of the plot's frame, and on which side of the way."""
        if len(errand.line_m) > 1:
            self._towards_m = errand.line_m[-1] - errand.line_m[-2]
        plant_m, towards_m = self._grid.xy_m[errand.stop.plant], self._towards_m
        side = "" if towards_m is None else side_of(plant_m, errand.line_m[-1], towards_m)
        return plant_m, side

    def home(self, line_m: Float) -> Visit | None:
        """Send the robot back to the gate."""
        line_m, why = self._cleared(line_m, GATE)
        if why is not None:
            return self._not_there(why)
        said = self._driven(line_m)
        if isinstance(said, str):
            return self._not_there(said)
        if self._traffic is not None:
            self._crossing.arrived(GATE)
        return Visit(None, self._day_clock.result_s(day_s(said)))

    def _cleared(self, line_m: Float, plant: int) -> tuple[Float, str | None]:
        """Return what is left of a way once all aisles on it are the robot's; or why it never is.

        Where they are not, it drives to the end of its own aisle, which is then free for others.
        """
        if self._traffic is None or self._crossing.enter(plant):
            return line_m, None
        out_m, rest_m = self._crossing.parted(line_m, plant)
        if len(out_m) > 1:
            said = self._driven(out_m)
            if isinstance(said, str):
                return rest_m, said
        self._crossing.left()
        self._tell("The robot waits until an aisle is free.")
        while not self._crossing.enter(plant):
            if self._crossing.blocked(plant):
                return rest_m, "The way is blocked by a robot that moves no more today."
            if why := self._wait():
                return rest_m, why
        return rest_m, None

    def _driven(self, line_m: Float) -> dict[str, Any] | str:
        """Let the robot drive along a line; return its state there, or why it is not there."""
        self._known["orderUpdateId"] += 1
        order, node = home_order(line_m, self._places, self._known)
        last = node["sequenceId"]
        said = self._done(
            order, lambda state: state if state["lastNodeSequenceId"] >= last else None
        )
        self._known["node"] = node
        return said

    def _not_there(self, why: str) -> Visit:
        """Return what came of an errand on which the robot did not get to its end."""
        return Visit(None, self._day_clock.now_s(), stuck=self._ended(why), there=False)

    def _ended(self, why: str) -> str:
        """Say at once that the robot moves no more today, and where, if there is a reason."""
        if why:
            self._say(f"{why} {self._where()}")
            if self._traffic is not None:
                self._traffic.end(self._name)
        return why

    def _where(self) -> str:
        """Return where the robot stands by its own word, in a sentence."""
        place_m = None if self._state is None else self._heard.place_m
        if place_m is None:
            return "It does not say where it stands."
        lonlat = self._east_north.lonlat(place_m)
        near = self._grid.tree.query(self._grid.frame.xy_m(lonlat))[1]
        numbered, (lon, lat) = plant_numbers(self._grid, near), lonlat[0].tolist()
        row = f"row {numbered.line[0]}, " if self._grid.in_rows else ""
        return (
            f"It stands near {row}plant {numbered.number[0]}, by its own word: latitude {lat:.6f}, "
            f"longitude {lon:.6f}."
        )

    def _done(
        self, order: dict[str, Any], wanted: Callable[[dict[str, Any]], dict[str, Any] | None]
    ) -> dict[str, Any] | str:
        """Send an order until it is taken; return what is wanted of a state, or why not."""
        if order["orderUpdateId"] == 0 and (why := self._made_free()):
            return why

        def send(in_vain: int) -> None:
            # what was left of an order of before was heard late
            if in_vain and self._heard.is_busy():
                self._ask("cancelOrder", f"cancel-{in_vain}")
            self._has_order = True
            self._wire.send("order", encoded("order", self._header, order))

        return self._had(send, "taken its order", lambda: self._has_taken(order), wanted)

    def _has_taken(self, order: dict[str, Any]) -> bool:
        """Tell whether the robot has said that it has this order."""
        return self._state is not None and self._heard.has_taken(order)

    def _made_free(self) -> str:
        """Let the robot end what is left of an order of before; return why the day ends, if so.

        A robot by the standard refuses an order while it has another one.
        """
        if isinstance(why := self._told_once(), str):
            return why
        if (why := self._broken()) or not self._heard.is_busy():
            return why
        self._say("The robot still has an order of before; it is asked to end it.")
        why = self._had(
            lambda _: self._ask("cancelOrder", "cancel"),
            "ended its order of before",
            lambda: self._heard.status("cancel") is not None or not self._heard.is_busy(),
            lambda state: (
                state if self._heard.status("cancel") in OVER or not self._heard.is_busy() else None
            ),
        )
        return why if isinstance(why, str) else ""

    def _told_once(self) -> dict[str, Any] | str:
        """Return what the robot said last, once it was heard, or why it never was."""
        return self._had(
            lambda _: self._ask("stateRequest", "state"),
            "told its state",
            lambda: self._state is not None,
            lambda state: state,
        )

    def _had(
        self,
        send: Callable[[int], None],
        what: str,
        has: Callable[[], bool],
        wanted: Callable[[dict[str, Any]], dict[str, Any] | None],
    ) -> dict[str, Any] | str:
        """Send something until the robot has it; return what is wanted of a state, or why not.

        Parameters
        ----------
        send
            Told how often it was sent in vain: heard since, the robot did not have it; 0: it was
            not heard since.
        what
            What the robot then has done.
        has
            Whether the robot has it.
        wanted
            What is waited for once it has.
        """
        sent, tries, before = -math.inf, 0, self._state
        self._heard_at = time.monotonic()
        while True:
            now, in_vain = time.monotonic(), 0
            if not has() and now - sent > _AGAIN_S:
                if math.isfinite(sent) and self._state is not before and not self._heard.stands:
                    in_vain = tries = tries + 1
                    said = f"The robot has not {what}{self._heard.complaint()}."
                    if tries > _MOST_TRIES:
                        return said
                    other = self._heard.other_order
                    self._say_once(said, said.replace(other, "") if other else said)
                send(in_vain)
                sent, before = now, self._state
            why = self._wait()
            # what is reported together with an error was done before it
            if self._state is not None and has() and (found := wanted(self._state)) is not None:
                return found
            if why:
                return why

    def _ask(self, action: str, name: str) -> None:
        """Ask for an instant action."""
        body = at_once(action, f"{self._known['orderId']}-{name}")
        self._wire.send("instantActions", encoded("instantActions", self._actions_header, body))

    def _say_once(self, sentence: str, about: str) -> None:
        """Say something, unless that was said in this run."""
        if about not in self._told_once_a_run:
            self._told_once_a_run.add(about)
            self._say(sentence)

    def _wait(self) -> str:
        """Hear the robot, or nothing for a moment; return why the day ends, if it does.

        Raise `FieldmonError` where somebody stopped the day and the robot is not waited for.
        """
        if self._wire.cut_off >= _MOST_CUT_OFF:
            self._say_once(
                "Our connection to the broker is lost as soon as it is made, again and again: "
                "another program may drive this robot, too, and take it. Let only one of them do "
                "so.",
                "cut off",
            )
        if (stops := self.stops()) and not self._has_order:
            raise FieldmonError("It has no order and is not waited for.")
        if stops > 1:
            raise FieldmonError("It is not waited for, but still ends what it was ordered last.")
        if self._hear():
            self._heard_at, self._told_until = time.monotonic(), False
            return self._broken()
        self._must_come()
        if stops:
            self._tell_until()
        if time.monotonic() - self._heard_at > self._patience_s:
            return f"The robot has not been heard for {self._patience_s:.0f} s."
        return ""

    def _tell_until(self) -> None:
        """Say once until when a robot that is not heard is waited for.

        One whose connection is lost is, too: it drives on, and what it found comes with it.
        """
        silent_s = time.monotonic() - self._heard_at
        if self._told_until or not (self._is_lost or silent_s > _SILENT_S):
            return
        self._told_until = True
        until = datetime.now(UTC).astimezone() + timedelta(seconds=self._patience_s - silent_s)
        self._say(
            f"It is not heard, and is waited for until {until:%H:%M:%S}, as it may still end the "
            "plant in hand. Ctrl-C again ends at once."
        )

    @property
    def _heard(self) -> Reported:
        """What the robot said last."""
        assert self._state is not None  # noqa: S101 - asked once it was heard
        return self._reported(self._state)

    def _reported(self, state: dict[str, Any]) -> Reported:
        return Reported(state, self._known["orderId"])

    def _broken(self) -> str:
        """Say that the robot cannot go on, if it says so now and not of a day before."""
        return self._heard.broken(self._began)

    def _over(self) -> str:
        """Return why the day ends after the plant in hand; "" if it does not."""
        return self._broken() or self._heard.low(self._least_battery)

    def _must_come(self) -> None:
        """Say that a robot was never heard yet; raise `SettingError` once it takes too long."""
        if self._state is not None:
            return
        name, waited_s = "/".join(self._wire.robot[:2]), self._day_clock.waited_s
        if waited_s > self._patience_s:
            raise SettingError(
                f"A robot called {name} must be at the broker, but none was heard for "
                f"{self._patience_s:.0f} s. Start it, or give its names as they stand in its "
                "topics: --manufacturer, and --serial or its name in the team."
            )
        if waited_s > _AGAIN_S:
            self._tell(f"Waiting for the robot {name}, which has not been heard yet.")

    def _hear(self) -> bool:
        """Take the robot's next state; return whether there was one within a moment.

        One that came late, or twice, is passed by.
        """
        try:
            kind, data = self._wire.heard.get(timeout=_POLL_S)
            message = decoded(kind, data)
        except queue.Empty:
            return False
        except ObservationError as error:
            self._tell(str(error))
            return False
        if kind == "connection":
            said = message["connectionState"]
            self._is_lost = said != "ONLINE"
            if self._is_lost:
                is_cut = said == "CONNECTIONBROKEN"
                what = "The robot's connection is lost" if is_cut else "The robot has signed off"
                self._tell(f"{what}; waiting for it.")
            return False
        if kind != "state" or self._late(message):
            return False
        self._state, self._is_lost = message, False
        if self._heard.is_of_ours:
            self._day_clock.hear_order(message)
            self._had_ours = True
        elif self._had_ours and (other := self._heard.other_order):
            self._say_once(
                f"The robot had our order, but reports the order {other} now: another program may "
                "give it orders, too. Let only one of them do so.",
                "another order",
            )
        self._see(message)
        if self._heard.stands:
            self._tell("The robot is paused, or driven by hand; waiting.")
        else:
            self._told = ""
        return True

    def _see(self, state: dict[str, Any]) -> None:
        """Pass on where the robot says that it is, once it has an order of this run."""
        reported = self._reported(state)
        if self.sees is None or not reported.is_of_ours or (place_m := reported.place_m) is None:
            return
        lonlat = self._east_north.lonlat(place_m)
        self.sees(self._day_clock.state_s(state), self._grid.frame.xy_m(lonlat)[0])

    def _late(self, message: dict[str, Any]) -> bool:
        """Tell whether a message came after one that was sent later, or twice; say a clock's jump.

        A robot that was started anew counts from the first, and a clock may be put back: late is
        only what both say.
        """
        if self._state is None:
            return False
        back_s = (sent_at(self._state) - sent_at(message)).total_seconds()
        if message["headerId"] <= self._state["headerId"]:
            return 0.0 <= back_s <= LATE_S
        if back_s > LATE_S:
            self._say(
                f"The robot's clock jumped back by {back_s:.0f} s; what it says still counts as "
                "it comes."
            )
        return False

    def _tell(self, sentence: str) -> None:
        """Say something once, not with every message."""
        if sentence != self._told:
            self._told = sentence
            self._say(sentence)


@contextmanager
def live_robot(
    broker: Broker,
    robot: RobotName,
    on: str,
    say: Callable[[str], None],
    traffic: AisleKeeper | None = None,
) -> Iterator[Vda5050Robot]:
    """Yield a robot on its wire; the order's name holds the day and when it was made."""
    wire = Wire(broker, f"fieldmon-{robot.serial}", robot, ("state", "connection"))
    order_id = f"{on}-{time.time_ns() // 10**6}"
    try:
        yield Vda5050Robot(wire, order_id, say, traffic=traffic)
    finally:
        wire.close()
