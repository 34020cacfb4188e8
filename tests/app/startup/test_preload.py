"""Loading while the person is still looking: in order, and never in anybody's way."""

import threading

import pytest

from app.startup import preload


@pytest.fixture
def steps(monkeypatch):
    """Return what is loaded, in order, with nothing really loaded."""
    done = []
    for name in (
        "_load_outline",
        "_load_first_page",
        "_load_planning",
        "_load_paper",
        "_load_simulation",
        "_load_charts",
    ):
        monkeypatch.setattr(preload, name, lambda name=name: done.append(name))
    monkeypatch.setattr(preload, "_BROWSER_S", 0.0)
    monkeypatch.setattr(preload, "_LATER_S", 30.0)
    return done


def test_the_outline_comes_first_and_what_other_pages_need_comes_after_a_page_was_shown(steps):
    loading = preload.Preload()
    loading.start()
    loading.load(map_sent=True)
    assert steps[:2] == ["_load_outline", "_load_first_page"]
    assert loading.ready.wait(180)
    assert "_load_simulation" not in steps
    loading.shown.set()
    loading.join(180)
    assert steps[2:] == ["_load_planning", "_load_paper", "_load_simulation", "_load_charts"]


def test_a_page_is_not_kept_waiting_where_loading_fails(steps, monkeypatch):
    def fails():
        raise RuntimeError

    monkeypatch.setattr(preload, "_load_outline", fails)
    monkeypatch.setattr(threading, "excepthook", lambda _: None)
    loading = preload.Preload()
    loading.start()
    loading.load(map_sent=False)
    assert loading.ready.wait(180)
    assert steps == []
