"""Other devices reach the app encrypted and behind a password; the certificate is beside it."""

import asyncio
import logging
import socket
import ssl
import subprocess
import sys
import threading
import urllib.request
from types import SimpleNamespace
from urllib.error import HTTPError

import pytest
import uvicorn
from websockets.sync.client import connect

from app.startup import lan
from app.startup.certificates import certificates
from app.state import scout_page
from fieldmon.errors import SettingError
from tests.app.driving import until

#: an address of this machine that its browser does not use
HERE = "127.0.0.2"


def free_ports():
    """Return a port of which the next one is free too."""
    while True:
        with socket.create_server((HERE, 0)) as one:
            port = one.getsockname()[1]
        try:
            socket.create_server((HERE, port + 1)).close()
        except OSError:
            continue
        return port


async def inside(scope, receive, send):
    if scope["type"] == "lifespan":
        await receive()
        await send({"type": "lifespan.startup.complete"})
        await receive()
        await send({"type": "lifespan.shutdown.complete"})
        return
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        await asyncio.sleep(1)
        await send({"type": "websocket.send", "text": "inside"})
        return
    if scope["path"].endswith("/slow"):
        await asyncio.sleep(1)
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"inside"})


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    folder = tmp_path_factory.mktemp("authority")
    port, servers, said = free_ports(), [], []
    kept = uvicorn.Server.__init__

    def noted(self, *all_, **named):
        servers.append(self)
        kept(self, *all_, **named)

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(lan.LAN, HERE)
        patch.setenv(lan.FOLDER, str(folder))
        patch.setenv(lan.PASSWORD, "secret-word")
        patch.delenv(scout_page.ADDRESS, raising=False)
        patch.setattr(uvicorn.Server, "__init__", noted)
        patch.setattr(lan, "_print", said.append)
        line = socket.create_server(("127.0.0.1", 0))
        settings = {"access_log": False, "log_level": "critical", "lifespan": "on"}
        thread = threading.Thread(target=lan.serve, args=(inside, port, line, settings))
        thread.start()
        until(lambda: len(servers) == 3 and all(one.started for one in servers))
        made = certificates(folder, HERE)
        patch.undo()
        address = lan.os.environ.pop(scout_page.ADDRESS)
        yield SimpleNamespace(port=port, own=line.getsockname()[1], made=made, folder=folder,
                              said="\n".join(said), address=address)  # fmt: skip
        servers[0].should_exit = True
        thread.join(180)
        assert not thread.is_alive(), "with the first server all of them end"


def got(url, context=None, **headers):
    asked = urllib.request.Request(url, headers=headers)  # noqa: S310 - ours
    try:
        with urllib.request.urlopen(asked, context=context) as answer:  # noqa: S310 - likewise
            return answer.status, answer.headers, answer.read()
    except HTTPError as error:
        with error:
            return error.code, error.headers, error.read()


def trusting(served):
    return ssl.create_default_context(cafile=served.folder / "authority.crt")


def test_a_phone_that_trusts_the_authority_reaches_the_gate_and_the_page(served):
    own = f"https://{HERE}:{served.port}"
    assert got(f"{own}/", trusting(served))[0] == 401
    assert got(f"{own}/scouting/", trusting(served))[2] == b"inside"
    assert served.address == own


def test_who_does_not_trust_it_is_warned(served):
    with pytest.raises(urllib.error.URLError, match="CERTIFICATE_VERIFY_FAILED"):
        got(f"https://{HERE}:{served.port}/", ssl.create_default_context())


def test_this_machines_own_browser_needs_no_password(served):
    assert got(f"http://127.0.0.1:{served.own}/")[2] == b"inside"


def test_the_certificate_and_three_steps_are_beside_it_and_nothing_else(served):
    beside = f"http://{HERE}:{served.port + 1}"
    status, headers, body = got(f"{beside}/fieldmon.crt")
    assert (status, headers["content-type"]) == (200, "application/x-x509-ca-cert")
    assert (
        ssl.DER_cert_to_PEM_cert(body).strip()
        == (served.folder / "authority.crt").read_text().strip()
    )
    _, _, steps = got(f"{beside}/", **{"Accept-Language": "es"})
    assert steps.count(b"<li>") == 6
    assert served.made.fingerprint.encode() in steps
    assert b'lang="es"' in steps
    for path in ("/authority.key", "/app.key", "/scouting/", "/api/v1/openapi.json", "/../app.key"):
        assert got(beside + path)[0] == 404


def test_the_window_says_password_fingerprint_and_both_codes(served):
    assert "secret-word" in served.said
    assert served.made.fingerprint in served.said
    assert f"http://{HERE}:{served.port + 1}" in served.said
    assert served.said.count("█") > 200, "drawn to be scanned"


def test_behind_a_server_of_ones_own_the_password_is_said(capsys):
    lan.say_password("a-b", "https://field.example")
    assert "https://field.example   password: a-b" in capsys.readouterr().out


