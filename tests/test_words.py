"""One word, one thing: of classes, private ones included, and of constants that leave a room."""

import ast
from collections import defaultdict

import pytest

from tests.paths import ROOT
from tests.syntax import no_garbage, statements


def nodes(sources: dict[str, str]) -> dict[str, list[ast.AST]]:
    """Return the statements of each module, itself first."""
    with no_garbage():
        return {path: [*statements(ast.parse(source))] for path, source in sources.items()}


def defined_twice(modules: dict[str, list[ast.AST]]) -> dict[str, list[str]]:
    """Return where each name stands that more than one class has, those inside others included."""
    places = defaultdict(list)
    for path, said in modules.items():
        for node in said:
            if isinstance(node, ast.ClassDef):
                places[node.name].append(path)
    return {name: paths for name, paths in places.items() if len(paths) > 1}


def room(path: str) -> str:
    """Return the room of a module: a package of the library, or the app."""
    return "/".join(path.split("/")[: 1 if path.startswith("app/") else 2])


def constants(tree: ast.Module) -> set[str]:
    """Return the public constants that a module defines."""
    made = [node for node in tree.body if isinstance(node, (ast.Assign, ast.AnnAssign))]
    targets = [
        one for node in made for one in getattr(node, "targets", [getattr(node, "target", 0)])
    ]
    names = {one.id for t in targets for one in ast.walk(t) if isinstance(one, ast.Name)}
    return {name for name in names if name.isupper() and not name.startswith("_")}


def meant_twice(modules: dict[str, list[ast.AST]]) -> dict[str, set[str]]:
    """Return the constants that other rooms import from several modules, and these."""
    places = defaultdict(set)
    for path, (tree, *_) in modules.items():
        for name in constants(tree):
            places[name].add(path)
    taken = defaultdict(set)
    for path, said in modules.items():
        for node in said:
            if not isinstance(node, ast.ImportFrom) or node.level:  # relative: within the app
                continue
            at = (node.module or "").replace(".", "/")
            for name in {one.name for one in node.names} & places.keys():
                # a package hands on what its modules define
                of = {one for one in places[name] if one == f"{at}.py" or one.startswith(f"{at}/")}
                taken[name] |= {one for one in of if room(one) != room(path)}
    return {name: paths for name, paths in taken.items() if len(paths) > 1}


@pytest.fixture(scope="module")
def modules():
    files = (*(ROOT / "fieldmon").rglob("*.py"), *(ROOT / "app").rglob("*.py"))
    return nodes({path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in files})


def test_no_two_classes_have_one_name(modules):
    assert defined_twice(modules) == {}


def test_no_two_constants_that_other_rooms_import_have_one_name(modules):
    assert meant_twice(modules) == {}


def test_the_rule_notices_a_constant_that_is_imported_with_two_meanings():
    one = {"fieldmon/samplers/registry.py": "USUAL = 'adaptive'\n",
           "fieldmon/drive/versions.py": "A, USUAL = 1, '2.1'\n",
           "fieldmon/cli/plan.py": "from fieldmon.samplers import USUAL\n",
           "app/watching.py": "from fieldmon.drive.versions import USUAL\n"}  # fmt: skip
    assert meant_twice(nodes(one)) == {
        "USUAL": {"fieldmon/samplers/registry.py", "fieldmon/drive/versions.py"}
    }
    within = one | {"app/watching.py": "", "fieldmon/drive/watcher.py": one["app/watching.py"]}
    assert meant_twice(nodes(within)) == {}, "within one room it has one meaning"


def test_the_rule_notices_a_name_defined_twice():
    one, other = "class Trial:\n    pass\n", "def f():\n    class Trial: ...\n"
    assert defined_twice(nodes({"a.py": one, "b.py": other})) == {"Trial": ["a.py", "b.py"]}
    assert defined_twice(nodes({"a.py": one + one})) == {"Trial": ["a.py", "a.py"]}
    assert defined_twice(nodes({"a.py": one.replace("Trial", "Trials"), "b.py": other})) == {}
