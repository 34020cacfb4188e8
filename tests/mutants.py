"""Do the tests bite? Small faults, one at a time, in a copy of the tree; who notices them?

    python tests/mutants.py infestation monitoring --each 60 --output mutants.csv
    python tests/mutants.py infestation --again mutants.csv --output again.csv

A mutant is one small change of a module: ``<`` made ``<=``, ``+`` made ``-``, a number another, a
condition turned round, a call left out. The tests of the module are run on it, then the files of
tests that reach the changed function, the nearest first. A mutant that no test notices survives:
write what must hold, or say why it changes nothing.

Ours, since both kept tools fail on compiled loops: mutmut leaves decorated functions alone, so all
loops; cosmic-ray starts Python for every mutant and marks every file as changed, so that each
time all loops compile again. Here a warm process forks for every mutant, only loops that the
change reaches are compiled, and nothing of it is kept.
"""

from __future__ import annotations

import argparse
import ast
import copy
import csv
import importlib
import os
import random
import shutil
import signal
import sys
import tempfile
import time
import traceback
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: what each room's faults are looked for in
ROOMS = {
    "infestation": "fieldmon/infestation",
    "samplers": "fieldmon/samplers",
    "planning": "fieldmon/planning",
    "travel": "fieldmon/plot/travel.py",
    "monitoring": "fieldmon/monitoring",
    "writers": "fieldmon/io/writers",
    "simulation": "fieldmon/simulation",
}
#: promises about all modules at once: they take a second
_OF_ALL = (ROOT / "tests" / "test_dataclasses.py",)
#: tests that start programs, browsers or take minutes: they are not run on mutants
_LEFT_OUT = ("tests/app/", "tests/real/", "tests/benchmarks/", "tests/docs/", "tests/drive/")
_WARM = ("numpy", "numba", "scipy.sparse", "scipy.stats", "shapely", "pyproj", "pandas",
         "geopandas", "pytest", "pyogrio", "jinja2")  # fmt: skip
_SWAPPED = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.Pow: ast.Mult, ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd, ast.BitXor: ast.BitOr, ast.LShift: ast.RShift, ast.RShift: ast.LShift,
    ast.And: ast.Or, ast.Or: ast.And, ast.Break: ast.Continue, ast.Continue: ast.Break,
}  # fmt: skip
_NAMES = {"min": "max", "minimum": "maximum", "lesser": "greater", "all": "any", "argmin": "argmax"}
_NAMES |= {other: name for name, other in _NAMES.items()}


@dataclass(frozen=True)
class Mutant:
    """One change of one module: the number of the place, and how it reads."""

    path: Path
    place: int
    line: int
    said: str


