"""Work in the background: it can be watched and stopped, goes on, and says its problem."""

import threading

from app.state.background_work import BackgroundWork
from fieldmon.errors import FieldmonError


class Steps(BackgroundWork):
    """Takes steps, each when it is let."""

    def __init__(self):
        super().__init__()
        self.taken, self.let = 0, threading.Semaphore(0)

    def work(self):
        while self.taken < 3:
            self.let.acquire()
            if self._stop.is_set():
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


def test_what_cannot_be_done_is_kept_as_its_sentence():
    failing = Failing()
    failing.begin()
    failing.wait(180)
    assert not failing.running
    assert str(failing.problem) == "There must be a plot."
