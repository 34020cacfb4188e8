"""A process that has imported and collected all: it forks for every mutant.

In the child the changed function gets its new code where it stands, so whoever holds it has the
fault; of the compiled loops only those that reach it are compiled. What runs while modules are
imported (a constant, a field of a class, a function that tests call to be collected) cannot be
changed so: there the child imports the library and its tests once more.
"""

from __future__ import annotations

import ast
import gc
import importlib
import importlib.abc
import importlib.util
import json
import mmap
import os
import shutil
import signal
import struct
import sys
import tempfile
import threading
import time
import traceback
from contextlib import contextmanager, suppress
from functools import _lru_cache_wrapper, partial
from pathlib import Path
from types import CodeType, FunctionType, ModuleType

import pytest
from _pytest.config import _prepareconfig
from _pytest.main import Session
from hypothesis import Phase, settings
from numba.core import config as numba_config
from numba.core import event
from numba.core.dispatcher import Dispatcher

#: rooms whose tests are tried on mutants, each on those that reach it
TESTED = ("infestation", "io/writers", "monitoring", "planning", "plot", "samplers", "simulation",
          "test_dataclasses.py")  # fmt: skip
_WORDS = ["-s", "-p", "no:cacheprovider", "-p", "no:terminal", "--timeout=0",
          "--assert=plain"]  # fmt: skip
_SLOW, _UNFINISHED, _BROKEN = (
    99,
    98,
    97,
)  # how a child is said to have ended that took too long, or was let be


_END = os._exit  # tests may replace it
_KILL = os.kill
_LITTLE = numba_config._OptLevel(1)


def collected(tree, files):
    """Return a pytest session with the tests of some files."""
    config = _prepareconfig([*_WORDS, f"--rootdir={tree}", *map(str, files)])
    config._do_configure()
    # a fault is to be noticed, not made small
    own = settings(phases=(Phase.explicit, Phase.generate), database=None)
    settings.register_profile("mutants", own)
    settings.load_profile("mutants")
    session = Session.from_config(config)
    config.hook.pytest_sessionstart(session=session)
    session.perform_collect()
    gc.unfreeze()
    return session


class _Said:
    """Hears how tests end."""

    def __init__(self):
        self.failed = self.skipped = False

    @pytest.hookimpl
    def pytest_runtest_logreport(self, report):
        self.failed |= report.failed
        if report.failed:
            sys.stderr.write(f"{report.nodeid}\n{report.longreprtext}\n")
        self.skipped |= report.skipped


class FixturesReach:
    """Keeps what fixtures reach as they are set up: all tests that use them reach it, too."""

    def __init__(self, seen):
        self.seen, self.reached = seen, {}

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        before = {*self.seen}
        self.seen.clear()
        try:
            return (yield)
        finally:
            self.reached.setdefault(fixturedef, set()).update(self.seen)
            self.seen |= before

    def of(self, item):
        """Return the code that the fixtures of a test reached, whichever test set them up."""
        info = getattr(item, "_fixtureinfo", None)
        every = [] if info is None else info.name2fixturedefs.values()
        return set().union(*(self.reached.get(one, ()) for defs in every for one in defs))


class _Compiling(event.Listener):
    """Sums the processor time that goes into compiling."""

    def __init__(self, shared):
        self.shared, self.began, self.depth, self.sum_s = shared, 0.0, 0, 0.0
        self.traced = None

    def on_start(self, _):
        if self.depth == 0:
            self.traced = sys.gettrace()
            sys.settrace(None)  # nobody asks what the compiler calls
            self.began = time.thread_time()
            self.shared.tell(is_compiling=1.0)
        self.depth += 1

    def on_end(self, _):
        self.depth -= 1
        if self.depth == 0:
            self.sum_s += time.thread_time() - self.began
            self.shared.tell(is_compiling=0.0, compiled_s=self.sum_s)
            sys.settrace(self.traced)


