"""Loops are kept compiled, and what was kept may be damaged or of another version."""

import importlib
import logging
import os
import re
import shutil
import sys

import numba
import numpy as np
import pytest

from fieldmon.compute import jit
from fieldmon.compute.jit_progress import FIRST_USE
from tests.paths import ROOT

TUPLES = """
from typing import NamedTuple
class {name}(NamedTuple):
    high: float
    low: float
made = {name}
"""
LOOPS = """
import numpy as np
from fieldmon.compute.jit import inlined, inner_loop, loop, routine

@inlined
def twice(x):
    return 2.0 * x

@inner_loop
def apart(pair):
    return twice(pair.high) - twice(pair.low)

@loop
def spans(pair, out):
    for i in range(out.size):
        out[i] = i * apart(pair)

@routine
def squares(n):
    made = np.empty(n)
    for i in range(n):
        made[i] = i * i
    return made

@loop
def over(zero):
    return 1.0 / zero
"""


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """Hand out a folder of loops, each fresh import of which is another start of the program."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "kept"))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(jit, "_SAID", [])
    (tmp_path / "loops_to_keep.py").write_text(LOOPS)
    (tmp_path / "tuples_to_keep.py").write_text(TUPLES.format(name="Range"))
    yield tmp_path / "kept"
    for name in ("loops_to_keep", "tuples_to_keep"):
        sys.modules.pop(name, None)


def started():
    """Start the program again: return what it found, and how many loops it had to compile."""
    importlib.invalidate_caches()
    for name in ("loops_to_keep", "tuples_to_keep"):
        sys.modules.pop(name, None)
    before = FIRST_USE.compiled
    loops = importlib.import_module("loops_to_keep")
    pair = importlib.import_module("tuples_to_keep").made(3.0, 1.0)
    out = np.zeros(4)
    loops.spans(pair, out)
    return [*out, *loops.squares(3)], FIRST_USE.compiled - before


RIGHT = [0.0, 4.0, 8.0, 12.0, 0.0, 1.0, 4.0]


def test_a_second_start_loads_what_the_first_compiled(kept, caplog):
    found, compiled = started()
    assert found == RIGHT
    assert compiled >= 4, "numba's own may come on top, once a process"
    assert len(list(kept.rglob("*.nbc"))) == 4
    assert started() == (RIGHT, 0)
    assert caplog.records == []


@pytest.mark.parametrize("ending", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", [b"", b"\x80\x05garbage", None], ids=["empty", "other", "cut"])
def test_a_damaged_file_is_compiled_anew_and_that_is_said_once(kept, caplog, ending, damage):
    started()
    files = sorted(kept.rglob(f"*.{ending}"))
    assert len(files) == 4
    for file in files:
        whole = file.read_bytes()
        file.write_bytes(whole[: len(whole) // 2] if damage is None else damage)
    with caplog.at_level(logging.WARNING):
        found, compiled = started()
    # parts are linked into the loops that call them, which are kept whole or not at all
    assert (found, compiled) == (RIGHT, 4)
    (said,) = caplog.records
    assert said.name == "fieldmon"
    assert "compiled anew" in said.message
    caplog.clear()
    assert started() == (RIGHT, 0), "the damage was not mended"
    assert caplog.records == []


def test_who_needs_a_loop_that_another_process_compiles_waits_and_loads_it(
    kept, tmp_path, monkeypatch
):
    fcntl = pytest.importorskip("fcntl")
    started()
    elsewhere, waited = tmp_path / "elsewhere", []
    kept.rename(elsewhere)
    with (tmp_path / "loops_to_keep.py").open() as other:
        fcntl.flock(other, fcntl.LOCK_EX)

        def it_is_done(seconds):
            waited.append(seconds)
            shutil.copytree(elsewhere, kept, dirs_exist_ok=True)
            fcntl.flock(other, fcntl.LOCK_UN)

        monkeypatch.setattr(jit.time, "sleep", it_is_done)
        assert started() == (RIGHT, 0)
    assert len(waited) == 1


def test_who_compiles_for_too_long_is_not_waited_for(kept, tmp_path, monkeypatch):
    fcntl = pytest.importorskip("fcntl")
    monkeypatch.setattr(jit._Turns, "most_s", 0.0)
    with (tmp_path / "loops_to_keep.py").open() as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        assert started()[0] == RIGHT
    assert len(list(kept.rglob("*.nbc"))) == 4


@pytest.mark.usefixtures("kept")
def test_a_loop_that_cannot_be_compiled_makes_nobody_wait(tmp_path):
    fcntl = pytest.importorskip("fcntl")
    started()
    loops = importlib.import_module("loops_to_keep")
    with pytest.raises(numba.TypingError):
        loops.squares("three")
    with (tmp_path / "loops_to_keep.py").open() as other:
        fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)


@pytest.mark.usefixtures("kept")
def test_a_named_tuple_of_another_name_is_no_harm(tmp_path, caplog):
    started()
    (tmp_path / "tuples_to_keep.py").write_text(TUPLES.format(name="HighAndLow"))
    found, compiled = started()
    assert found == RIGHT
    assert compiled == 2, "what takes the tuple is compiled anew, the rest was loaded"
    assert "'Range'" in caplog.text
    assert started() == (RIGHT, 0)


def test_where_nothing_can_be_written_a_damaged_file_is_left_and_the_loop_runs(kept, monkeypatch):
    started()
    for file in kept.rglob("*.nbi"):
        file.write_bytes(b"")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(numba.core.caching.IndexDataCacheFile, "_open_for_write", full)
    assert started()[0] == RIGHT
    assert {file.read_bytes() for file in kept.rglob("*.nbi")} == {b""}


CALLER = """
from fieldmon.compute.jit import loop
from callee_to_keep import sign

@loop
def signed(x):
    return inner(x)

@loop
def inner(x):
    return sign(x) * x
"""
CALLEE = """
from fieldmon.compute.jit import inner_loop

@inner_loop
def sign(x):
    return {sign}
"""


@pytest.mark.usefixtures("kept")
def test_a_loop_is_compiled_anew_where_one_that_it_calls_has_changed_in_another_file(tmp_path):
    (tmp_path / "caller_to_keep.py").write_text(CALLER)
    counts = []
    for sign in ("1.0", "1.0", "-1.0", "-1.0"):
        (tmp_path / "callee_to_keep.py").write_text(CALLEE.format(sign=sign))
        os.utime(tmp_path / "callee_to_keep.py", (1e9, 1e9))
        importlib.invalidate_caches()
        for name in ("caller_to_keep", "callee_to_keep"):
            sys.modules.pop(name, None)
        shutil.rmtree(tmp_path / "__pycache__", ignore_errors=True)
        before = FIRST_USE.compiled
        assert importlib.import_module("caller_to_keep").signed(2.0) == float(sign) * 2.0
        counts.append(FIRST_USE.compiled - before)
    assert counts[0] >= 3
    assert counts[1:] == [0, 3, 0]
    for name in ("caller_to_keep", "callee_to_keep"):
        sys.modules.pop(name, None)


@pytest.mark.usefixtures("kept")
def test_a_loop_divides_as_ieee_754_says():
    started()
    loops = sys.modules["loops_to_keep"]
    assert loops.over(0.0) == np.inf
    assert np.isnan(loops.over(np.nan))


def test_every_loop_of_the_program_is_kept_by_this_guard():
    rule = re.compile(r"(?<!@kept\n)@nb\.|cache=True")
    files = [path for path in (ROOT / "fieldmon").rglob("*.py") if path.name != "jit.py"]
    assert [path for path in files if rule.search(path.read_text(encoding="utf-8"))] == []