class _Places(ast.NodeTransformer):
    """Counts the places where a module can be changed; changes the one that is asked for."""

    def __init__(self, wanted=None):
        self.wanted, self.found, self.changed = wanted, [], None

    def _at(self, node, change):
        """Count a place; return what stands there afterwards."""
        place = len(self.found)
        self.found.append(node.lineno)
        if place != self.wanted:
            return node
        before = ast.unparse(node)
        after = change(copy.deepcopy(node))
        ast.copy_location(after, node)
        said = ast.unparse(ast.fix_missing_locations(after))
        self.changed = f"{_short(before)}  ->  {_short(said)}"
        return after

    # what is said to people, checked by mypy or never run
    def visit_Raise(self, node):
        return node

    def visit_AnnAssign(self, node):
        if node.value is not None:
            node.value = self.visit(node.value)
        return node

    def visit_FunctionDef(self, node):
        node.body = [self.visit(one) for one in node.body]
        node.args.defaults = [self.visit(one) for one in node.args.defaults]
        node.args.kw_defaults = [one and self.visit(one) for one in node.args.kw_defaults]
        return node

    def visit_If(self, node):
        if ast.unparse(node.test) == "TYPE_CHECKING":
            return node
        self.generic_visit(node)
        return self._at(node, _turned_round)

    def visit_IfExp(self, node):
        self.generic_visit(node)
        return self._at(node, _turned_round)

    def visit_Expr(self, node):
        if not isinstance(node.value, ast.Call):
            return node
        self.generic_visit(node)
        return self._at(node, lambda _: ast.Pass())

    def visit_AugAssign(self, node):
        self.generic_visit(node)
        return self._at(node, _other_operator)

    def visit_BinOp(self, node):
        self.generic_visit(node)
        return node if _is_text(node.left) else self._at(node, _other_operator)

    def visit_BoolOp(self, node):
        self.generic_visit(node)
        return self._at(node, _other_operator)

    def visit_Compare(self, node):
        self.generic_visit(node)
        return self._at(node, _other_comparison)

    def visit_UnaryOp(self, node):
        if isinstance(node.operand, ast.Constant):
            return node
        self.generic_visit(node)
        return self._at(node, lambda one: one.operand)

    def visit_Break(self, node):
        return self._at(node, lambda _: ast.Continue())

    def visit_Continue(self, node):
        return self._at(node, lambda _: ast.Break())

    def visit_Constant(self, node):
        if isinstance(node.value, (bool, int, float)):
            return self._at(node, _other_number)
        return node

    def visit_JoinedStr(self, node):
        return node

    def visit_Name(self, node):
        return self._at(node, _other_name) if node.id in _NAMES else node

    def visit_Attribute(self, node):
        self.generic_visit(node)
        return self._at(node, _other_name) if node.attr in _NAMES else node


def _short(text):
    text = " ".join(text.split())
    return text if len(text) <= 90 else f"{text[:87]}..."


