"""Loops are kept compiled, and what was kept may be damaged or of another version."""

import importlib
import logging
import os
import re
import shutil
import sys
from pathlib import Path

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
from fieldmon.compute.jit import inner_inlined, inner_loop, loop, routine

@inner_inlined
def scaled(x, way):
    n, by = way
    return n * by * x

@inner_loop
def apart(pair, n):
    return scaled(pair.high, (1, 2)) - scaled(pair.low, (n, np.int32(1)))

@loop
def spans(pair, out):
    for i in range(out.size):
        out[i] = i * apart(pair, out.size // 2)

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


def written(folder):
    """Write loops into a folder, always at the same time: those compiled of them stay valid."""
    folder.mkdir()
    for name, text in (("loops", LOOPS), ("tuples", TUPLES.format(name="Range"))):
        (folder / f"{name}_to_keep.py").write_text(text)
        os.utime(folder / f"{name}_to_keep.py", (1e9, 1e9))


def forget():
    for name in ("loops_to_keep", "tuples_to_keep"):
        sys.modules.pop(name, None)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """Return a folder of loops that were compiled once, beside what was kept of them."""
    home = tmp_path_factory.mktemp("loops")
    written(home / "loops")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(numba.config, "CACHE_DIR", str(home / "kept"))
        patch.syspath_prepend(home / "loops")
        started()
    forget()
    (home / "kept").rename(home / "compiled")
    return home


@pytest.fixture
def loops(compiled, monkeypatch):
    """Hand out a folder of loops, each fresh import of which is another start of the program."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(compiled / "kept"))
    monkeypatch.setattr(jit, "_SAID", [])
    shutil.rmtree(compiled / "loops")
    written(compiled / "loops")
    monkeypatch.syspath_prepend(compiled / "loops")
    yield compiled / "loops"
    shutil.rmtree(compiled / "kept", ignore_errors=True)
    forget()


@pytest.fixture
def kept(compiled, loops):  # noqa: ARG001
    """Return what is kept of them: all four were compiled before."""
    return Path(shutil.copytree(compiled / "compiled", compiled / "kept"))


def started():
    """Start the program again: return what it found, and how many loops it had to compile."""
    importlib.invalidate_caches()
    forget()
    before = FIRST_USE.compiled
    loops = importlib.import_module("loops_to_keep")
    pair = importlib.import_module("tuples_to_keep").made(3.0, 1.0)
    out = np.zeros(4)
    loops.spans(pair, out)
    return [*out, *loops.squares(3)], FIRST_USE.compiled - before


RIGHT = [0.0, 4.0, 8.0, 12.0, 0.0, 1.0, 4.0]


@pytest.mark.usefixtures("loops")
def test_a_second_start_loads_what_the_first_compiled(compiled, caplog):
    found, n = started()
    assert found == RIGHT
    assert n >= 4, "numba's own may come on top, once a process"
    # one of each, though `scaled` is called with constants, a narrow number and any number
    assert len(list((compiled / "kept").rglob("*.nbc"))) == 4
    assert started() == (RIGHT, 0)
    assert caplog.records == []


@pytest.mark.parametrize("ending", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", [b"", b"\x80\x05garbage", None], ids=["empty", "other", "cut"])
def test_a_damaged_file_is_compiled_anew_and_that_is_said_once(kept, caplog, ending, damage):
    files = sorted(kept.rglob(f"*.{ending}"))
    assert len(files) == 4
    for file in files:
        whole = file.read_bytes()
        file.write_bytes(whole[: len(whole) // 2] if damage is None else damage)
    with caplog.at_level(logging.WARNING):
        # parts are linked into the loops that call them, which are kept whole or not at all
        assert started() == (RIGHT, 4)
    (said,) = caplog.records
    assert said.name == "fieldmon"
    assert "compiled anew" in said.message
    caplog.clear()
    assert started() == (RIGHT, 0), "the damage was not mended"
    assert caplog.records == []


def test_who_needs_a_loop_that_another_process_compiles_waits_and_loads_it(
    compiled, loops, monkeypatch
):
    fcntl = pytest.importorskip("fcntl")
    waited = []
    with (loops / "loops_to_keep.py").open() as other:
        fcntl.flock(other, fcntl.LOCK_EX)

        def it_is_done(seconds):
            waited.append(seconds)
            shutil.copytree(compiled / "compiled", compiled / "kept", dirs_exist_ok=True)
            fcntl.flock(other, fcntl.LOCK_UN)

        monkeypatch.setattr(jit.time, "sleep", it_is_done)
        assert started() == (RIGHT, 0)
    assert len(waited) == 1


def test_who_compiles_for_too_long_is_not_waited_for(compiled, loops, monkeypatch):
    fcntl = pytest.importorskip("fcntl")
    monkeypatch.setattr(jit._Turns, "most_s", 0.0)
    with (loops / "loops_to_keep.py").open() as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        assert started()[0] == RIGHT
    assert len(list((compiled / "kept").rglob("*.nbc"))) == 4


def test_a_loop_that_cannot_be_compiled_makes_nobody_wait(loops):
    fcntl = pytest.importorskip("fcntl")
    with pytest.raises(numba.TypingError):
        importlib.import_module("loops_to_keep").squares("three")
    with (loops / "loops_to_keep.py").open() as other:
        fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)


@pytest.mark.usefixtures("kept")
def test_a_named_tuple_of_another_name_is_no_harm(loops, caplog):
    (loops / "tuples_to_keep.py").write_text(TUPLES.format(name="HighAndLow"))
    found, n = started()
    assert found == RIGHT
    assert n == 2, "what takes the tuple is compiled anew, the rest was loaded"
    assert "'Range'" in caplog.text
    assert started() == (RIGHT, 0)


def test_where_nothing_can_be_written_a_damaged_file_is_left_and_the_loop_runs(kept, monkeypatch):
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


def test_a_loop_is_compiled_anew_where_one_that_it_calls_has_changed_in_another_file(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "kept"))
    monkeypatch.syspath_prepend(tmp_path)
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


@pytest.mark.usefixtures("loops")
def test_a_loop_divides_as_ieee_754_says():
    over = importlib.import_module("loops_to_keep").over
    assert over(0.0) == np.inf
    assert np.isnan(over(np.nan))


def test_every_loop_of_the_program_is_kept_by_this_guard():
    rule = re.compile(r"(?<!@kept\n)@nb\.|cache=True")
    files = [path for path in (ROOT / "fieldmon").rglob("*.py") if path.name != "jit.py"]
    assert [path for path in files if rule.search(path.read_text(encoding="utf-8"))] == []
