"""Do the tests bite? Small faults, one at a time, in a copy of the tree; who notices them?

    python tests/mutants.py infestation monitoring --each 60 --output mutants.csv
    python tests/mutants.py infestation --again mutants.csv --output again.csv

A mutant is one small change of a module: ``<`` made ``<=``, ``+`` made ``-``, a number another, a
condition turned round, a call left out. It is tried on the tests that reach the changed function
when nothing is wrong (measured once, for a copy that is kept): those of the module first, the quick
before the slow. A mutant that no test notices survives: write what must hold, or say why it changes
nothing.

Ours, since both kept tools fail on compiled loops: mutmut leaves decorated functions alone, so all
loops; cosmic-ray starts Python for every mutant and marks every file as changed, so that each
time all loops compile again. Here a process that has imported and collected all forks for every
mutant (tests/mutants_warm.py).
"""

from __future__ import annotations

import argparse
import ast
import copy
import csv
import os
import random
import shutil
import signal
import sys
import tempfile
import time
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
    """Return a module's tree with one place changed, and how the change reads."""
    places = _Places(place)
    tree = ast.fix_missing_locations(places.visit(ast.parse(source)))
    return tree, places.changed


def mutants_of(path):
    """Return all mutants of a module."""
    source = path.read_text("utf-8")
    places = _Places()
    places.visit(ast.parse(source))
    return [Mutant(path, k, line, "") for k, line in enumerate(places.found)]


@cache
def _top_of(path):
    return ast.parse(path.read_text("utf-8")).body


def _definitions(node):
    """Yield a function or a class, and the methods in it."""
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
        yield node
    if isinstance(node, ast.ClassDef):
        yield from (one for one in node.body if isinstance(one, ast.FunctionDef))


def _words(node):
    found = {one.id for one in ast.walk(node) if isinstance(one, ast.Name)}
    return found | {one.attr for one in ast.walk(node) if isinstance(one, ast.Attribute)}


def _inside(mutant):
    """Return what a mutant stands in, from the outside: a class, a function, or nothing."""
    return [one for top in _top_of(mutant.path) for one in _definitions(top)
            if one.lineno <= mutant.line <= (one.end_lineno or 0)]  # fmt: skip


def mutant_function(mutant):
    """Return the name of the function that a mutant changes, of its class where that makes it."""
    name = None
    for one in _inside(mutant):
        special = one.name.startswith("__") and name is not None
        name = name if special else one.name
    return name


@cache
def _all_words(root):
    """Return the words in each function of the library, by its file and name."""
    found = {}
    for file in sorted((root / "fieldmon").rglob("*.py")):
        for top in _top_of(file):
            for one in _definitions(top):
                of = f"{top.name}." if one is not top else ""
                found[f"{file.relative_to(root)}:{of}{one.name}"] = _words(one)
    return found


def _is_in_function(mutant):
    inside = _inside(mutant)
    return bool(inside) and isinstance(inside[-1], ast.FunctionDef)


def _said_at(mutant):
    """Return the constants that a mutant of a module changes, and those that are made of them."""
    assigned = [one for one in _top_of(mutant.path) if isinstance(one, (ast.Assign, ast.AnnAssign))]
    found = set()
    for one in assigned:
        named = _words(ast.Tuple(one.targets if isinstance(one, ast.Assign) else [one.target]))
        stands = one.lineno <= mutant.line <= one.end_lineno
        if stands or (one.value is not None and found & _words(one.value)):
            found |= named
    return found


def functions_changed(mutant):
    """Return the functions in which a mutant shows; of a constant, those that name it."""
    inside, module = _inside(mutant), mutant.path.relative_to(ROOT)
    if _is_in_function(mutant):
        return {f"{module}:{'.'.join(one.name for one in inside)}"}
    names = {one.name for one in inside} | _said_at(mutant)
    own = tuple(f"{module}:{name}." for name in names)
    return {one for one, words in _all_words(ROOT).items() if words & names or one.startswith(own)}


def own_tests(module):
    """Return the test file of a module, or the folder of its room."""
    named = ROOT / "tests" / module.relative_to("fieldmon").with_name(f"test_{module.name}")
    return named.relative_to(ROOT) if named.is_file() else named.parent.relative_to(ROOT)


