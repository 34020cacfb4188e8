"""What a visitor's browser says of itself."""

from types import SimpleNamespace

import pytest
import streamlit as st

from app.state import browser


@pytest.fixture
def visitor(monkeypatch):
    context = SimpleNamespace(headers={}, theme={}, timezone_offset=None)
    monkeypatch.setattr(st, "context", context)
    return context


def test_a_page_is_light_unless_it_says_dark(visitor):
    assert not browser.is_dark()
    visitor.theme = {"type": "dark"}
    assert browser.is_dark()


def test_a_device_says_its_time_zone_or_none(visitor):
    visitor.timezone = "Asia/Jerusalem"
    assert browser.zone() == "Asia/Jerusalem"
    visitor.timezone = None
    assert browser.zone() == ""


def test_a_tab_is_told_from_others_and_says_whether_it_is_connected(monkeypatch):
    assert browser.tab() is None  # no browser
    connected = {"mine", "other"}
    run = SimpleNamespace(session_id="mine")
    server = SimpleNamespace(is_active_session=connected.__contains__)
    monkeypatch.setattr(browser, "get_script_run_ctx", lambda **_: run)
    monkeypatch.setattr(browser.runtime, "exists", lambda: True)
    monkeypatch.setattr(browser.runtime, "get_instance", lambda: server)
    name, is_open = browser.tab()
    assert (name, is_open()) == ("mine", True)
    connected.discard("mine")
    assert not is_open()