def opened(port, count, said=b"GET / HTTP/1.1\r\nHost: a\r\n"):
    """Open connections to this address that begin to ask."""
    lines = [socket.create_connection((HERE, port), timeout=5) for _ in range(count)]
    for one in lines:
        one.sendall(said)
    return lines


def is_closed(line, within_s=5.0):
    line.settimeout(within_s)
    try:
        while line.recv(4096):
            pass
    except TimeoutError:
        return False
    except ConnectionError:
        pass
    return True


@pytest.mark.parametrize("said", [b"", b"GET / HTTP/1.1\r\nHost: a\r\n"])
def test_who_does_not_say_what_is_asked_is_closed(served, monkeypatch, said):
    monkeypatch.setattr(lan, "_HEAD_S", 0.5)
    with opened(served.port + 1, 1, said)[0] as line:
        assert is_closed(line)


def test_who_asked_once_must_say_as_soon_what_is_asked_next(served, monkeypatch):
    monkeypatch.setattr(lan, "_HEAD_S", 1.0)
    with opened(served.port + 1, 1, b"GET /none HTTP/1.1\r\nHost: a\r\n\r\n")[0] as line:
        assert line.recv(4096).startswith(b"HTTP/1.1 404")
        line.sendall(b"GET / HTTP/1.1\r\n")
        assert is_closed(line)


def test_who_waits_for_a_slow_answer_or_has_a_websocket_is_not_closed(served, monkeypatch):
    monkeypatch.setattr(lan, "_HEAD_S", 0.2)
    slow = f"{HERE}:{served.port}/scouting/slow"
    assert got(f"https://{slow}", trusting(served))[2] == b"inside"
    with connect(f"wss://{slow}", ssl=trusting(served), proxy=None) as socket_:
        assert socket_.recv(timeout=5) == "inside"


@pytest.mark.parametrize("beside", [0, 1])
def test_one_device_that_opens_many_connections_keeps_nobody_out(served, caplog, beside):
    port = served.port + beside
    lines = opened(port, lan._MOST_OF_ONE + 30, b"")
    try:
        beyond = lines[lan._MOST_OF_ONE - 5 :]
        until(lambda: sum(is_closed(one, 0.01) for one in beyond) >= 30)
        assert not any(is_closed(one, 0.001) for one in lines[: lan._MOST_OF_ONE - 5])
        assert got(f"http://127.0.0.1:{served.own}/")[2] == b"inside"
        with socket.create_connection((HERE, port), 5, ("127.0.0.3", 0)) as other:
            assert not is_closed(other, 0.2)
    finally:
        for one in lines:
            one.close()

    def taken_again():
        with socket.create_connection((HERE, port), 5) as one:
            return not is_closed(one, 0.2)

    until(taken_again)
    refused = [one for one in caplog.records if "asks for more" in one.getMessage()]
    assert len(refused) <= lan._LINES_OF_LOG, "the log stays short"


def test_a_line_takes_so_many_connections_of_all_devices():
    with lan._Listening(socket.create_server((HERE, 0)), 2) as line:
        others = [socket.create_connection(line.getsockname(), 5) for _ in range(3)]
        taken = [line.accept()[0], line.accept()[0]]
        with pytest.raises(ConnectionAbortedError):
            line.accept()
        assert is_closed(others[2])
        taken[0].close()
        others.append(socket.create_connection(line.getsockname(), 5))
        taken.append(line.accept()[0])
        for one in [*taken, *others]:
            one.close()


def test_each_place_writes_few_lines_into_the_log_and_says_that_there_are_more(monkeypatch, caplog):
    log = logging.getLogger("tests.flooded")
    log.addFilter(lan._Seldom())
    for k in range(50):
        log.warning("device %d", k)
    log.warning("from another place")
    said = [one.getMessage() for one in caplog.records if one.name == log.name]
    assert said[:9] == [f"device {k}" for k in range(9)]
    assert said[9:] == [
        "device 9 (More of these within the minute are left out.)", "from another place"
    ]  # fmt: skip
    monkeypatch.setattr(lan, "_LOG_S", 0.0)
    for k in range(50):
        log.warning("device %d", k)
    assert len([one for one in caplog.records if one.name == log.name]) == 61


def test_enough_files_may_be_open():
    resource = pytest.importorskip("resource")
    code = (
        "import resource as r; from app.startup import lan;"
        "r.setrlimit(r.RLIMIT_NOFILE, (256, 1000)); print(lan._open_files());"
        "print(r.getrlimit(r.RLIMIT_NOFILE));"
        "r.setrlimit(r.RLIMIT_NOFILE, (500, 500)); print(lan._open_files())"
    )
    if resource.getrlimit(resource.RLIMIT_NOFILE)[1] in range(1000):
        pytest.skip("fewer files may be open here")
    said = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
    assert said.stdout.split(b"\n")[:3] == [b"1000", b"(1000, 1000)", b"500"]


def test_a_port_that_somebody_else_has_is_a_sentence(served):
    with pytest.raises(SettingError, match="must be free for other devices"):
        lan._listening(HERE, served.port)
