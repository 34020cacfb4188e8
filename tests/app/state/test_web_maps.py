"""Addresses of maps: whole, safe, and of one server that is named before anything is asked."""

from urllib.parse import unquote

import pytest

from app.state import web_maps
from fieldmon.errors import SettingError


@pytest.mark.parametrize(
    "address",
    [web_maps.OSM, " https://a.example/{z}/{x}/{-y}.jpg?key=1 ", "http://127.0.0.1:9/{z}/{x}/{y}"],
)
def test_an_address_of_tiles_is_taken(address):
    assert web_maps.checked(address) == address.strip()


@pytest.mark.parametrize(
    "address",
    ["", "x", "http://a.example/{z}/{x}/{y}", "https://a.example/{z}/{x}", "ftp://a/{z}/{x}/{y}",
     "https://{x}.example/{z}/{y}", "https://a.example/{z}/{x}/{y}/{s}", "javascript:{z}{x}{y}",
     "https://me:word@a.example/{z}/{x}/{y}", "https://a.example/{z}/{x}/{y} b", "https:///{z}{x}{y}",
     "https://a.example/{z}/{x}/{y}/" + "a" * 600, "https://a.example;img-src/{z}/{x}/{y}",
     "https://a.example,b/{z}/{x}/{y}"],
)  # fmt: skip
def test_what_is_no_such_address_is_refused_with_a_sentence(address):
    with pytest.raises(SettingError, match="must begin with https://"):
        web_maps.checked(address)


def test_a_worker_may_ask_the_one_server_that_was_agreed_to():
    asked = web_maps.Asked()
    assert asked.policy("/web_map/https://a.example.js") is None
    path = unquote(asked.worker("https://A.example/{z}/{x}/{y}.png"))
    assert path == "/web_map/https://a.example.js"
    assert asked.policy(path) == "default-src 'none'; connect-src https://a.example"
    own = unquote(asked.worker("https://bücher.example:8443/{z}/{x}/{y}"))
    assert asked.policy(own).endswith("connect-src https://xn--bcher-kva.example:8443")
    assert asked.worker("https://a.example;x/{z}/{x}/{y}") == ""


def test_the_server_that_is_asked_is_named_and_so_is_whom_to_thank():
    assert web_maps.host("https://a.example:8443/{z}/{x}/{y}") == "a.example:8443"
    assert "OpenStreetMap" in web_maps.credit(web_maps.OSM)
    assert web_maps.credit("https://a.example/{z}/{x}/{y}") == "a.example"
