"""All small faults of some functions, tried at once: loops as plain Python, in this very process.

    python tests/mutants_plain.py

For functions that have an oracle of their own (`HELD`), on tiny plots: nothing is compiled, so a
mutant takes milliseconds. `tests/mutants.py` draws from all the others.
"""

import ast
import importlib
import itertools
import os
import sys
from pathlib import Path

os.environ["NUMBA_DISABLE_JIT"] = "1"
ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import pytest  # noqa: E402

from tests.mutants import mutant_function, mutants_of, mutated  # noqa: E402
from tests.mutants_warm import changed_functions, code_of, fault, functions_within  # noqa: E402

#: a module, the functions that are changed, and which tests of its file are to notice it
HELD = (
    ("planning/meetings", ("meetings", "_presences", "_with_stops", "_joined"), "test_"),
    ("io/writers/chance_raster", ("_paint",), "test_each_pixel"),
    ("io/writers/zone_cells", ("narrowest_m",), "test_the_narrowest"),
    ("planning/routes/binned", ("_sweep",), "test_the_sweep"),
    ("planning/routes/blocks", ("blockings",), "test_two_aisles"),
    ("samplers/adaptive/tours", ("measure_ways",), "test_the_ways_measured"),
)


def calls_in(tests, begins):
    """Yield the tests of a file with the values that they are to be tried with."""
    for name, test in vars(tests).items():
        if name.startswith(begins) and callable(test):
            marks = [mark for mark in getattr(test, "pytestmark", ()) if mark.name == "parametrize"]
            sets = [[told_by(mark, one) for one in mark.args[1]] for mark in marks]
            for chosen in itertools.product(*sets):
                yield test, {name: value for one in chosen for name, value in one.items()}


def told_by(mark, one):
    """Return the values of a test's parameters by their names."""
    names = mark.args[0]
    if isinstance(names, str):
        return {names: one}
    return dict(zip(names, one, strict=True))


def is_noticed(calls):
    """Tell whether any test fails."""
    try:
        for test, values in calls:
            test(**values)
    except (Exception, pytest.fail.Exception):  # noqa: BLE001 - whatever it is, it was noticed
        return True
    return False


def tried(path, functions, begins):
    """Return how many mutants of some functions were noticed, of how many; print the others."""
    dotted = path.replace("/", ".")
    folder, _, name = dotted.rpartition(".")
    importlib.import_module(f"fieldmon.{dotted}")
    tests = importlib.import_module(f"tests.{folder}.test_{name}")
    calls, file = [*calls_in(tests, begins)], ROOT / "fieldmon" / f"{path}.py"
    assert not is_noticed(calls), f"the tests of {path} fail without a fault"
    source, standing = file.read_text("utf-8"), functions_within(file)
    was = code_of(ast.parse(source), file)
    n_noticed = n = 0
    for mutant in mutants_of(file):
        if mutant_function(mutant) in functions:
            tree, said = mutated(source, mutant.place)
            with fault([*changed_functions(was, code_of(tree, file))], standing):
                noticed = is_noticed(calls)
            n_noticed, n = n_noticed + noticed, n + 1
            if not noticed:
                print(f"{path}:{mutant.line}  {said}")  # noqa: T201 - a command
    return n_noticed, n


def main():
    """Try all of them; say how many were noticed."""
    for path, functions, begins in HELD:
        n_noticed, n = tried(path, functions, begins)
        print(f"{path}: {n_noticed} of {n} noticed ({', '.join(functions)})", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
