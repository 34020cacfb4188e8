"""The tool that puts small faults in: a child ends as a child, whatever its tests do."""

import gc
import os
import signal
import subprocess
import sys
import weakref
from types import CodeType

import pytest

from fieldmon.io.sandbox import process
from tests import mutants_warm
from tests.mutants import mutants_of, mutated
from tests.paths import ROOT


def _raised(error):
    def work():
        raise error

    return work


def _mute_exit():
    os._exit = lambda _: None
    return 0


WORK = {
    "done": (lambda: 0, 0),
    "noticed": (lambda: 1, 1),
    "an error": (_raised(ValueError()), 70),
    "an end": (_raised(SystemExit(0)), 70),
    "Ctrl-C": (_raised(KeyboardInterrupt()), 70),
    "the end of a run": (_raised(pytest.exit.Exception("all")), 70),
    "nothing returned": (lambda: None, 70),
    "an exit that does nothing": (_mute_exit, 0),
}


@pytest.mark.parametrize("name", WORK)
def test_a_child_ends_whatever_its_work_does(name):
    work, code = WORK[name]
    child = os.fork()
    if child == 0:
        try:
            mutants_warm.end_as(work)
        finally:
            os.kill(os.getpid(), signal.SIGABRT)  # it went on
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == code


def test_a_child_whose_end_fails_is_ended(monkeypatch):
    monkeypatch.setattr(mutants_warm, "_END", lambda _: None)
    child = os.fork()
    if child == 0:
        mutants_warm.end_as(lambda: 0)
        os.kill(os.getpid(), signal.SIGABRT)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL


SCRIPT = """
import multiprocessing, os, sys
sys.path.insert(0, {root!r})
from tests import mutants_warm

with open({told!r}, "a") as told:
    told.write("began\\n")
{guard}
def work():
    {forget}
    process = multiprocessing.get_context("spawn").Process(target=os.getpid)
    process.start()
    process.join()
    return 0

child = os.fork()
if child == 0:
    mutants_warm.end_as(work)
os.waitpid(child, 0)
"""


@pytest.mark.parametrize(
    ("forget", "n"), [("mutants_warm.forget_script()", 1), ("pass", 2)], ids=["forgot", "kept"]
)
def test_a_process_that_a_test_starts_does_not_run_the_script_again(forget, n, tmp_path):
    # the second shows that the script had no guard of its own
    script, told = tmp_path / "script.py", tmp_path / "told"
    guard = "mutants_warm.refuse_second()"
    script.write_text(SCRIPT.format(root=str(ROOT), told=str(told), forget=forget, guard=guard))
    subprocess.run(
        [sys.executable, str(script)], check=True, timeout=120, stderr=subprocess.DEVNULL
    )
    assert told.read_text() == "began\n" * n


def _frames(started):
    found = []
    sys.settrace(lambda frame, *_: found.append(mutants_warm.starts_another(frame)))
    try:
        started()
    finally:
        sys.settrace(None)
    return any(found)


def test_a_test_that_starts_processes_is_told_from_one_that_has_a_file_read():
    def reads():
        process.ReadingProcess().stop()

    assert _frames(lambda: subprocess.run([sys.executable, "-c", ""], check=True))
    assert not _frames(reads)
    assert not _frames(ROOT.exists)


SOURCE = """
LEVEL = 3

def told(x):
    return x < LEVEL

class Row:
    def seats(self, n):
        return [n + k for k in range(n)]
"""


def test_what_stands_for_something_that_is_gone_is_passed_over(tmp_path):
    gone = {1}
    held = weakref.proxy(gone)
    del gone
    assert any(one is held for one in gc.get_objects())
    assert mutants_warm.functions_within(tmp_path) == {}
    assert all(isinstance(one, CodeType) for one in mutants_warm.loops_run())
    assert mutants_warm.answers_kept("tests.nowhere") == []


