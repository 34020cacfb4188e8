"""Work in the background: it can be watched and stopped, goes on, and says its problem."""

import threading

from app.state import background_work
from app.state.background_work import BackgroundWork
from fieldmon.errors import FieldmonError
from tests.app.driving import until


class Steps(BackgroundWork):
    """Takes steps, each when it is let."""

    def __init__(self):
        super().__init__()
        self.taken, self.let = 0, threading.Semaphore(0)

    def work(self):
        while self.taken < 3:
            self.let.acquire()
            if self._is_over_here():
                return
            self.taken += 1


class Failing(BackgroundWork):
    """Cannot be done."""

    def work(self):
        raise FieldmonError("There must be a plot.")


def test_it_ends_at_the_step_it_is_at_and_goes_on_from_there():
    steps = Steps()
    assert not steps.running
    steps.begin()
    assert steps.running
    steps.stop()
    steps.let.release()
    steps.wait(180)
    assert not steps.running
    assert steps.taken == 0
    steps.let.release(3)
    steps.begin()
    steps.wait(180)
    assert steps.taken == 3
    assert steps.problem is None


def test_it_waits_while_no_tab_is_open_and_ends_where_none_comes_back(monkeypatch):
    monkeypatch.setattr(background_work, "_EVERY_S", 0.01)
    steps, asked, is_open = Steps(), [], threading.Event()

    def is_there():
        asked.append(steps.taken)
        return is_open.is_set()

    steps.watch("closed", lambda: False)
    steps.watch("lost for a moment", is_there)
    steps.begin()
    steps.let.release()
    until(lambda: len(asked) > 3)
    assert steps.running
    is_open.set()
    until(lambda: steps.taken == 1)
    assert {*asked} == {0}
    is_open.clear()
    monkeypatch.setattr(background_work, "UNSEEN_S", 0.0)
    steps.let.release()
    steps.wait(180)
    assert not steps.running
    assert steps.taken == 1


def test_what_cannot_be_done_is_kept_as_its_sentence():
    failing = Failing()
    failing.begin()
    failing.wait(180)
    assert not failing.running
    assert str(failing.problem) == "There must be a plot."
