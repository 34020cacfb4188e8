"""Phones find the app where it was started for them, or where it is seen; that is said once."""

from types import SimpleNamespace
from urllib.parse import parse_qs, urlsplit

import pytest
import streamlit as st

from app.state import phone_address, scout_page


@pytest.fixture
def seen_at(monkeypatch):
    """Return what lets the page be seen at an address."""
    monkeypatch.delenv(scout_page.ADDRESS, raising=False)

    def at(url, **words):
        monkeypatch.setattr(st, "context", SimpleNamespace(url=url))
        monkeypatch.setattr(st, "query_params", words)

    return at


def test_it_leads_to_the_plan_that_is_open(seen_at):
    seen_at("http://192.0.2.7:8501/season", files="abc", day="2026-11-18", lang="he")
    url = urlsplit(phone_address.address().url)
    assert (url.netloc, url.path) == ("192.0.2.7:8501", "/")
    assert parse_qs(url.query) == {"files": ["abc"], "day": ["2026-11-18"]}, "no language: its own"


@pytest.mark.parametrize(
    ("host", "reachable"),
    [("127.0.0.1", False), ("localhost", False), ("[::1]", False), ("192.0.2.7", True),
     ("farm.example", True)],
)  # fmt: skip
def test_this_machine_s_own_names_reach_no_phone(host, reachable, seen_at):
    seen_at(f"http://{host}:8501/")
    assert phone_address.address().reachable is reachable
    assert not phone_address.base().works_offline, "phones keep encrypted pages only"


def test_what_the_app_was_started_for_comes_first(seen_at, monkeypatch):
    seen_at("http://127.0.0.1:8501/")
    monkeypatch.setenv(scout_page.ADDRESS, "https://field.example")
    assert phone_address.base() == phone_address.PhoneAddress("https://field.example", True)
    assert phone_address.base().works_offline


def test_without_a_browser_it_is_this_machine(seen_at, monkeypatch):
    seen_at(None)
    monkeypatch.setenv("STREAMLIT_SERVER_PORT", "9000")
    assert phone_address.base() == phone_address.PhoneAddress("http://127.0.0.1:9000", False)
