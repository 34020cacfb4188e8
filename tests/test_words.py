"""One word, one thing: no two public classes share a name."""

import ast
from collections import defaultdict
from datetime import date

import pytest

from tests.paths import ROOT

#: names that two rooms still share, and since when; the list only shrinks, and ends empty
SHARED_SINCE = {}


def public_classes(source: str) -> list[str]:
    """Return the public classes of a module, those inside others included."""
    return [
        node.name
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    ]


def defined_twice(sources: dict[str, str]) -> dict[str, list[str]]:
    """Return where each name stands that more than one class has."""
    places = defaultdict(list)
    for path, source in sources.items():
        for name in public_classes(source):
            places[name].append(path)
    return {name: paths for name, paths in places.items() if len(paths) > 1}


@pytest.fixture(scope="module")
def shared_names():
    files = (*(ROOT / "fieldmon").rglob("*.py"), *(ROOT / "app").rglob("*.py"))
    return defined_twice(
        {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in files}
    )


def test_no_two_classes_have_one_name(shared_names):
    assert {name: at for name, at in shared_names.items() if name not in SHARED_SINCE} == {}


def test_the_list_of_shared_names_only_shrinks(shared_names):
    settled = SHARED_SINCE.keys() - shared_names.keys()
    assert settled == set(), "these have one meaning now: take them off the list"
    assert max(SHARED_SINCE.values(), default=date.min) <= date(2026, 11, 22)


def test_the_rule_notices_a_name_defined_twice():
    one, other = "class Trial:\n    pass\n", "def f():\n    class Trial: ...\n"
    assert defined_twice({"a.py": one, "b.py": other}) == {"Trial": ["a.py", "b.py"]}
    assert defined_twice({"a.py": one + one}) == {"Trial": ["a.py", "a.py"]}
    assert defined_twice({"a.py": one.replace("Trial", "_Trial"), "b.py": other}) == {}
