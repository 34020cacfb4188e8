"""What a first page shows before anything is planned."""

from types import SimpleNamespace

import streamlit as st

from app.startup import preload
from fieldmon.compute.jit_progress import FIRST_USE
from tests.app.driving import opened


def test_while_loops_are_compiled_the_page_says_so_and_shows_the_outline(monkeypatch):
    class Ready:
        asked = 0

        def is_set(self):
            return False

        def wait(self, _):
            self.asked += 1
            if self.asked > 2:
                st.stop()
            return False

    waiting = SimpleNamespace(ready=Ready(), load=lambda **_: None)
    monkeypatch.setattr(preload, "start", lambda: waiting)
    monkeypatch.setattr(FIRST_USE, "compiled", 7)
    app = opened()
    assert "7 parts" in app.info[0].value
    (picture,) = app.get("deck_gl_json_chart")
    assert "boundary" in picture.proto.json
    assert not app.metric
