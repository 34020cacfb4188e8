"""Nobody else's page asks, and nobody else's name leads here."""

import pytest

from app.startup import addresses

NAMES = frozenset({"localhost", "packing-house", "farm.example"})


def asks(host, origin=None, kind="http", method="GET"):
    headers = [(b"host", host.encode("latin-1"))] if host is not None else []
    if origin is not None:
        headers.append((b"origin", origin.encode()))
    return addresses.refusal({"type": kind, "method": method}, headers, NAMES)


@pytest.fixture(autouse=True)
def proxied(monkeypatch):
    monkeypatch.setenv(addresses.NAMES, "farm.example")


@pytest.mark.parametrize(
    "host",
    ["localhost:8501", "127.0.0.1:8501", "[::1]:8501", "192.168.1.7", "Packing-House",
     "farm.example", "localhost.:80"],
)  # fmt: skip
def test_numbers_and_own_names_are_answered(host):
    assert asks(host) is None


@pytest.mark.parametrize(
    "host",
    ["evil.example", "127.0.0.1.evil.example:8501", "evil.example:8501", "", None, "a@localhost",
     "localhost evil", "localhost:8501/x", "[evil]", "0x7f.1"],
)  # fmt: skip
def test_a_name_that_somebody_else_lets_lead_here_is_not(host):
    """DNS rebinding: the page of evil.example asks evil.example, which is this machine by now."""
    assert "asked for by another" in asks(host)


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("localhost:8501", "http://localhost:8501"),
        ("192.168.1.7:8501", "http://192.168.1.7:8501"),
        ("farm.example", "https://farm.example"),
        ("farm.example:443", "https://farm.example"),
        ("127.0.0.1:8501", "https://farm.example"),  # a proxy that asks us by its own way
        ("localhost:8501", None),  # a program, no page
    ],
)
def test_own_pages_open_their_socket_directly_and_behind_a_proxy(host, origin):
    assert asks(host, origin, "websocket") is None
    assert asks(host, origin, method="PUT") is None


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "https://evil.example", "null", "http://localhost:3000",
     "http://localhost.evil.example:8501", "file://", "http://packing-house:9"],
)  # fmt: skip
def test_a_page_of_another_site_opens_no_socket_and_sends_nothing(origin):
    for host in ("localhost:8501", "farm.example"):
        assert "another site" in asks(host, origin, "websocket")
        assert "another site" in asks(host, origin, method="POST")
        assert asks(host, origin) is None  # to read what is answered, browsers ask for leave


def test_the_machines_own_name_is_one_of_its_names(monkeypatch):
    monkeypatch.setattr(addresses.socket, "gethostname", lambda: "Tractor")
    assert {"tractor", "tractor.local", "localhost", "farm.example"} == addresses.own_names()
