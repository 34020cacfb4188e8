"""Look down, never up, never sideways: which room may import which."""

import ast
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from tests.paths import ROOT
from tests.syntax import no_garbage, statements

#: rooms from the ground up; those that share a floor do not know of each other
FLOORS = [
    {"errors"},
    {"compute"},
    {"plot"},
    {"pests"},
    {"infestation"},
    {"io"},
    {"decisions"},
    {"samplers"},
    {"planning"},
    {"simulation", "monitoring"},
    {"studies", "reports", "drive"},
    {"__init__"},
    {"cli"},
    {"app"},
]
FLOOR = {room: level for level, rooms in enumerate(FLOORS) for room in rooms}
#: likewise within the app
APP_FLOORS = ["words", "state", "show", "actions", "api", "views", "startup", "streamlit_app"]
#: likewise within a season, but for types: what stands on a lower floor may be handed a season.
#: Modules that stand in no room of it are above all
SEASON_FLOORS = ["file", "settings", "treating", "inspecting", "changes", "estimates", "advice",
                 "phones", "days", "merging", "season"]  # fmt: skip
#: libraries that only some rooms may know
ALONE = {
    "pyproj": {"plot", "io"},
    "geopandas": {"plot", "planning", "io", "monitoring"},
    "pyogrio": {"io", "monitoring"},
    "rasterio": {"io", "monitoring"},
    "pyarrow": {"io", "simulation", "cli"},
    "distributed": {"simulation"},
    "jinja2": {"io"},
    "markupsafe": {"io", "studies", "reports", "app"},
    "typer": {"cli"},
    "tzfpy": {"plot"},
    "rich": {"cli"},
    "pydeck": {"planning", "app"},
    "streamlit": {"app"},
    "altair": {"app"},
    "PIL": {"reports", "app"},
    "fpdf": {"reports"},
    "fontTools": {"reports"},
    "segno": {"app"},
    "cryptography": {"app"},
    "starlette": {"app"},
    "jsonschema": {"app"},
    "mujoco": {"drive"},
    "rosbags": {"drive"},
    "paho": {"drive"},
}
FILES = sorted((*(ROOT / "fieldmon").rglob("*.py"), *(ROOT / "app").rglob("*.py")))


def module_of(path: Path) -> str:
    """Return a file's dotted name."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(path): path for path in FILES}


@cache
def tree_of(module: str) -> ast.Module:
    """Return what a module says, read once."""
    with no_garbage():
        return ast.parse(MODULES[module].read_text(encoding="utf-8"))


def room(module: str) -> str:
    """Return the room of a dotted name."""
    top, *rest = module.split(".")
    if rest == ["__main__"]:  # the door of the command line
        return "cli"
    return "app" if top == "app" else rest[0] if rest else "__init__"


def imports(tree: ast.AST, here: str):
    """Yield the dotted names that a module imports, at the top or later."""
    package = here if MODULES.get(here, Path()).name == "__init__.py" else here.rpartition(".")[0]
    for node in statements(tree):
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


def app_floor(module: str) -> int:
    """Return the floor of a module of the app."""
    inner = module.split(".")[1:]
    return APP_FLOORS.index(inner[0]) if inner else -1


def season_floor(module: str) -> int:
    """Return the floor of a module of a season."""
    inner = module.split(".")[2:]
    return SEASON_FLOORS.index(inner[0]) if inner else len(SEASON_FLOORS)


def breaches(here: str, tree: ast.Module) -> list[str]:
    """Return what a module imports although its floor does not allow it."""
    found = []
    for name in imports(tree, here):
        top = name.split(".")[0]
        if top in ALONE and room(here) not in ALONE[top]:
            found.append(f"{here} imports {name}")
        if room(name) == room(here) == "app" and app_floor(name) > app_floor(here):
            found.append(f"{here} imports {name}")
        if top not in {"fieldmon", "app"} or room(name) == room(here):
            continue
        if FLOOR[room(name)] >= FLOOR[room(here)]:
            found.append(f"{here} imports {name}")
    if room(here) == "monitoring":
        found += breaches_within_a_season(here, tree)
    return found


def breaches_within_a_season(here: str, tree: ast.Module) -> list[str]:
    """Return what a module of a season imports from floors of it above its own."""
    types = {name for node in statements(tree) if isinstance(node, ast.If) and is_for_types(node)
             for name in imports(node, here)}  # fmt: skip
    others = (name for name in imports(tree, here) if name not in types)
    return [
        f"{here} imports {name}"
        for name in others
        if room(name) == "monitoring" and season_floor(name) > season_floor(here)
    ]


def is_for_types(node: ast.If) -> bool:
    """Return whether a branch is read by type checkers alone."""
    return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


OF_APP = [module for module in MODULES if room(module) == "app"]


@pytest.mark.parametrize("here", sorted({room(module) for module in MODULES}))
def test_the_modules_of_a_room_look_only_down(here):
    own = [module for module in MODULES if room(module) == here]
    assert [one for module in own for one in breaches(module, tree_of(module))] == []


def test_every_room_has_a_floor():
    assert {room(module) for module in MODULES} <= FLOOR.keys()


def named_whole(tree: ast.AST):
    """Yield the modules that are imported by their whole names."""
    for node in statements(tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)) and getattr(node, "level", 0) == 0:
            yield getattr(node, "module", "") or node.names[0].name


def test_the_app_names_its_own_modules_relatively_whatever_it_is_installed_as():
    named = [(module, name) for module in OF_APP for name in named_whole(tree_of(module))]
    assert len(named) > len(OF_APP)
    assert [one for one in named if one[1].split(".")[0] == "app"] == []


def loaded_by_name(tree: ast.AST):
    """Yield what is given to ``import_module``: a name, or None where it is not written out."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            first = node.args[0]
            yield first.value if isinstance(first, ast.Constant) else None


