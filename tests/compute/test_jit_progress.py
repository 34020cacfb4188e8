"""What is said while an installation compiles its loops."""

import os
import subprocess
import sys

import pytest

from fieldmon.compute import jit_progress
from fieldmon.compute.jit_progress import FirstUse

A_COIN = """
import numpy as np
from fieldmon.compute.jit_progress import FIRST_USE
from fieldmon.compute.random_streams import coin
coin(np.uint64(1), 0)
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


def test_the_clock_of_work_stands_while_loops_are_compiled_or_waited_for(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(jit_progress, "monotonic", lambda: now[0])
    use = FirstUse()
    began = use.work_clock()

    def after(seconds):
        now[0] += seconds
        return use.work_clock() - began

    assert after(2.0) == 2.0
    use.began()
    assert after(30.0) == 2.0
    use.began()
    use.ended()
    assert after(10.0) == 2.0
    use.ended()
    assert after(0.0) == 2.0
    assert after(1.5) == 3.5
    now[0] += 20.0
    use.waited(20.0)
    assert after(0.5) == 4.0


@pytest.mark.parametrize("sees", [True, False])
def test_a_program_of_ones_own_says_once_that_it_compiles_where_somebody_sees_it(
    monkeypatch, capsys, sees
):
    now = [0.0]
    monkeypatch.setattr(jit_progress, "monotonic", lambda: now[0])
    monkeypatch.setattr(sys.stderr, "isatty", lambda: sees)
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    use = FirstUse()
    for _ in range(2):
        use.began()
        now[0] += 1.0
        use.ended()
        now[0] += 100.0  # work between two loops is not compiling
    use.began()
    assert not capsys.readouterr().err
    for _ in range(2):
        now[0] += 2.0
        use.ended()
        use.began()
    assert capsys.readouterr().err == (f"{jit_progress.COMPILING}\n" if sees else "")
    told = FirstUse()
    told.tell(lambda *_: None)
    told.began()
    now[0] += 4.0
    told.ended()
    assert not capsys.readouterr().err


def test_only_the_first_use_of_an_installation_compiles(tmp_path):
    env = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}

    def compiled():
        command = [sys.executable, "-c", A_COIN]
        return int(subprocess.run(command, env=env, check=True, capture_output=True).stdout)

    assert compiled() > 0
    assert compiled() == 0