class _Shared:
    """What a child tells while it runs: which test, since when, and whether it compiles."""

    _fields = ("test", "from_cpu_s", "from_s", "is_compiling", "compiled_s", "from_compiled_s")

    def __init__(self):
        self.memory = mmap.mmap(-1, 8 * len(self._fields))

    def tell(self, **values):
        for name, value in values.items():
            struct.pack_into("d", self.memory, 8 * self._fields.index(name), value)

    def heard(self):
        return dict(zip(self._fields, struct.unpack_from("6d", self.memory), strict=True))


def function_name(tree, code):
    """Return the name by which a function is kept: its file and where it stands in it."""
    return f"{Path(code.co_filename).relative_to(tree)}:{code.co_qualname}"


def end_as(work):
    """Do a child's work and end this process, whatever the work raises or returns."""
    code = 70
    try:
        code = int(work())
    except BaseException:  # noqa: BLE001 - SystemExit, Ctrl-C and pytest's own are none of ours
        traceback.print_exc()
    finally:
        try:
            _END(code & 255)
        finally:
            _KILL(os.getpid(), signal.SIGKILL)


def forget_script():
    """Let no process that this one starts run the script again that began all.

    Python does so for each process that Dask or a pool starts ("spawn"): where the script has no
    guard it tried mutants once more, beside the first, and wrote to the same file.
    """
    script = sys.modules["__main__"]
    script.__spec__ = None
    vars(script).pop("__file__", None)


def refuse_second():
    """End this process where another Python started it and ran the script again."""
    if "--multiprocessing-fork" in sys.orig_argv:
        raise SystemExit("a process that a test started does not try mutants itself")


def functions_within(folder):
    """Return all functions whose code stands in a folder, by their code."""
    inside, found = str(folder), {}
    for one in gc.get_objects():  # some stand for what is gone: `isinstance` raises an error of it
        if type(one) is FunctionType and one.__code__.co_filename.startswith(inside):
            found.setdefault(one.__code__, []).append(one)
    return found


def answers_kept(name):
    """Return all functions of a library's modules that keep their answers (``@cache``)."""
    every = [one for one in gc.get_objects() if type(one) is _lru_cache_wrapper]
    return [one for one in every if one.__module__.split(".")[0] == name]


def put_in(pairs, functions):
    """Give functions their new code where they stand, so that whoever holds them has it.

    ``pairs`` are those of `changed_functions`, ``functions`` those of `functions_within`. Returns
    what is put in.
    """
    for old, new in pairs:
        for one in functions[old]:
            one.__code__ = new
    return {new for _, new in pairs}


@contextmanager
def fault(pairs, functions):
    """Put a change in for a while."""
    put_in(pairs, functions)
    try:
        yield
    finally:
        put_in([(old, old) for old, _ in pairs], functions)


def code_of(tree, file):
    """Return what a module's tree is compiled to."""
    return compile(tree, str(file), "exec", dont_inherit=True)


def starts_another(frame):
    """Tell whether a frame hands work to another process, which has no fault put in.

    A mutant that changes a result would differ from what such a process makes of it: that is no
    test's merit. The reading process only reads files.
    """
    code = frame.f_code
    if f"{os.sep}distributed{os.sep}" in code.co_filename:
        return True
    if code.co_name not in ("_execute_child", "_launch"):
        return False
    if not code.co_filename.endswith(("subprocess.py", "popen_spawn_posix.py")):
        return False
    while frame is not None:
        if f"{os.sep}sandbox{os.sep}" in frame.f_code.co_filename:
            return False
        frame = frame.f_back
    return True


def _inner(code):
    return [one for one in code.co_consts if isinstance(one, CodeType)]


def _loops_named(code, names):
    """Return the loops that a function's code names: by itself, in a module, a table or a class."""
    found = []
    for name in code.co_names:
        value = names.get(name)
        if isinstance(value, Dispatcher):
            found.append(value)
        elif isinstance(value, ModuleType):
            found += [vars(value).get(one) for one in code.co_names]
        elif isinstance(value, (tuple, list)):
            found += value
        elif isinstance(value, dict):
            found += value.values()
    inner = [loop for one in _inner(code) for loop in _loops_named(one, names)]
    return inner + [one for one in found if isinstance(one, Dispatcher)]