def test_a_fault_is_put_in_where_a_function_stands_and_taken_out_again(tmp_path, monkeypatch):
    file = tmp_path / "seats_of_mutants.py"
    file.write_text(SOURCE)
    monkeypatch.syspath_prepend(str(tmp_path))
    import seats_of_mutants

    held = seats_of_mutants.told, seats_of_mutants.Row().seats
    before = [held[0](3), held[1](2)]
    standing = mutants_warm.functions_within(file)
    was = mutants_warm.code_of(mutated(SOURCE, None)[0], file)
    shown = []
    for mutant in mutants_of(file):
        now = mutants_warm.code_of(mutated(SOURCE, mutant.place)[0], file)
        pairs = [*mutants_warm.changed_functions(was, now)]
        if None in pairs:
            shown.append(None)
            continue
        with mutants_warm.fault(pairs, standing):
            shown.append([held[0](3), held[1](2)])
        assert [held[0](3), held[1](2)] == before
    assert shown == [None, [True, [2, 3]], [False, [2, 1]]]


LOOPS = """
from fieldmon.compute.jit import inner_loop, loop

@inner_loop
def twice(x):
    return 2 * x

@loop
def seats(x):
    return twice(x) + 1

@loop
def never(x):
    return x
"""


def test_a_fault_shows_in_loops_that_were_compiled_before(tmp_path, monkeypatch):
    file = tmp_path / "loops_of_mutants.py"
    file.write_text(LOOPS)
    monkeypatch.syspath_prepend(str(tmp_path))
    import loops_of_mutants

    every = (loops_of_mutants.seats, loops_of_mutants.twice, loops_of_mutants.never)
    codes = [one.py_func.__code__ for one in every]
    assert not mutants_warm.loops_run().intersection(codes)
    assert loops_of_mutants.seats(4) == 9
    # what ran while tests were found cannot be changed where it stands: they may hold its results
    assert mutants_warm.loops_run().intersection(codes) == {*codes[:2]}
    monkeypatch.setattr("fieldmon.compute.jit._KeptLoops.load_overload", lambda *_: None)
    monkeypatch.setattr("fieldmon.compute.jit._KeptLoops.save_overload", lambda *_: None)
    standing = mutants_warm.functions_within(file)
    was = mutants_warm.code_of(mutated(LOOPS, None)[0], file)
    now = mutants_warm.code_of(mutated(LOOPS, 0)[0], file)
    pairs = [*mutants_warm.changed_functions(was, now)]
    with mutants_warm.fault(pairs, standing):
        changed = mutants_warm.put_in(pairs, standing)
        mutants_warm.let_go(lambda one: one.__code__ in changed)
        assert loops_of_mutants.seats(4) == 13


SHARING = """
import pytest
from threading import Barrier

@pytest.fixture(scope="module")
def ground():
    return Barrier(2)

@pytest.fixture(scope="module")
def plot(ground):
    return ground.parties

def test_first(plot):
    assert plot == 2

def test_second(plot):
    assert plot == 2

def test_third():
    assert True
"""


def test_what_a_fixture_of_several_tests_reaches_each_of_them_reaches(tmp_path):
    file = tmp_path / "test_sharing_of_mutants.py"
    file.write_text(SHARING)
    seen, told = set(), {}
    fixtures = mutants_warm.FixturesReach(seen)

    class Measured:
        @pytest.hookimpl(wrapper=True)
        def pytest_runtest_protocol(self, item):
            seen.clear()
            before = sys.gettrace()
            sys.settrace(lambda frame, *_: seen.add(frame.f_code))
            try:
                return (yield)
            finally:
                sys.settrace(before)
                told[item.name] = {code.co_qualname for code in seen | fixtures.of(item)}

    # pytest's look for errors that nobody caught collects garbage five times, all of this process's
    config = ["-p", "no:cacheprovider", "-p", "no:terminal", "-p", "no:unraisableexception"]
    config += ["-n0", f"--rootdir={tmp_path}"]
    assert pytest.main([*config, "-c", "/dev/null", str(file)], [fixtures, Measured()]) == 0
    reached = {name for name, codes in told.items() if "Barrier.__init__" in codes}
    assert reached == {"test_first", "test_second"}
    assert "ground" in told["test_second"]
    assert "ground" not in told["test_third"]
