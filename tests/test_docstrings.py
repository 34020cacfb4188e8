"""What docstrings name in backquotes is there: a module, a class, a field, a file of the house."""

import ast
import builtins
import re

from tests.paths import ROOT
from tests.syntax import everything, no_garbage

#: of other programs, and of anybody
FOREIGN = {
    "FPDF", "polyline", "PCD_ED", "concurrent", "futures", "asdict", "layer_styles", "markupsafe",
    "Markup", "SeedSequence", "NAME", "dataclasses", "numpy", "random",
}  # fmt: skip
OWN_SAMPLERS = {"my_sampler.py", "mine.py"}
_NAMED = re.compile(r"(?<!`)`([A-Za-z_][\w.]*)`(?!`)")
_FILE = re.compile(r"[\w-]+\.py\b")
_DEFINED = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
#: in what part of a tree the name stands that it gives or uses
_GIVEN = {
    **dict.fromkeys(_DEFINED, "name"),
    **dict.fromkeys((ast.arg, ast.keyword), "arg"),
    ast.Name: "id",
    ast.Attribute: "attr",
}


def sources():
    """Return the code of library and app by file."""
    paths = [path for room in ("fieldmon", "app") for path in (ROOT / room).rglob("*.py")]
    return {
        path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(paths)
        if "_app" not in path.parts
    }


def names_in(nodes):
    """Yield every name that code gives or uses."""
    for node in nodes:
        given = _GIVEN.get(type(node))
        if given is not None:
            yield getattr(node, given)
        elif isinstance(node, ast.alias):
            yield from (node.asname or node.name).split(".")


def untrue(code):
    """Return what docstrings name and there is not, by file."""
    files = {path.rpartition("/")[2] for path in code} | OWN_SAMPLERS
    known = {*dir(builtins), *FOREIGN, *(part for path in code for part in path[:-3].split("/"))}
    said = {}
    for path, text in code.items():  # each tree is let go of before the next one comes
        nodes = [*everything(ast.parse(text))]
        known.update(names_in(nodes))
        told = [node for node in nodes if isinstance(node, (ast.Module, *_DEFINED))]
        said[path] = "\n".join(ast.get_docstring(node) or "" for node in told)
    found = {}
    for path, words in said.items():
        named = {name for name in _NAMED.findall(words) if not known.issuperset(name.split("."))}
        if gone := named | set(_FILE.findall(words)) - files:
            found[path] = gone
    return found


def test_docstrings_name_nothing_that_is_gone():
    with no_garbage():
        assert untrue(sources()) == {}


def test_what_is_gone_is_noticed():
    code = {
        "io/read.py": '"""Only here (and in project.py), see `guard` and `io.gone`, not ``x``."""',
        "io/write.py": 'def write(plan):\n    """Write `plan` as `read` and write.py say."""',
    }
    assert untrue(code) == {"io/read.py": {"project.py", "guard", "io.gone"}}
