"""What each room of the app may do, and how large a page may be."""

import ast
import re

import pytest

from tests.paths import ROOT

APP = ROOT / "app"
SOURCES = {path.relative_to(APP).as_posix(): path.read_text(encoding="utf-8")
           for path in sorted(APP.rglob("*.py"))}  # fmt: skip


def imported(source):
    """Yield the first words of what a module imports."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (name.name.split(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module.split(".")[0]


def test_only_modules_that_say_so_keep_things_between_sessions():
    found = [name for name, source in SOURCES.items() if re.search(r"\bst\.cache_", source)]
    assert found == [f"state/cached{of}.py" for of in ("", "_files", "_simulations")]


def test_modules_that_promise_it_know_nothing_of_streamlit():
    promised = [name for name, source in SOURCES.items() if "No Streamlit in here" in source]
    promised += [name for name in SOURCES if name.startswith("show/maps/")]
    assert len(promised) > 12
    assert [name for name in promised if "streamlit" in imported(SOURCES[name])] == []


def test_words_are_words_without_a_page():
    assert [name for name, source in SOURCES.items()
            if name.startswith("words/") and "streamlit" in imported(source)] == []  # fmt: skip


def test_nothing_in_the_app_speaks_to_a_database():
    queries = re.compile(r"\bSELECT\b|\bINSERT\b|\.execute\(|\.store\b")
    assert [name for name, source in SOURCES.items() if queries.search(source)] == []
    assert [name for name, source in SOURCES.items() if "sqlite3" in imported(source)] == []


@pytest.mark.parametrize("name", [n for n in SOURCES if re.match(r"views/(?!__init__)", n)])
def test_a_page_is_short_and_has_one_show(name):
    assert len(SOURCES[name].splitlines()) < 80
    made = ast.parse(SOURCES[name]).body
    assert "show" in {node.name for node in made if isinstance(node, ast.FunctionDef)}


def test_every_module_of_logic_has_tests_of_its_name():
    # a tuple of places has nothing to test
    names = [n for n in SOURCES if not n.endswith("__init__.py") and n != "show/places.py"]
    tests = {path.relative_to(ROOT / "tests" / "app").as_posix()
             for path in (ROOT / "tests" / "app").rglob("test_*.py")}  # fmt: skip
    wanted = [re.sub(r"(\w+\.py)$", r"test_\1", name) for name in names]
    assert [name for name in wanted if name not in tests] == []
