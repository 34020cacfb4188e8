"""What a person at a terminal sees while a command takes its time."""

import contextlib
import sys
import threading
import time

import pytest

from fieldmon.cli import progress
from fieldmon.compute import jit_progress
from fieldmon.compute.jit_progress import FirstUse


@pytest.mark.parametrize("tty", [True, False])
def test_a_command_says_that_it_compiles_and_wipes_it_away_where_it_can(monkeypatch, capsys, tty):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: tty, raising=False)
    use = FirstUse()
    monkeypatch.setattr(progress, "FIRST_USE", use)
    shown = progress.Waiting()
    with shown:
        use.began()
        use.waited(jit_progress.LEAST_S)
        use.began()
        use.ended()
        use.ended()
    err = capsys.readouterr().err
    assert "Compiling" in err
    assert err.endswith("\x1b[K") if tty else err.count("Compiling") == 1


class Clock:
    """A clock that is a second later with each look, and which can be waited for."""

    def __init__(self):
        self.now, self.looked = 0.0, threading.Condition()

    def __call__(self):
        with self.looked:
            self.now += 1.0
            self.looked.notify_all()
            return self.now

    def goes_on(self):
        """Wait until the count was about to be written at least once more."""
        with self.looked:
            after = self.now + 2
            assert self.looked.wait_for(lambda: self.now >= after, 10)


def fast(monkeypatch):
    """Let seconds be counted at a terminal as fast as can be; return their clock."""
    made = Clock()
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(progress, "monotonic", made)
    monkeypatch.setattr(progress, "_SILENT_S", 0.0)
    monkeypatch.setattr(progress, "_EVERY_S", 0.001)
    return made


def test_a_long_command_counts_the_seconds_at_a_terminal_unless_a_bar_does(monkeypatch, capsys):
    clock, written = fast(monkeypatch), []
    monkeypatch.setattr(progress, "_show", written.append)
    with progress.WAITING:
        clock.goes_on()
        with progress.progress("Simulating"):
            clock.goes_on()
            assert written[-1] == "\r\x1b[K"
        clock.goes_on()
    assert written[0] == "\rWorking, 1 s\r"
    assert written[-1] == "\r\x1b[K"
    assert written.count("\r\x1b[K") == 2
    assert "Simulating" in capsys.readouterr().err


@pytest.mark.parametrize("leaving", ["the command", "for a bar"])
def test_no_second_is_counted_after_the_count_was_wiped_away(monkeypatch, leaving):
    clock = fast(monkeypatch)
    writing, written, others = threading.Event(), [], {*threading.enumerate()}

    def slow(text):
        if "Working" in text:
            writing.set()
            time.sleep(0.02)  # whoever leaves meanwhile must wait for it
        written.append(text)

    monkeypatch.setattr(progress, "_show", slow)
    shown = progress.Waiting()
    with shown:
        (count,) = {*threading.enumerate()} - others
        assert writing.wait(5)
        if leaving == "for a bar":
            with shown.silent():
                clock.goes_on()
                assert written[-1] == "\r\x1b[K"
    count.join(5)
    assert written[-1] == "\r\x1b[K"


def test_a_bar_that_is_told_what_is_done_is_as_far_as_that(monkeypatch):
    class Bar:
        length, pos = 1, 0

        def update(self, more):
            self.pos += more

    bar = Bar()
    monkeypatch.setattr(progress, "progress", lambda _: contextlib.nullcontext(bar))
    with progress.counting("Simulating") as count:
        for done in (2, 3, 7):
            count(done, 9)
            assert (bar.pos, bar.length) == (done, 9)
