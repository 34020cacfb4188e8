"""Look down, never up, never sideways: who may import whom."""

import ast
from pathlib import Path

import pytest

from tests.paths import ROOT

FLOORS = [
    {"errors", "first_use", "compiled"},
    {"chance"},
    {"frame"},
    {"field"},
    {"grid", "planting", "rows", "neighbours", "gaps"},
    {"headland", "robot", "spread"},
    {"aisles", "prior", "belief", "risk"},
    {"samplers", "outlook", "ensemble"},
    {"workday"},
    {"route", "explain"},
    {"season", "hotspots", "history"},
    {"metrics", "thesis", "monitor"},
    {"study", "batch", "project", "comparison"},
    {"cli_parts"},
    {"cli"},
]
# cli_study, cli_season ...: parts of the command line, which cli puts together
CLI = {"cli", "cli_parts"}
FLOOR = {name: level for level, names in enumerate(FLOORS) for name in names}
# modules of one floor that form one room: the first may use the second
SAME_ROOM = {
    ("compiled", "first_use"),
    ("ensemble", "outlook"),
    ("planting", "grid"),
    ("planting", "rows"),
    ("planting", "neighbours"),
    ("grid", "neighbours"),
    ("rows", "grid"),
    ("gaps", "grid"),
    ("risk", "prior"),
}
ALONE = {
    "pyproj": {"frame", "geodata"},
    "geopandas": {"geodata", "project"},
    "pyogrio": {"geodata", "project"},
    "rasterio": {"geodata", "project"},
    "typer": CLI,
    "rich": CLI,
    "streamlit": set(),
    "pydeck": set(),
    "altair": set(),
    "app": set(),
}


def room(path: Path) -> str:
    """Return the module or sub-package of fieldmon that a file belongs to."""
    name = path.relative_to(ROOT / "fieldmon").parts[0].removesuffix(".py")
    return "cli_parts" if name.startswith("cli_") else name


def imports(tree: ast.AST):
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for name in node.names:
                yield name.name
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            yield node.module
            if node.module == "fieldmon":
                yield from (f"fieldmon.{name.name}" for name in node.names)


def breaches(here: str, source: str) -> list[str]:
    """Return what a module of room `here` imports although its floor does not allow it."""
    found = []
    for name in imports(ast.parse(source)):
        top, *rest = name.split(".")
        if top in ALONE and here not in ALONE[top]:
            found.append(f"{here} imports {name}")
        if top != "fieldmon" or not rest or rest[0] == here:
            continue
        there = "cli_parts" if rest[0].startswith("cli_") else rest[0]
        if there == here:
            continue
        if there == "geodata":
            allowed = here in CLI | {"project", "study"}
        elif here == "geodata":
            allowed = FLOOR.get(there, 99) <= FLOOR["monitor"]
        else:
            allowed = FLOOR[there] < FLOOR[here] or (here, there) in SAME_ROOM
        if not allowed:
            found.append(f"{here} imports {name}")
    return found


FILES = sorted(
    path for path in (ROOT / "fieldmon").rglob("*.py") if path.name != "__init__.py"
) + sorted((ROOT / "fieldmon").glob("*/__init__.py"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_looks_only_down(path):
    assert breaches(room(path), path.read_text(encoding="utf-8")) == []


def test_every_module_has_a_floor():
    rooms = {room(path) for path in FILES} - {"geodata", "__init__"}
    assert rooms <= FLOOR.keys()


@pytest.mark.parametrize(
    ("here", "line"),
    [
        ("grid", "from fieldmon.simulation.season import days"),
        ("belief", "from fieldmon.infestation.prior import prior_chance"),
        ("season", "from fieldmon import cli"),
        ("samplers", "import geopandas"),
        ("route", "from pyproj import CRS"),
        ("geodata", "import streamlit"),
        ("monitor", "def f():\n    from fieldmon.io.vector import read_plots"),
        ("cli", "from app import maps"),
    ],
)
def test_the_rule_notices_a_breach(here, line):
    assert breaches(here, line) != []
