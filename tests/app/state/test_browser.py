"""What a visitor's browser says of itself."""

from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import pytest
import streamlit as st

from app.state import browser


@pytest.fixture
def visitor(monkeypatch):
    context = SimpleNamespace(headers={}, theme={}, timezone_offset=None)
    monkeypatch.setattr(st, "context", context)
    return context


def test_a_phone_is_told_by_its_name(visitor):
    assert not browser.is_phone()
    visitor.headers["User-Agent"] = "Mozilla/5.0 (Linux; Android 14) Mobile Safari/537.36"
    assert browser.is_phone()


def test_a_page_is_light_unless_it_says_dark(visitor):
    assert not browser.is_dark()
    visitor.theme = {"type": "dark"}
    assert browser.is_dark()


def test_a_moment_is_told_in_the_browser_s_time(visitor):
    noon = datetime(2026, 11, 16, 12, tzinfo=UTC)
    visitor.timezone_offset = -120  # minutes to add to local time, as browsers have it
    assert browser.local(noon) == datetime(2026, 11, 16, 14)
    visitor.timezone_offset = 300
    assert browser.local(noon) == datetime(2026, 11, 16, 7)


def test_now_is_now_to_the_second(visitor):
    visitor.timezone_offset = 0
    now = browser.now()
    assert now.microsecond == 0
    assert abs(now.replace(tzinfo=UTC) - datetime.now(UTC)) < timedelta(seconds=5)
