"""One word, one thing: no two classes share a name, private ones included."""

import ast
from collections import defaultdict

from tests.paths import ROOT


def classes(source: str) -> list[str]:
    """Return the classes of a module, those inside others included."""
    return [node.name for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ClassDef)]


def defined_twice(sources: dict[str, str]) -> dict[str, list[str]]:
    """Return where each name stands that more than one class has."""
    places = defaultdict(list)
    for path, source in sources.items():
        for name in classes(source):
            places[name].append(path)
    return {name: paths for name, paths in places.items() if len(paths) > 1}


def test_no_two_classes_have_one_name():
    files = (*(ROOT / "fieldmon").rglob("*.py"), *(ROOT / "app").rglob("*.py"))
    sources = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in files}
    assert defined_twice(sources) == {}


def test_the_rule_notices_a_name_defined_twice():
    one, other = "class Trial:\n    pass\n", "def f():\n    class Trial: ...\n"
    assert defined_twice({"a.py": one, "b.py": other}) == {"Trial": ["a.py", "b.py"]}
    assert defined_twice({"a.py": one + one}) == {"Trial": ["a.py", "a.py"]}
    assert defined_twice({"a.py": one.replace("Trial", "Trials"), "b.py": other}) == {}
