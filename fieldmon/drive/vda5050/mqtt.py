"""MQTT: messages of one robot, sent and received, over connections that come and go."""

from __future__ import annotations

import math
import queue
import socket
import ssl
import threading
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import urlsplit

from fieldmon.compute.wording import worded
from fieldmon.drive.vda5050.versions import USUAL_VERSION, VERSIONS
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from paho.mqtt.reasoncodes import ReasonCode

_KEEP_ALIVE_S = 15
# a lost connection is sought again after so long, and twice as long each time, up to
_SEEK_S, _SEEK_AT_MOST_S = 1.0, 10.0
# one that is lost so soon after it was made may have been taken by another of the same name
_SOON_S = 10.0
# so long a broker may take until it says that one is let in and will hear
_ANSWERS_S = 30.0


class Broker(NamedTuple):
    """Where messages are exchanged, and who one is there."""

    host: str = "127.0.0.1"
    port: int = 1883
    user: str | None = None
    password: str | None = None
    encrypted: bool = False

    @classmethod
    def of(cls, text: str) -> Broker:
        """Return a broker given as HOST, HOST:PORT or mqtts://USER:PASSWORD@HOST:PORT.

        Raises
        ------
        SettingError
            If it is none of these.

        Examples
        --------
        >>> from fieldmon.drive.vda5050.mqtt import Broker
        >>> Broker.of("farm.local:1884").port
        1884
        """
        parts = urlsplit(text if "://" in text else f"mqtt://{text}")
        try:
            port = parts.port
        except ValueError:
            port = 0
        if parts.scheme not in {"mqtt", "mqtts"} or not parts.hostname or port == 0:
            raise SettingError(
                worded(
                    "A broker must be given as HOST, HOST:PORT or mqtts://USER:PASSWORD@HOST:PORT, "
                    "but it is {text}.",
                    text=repr(text),
                )
            )
        encrypted = parts.scheme == "mqtts"
        usual = 8883 if encrypted else 1883
        return cls(parts.hostname, port or usual, parts.username, parts.password, encrypted)


class BrokerError(SettingError):
    """A broker cannot be used: say where another one is, or as whom it knows you.

    Parameters
    ----------
    message
        The sentence for the person.
    where
        Host and port.
    answers
        Whether one answers there, but lets nobody in.
    """

    def __init__(self, message: str, where: str, *, answers: bool) -> None:
        super().__init__(message)
        self.where, self.answers = where, answers


class RobotName(NamedTuple):
    """What a robot is called in its topics, and the version of VDA 5050 that it speaks."""

    manufacturer: str
    serial: str
    version: str = USUAL_VERSION

    def check(self) -> None:
        """Raise `SettingError` if a name holds what parts or stands for topics."""
        for name in self[:2]:
            if not name.isprintable() or not name or set(name) & set("/+#$"):
                raise SettingError(
                    worded(
                        "Manufacturer and serial number of a robot must be letters that can be "
                        "printed, but no /, +, # or $, and not be empty, but one is {name}.",
                        name=repr(name),
                    )
                )

    @property
    def topic(self) -> str:
        """Return what its topics begin with; raise `SettingError` as `check` does."""
        self.check()
        return f"{VERSIONS[self.version][1]}/{self.manufacturer}/{self.serial}"


class Watched(NamedTuple):
    """Which robots of a manufacturer are listened to, and the version of VDA 5050 that they speak.

    Parameters
    ----------
    manufacturer
        As in their topics.
    serials
        Their serial numbers; none: all that are heard of at the broker.
    version
        As `RobotName` has it.
    """

    manufacturer: str
    serials: tuple[str, ...] = ()
    version: str = USUAL_VERSION

    @classmethod
    def of(cls, manufacturer: str, serials: str | None, version: str = USUAL_VERSION) -> Watched:
        """Return who is named by serial numbers with commas between them, each once; None: all.

        Raises
        ------
        SettingError
            If a name cannot be one, or none is named.

        Examples
        --------
        >>> from fieldmon.drive.vda5050.mqtt import Watched
        >>> Watched.of("fieldmon", "robot-1, robot-2").serials
        ('robot-1', 'robot-2')
        """
        is_all = serials is None
        named = [one.strip() for one in (serials or "").split(",") if one.strip()]
        for serial in named or ["any" if is_all else ""]:
            RobotName(manufacturer, serial, version).check()
        return cls(manufacturer, tuple(dict.fromkeys(named)), version)

    def robot(self, serial: str) -> RobotName:
        """Return one of them."""
        return RobotName(self.manufacturer, serial, self.version)


