"""What each room of the app may do, and how large a page may be."""

import ast
import re

import pytest

from tests.paths import ROOT

APP = ROOT / "app"
SOURCES = {path.relative_to(APP).as_posix(): path.read_text(encoding="utf-8")
           for path in sorted(APP.rglob("*.py"))}  # fmt: skip

NEVER_CHANGES = re.compile("frozen=True|NamedTuple|TypedDict")
CACHE = re.compile(r"\b(lru_)?cache\b")
DEFINED = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
CHANGING = {"add", "append", "clear", "discard", "extend", "insert", "pop", "popitem", "remove",
            "setdefault", "update"}  # fmt: skip


def imported(source):
    """Yield the first words of what a module imports."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (name.name.split(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module.split(".")[0]


def said_above(node):
    """Return decorators and bases of a class, or the decorators of a function."""
    return " ".join(map(ast.unparse, [*node.decorator_list, *getattr(node, "bases", ())]))


def changed_by(node):
    """Return what a statement or a call changes in place, if it does."""
    if isinstance(node, ast.Subscript) and not isinstance(node.ctx, ast.Load):
        return ast.unparse(node.value)
    if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in CHANGING:
        return ast.unparse(node.func.value)
    return None


def kept(source):
    """Return the names under which a module keeps something as long as the server runs.

    What functions keep of their answers, what they change in place, and objects of a class of the
    module's own that can change.
    """
    tree = ast.parse(source)
    given = [node for node in tree.body if isinstance(node, (ast.Assign, ast.AnnAssign))]
    made = {ast.unparse(getattr(node, "target", None) or node.targets[0]): node.value
            for node in given}  # fmt: skip
    inner = [node for top in tree.body if isinstance(top, DEFINED) for node in ast.walk(top)]
    own = {
        node.name
        for node in tree.body
        if isinstance(node, ast.ClassDef) and not NEVER_CHANGES.search(said_above(node))
    }
    objects = {
        name
        for name, value in made.items()
        if isinstance(value, ast.Call) and ast.unparse(value.func) in own
    }
    answers = {node.name for node in inner
               if isinstance(node, ast.FunctionDef) and CACHE.search(said_above(node))}  # fmt: skip
    told = {name for node in inner if isinstance(node, ast.Global) for name in node.names}
    return objects | answers | told | made.keys() & {changed_by(node) for node in inner}


# of values as long as somebody has them (weak), of the server, or the same for everybody
KEEP = {
    "api/documents.py": {"plot_document"},
    "api/reading.py": {"_validator"},
    "api/season_api.py": {"application"},
    "show/drive_play.py": {"_WRITTEN"},
    "show/maps/deck.py": {"_WRITTEN"},
    "show/maps/plant_layers.py": {"_PLACES"},
    "startup/preload.py": {"start"},
    "state/chosen_day.py": {"_BOUNDED", "_LEVELS"},
    "state/last_heard.py": {"_HEARD", "_KEYS"},
    "state/map_store.py": {"STORE"},
    "state/map_tiles.py": {"SHELF"},
    "state/opened_seasons.py": {"_OPEN"},
    "state/sample_estate.py": {"plots"},
    "state/scout_page.py": {"files"},
    "state/web_maps.py": {"ASKED"},
    "words/blanks.py": {"_separators"},
    "words/language.py": {"_ASKED", "_DAYS", "_TRANSLATED", "_known", "_said_again", "for_reports"},
    "words/translations.py": {"catalogue_of"},
}  # fmt: skip


def test_only_modules_that_say_so_keep_things_between_sessions():
    found = [name for name, source in SOURCES.items() if re.search(r"\bst\.cache_", source)]
    assert found == [f"state/cached{of}.py" for of in ("", "_files", "_simulations")]
    # the script itself is run anew each time, with all its names
    also = {name: kept(source) for name, source in SOURCES.items() if name != "streamlit_app.py"}
    assert {name: names for name, names in also.items() if names} == KEEP


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
