"""Look down, never up, never sideways: which room may import which."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.paths import ROOT

#: rooms from the ground up; those that share a floor do not know of each other
FLOORS = [
    {"errors"},
    {"compute"},
    {"plot"},
    {"infestation"},
    {"samplers"},
    {"planning"},
    {"io"},
    {"simulation", "monitoring"},
    {"studies"},
    {"__init__"},
    {"cli"},
    {"app"},
]
FLOOR = {room: level for level, rooms in enumerate(FLOORS) for room in rooms}
#: libraries that only some rooms may know
ALONE = {
    "pyproj": {"plot", "io"},
    "geopandas": {"plot", "planning", "io", "monitoring"},
    "pyogrio": {"io", "monitoring"},
    "rasterio": {"io", "monitoring"},
    "pyarrow": {"io", "simulation", "cli"},
    "distributed": {"simulation"},
    "jinja2": {"io"},
    "markupsafe": {"io", "studies", "app"},
    "typer": {"cli"},
    "rich": {"cli"},
    "pydeck": {"planning", "app"},
    "streamlit": {"app"},
    "altair": {"app"},
    "PIL": {"app"},
}
FILES = sorted((*(ROOT / "fieldmon").rglob("*.py"), *(ROOT / "app").rglob("*.py")))


def module_of(path: Path) -> str:
    """Return a file's dotted name."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(path): path for path in FILES}


def room(module: str) -> str:
    """Return the room of a dotted name."""
    top, *rest = module.split(".")
    return "app" if top == "app" else rest[0] if rest else "__init__"


def imports(tree: ast.AST, here: str):
    """Yield the dotted names that a module imports, at the top or later."""
    package = here if MODULES.get(here, Path()).name == "__init__.py" else here.rpartition(".")[0]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) + 1 - node.level]
            whole = (
                [*base, *([node.module] if node.module else [])] if node.level else [node.module]
            )
            for name in node.names:
                inner = ".".join([*whole, name.name])
                yield inner if inner in MODULES else ".".join(whole)


def typed_only(tree: ast.Module) -> ast.Module:
    """Return a module without what it imports for its types alone."""
    kept = [
        node
        for node in tree.body
        if not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING")
    ]
    return ast.Module(kept, [])


def breaches(here: str, source: str) -> list[str]:
    """Return what a module imports although its floor does not allow it."""
    found = []
    for name in imports(ast.parse(source), here):
        top = name.split(".")[0]
        if top in ALONE and room(here) not in ALONE[top]:
            found.append(f"{here} imports {name}")
        if top not in {"fieldmon", "app"} or room(name) == room(here):
            continue
        if FLOOR[room(name)] >= FLOOR[room(here)]:
            found.append(f"{here} imports {name}")
    return found


@pytest.mark.parametrize("module", MODULES)
def test_a_module_looks_only_down(module):
    assert breaches(module, MODULES[module].read_text(encoding="utf-8")) == []


def test_every_room_has_a_floor():
    assert {room(module) for module in MODULES} <= FLOOR.keys()


def test_no_module_needs_itself_round_a_circle():
    graph = {
        module: {
            name
            for name in imports(typed_only(ast.parse(path.read_text(encoding="utf-8"))), module)
            if name in MODULES and name != module
        }
        for module, path in MODULES.items()
    }
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as circle:
        pytest.fail(" -> ".join(circle.args[1]))


@pytest.mark.parametrize(
    ("here", "line"),
    [
        ("fieldmon.plot.grid", "from fieldmon.simulation.season import days"),
        ("fieldmon.simulation.season", "from fieldmon.cli import main"),
        ("fieldmon.simulation.season", "from fieldmon.monitoring import Season"),
        ("fieldmon.samplers.base", "import geopandas"),
        ("fieldmon.planning.route", "from pyproj import CRS"),
        ("fieldmon.io.read", "import streamlit"),
        ("fieldmon.planning.plan", "def f():\n    from fieldmon.io.read import read_plots"),
        ("fieldmon.cli.main", "from app import maps"),
        ("fieldmon.io.read", "from fieldmon import plan_day"),
    ],
)
def test_the_rule_notices_a_breach(here, line):
    assert breaches(here, line) != []