class Nearest:
    """Chooses tests for a mutant: who reaches it, the nearest and quickest first."""

    def __init__(self, known):
        self.known, self.kills = known, {}

    def of(self, mutant, most_s):
        """Return the names of tests that take so long together at most."""
        module, changed = mutant.path.relative_to(ROOT), functions_changed(mutant)
        own, room = str(own_tests(module)), f"{own_tests(module).parent}/"
        # other processes have no fault put in: they say something of who starts them alone
        found = [one for one, it in self.known.items() if it["ok"] and changed & set(it["reach"])
                 and (not it["elsewhere"] or one.startswith(f"{own}::"))]  # fmt: skip
        anew = not _is_in_function(mutant)
        if anew:
            found += [one for one in self.known if one.startswith("tests/test_dataclasses")]

        def far(one):
            return 0 if one.startswith(own) else 1 if one.startswith(room) else 2

        def cost(one):
            return (far(one), self.known[one]["s"] / (1 + 4 * self.kills.get(one, 0)))

        sum_s, chosen, files = 0.0, [], set()
        for one in sorted(found, key=cost):
            files.add(one.split("::")[0])
            if anew and len(files) > 6:  # files that would be imported anew
                break
            sum_s += self.known[one]["s"]
            if sum_s > most_s and chosen:
                break
            chosen.append(one)
        return chosen

    def tell(self, test):
        """Hear which test noticed a mutant: it is tried earlier on the next."""
        self.kills[test] = self.kills.get(test, 0) + 1


def copied_tree(folder):
    """Copy the tree; what was compiled in an older copy is kept."""
    tree, left_out = folder / "tree", [".git", ".venv", "node_modules", "_build"]
    left_out += ["*.nbi", "*.nbc"] if tree.exists() else []
    shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(*left_out), dirs_exist_ok=True)
    shared = folder / "shared"
    if not shared.exists():
        shared.symlink_to(ROOT.parent / "shared")
    return tree


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
        rows = [row for row in csv.reader(lines) if row[:2] == [room, "survived"]]
    told = [(ROOT / module, int(line), said) for _, _, module, line, said, *_ in rows]
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
    asked.add_argument("--tests-s", type=float, default=60, help="most seconds of tests a mutant")
    asked.add_argument(
        "--tested", nargs="+", help="tests of these rooms alone, as of tests/io/writers"
    )
    asked.add_argument("--kept", type=Path, help="folder of a copy and what was measured of it")
    asked.add_argument("--output", type=Path, default=Path("mutants.csv"))
    told = asked.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # the child at work is ended, too
    with tempfile.TemporaryDirectory(prefix="mutants-") as passing, told.output.open("a") as file:
        folder = (told.kept or Path(passing)).absolute()
        folder.mkdir(exist_ok=True)
        tree = copied_tree(folder)
        from mutants_warm import TESTED, Warm

        out = os.fdopen(os.dup(1), "w")
        warm = Warm(tree, told.tested or TESTED)
        warm.measure(folder / "reached.json")
        nearest = Nearest(warm.known)
        for room in told.rooms:
            out.write(f"{room}: {_tried_room(room, warm, nearest, told, file)}\n")
            out.flush()


def _tried_room(room, warm, nearest, told, file):
    """Try mutants of a room, write a line a mutant; return the score in words."""
    began, counted, table = time.monotonic(), {}, csv.writer(file)
    mutants, n_all = (
        chosen(room, told.each, told.seed) if told.again is None else survivors(told.again, room)
    )
    for mutant in mutants:
        if time.monotonic() > began + 60 * told.minutes:
            break
        module = mutant.path.relative_to(ROOT)
        source = (warm.tree / module).read_text("utf-8")
        new, said = mutated(source, mutant.place)
        tests, by, cpu_s = nearest.of(mutant, told.tests_s), None, 0.0
        if tests:
            by, cpu_s = warm.tried(warm.tree / module, ast.parse(source), new, tests, 150)
        ended = (by or "survived").split(":")[0]
        # what was not tried to the end counts as not noticed
        outcome = {"slow": "slow", "survived": ended, "unfinished": "survived"}.get(
            ended, "noticed"
        )
        if outcome == "noticed":
            nearest.tell(by)
        counted[outcome] = counted.get(outcome, 0) + 1
        row = (room, outcome, module, mutant.line, said, by, round(cpu_s, 1), len(tests))
        table.writerow(row)
        file.flush()
    n = sum(counted.values())
    noticed, each_s = n - counted.get("survived", 0), (time.monotonic() - began) / max(n, 1)
    return f"{noticed} of {n} noticed ({n_all} there are), {each_s:.1f} s each: {counted}"


if __name__ == "__main__":
    main()
