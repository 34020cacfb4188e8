"""MQTT: messages of one robot, sent and received, over connections that come and go."""

from __future__ import annotations

import queue
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import urlsplit

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from collections.abc import Iterable

_KEEP_ALIVE_S = 15


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
        >>> from fieldmon.drive.vda5050.wire import Broker
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
                "A broker must be given as HOST, HOST:PORT or mqtts://USER:PASSWORD@HOST:PORT, "
                f"but it is {text!r}."
            )
        encrypted = parts.scheme == "mqtts"
        usual = 8883 if encrypted else 1883
        return cls(parts.hostname, port or usual, parts.username, parts.password, encrypted)


class Wire:
    """One end of a robot's topics; needs ``pip install fieldmon[robot]``.

    Whatever is sent while there is no connection is sent when there is one again (at least once).

    Parameters
    ----------
    broker
        Where.
    name
        Of this end, the same after a restart.
    robot
        Manufacturer and serial number, which name the topics.
    hears
        Kinds of messages that come to this end.
    will
        Kind and content of what the broker says if the connection breaks; None: nothing.
    """

    def __init__(
        self,
        broker: Broker,
        name: str,
        robot: tuple[str, str],
        hears: Iterable[str],
        will: tuple[str, bytes] | None = None,
    ) -> None:
        mqtt = _paho()
        self.heard: queue.Queue[tuple[str, bytes]] = queue.Queue()
        self._topic = f"uagv/v2/{robot[0]}/{robot[1]}"
        self._hears = [f"{self._topic}/{kind}" for kind in hears]
        client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2, client_id=name, clean_session=False)
        client.on_message = self._on_message
        client.on_connect = self._on_connect
        client.reconnect_delay_set(min_delay=1, max_delay=10)
        if broker.user is not None:
            client.username_pw_set(broker.user, broker.password)
        if broker.encrypted:
            client.tls_set()
        if will is not None:
            client.will_set(f"{self._topic}/{will[0]}", will[1], qos=1, retain=True)
        self.client: Any = client
        try:
            client.connect(broker.host, broker.port, _KEEP_ALIVE_S)
        except OSError as error:
            raise SettingError(
                f"An MQTT broker must answer at {broker.host}, port {broker.port}, but none does "
                f"({error}). Start one (docs: drive), or give --broker HOST:PORT."
            ) from error
        client.loop_start()

    def send(self, kind: str, data: bytes, *, kept: bool = False) -> None:
        """Send a message; `kept`: whoever comes later hears the last of its kind."""
        self.client.publish(f"{self._topic}/{kind}", data, qos=1, retain=kept)

    def close(self) -> None:
        """Say farewell to the broker."""
        self.client.disconnect()
        self.client.loop_stop()

    def _on_connect(self, client: Any, *_: object) -> None:  # noqa: ANN401 - paho's own
        for topic in self._hears:
            client.subscribe(topic, qos=1)

    def _on_message(self, _client: object, _data: object, message: Any) -> None:  # noqa: ANN401
        self.heard.put((message.topic.rpartition("/")[2], message.payload))


def _paho() -> Any:  # noqa: ANN401 - loaded late
    try:
        import paho.mqtt.client as mqtt  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise SettingError(
            "Robots that speak VDA 5050 need an MQTT client, which is not installed. "
            'Install it with: pip install "fieldmon[robot]"'
        ) from error
    return mqtt