class Inbox:
    """What came of a robot, until it is taken.

    Parameters
    ----------
    robot
        Who it is.
    """

    def __init__(self, robot: RobotName) -> None:
        self.robot = robot
        self.heard: queue.Queue[tuple[str, bytes]] = queue.Queue()
        #: when a message of each kind came last, by `time.monotonic`
        self.heard_at: dict[str, float] = {}

    def put(self, kind: str, message: Any) -> None:  # noqa: ANN401 - of a library loaded late
        """Take a message in; of what was said before, only whether somebody is there holds."""
        if message.retain and kind != "connection":
            return
        self.heard_at[kind] = time.monotonic()
        self.heard.put((kind, message.payload))


class _End:
    """One end of a connection that comes and goes, to a broker; needs ``fieldmon[robot]``."""

    def __init__(self) -> None:
        #: how often in a row the connection was lost as soon as it was made
        self.cut_off, self._connected_at = 0, -math.inf
        #: called whenever there is a connection again
        self.connected: Callable[[], None] = lambda: None
        self.client: Any = None

    def _open(
        self, broker: Broker, name: str, topics: list[str], will: tuple[str, bytes] | None = None
    ) -> None:
        """Connect under a name, of which the broker forgets what it kept; return once one hears."""
        self._forget(broker, name)
        self.client = self._client(broker, name, clean=False)
        if will is not None:
            self.client.will_set(*will, qos=1, retain=True)
        self._join(broker, topics)

    def _forget(self, broker: Broker, name: str) -> None:
        """Let a broker forget what it kept for one of this name: it is of before."""
        self.client = self._client(broker, name, clean=True)
        self._join(broker, [])
        self.close()

    def _client(self, broker: Broker, name: str, *, clean: bool) -> Any:  # noqa: ANN401 - loaded late
        """Return an end of this name that is not connected yet."""
        mqtt = _paho()
        client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2, client_id=name, clean_session=clean)
        client.on_message = self._on_message
        client.on_connect, client.on_subscribe = self._on_connect, self._on_subscribe
        client.on_disconnect, client.on_socket_open = self._on_disconnect, _at_once
        client.reconnect_delay_set(_SEEK_S, _SEEK_AT_MOST_S)
        if broker.user is not None:
            client.username_pw_set(broker.user, broker.password)
        if broker.encrypted:
            client.tls_set()
        return client

    def _join(self, broker: Broker, hears: list[str]) -> None:
        """Connect; return once the broker has let one in, and topics are heard."""
        self._hears, self._answered, self._refused = hears, threading.Event(), ""
        where = f"{broker.host}:{broker.port}"
        try:
            self.client.connect(broker.host, broker.port, _KEEP_ALIVE_S)
        except OSError as error:
            if broker.encrypted and isinstance(error, ssl.SSLError | ConnectionResetError):
                raise BrokerError(
                    f"The MQTT broker at {broker.host}, port {broker.port}, must encrypt, as "
                    "mqtts:// says, with a certificate that this machine trusts, but it does not "
                    f"({error}). Where it need not, give --broker mqtt://HOST:PORT.",
                    where, answers=True,
                ) from error  # fmt: skip
            raise BrokerError(
                f"An MQTT broker must answer at {broker.host}, port {broker.port}, but none does "
                f"({error}). Start one (docs: drive), or give --broker HOST:PORT.",
                where, answers=False,
            ) from error  # fmt: skip
        self.client.loop_start()
        if not self._answered.wait(_ANSWERS_S):
            self._refused = f"it said nothing for {_ANSWERS_S:.0f} s"
        if self._refused:
            self.close()
            raise BrokerError(
                f"The MQTT broker at {broker.host}, port {broker.port}, must let us in, but "
                f"{self._refused}. Give --broker mqtt://USER:PASSWORD@HOST:PORT as it knows you.",
                where, answers=True,
            )  # fmt: skip

    def close(self) -> None:
        """Say farewell to the broker."""
        self.client.disconnect()
        self.client.loop_stop()

    def _on_connect(
        self, _client: object, _data: object, _flags: object, said: ReasonCode, *_: object
    ) -> None:
        if said.is_failure:
            self._answer([said])
            return
        self._connected_at = time.monotonic()
        if self._hears:
            self.client.subscribe([(topic, 1) for topic in self._hears])
        else:
            self._answer([])
        self.connected()

    def _on_disconnect(
        self, _client: object, _data: object, _flags: object, said: ReasonCode, *_: object
    ) -> None:
        soon = said.is_failure and time.monotonic() - self._connected_at < _SOON_S
        self.cut_off = self.cut_off + 1 if soon else 0

    def _on_subscribe(
        self, _client: object, _data: object, _number: int, said: list[ReasonCode], *_: object
    ) -> None:
        self._answer(said)

    def _answer(self, said: list[ReasonCode]) -> None:
        """Take a broker's answer: codes, of which some may refuse."""
        self._refused = next((f'it said "{one}"' for one in said if one.is_failure), "")
        self._answered.set()

    def _on_message(self, _client: object, _data: object, message: Any) -> None:  # noqa: ANN401
        raise NotImplementedError


