"""Other devices reach the app encrypted and behind a password; the certificate is beside it."""

import socket
import ssl
import threading
import urllib.request
from types import SimpleNamespace
from urllib.error import HTTPError

import pytest
import uvicorn

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


def test_a_port_that_somebody_else_has_is_a_sentence(served):
    with pytest.raises(SettingError, match="must be free for other devices"):
        lan._listening(HERE, served.port)