def _is_text(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _turned_round(node):
    node.test = ast.UnaryOp(ast.Not(), node.test)
    return node


def _other_operator(node):
    node.op = _SWAPPED.get(type(node.op), ast.Sub)()
    return node


def _other_comparison(node):
    node.ops[0] = _SWAPPED[type(node.ops[0])]()
    return node


def _other_number(node):
    value = node.value
    if isinstance(value, bool):
        node.value = not value
    else:
        node.value = value + 1 if isinstance(value, int) else (1.5 * value or 1.0)
    return node


def _other_name(node):
    if isinstance(node, ast.Name):
        node.id = _NAMES[node.id]
    else:
        node.attr = _NAMES[node.attr]
    return node


def mutated(source, place):
    """Return a module's source with one place changed, and how the change reads."""
    places = _Places(place)
    tree = ast.fix_missing_locations(places.visit(ast.parse(source)))
    return ast.unparse(tree), places.changed


def mutants_of(path):
    """Return all mutants of a module."""
    source = path.read_text("utf-8")
    places = _Places()
    places.visit(ast.parse(source))
    return [Mutant(path, k, line, "") for k, line in enumerate(places.found)]


def own_tests(module):
    """Return the test file of a module, or of the package it lies in."""
    named = ROOT / "tests" / module.relative_to("fieldmon").with_name(f"test_{module.name}")
    if named.is_file():
        return named
    folder = ROOT / "tests" / module.parent.relative_to("fieldmon")
    beside = folder / f"test_{module.parent.name}.py"
    return beside if beside.is_file() else folder


class Reached:
    """Which files of tests reach a function, the nearest first: who names it, or who names those.

    By the words that stand in functions, since nobody sees Python call a compiled loop. A method
    or a function of a common name is found too often: that costs time, not a verdict.
    """

    def __init__(self):
        self.names = {}  # each definition of the program: the words in it
        for file in sorted((ROOT / "fieldmon").rglob("*.py")):
            for top in ast.parse(file.read_text("utf-8")).body:
                for one in _definitions(top):
                    self.names[file, one.name] = _words(one)
        self.tests = {
            file: _words(ast.parse(file.read_text("utf-8")))
            for file in sorted((ROOT / "tests").rglob("test_*.py"))
            if not str(file.relative_to(ROOT)).startswith(_LEFT_OUT)
        }

    def at(self, mutant, most, farthest=4):
        """Return the nearest files of tests for a mutant, at most so many."""
        reached, found = {(mutant.path, mutant_function(mutant))}, []
        room = ROOT / "tests" / mutant.path.parent.relative_to(ROOT / "fieldmon")
        for _ in range(farthest):
            public = {name for _, name in reached if name and not name.startswith("_")}
            near = [file for file, words in self.tests.items() if words & public]
            near.sort(key=lambda file: (room not in file.parents, -len(self.tests[file] & public)))
            found += [file for file in near if file not in found]
            if len(found) >= most:
                break
            reached |= {
                (file, name)
                for (file, name), words in self.names.items()
                if words & public or any(at == file and one in words for at, one in reached)
            }
        return tuple(found[:most])


def _definitions(node):
    """Yield a function or a class, and the methods in it."""
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
        yield node
    if isinstance(node, ast.ClassDef):
        yield from (one for one in node.body if isinstance(one, ast.FunctionDef))


def _words(node):
    found = {one.id for one in ast.walk(node) if isinstance(one, ast.Name)}
    return found | {one.attr for one in ast.walk(node) if isinstance(one, ast.Attribute)}


@cache
def _top_of(path):
    return ast.parse(path.read_text("utf-8")).body


def mutant_function(mutant):
    """Return the name of the function that a mutant changes, of its class where that makes it."""
    name = None
    for top in _top_of(mutant.path):
        for one in _definitions(top):
            if one.lineno <= mutant.line <= (one.end_lineno or 0):
                special = one.name.startswith("__") and name is not None
                name = name if special else one.name
    return name


def _begin_session():
    """Begin a session of its own, that gives way to other programs as this one does."""
    told = Path("/proc/self/autogroup")  # where Linux shares time out by sessions
    gives_way = told.read_text().split()[-1] if told.is_file() else ""
    os.setsid()
    if gives_way:
        with suppress(OSError):  # nobody may ask for more than before
            told.write_text(gives_way)


def _tests_in(log, tests, copied):
    """Run tests in this process, a child that ends with their exit code."""
    _begin_session()
    os.chdir(copied)
    sys.path.insert(0, str(copied))
    sys.dont_write_bytecode = True
    quiet = os.open(log or os.devnull, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    for stream in (1, 2):
        os.dup2(quiet, stream)
    import pytest

    loops = importlib.import_module("fieldmon.compute.jit")
    loops._KeptLoops.save_overload = lambda *_: None  # what a fault compiles to is not kept
    words = ["-x", "-q", "-p", "no:cacheprovider", "--timeout=0", "--assert=plain"]
    os._exit(int(pytest.main([*words, *(str(copied / one.relative_to(ROOT)) for one in tests)])))


def run(tests, copied, seconds, log=None):
    """Return how tests ended in a process of their own: an exit code, or None if it took longer."""
    child = os.fork()
    if child == 0:
        try:
            _tests_in(log, tests, copied)
        except Exception:  # noqa: BLE001 - whatever it is, this process ends
            traceback.print_exc()
        finally:
            os._exit(70)
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.05)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


class Trial:
    """Tries mutants in a copy of the tree."""

    def __init__(self, copied):
        self.copied, self._takes = copied, {}

    def takes_s(self, tests):
        """Return how long tests take without a fault; None where they fail by themselves."""
        if tests not in self._takes:
            began = time.monotonic()
            good = run(tests, self.copied, 600) == 0
            self._takes[tests] = time.monotonic() - began if good else None
        return self._takes[tests]

    def outcome(self, mutant, lots):
        """Return which lot of tests noticed a mutant, "slow", or nobody: "survived"."""
        path = self.copied / mutant.path.relative_to(ROOT)
        stat, source = path.stat(), path.read_text("utf-8")
        text, said = mutated(source, mutant.place)
        for name, tests in lots.items():
            usual_s = self.takes_s(tests)
            if usual_s is None:
                continue  # they fail or take too long without a fault: they say nothing
            path.write_text(text, "utf-8")
            try:
                code = run(tests, self.copied, 60 + 4 * usual_s)
            finally:
                path.write_text(source, "utf-8")
                os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))  # or all loops compile
            if code != 0:
                return ("slow" if code is None else name), said
        return "survived", said


