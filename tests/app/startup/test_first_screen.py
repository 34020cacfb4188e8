"""What a first page shows before anything is planned."""

from types import SimpleNamespace

import streamlit as st

from app.startup import preload
from fieldmon.compute.jit_progress import FIRST_USE
from tests.app.driving import opened


def test_while_loops_are_compiled_the_page_says_so_and_shows_the_outline(monkeypatch):
    seen = []

    class Ready:
        asked = 0

        def is_set(self):
            return False

        def wait(self, _):
            self.asked += 1
            if self.asked > 2:
                st.stop()
            return False

    waiting = SimpleNamespace(ready=Ready(), load=lambda **given: seen.append(given),
                              shown=SimpleNamespace(set=lambda: None))  # fmt: skip
    monkeypatch.setattr(preload, "start", lambda: waiting)
    monkeypatch.setattr(FIRST_USE, "compiled", 7)
    app = opened()
    assert "7 parts" in app.info[0].value
    assert seen == [{"map_sent": True}], "the outline went ahead of all that is loaded"
    assert not app.metric
    assert not app.get("bidi_component")


def test_the_outline_stands_where_the_map_will_be(monkeypatch):
    class Ready:
        def is_set(self):
            return False

        def wait(self, _):
            st.stop()

    waiting = SimpleNamespace(ready=Ready(), load=lambda **_: None)
    monkeypatch.setattr(preload, "start", lambda: waiting)
    pictures = [one.proto.body for one in opened().get("html") if "<img" in one.proto.body]
    assert len(pictures) == 1
    assert "Outline of plot" in pictures[0]
    assert 'class="first-map"' in pictures[0]
