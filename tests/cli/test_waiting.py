"""What a person at a terminal sees while a command takes its time."""

import contextlib
import sys
import threading
import time

import pytest

from fieldmon.cli import waiting
from fieldmon.compute.jit_progress import FirstUse


@pytest.mark.parametrize("tty", [True, False])
def test_a_command_says_that_it_compiles_and_wipes_it_away_where_it_can(monkeypatch, capsys, tty):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: tty, raising=False)
    use = FirstUse()
    monkeypatch.setattr(waiting, "FIRST_USE", use)
    shown = waiting.Waiting()
    with shown:
        use.began()
        use._since -= 2
        use.began()
        use.ended()
        use.ended()
    err = capsys.readouterr().err
    assert "Compiling" in err
    assert err.endswith("\x1b[K") if tty else err.count("Compiling") == 1


def test_a_long_command_counts_the_seconds_at_a_terminal_unless_a_bar_does(monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(waiting, "_SILENT_S", 0.0)
    with waiting.WAITING:
        time.sleep(1.2)
        before = capsys.readouterr().err
        with waiting.progress("Simulating"):
            time.sleep(1.2)
        barred = capsys.readouterr().err
    assert "Working, 1 s" in before
    assert "Working" not in barred
    assert "Simulating" in barred
    assert capsys.readouterr().err.endswith("\x1b[K")


@pytest.mark.parametrize("leaving", ["the command", "for a bar"])
def test_no_second_is_counted_after_the_count_was_wiped_away(monkeypatch, leaving):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(waiting, "_SILENT_S", 0.0)
    writing, written = threading.Event(), []

    def slow(text):
        if "Working" in text:
            writing.set()
            time.sleep(0.2)
        written.append(text)

    monkeypatch.setattr(waiting, "_show", slow)
    shown = waiting.Waiting()
    with shown:
        assert writing.wait(5)
        if leaving == "for a bar":
            with shown.silent():
                time.sleep(0.4)
                assert written[-1] == "\r\x1b[K"
    time.sleep(0.4)
    assert written[-1] == "\r\x1b[K"


def test_a_bar_that_is_told_what_is_done_is_as_far_as_that(monkeypatch):
    class Bar:
        length, pos = 1, 0

        def update(self, more):
            self.pos += more

    bar = Bar()
    monkeypatch.setattr(waiting, "progress", lambda _: contextlib.nullcontext(bar))
    with waiting.counting("Simulating") as count:
        for done in (2, 3, 7):
            count(done, 9)
            assert (bar.pos, bar.length) == (done, 9)
