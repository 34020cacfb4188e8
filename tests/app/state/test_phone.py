"""The address for a phone leads to the season, and says when no phone can reach it."""

from types import SimpleNamespace
from urllib.parse import parse_qs, urlsplit

import pytest
import streamlit as st

from app.state import phone
from tests.app.chosen import a_plot, chosen, in_season
from tests.monitoring.seasons import a_season


@pytest.fixture
def seen_at(monkeypatch):
    """Return what lets the page be seen at an address."""

    def at(url, **words):
        monkeypatch.setattr(st, "context", SimpleNamespace(url=url))
        monkeypatch.setattr(st, "query_params", words)

    return at


def test_it_leads_to_scouting_in_the_season_that_is_open(tmp_path, seen_at):
    seen_at("http://192.0.2.7:8501/season", season="Gate 2026", lang="he")
    url = urlsplit(phone.address(in_season(a_season(tmp_path / "s.gpkg"))).url)
    assert (url.netloc, url.path) == ("192.0.2.7:8501", "/")
    assert parse_qs(url.query) == {"season": ["Gate 2026"], "part": ["scout"]}, (
        "no language: its own"
    )


@pytest.mark.parametrize(
    ("host", "reachable"),
    [("127.0.0.1", False), ("localhost", False), ("[::1]", False), ("192.0.2.7", True),
     ("farm.example", True)],
)  # fmt: skip
def test_this_machine_s_own_names_reach_no_phone(host, reachable, seen_at):
    seen_at(f"http://{host}:8501/")
    assert phone.address(chosen(a_plot())).reachable is reachable
