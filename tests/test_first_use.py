"""What is said while an installation compiles its loops."""

import os
import subprocess
import sys

import pytest

from fieldmon import cli
from fieldmon.first_use import FirstUse

A_NIGHT = """
import numpy as np
from fieldmon.first_use import FIRST_USE
from fieldmon.planting import rectangle
from fieldmon.spread import Spread, night
night(rectangle(3, 3), np.ones(9, bool), Spread(), np.uint64(1))
print(FIRST_USE.compiled)
"""


def test_a_loop_within_a_loop_is_counted_and_the_outer_one_ends_last():
    heard = []
    use = FirstUse()
    use.tell(lambda *said: heard.append((said[0], said[2])))
    use.began()
    use.began()
    use.ended()
    use.ended()
    assert heard == [(0, True), (0, True), (1, True), (2, False)]


@pytest.mark.parametrize("tty", [True, False])
def test_a_command_says_that_it_compiles_and_wipes_it_away_where_it_can(monkeypatch, capsys, tty):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: tty, raising=False)
    said = cli._Compiling()
    said(0, 0.0, True)
    said(3, 2.0, True)
    said(4, 2.5, True)
    said(5, 3.0, False)
    err = capsys.readouterr().err
    assert err.count("Compiling") == (2 if tty else 1)
    assert err.endswith("\x1b[K" if tty else "...\n")


def test_only_the_first_use_of_an_installation_compiles(tmp_path):
    env = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}

    def compiled():
        command = [sys.executable, "-c", A_NIGHT]
        return int(subprocess.run(command, env=env, check=True, capture_output=True).stdout)

    assert compiled() > 0
    assert compiled() == 0
