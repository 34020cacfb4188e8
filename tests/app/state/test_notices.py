"""Sentences that an action leaves are shown once, by the next run."""

import pytest
import streamlit as st

from app.state import notices
from fieldmon.errors import SettingError


@pytest.fixture
def shown(session, monkeypatch):  # noqa: ARG001 - said within it
    said = []
    for kind in ("success", "warning", "error"):
        monkeypatch.setattr(st, kind, lambda text, kind=kind, **_: said.append((kind, text)))
    return said


def test_what_an_action_returns_is_said_once(shown):
    notices.reporting(lambda n: f"{n} recorded")(3)
    notices.show()
    notices.show()
    assert shown == [("success", "3 recorded")]


def test_what_was_done_by_half_is_no_success_and_what_is_done_next_is_one(shown):
    def by_half():
        notices.warn()
        return "2 recorded, 2 left out"

    for action in (by_half, lambda: "3 recorded"):
        notices.reporting(action)()
        notices.show()
    assert shown == [("warning", "2 recorded, 2 left out"), ("success", "3 recorded")]


def test_a_problem_is_said_and_anything_else_is_a_fault(shown):
    def refuse():
        raise SettingError("It must be otherwise.")

    notices.reporting(refuse)()
    notices.show()
    assert shown == [("error", "It must be otherwise.")]
    with pytest.raises(ZeroDivisionError):
        notices.reporting(lambda: 1 / 0)()


def test_nothing_to_say_is_nothing_shown(shown, session):
    notices.reporting(lambda: "")()
    notices.show()
    assert shown == []
    assert session == {}