def loops_reached(function):
    """Return the functions of a loop and of all loops that it calls."""
    seen, waiting = {function}, [function]
    while waiting:
        one = waiting.pop()
        for loop in _loops_named(one.__code__, one.__globals__):
            if loop.py_func not in seen:
                seen.add(loop.py_func)
                waiting.append(loop.py_func)
    return seen


def loops_run():
    """Return the code of all loops that ran so far: Python tells nobody when one is called."""
    every = [one for one in gc.get_objects() if issubclass(type(one), Dispatcher) and one.overloads]
    return {function.__code__ for one in every for function in loops_reached(one.py_func)}


def _own_part(code):
    """Return what a body does itself, without the functions and classes in it."""
    consts = tuple(one for one in code.co_consts if not isinstance(one, CodeType))
    return code.co_code, repr(consts), code.co_names


def changed_functions(old, new):
    """Yield pairs of functions' code that differ; None where what is run at import does."""
    if _own_part(old) != _own_part(new) or len(_inner(old)) != len(_inner(new)):
        yield None
    for before, after in zip(_inner(old), _inner(new), strict=False):
        if before != after:
            if before.co_flags & 0x2:  # it has variables of its own: no module, no class
                yield before, after
            else:
                yield from changed_functions(before, after)


class Warm:
    """The library and its tests, imported once; mutants are tried in children."""

    def __init__(self, tree, rooms=TESTED):
        refuse_second()
        self.pid = os.getpid()
        self.tree, self.shared = tree, _Shared()
        self.files = [tree / "tests" / one for one in rooms if (tree / "tests" / one).exists()]
        os.chdir(tree)
        sys.path.insert(0, str(tree))
        self.at_import = set()
        sys.settrace(lambda frame, *_: self.at_import.add(frame.f_code))
        self.session = collected(tree, self.files)
        sys.settrace(None)
        self.at_import |= loops_run()
        self.items = {item.nodeid: item for item in self.session.items}
        self.functions = functions_within(tree / "fieldmon")
        self.answers = answers_kept("fieldmon") + answers_kept("tests")
        self.names_of = {getattr(one, "__file__", None): vars(one) for one in sys.modules.values()}
        gc.freeze()

    def measure(self, kept):
        """Run all tests without a fault, each file in a child; keep time and what they reach."""
        known = json.loads(kept.read_text()) if kept.exists() else {}
        by_file = {}
        for item in self.session.items:
            by_file.setdefault(item.path, []).append(item)
        for file, items in by_file.items():
            at = file.stat().st_mtime
            if all(known.get(one.nodeid, {}).get("at") == at for one in items):
                continue
            with tempfile.NamedTemporaryFile("r+", suffix=".json") as told:
                self._forked(partial(self._measured, items, at, told.name), lambda _: 900)
                for line in told:
                    nodeid, values = json.loads(line)
                    known[nodeid] = values
            part = kept.with_suffix(f".{os.getpid()}")
            part.write_text(json.dumps(known))
            part.replace(kept)
        self.known = {one: values for one, values in known.items() if one in self.items}
        for one, values in self.known.items():
            values["reach"] = [*{*values["reach"], *self._named_by(self.items[one])}]

    def _named_by(self, item):
        """Return the loops that a test's own function names, and what they call."""
        test = getattr(item.obj, "hypothesis", None)
        code = (item.obj if test is None else test.inner_test).__code__
        loops = _loops_named(code, vars(item.module))
        reached = {one for loop in loops for one in loops_reached(loop.py_func)}
        return {function_name(self.tree, one.__code__) for one in reached}

    def _measured(self, items, at, told):
        seen, others, compiling = set(), [], _Compiling(self.shared)
        event.register("numba:compile", compiling)
        fixtures = FixturesReach(seen)
        self.session.config.pluginmanager.register(fixtures)

        def trace(frame, *_):
            seen.add(frame.f_code)
            if not others and starts_another(frame):
                others.append(frame.f_code.co_filename)

        with Path(told).open("a") as lines:
            for item, after in zip(items, [*items[1:], None], strict=True):
                seen.clear()
                others.clear()
                self._forget_answers()  # what an earlier test had worked out is reached by none
                before_s, began_s = compiling.sum_s, time.process_time()
                threading.settrace(trace)
                sys.settrace(trace)
                said = self._run(item, after)
                sys.settrace(None)
                threading.settrace(None)
                takes_s = time.process_time() - began_s - (compiling.sum_s - before_s)
                reached = self._reached(seen | fixtures.of(item))
                good = not said.failed and not said.skipped
                values = {"at": at, "s": round(takes_s, 3), "ok": good, "reach": sorted(reached)}
                values["elsewhere"] = bool(others)
                lines.write(json.dumps((item.nodeid, values)) + "\n")
                lines.flush()
        return 0

    def _forget_answers(self):
        for one in self.answers:
            one.cache_clear()

    def _reached(self, seen):
        inside = str(self.tree / "fieldmon")
        own = [code for code in seen if code.co_filename.startswith(inside)]
        loops = set()
        for code in seen:  # tests call loops, too
            for loop in _loops_named(code, self.names_of.get(code.co_filename, {})):
                if loop.py_func not in loops:
                    loops |= loops_reached(loop.py_func)
        codes = [*own, *(one.__code__ for one in loops)]
        return {function_name(self.tree, code).split(".<locals>")[0] for code in codes}

    def _run(self, item, after):
        said = _Said()
        item.config.pluginmanager.register(said)
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
        item.config.pluginmanager.unregister(said)
        return said

    def _forked(self, work, limit_s, most_cpu_s=1e9, log=None):
        """Return the exit code of a child, or `_SLOW`; and the processor time it took."""
        assert os.getpid() == self.pid, "a child went on beside its parent"
        self.shared.tell(test=0, from_cpu_s=0, from_s=time.monotonic(), is_compiling=0,
                         compiled_s=0, from_compiled_s=0)  # fmt: skip
        folder = tempfile.mkdtemp(prefix="mutant-")
        child = os.fork()
        if child == 0:
            end_as(lambda: self._settle(Path(folder), log) or work())
        try:
            return self._waited(child, limit_s, most_cpu_s)
        finally:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(child, signal.SIGKILL)  # what a test left running
            shutil.rmtree(folder, ignore_errors=True)

    def _settle(self, folder, log):
        with suppress(OSError):
            os.setpgid(0, 0)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        forget_script()
        quiet = os.open(log or os.devnull, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        for stream in (1, 2):
            os.dup2(quiet, stream)
        self.session.config._tmp_path_factory._given_basetemp = folder / "tmp"

    def _waited(self, child, limit_s, most_cpu_s):
        while True:
            done, status, used = os.wait4(child, os.WNOHANG)
            if done:
                return os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime
            cpu_s, heard = _cpu_s(child), self.shared.heard()
            # compiling is not the test's own work
            own_s = cpu_s - heard["from_cpu_s"] - heard["compiled_s"] + heard["from_compiled_s"]
            waited_s = time.monotonic() - heard["from_s"]
            most_s = limit_s(int(heard["test"]))
            too_long = not heard["is_compiling"] and own_s > most_s
            idle = waited_s > 300 + 30 * most_s
            if too_long or idle or cpu_s > most_cpu_s:
                os.killpg(child, signal.SIGKILL)
                os.waitpid(child, 0)
                return (_SLOW if too_long or idle else _UNFINISHED), cpu_s
            time.sleep(0.02)

    def tried(self, source_path, old, new, tests, most_cpu_s, log=None):
        """Return which test noticed a change of a module ("slow: ..." too), or None; how long.

        ``old`` and ``new`` are the module's trees.
        """
        file = str(source_path)
        was, now = code_of(old, file), code_of(new, file)
        pairs = [*changed_functions(was, now)]
        is_swapped = all(self._can_swap(pair) for pair in pairs)
        usual = [self.known.get(one, {}).get("s", 1.0) for one in tests]

        def work():
            if not is_swapped:
                return self._noticed(self._imported_anew(file, now, tests))
            try:
                changed = put_in(pairs, self.functions)
                self._forget_answers()
                _compile_anew(lambda one: one.__code__ in changed)
            except Exception:  # noqa: BLE001 - whatever it is, no test has noticed it
                traceback.print_exc()
                return _BROKEN
            return self._noticed([self.items[one] for one in tests])

        code, cpu_s = self._forked(
            work, lambda at: 10 + 5 * usual[min(at, len(usual) - 1)], most_cpu_s, log
        )
        at = tests[int(self.shared.heard()["test"])]
        if code == _BROKEN:
            raise RuntimeError(f"a mutant of {file} could not be put in")
        if code == 0:
            return None, cpu_s
        return {_SLOW: "slow: ", _UNFINISHED: "unfinished: "}.get(code, "") + at, cpu_s

    def _can_swap(self, pair):
        return pair is not None and pair[0] in self.functions and pair[0] not in self.at_import

    def _imported_anew(self, file, now, tests):
        """Import the library and the tests once more, with another code of one module."""
        name = ".".join(Path(file).relative_to(self.tree).with_suffix("").parts)
        for one in [*sys.modules]:
            if one.split(".")[0] in ("fieldmon", "tests", "app", "conftest"):
                del sys.modules[one]
        sys.meta_path.insert(0, _Instead(name, file, now))
        files = list(dict.fromkeys(one.split("::")[0] for one in tests))
        folder = self.session.config._tmp_path_factory._given_basetemp
        # before tests are found: what their modules hold is worked out by these loops, too
        _compile_anew(lambda one: one.__code__.co_filename == file)
        self.session = collected(self.tree, [self.tree / one for one in files])
        self.session.config._tmp_path_factory._given_basetemp = folder
        found = {item.nodeid: item for item in self.session.items}
        return [found[one] for one in tests]  # one that is not there any more was noticed

    def _noticed(self, items):
        compiling = _Compiling(self.shared)
        event.register("numba:compile", compiling)
        for k, (item, after) in enumerate(zip(items, [*items[1:], None], strict=True)):
            used = os.times()
            self.shared.tell(test=k, from_cpu_s=used.user + used.system, from_s=time.monotonic(),
                             from_compiled_s=compiling.sum_s)  # fmt: skip
            if self._run(item, after).failed:
                return 1
        return 0


class _Instead(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Gives one module another code."""

    def __init__(self, name, file, code):
        self.name, self.file, self.code = name, file, code

    def find_spec(self, name, path=None, target=None):  # noqa: ARG002 - as Python calls it
        if name != self.name:
            return None
        return importlib.util.spec_from_file_location(name, self.file, loader=self)

    def exec_module(self, module):
        exec(self.code, vars(module))  # noqa: S102 - our own source


def let_go(is_changed):
    """Let no loop that reaches a change run as it was compiled while tests were found."""
    for one in [one for one in gc.get_objects() if issubclass(type(one), Dispatcher)]:
        if one.overloads and any(is_changed(each) for each in loops_reached(one.py_func)):
            one._make_finalizer()()
            one._reset_overloads()


def _compile_anew(is_changed):
    """Let loops that reach a change be compiled, all others be loaded, and nothing be kept."""
    # compiled for one use: quickly rather than well
    numba_config.OPT, numba_config.LOOP_VECTORIZE, numba_config.SLP_VECTORIZE = _LITTLE, 0, 0
    kept = importlib.import_module("fieldmon.compute.jit")._KeptLoops
    load = kept.load_overload

    def load_overload(self, sig, target_context):
        if any(is_changed(one) for one in loops_reached(self._py_func)):
            return None
        return load(self, sig, target_context)

    let_go(is_changed)
    kept.load_overload = load_overload
    kept.save_overload = lambda self, *_: self.end_turn()


def _cpu_s(child):
    try:
        fields = Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def parsed(text):
    """Return a module's tree."""
    return ast.parse(text)