def chosen(room, each, seed):
    """Return some mutants of a room, drawn evenly from all that there are."""
    place = ROOT / ROOMS[room]
    modules = sorted(place.rglob("*.py")) if place.is_dir() else [place]
    every = [mutant for module in modules for mutant in mutants_of(module)]
    random.Random(f"{seed} {room}").shuffle(every)
    return every[:each], len(every)


def survivors(file, room):
    """Return the mutants of a room that a file of outcomes says survived, as they are now."""
    with file.open(newline="", encoding="utf-8") as lines:
        told = [(ROOT / module, int(line), said) for r, outcome, module, line, said
                in csv.reader(lines) if (r, outcome) == (room, "survived")]  # fmt: skip
    found = []
    for path, line, said in told:
        source = path.read_text("utf-8")
        # lines may have moved since
        nearest = sorted(mutants_of(path), key=lambda one: abs(one.line - line))
        same = (one for one in nearest[:400] if mutated(source, one.place)[1] == said)
        found += [one for one in (next(same, None),) if one is not None]
    return found, len(told)


def main():
    """Try mutants of the rooms named; write a line a mutant, and say the score of each room."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument("rooms", nargs="*", default=[*ROOMS], help=f"some of {', '.join(ROOMS)}")
    asked.add_argument("--each", type=int, default=10**9, help="most mutants of a room; else all")
    asked.add_argument("--seed", type=int, default=1)
    asked.add_argument("--minutes", type=float, default=10**6, help="most minutes a room")
    asked.add_argument("--again", type=Path, help="only those that this file says survived")
    asked.add_argument("--files", type=int, default=6, help="most files of tests that reach it")
    asked.add_argument("--room-tests", action="store_true", help="try survivors on all of the room")
    asked.add_argument("--output", type=Path, default=Path("mutants.csv"))
    told = asked.parse_args()
    for name in _WARM:
        importlib.import_module(name)
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder, told.output.open("a") as file:
        copied = Path(folder) / "tree"
        shutil.copytree(
            ROOT, copied, ignore=shutil.ignore_patterns(".git", "node_modules", "_build")
        )
        (Path(folder) / "shared").symlink_to(ROOT.parent / "shared")
        table, trial, reached = csv.writer(file), Trial(copied), Reached()
        for room in told.rooms:
            until, counted = time.monotonic() + 60 * told.minutes, {}
            mutants, n_all = (
                chosen(room, told.each, told.seed)
                if told.again is None
                else survivors(told.again, room)
            )
            for mutant in mutants:
                if time.monotonic() > until:
                    break
                module = mutant.path.relative_to(ROOT)
                lots = {"all": _OF_ALL, "module": (own_tests(module),)}
                for k, near in enumerate(reached.at(mutant, told.files), 1):
                    if near != own_tests(module):
                        lots[f"reached {k}"] = (near,)
                if told.room_tests:
                    lots["room"] = (ROOT / "tests" / module.parent.relative_to("fieldmon"),)
                outcome, said = trial.outcome(mutant, lots)
                counted[outcome] = counted.get(outcome, 0) + 1
                table.writerow((room, outcome, module, mutant.line, said))
                file.flush()
            n = sum(counted.values())
            noticed = n - counted.get("survived", 0)
            said = f"{room}: {noticed} of {n} noticed ({n_all} there are): {counted}"
            sys.stdout.write(f"{said}\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
