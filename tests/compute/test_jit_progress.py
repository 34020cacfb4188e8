"""What is said while an installation compiles its loops."""

import os
import subprocess
import sys
import threading
import time

import pytest

from fieldmon.cli import waiting
from fieldmon.compute.jit_progress import FirstUse

A_NIGHT = """
import numpy as np
from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.plot.layout import rectangle
from fieldmon.infestation.spread import Spread, night
night(rectangle(3, 3), np.ones(9, bool), Spread(), np.uint64(1))
print(FIRST_USE.compiled)
"""


def test_a_loop_within_a_loop_is_counted_and_the_outer_one_ends_last():
    heard = []
    use = FirstUse()
    use.tell(lambda *said: heard.append((said[0], use.is_busy)))
    use.began()
    use.began()
    use.ended()
    use.ended()
    assert heard == [(0, True), (0, True), (1, True), (2, False)]


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


def test_only_the_first_use_of_an_installation_compiles(tmp_path):
    env = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}

    def compiled():
        command = [sys.executable, "-c", A_NIGHT]
        return int(subprocess.run(command, env=env, check=True, capture_output=True).stdout)

    assert compiled() > 0
    assert compiled() == 0
