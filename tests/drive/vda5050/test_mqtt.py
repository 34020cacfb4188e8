"""Brokers as they are named, and messages over connections that break."""

import builtins
import queue
import socket
import ssl
from types import SimpleNamespace

import pytest

from fieldmon.drive.vda5050.mqtt import Broker, BrokerError, Ear, Watched, Wire
from fieldmon.errors import SettingError
from tests.drive.vda5050.conftest import ROBOT


@pytest.mark.parametrize(
    ("text", "broker"),
    [
        ("farm.local", Broker("farm.local", 1883)),
        ("10.0.0.2:1999", Broker("10.0.0.2", 1999)),
        ("mqtt://a:b@farm", Broker("farm", 1883, "a", "b")),
        ("mqtts://a:b@farm", Broker("farm", 8883, "a", "b", encrypted=True)),
    ],
)
def test_a_broker_is_named_as_people_do(text, broker):
    assert Broker.of(text) == broker


def test_who_is_watched_is_named_once_each_or_is_everybody():
    assert Watched.of("a", " r1,r2 , r1,") == Watched("a", ("r1", "r2"))
    assert Watched.of("a", None).serials == ()
    assert Watched.of("a", "r 1", "3.0").robot("r 1").topic == "vda5050/v3/a/r 1"
    for maker, serials in (("a", " , "), ("a", "r1, +"), ("", None), ("a/b", "r1")):
        with pytest.raises(SettingError, match="can be printed"):
            Watched.of(maker, serials)


def test_a_broker_keeps_nothing_for_who_listened_and_has_ended(broker):
    mqtt = pytest.importorskip("paho.mqtt.client")
    ear = Ear(broker, "an ear", Watched("fieldmon"), ("state",))
    assert ear.hears
    ear.end()
    said = queue.Queue()
    again = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2, client_id="an ear", clean_session=False)
    again.on_connect = lambda _client, _data, flags, *_: said.put(flags.session_present)
    again.connect(broker.host, broker.port)
    again.loop_start()
    assert said.get(timeout=180) is False
    again.disconnect()
    again.loop_stop()


@pytest.mark.parametrize("text", ["", "http://farm", "farm:port", "farm:99999"])
def test_what_is_no_broker_is_refused(text):
    with pytest.raises(SettingError, match="HOST:PORT"):
        Broker.of(text)


def test_where_no_broker_answers_it_is_said():
    with pytest.raises(SettingError, match="must answer at"):
        Wire(Broker("127.0.0.1", 1), "a", ROBOT, ())


@pytest.mark.parametrize("wrong", [ssl.SSLError("wrong version"), ConnectionResetError("reset")])
def test_a_broker_that_does_not_encrypt_is_said(wrong, monkeypatch):
    """Mosquitto ends such a line; paho leaves its socket to the garbage, so none is opened here."""
    client = pytest.importorskip("paho.mqtt.client").Client

    def connect(*_):
        raise wrong

    monkeypatch.setattr(client, "connect", connect)
    for encrypted, told in ((True, r"must encrypt, .* give --broker mqtt://"), (False, "answer")):
        with pytest.raises(BrokerError, match=told) as refused:
            Wire(Broker("farm", encrypted=encrypted), "x", ROBOT, ("state",))
        assert refused.value.answers == encrypted


def test_without_a_client_it_is_said_how_to_get_one(monkeypatch):
    real = builtins.__import__

    def missing(name, *rest):
        if name.startswith("paho"):
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(SettingError, match=r"fieldmon\[robot\]"):
        Wire(Broker(), "a", ROBOT, ())


def test_who_is_made_hears_what_is_sent_from_then_on(broker):
    for name in range(20):
        one = Wire(broker, f"new {name}", ROBOT, ("order", "state"))
        other = Wire(broker, "sends at once", ROBOT, ())
        other.send("order", b"%d" % name)
        assert one.heard.get(timeout=180) == ("order", b"%d" % name)
        one.close()
        other.close()


def test_what_a_broker_kept_of_before_is_not_heard(broker):
    other = Wire(broker, "sends overnight", ROBOT, ())
    Wire(broker, "away", ROBOT, ("order", "state", "connection")).close()
    other.send("order", b"of yesterday")
    other.send("state", b"kept by the broker", kept=True)
    other.send("connection", b"is there", kept=True)
    # both have arrived once somebody else hears what came after them
    witness = Wire(broker, "witness", ROBOT, ("connection",))
    assert witness.heard.get(timeout=180) == ("connection", b"is there")
    one = Wire(broker, "away", ROBOT, ("order", "state", "connection"))
    other.send("order", b"of today")
    heard = [one.heard.get(timeout=180) for _ in range(2)]
    assert sorted(heard) == [("connection", b"is there"), ("order", b"of today")]
    other.client.publish(f"{ROBOT.topic}/state", b"", qos=1, retain=True).wait_for_publish(180)
    other.client.publish(f"{ROBOT.topic}/connection", b"", qos=1, retain=True).wait_for_publish(180)
    for each in (one, other, witness):
        each.close()


@pytest.fixture
def wary(broker_program):
    """Return a broker that lets nobody in without a password."""
    with broker_program("allow_anonymous false\n") as found:
        yield found


@pytest.mark.parametrize("who", [(None, None), ("robot", "wrong")])
def test_a_broker_that_does_not_let_one_in_is_said(wary, who):
    with pytest.raises(SettingError, match=r'must let us in, but it said "Not authorized"'):
        Wire(Broker(wary.host, wary.port, *who), "a", ROBOT, ("order",))


def test_a_broker_that_says_nothing_is_said(monkeypatch):
    monkeypatch.setattr("fieldmon.drive.vda5050.mqtt._ANSWERS_S", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as mute:
        broker = Broker("127.0.0.1", mute.getsockname()[1])
        with pytest.raises(SettingError, match="it said nothing for 0 s"):
            Wire(broker, "a", ROBOT, ())


def test_connections_that_are_lost_as_soon_as_they_are_made_are_counted(monkeypatch):
    wire, now = object.__new__(Wire), [0.0]
    shown = SimpleNamespace(monotonic=lambda: now[0])
    monkeypatch.setattr("fieldmon.drive.vda5050.mqtt.time", shown)
    wire._hears, wire._answer, wire.connected = [], lambda _: None, lambda: None
    wire.cut_off = 0
    counted = []
    for so_long, lost in ((9000.0, True), (1.0, True), (2.0, True), (1.0, True), (60.0, True)):
        wire._on_connect(None, None, None, SimpleNamespace(is_failure=False))
        now[0] += so_long
        wire._on_disconnect(None, None, None, SimpleNamespace(is_failure=lost))
        counted.append(wire.cut_off)
    assert counted == [0, 1, 2, 3, 0]


def test_what_is_sent_while_the_line_is_cut_arrives(broker):
    one = Wire(broker, "one", ROBOT, ("order",))
    other = Wire(broker, "other", ROBOT, ())
    other.send("order", b"first")
    assert one.heard.get(timeout=180) == ("order", b"first")
    other.client.socket().close()  # as a robot behind a hill
    other.send("order", b"second")
    heard = one.heard.get(timeout=180)
    while heard == ("order", b"first"):  # its receipt was cut off: MQTT sends again
        heard = one.heard.get(timeout=180)
    assert heard == ("order", b"second")
    one.close()
    other.close()
