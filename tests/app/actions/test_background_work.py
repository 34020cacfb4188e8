"""Work in the background is begun and stopped by buttons."""

from types import SimpleNamespace

import pytest

from app.actions import background_work
from app.state import browser
from app.state.comparison import WatchedComparison
from tests.app.driving import go


def test_numbers_typed_just_before_pressing_compare_are_those_compared(app, monkeypatch):
    begun = []

    def start(comparison):
        begun.append(comparison)

    monkeypatch.setattr(WatchedComparison, "start", start)
    monkeypatch.setattr(browser, "tab", lambda: ("a tab", lambda: True))
    go(app, "compare")
    app.number_input(key="seeds").set_value(7)
    app.button(key="run").click().run()
    assert not app.exception
    (one,) = begun
    assert (one.settings.seeds, *one._tabs) == (7, "a tab")  # it ends with the tab
    assert one._is_watched()
    app.number_input(key="seeds").set_value(8).run()
    assert not one._is_watched()  # another took its place: nobody sees it
    app.number_input(key="seeds").set_value(7).run()
    assert one._is_watched()


@pytest.mark.parametrize(("done", "asked"), [(0, True), (1, False)])
def test_what_was_begun_is_not_asked_for_again(done, asked, monkeypatch):
    told = []
    monkeypatch.setattr(background_work.st, "info", told.append)
    monkeypatch.setattr(background_work.st, "progress", lambda *_: SimpleNamespace(progress=None))
    stopped = SimpleNamespace(running=False, done=done, total=60, is_answered=False)
    background_work.show_progress(stopped)
    assert bool(told) is asked