def test_only_the_apps_frame_loads_modules_of_its_own_by_name():
    calls = [one for one in OF_APP if "import_module" in MODULES[one].read_text(encoding="utf-8")]
    named = {(module, name) for module in calls for name in loaded_by_name(tree_of(module))}
    others = {"pandas", "streamlit"}
    own = {module for module, name in named if not name or name.split(".")[0] not in others}
    assert own == {"app.streamlit_app"}


def circle(graph) -> list[str]:
    """Return modules that need each other in a circle, those that types alone name as well."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as found:
        return list(found.args[1])
    return []


def test_no_module_needs_itself_round_a_circle_be_it_for_a_type():
    graph = {
        module: {
            name for name in imports(tree_of(module), module) if name in MODULES and name != module
        }
        for module in MODULES
    }
    assert circle(graph) == []


def test_a_circle_is_noticed_where_a_type_alone_closes_it():
    grid = "if TYPE_CHECKING:\n    from fieldmon.plot.travel import Aisles"
    travel = "def f():\n    from fieldmon.plot.grid import PlantGrid"
    graph = {
        here: set(imports(ast.parse(source), here))
        for here, source in {"fieldmon.plot.grid": grid, "fieldmon.plot.travel": travel}.items()
    }
    assert sorted(set(circle(graph))) == ["fieldmon.plot.grid", "fieldmon.plot.travel"]


def test_what_stands_lower_may_be_handed_a_season():
    line = "if TYPE_CHECKING:\n    from fieldmon.monitoring import Season"
    assert breaches("fieldmon.monitoring.days.day_ahead", ast.parse(line)) == []


@pytest.mark.parametrize(
    ("here", "line"),
    [
        ("fieldmon.plot.grid", "from fieldmon.simulation.season import simulated_days"),
        ("fieldmon.simulation.season", "from fieldmon.cli import main"),
        ("fieldmon.simulation.season", "from fieldmon.monitoring import Season"),
        ("fieldmon.samplers.base", "import geopandas"),
        ("fieldmon.planning.route", "from pyproj import CRS"),
        ("fieldmon.io.read", "import streamlit"),
        ("fieldmon.io.writers.gpx", "def f():\n    from fieldmon.planning import plan"),
        ("fieldmon.cli.main", "from app import maps"),
        ("fieldmon.monitoring.file.schema", "from fieldmon.monitoring.changes import season_log"),
        ("fieldmon.monitoring.days.day_ahead", "from fieldmon.monitoring import Season"),
        ("fieldmon.io.read", "from fieldmon import plan_day"),
        ("app.state.choices", "from ..show import field_map"),
        ("app.words.texts", "from . import units\nfrom ..state.cached import plots"),
        ("app.views.today", "from ..startup import preload"),
        ("app.show.maps.deck", "from ...actions.editing_plot import rows"),
    ],
)
def test_the_rule_notices_a_breach(here, line):
    assert breaches(here, ast.parse(line)) != []