class Wire(_End):
    """One end of a robot's topics; needs ``pip install fieldmon[robot]``.

    Whatever is sent while there is no connection is sent when there is one again (at least once).
    Once it is made it hears: what others send from then on comes to it, and nothing of before but
    whether somebody is connected.

    Parameters
    ----------
    broker
        Where.
    name
        Of this end, the same after a restart.
    robot
        Whose topics.
    hears
        Kinds of messages that come to this end.
    will
        Kind and content of what the broker says if the connection breaks; None: nothing.

    Raises
    ------
    SettingError
        If no broker answers, or it does not let one in.
    """

    def __init__(
        self,
        broker: Broker,
        name: str,
        robot: RobotName,
        hears: Iterable[str],
        will: tuple[str, bytes] | None = None,
    ) -> None:
        super().__init__()
        self._inbox, self.robot, self._topic = Inbox(robot), robot, robot.topic
        self.heard, self.heard_at = self._inbox.heard, self._inbox.heard_at
        said = None if will is None else (f"{self._topic}/{will[0]}", will[1])
        self._open(broker, name, [f"{self._topic}/{kind}" for kind in hears], said)

    def send(self, kind: str, data: bytes, *, kept: bool = False) -> Any:  # noqa: ANN401 - paho's
        """Send a message, and return its receipt; `kept`: whoever comes later hears the last."""
        return self.client.publish(f"{self._topic}/{kind}", data, qos=1, retain=kept)

    def _on_message(self, _client: object, _data: object, message: Any) -> None:  # noqa: ANN401
        self._inbox.put(message.topic.rpartition("/")[2], message)


class Ear(_End):
    """One end that only listens, to several robots of a manufacturer or to all of them.

    Parameters
    ----------
    broker
        Where.
    name
        Of this end; the broker forgets it once it is closed.
    watched
        Whom it listens to.
    hears
        Kinds of messages that come to it.

    Raises
    ------
    SettingError
        If no broker answers, or it does not let one in.
    """

    def __init__(self, broker: Broker, name: str, watched: Watched, hears: Iterable[str]) -> None:
        super().__init__()
        self._where, self._watched = (broker, name), watched
        #: by serial number, in the order in which they were named or heard of
        self.inboxes = {one: Inbox(watched.robot(one)) for one in watched.serials}
        begins = VERSIONS[watched.version][1], watched.manufacturer
        every = [*watched.serials] or ["+"]
        self._open(
            broker, name, ["/".join((*begins, one, kind)) for one in every for kind in hears]
        )

    @property
    def hears(self) -> bool:
        """Return whether there is a connection to the broker now."""
        return bool(self.client.is_connected())

    def end(self) -> None:
        """Say farewell; what the broker would have kept for who comes back is forgotten."""
        self.close()
        with suppress(BrokerError):
            self._forget(*self._where)

    def _on_message(self, _client: object, _data: object, message: Any) -> None:  # noqa: ANN401
        *_, serial, kind = message.topic.split("/")
        if serial not in self.inboxes:
            if not message.payload:  # what was kept of it is taken back
                return
            self.inboxes[serial] = Inbox(self._watched.robot(serial))
        self.inboxes[serial].put(kind, message)


def _at_once(_client: object, _data: object, line: Any) -> None:  # noqa: ANN401 - a socket
    """Let small messages go at once: else each waits for the last one's receipt, 40 ms."""
    line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)


def _paho() -> Any:  # noqa: ANN401 - loaded late
    try:
        import paho.mqtt.client as mqtt  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise SettingError(
            "Robots that speak VDA 5050 need an MQTT client, which is not installed. "
            'Install it with: pip install "fieldmon[robot]"'
        ) from error
    return mqtt
