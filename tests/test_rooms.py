"""What each room of the library keeps to: its tests, and how its values say themselves."""

import ast
import subprocess
from pathlib import Path

import pytest

from fieldmon.compute.wording import worded
from fieldmon.io.writers.handoff import FORMATS, HandoffFormat
from tests.paths import ROOT

LIBRARY, TESTS = ROOT / "fieldmon", ROOT / "tests"
#: modules without logic: constants, and arrays that only compiled loops are handed
DECLARATIONS = {
    "__main__.py",
    "cli/stopped.py",
    "infestation/ancestry/ancestry_arrays.py",
    "samplers/adaptive/arrays.py",
    "studies/thesis/chapter5/fitted_choices.py",
}
#: rooms whose values people meet in a notebook
SHOWN = ("plot", "samplers")
_ARRAYS = ("NDArray", "Float", "Index", "Int", "Mask", "Lists")


def modules():
    """Return the modules of the library, the fronts of packages left out."""
    files = (path.relative_to(LIBRARY) for path in LIBRARY.rglob("*.py"))
    return sorted(path.as_posix() for path in files if path.name != "__init__.py")


def without_tests(names, tests):
    """Return the modules that have no test file of their name in the same room."""
    wanted = {name: "/".join([*name.split("/")[:-1], f"test_{name.split('/')[-1]}"])
              for name in names}  # fmt: skip
    return [name for name, test in wanted.items() if test not in tests]


def of_formats():
    """Return the writers of route formats: `tests/io/writers/test_handoff.py` tries each format."""
    return {f"io/writers/{one.writer.partition(':')[0]}.py" for one in FORMATS.values()}


def test_every_module_of_logic_has_tests_of_its_name():
    tests = {path.relative_to(TESTS).as_posix() for path in TESTS.rglob("test_*.py")}
    assert without_tests(set(modules()) - DECLARATIONS - of_formats(), tests) == []


def test_the_writer_of_a_new_format_needs_no_tests_of_its_name(monkeypatch):
    assert of_formats() < set(modules())
    new = HandoffFormat("plain:route_plain", (".txt",), worded("people"))
    monkeypatch.setitem(FORMATS, "plain", new)
    assert "io/writers/plain.py" in of_formats()


def test_a_module_without_tests_is_noticed():
    tests = {"plot/test_grid.py", "test_errors.py"}
    assert without_tests(["plot/grid.py", "errors.py"], tests) == []
    assert without_tests(["io/grid.py", "plot/field.py"], tests) == ["io/grid.py", "plot/field.py"]


@pytest.mark.parametrize("name", sorted(DECLARATIONS))
def test_what_has_no_tests_declares_and_does_nothing(name):
    """It has no loops and no branches; functions in it only make room."""
    tree = ast.parse((LIBRARY / name).read_text(encoding="utf-8"))
    deciding = (ast.For, ast.While, ast.Try, ast.IfExp, ast.comprehension)
    assert not [node for node in ast.walk(tree) if isinstance(node, deciding)]


def test_no_file_of_a_try_is_kept_at_the_top():
    """What examples and tests write where they run is no part of the project."""
    try:
        listed = subprocess.check_output(["git", "ls-files"], cwd=ROOT, text=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("no checkout of git")
    top = {Path(name).suffix for name in listed.split("\n") if "/" not in name}
    assert top <= {"", ".md", ".toml", ".cff"}


def test_the_front_of_a_package_has_no_logic():
    for path in LIBRARY.rglob("__init__.py"):
        if path.parent == LIBRARY:  # the library itself, see tests/test_library.py
            continue
        made = ast.parse(path.read_text(encoding="utf-8")).body
        assert not [node for node in made if isinstance(node, (ast.FunctionDef, ast.ClassDef))]


def dumped(source):
    """Return the public classes that hold arrays and would print them all."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.ClassDef) or node.name.startswith("_"):
            continue
        types = [ast.unparse(inner.annotation) for inner in node.body
                 if isinstance(inner, ast.AnnAssign)]  # fmt: skip
        holds = any(kind.startswith(_ARRAYS) for kind in types)
        said = {inner.name for inner in node.body if isinstance(inner, ast.FunctionDef)}
        if holds and "__repr__" not in said:
            found.append(node.name)
    return found


@pytest.mark.parametrize(
    "name", [name for name in modules() if name.startswith(SHOWN) and name not in DECLARATIONS]
)
def test_what_holds_arrays_says_itself_in_a_short_line(name):
    assert dumped((LIBRARY / name).read_text(encoding="utf-8")) == []


def test_a_dump_is_noticed():
    source = "class A:\n    xy_m: NDArray[np.float64]\n"
    assert dumped(source) == ["A"]
    assert dumped(f"{source}    def __repr__(self): ...\n") == []
    assert dumped(source.replace("NDArray[np.float64]", "float")) == []
