"""The public library: every name is there, documented, and its examples run as they stand."""

import ast
import doctest
import importlib
import inspect
import os
import subprocess
import sys
import warnings
from datetime import date

import pytest

import fieldmon as fm
from fieldmon.errors import ImportDoubt
from tests.paths import ROOT, SAMPLE_DATA

#: modules in which public functions have their examples
MODULES = sorted(
    {
        getattr(fm, name).__module__
        for name in fm.__all__
        if inspect.isclass(getattr(fm, name)) or inspect.isfunction(getattr(fm, name))
    }
    | {"fieldmon", "fieldmon.planning.routes.best_route", "fieldmon.planning.bound_wording"}
)
FUNCTIONS = {
    **{name: getattr(fm, name) for name in fm.__all__ if inspect.isfunction(getattr(fm, name))},
    "routes.best": fm.routes.best,
    "routes.bound": fm.routes.bound,
}


@pytest.fixture
def _here(tmp_path, monkeypatch):
    """Work in an empty folder beside the sample estate, as a reader would."""
    (tmp_path / "sample_data").symlink_to(SAMPLE_DATA)
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("_here")
@pytest.mark.parametrize("module", MODULES)
def test_examples_run_as_they_stand(module):
    with warnings.catch_warnings():
        # the sample's records lie about several plots, which is said
        warnings.simplefilter("ignore", ImportDoubt)
        failed, _ = doctest.testmod(importlib.import_module(module))
    assert failed == 0


def test_enough_examples_are_there():
    finder = doctest.DocTestFinder()
    tested = [
        test.name
        for module in MODULES
        for test in finder.find(importlib.import_module(module))
        if test.examples
    ]
    assert len(tested) >= 14


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_public_function_says_what_it_takes_raises_and_shows_an_example(name):
    text = inspect.getdoc(FUNCTIONS[name])
    takes = list(inspect.signature(FUNCTIONS[name]).parameters.values())
    assert ">>>" in text
    if len(takes) > 2:
        assert "Parameters\n" in text
        assert "Raises\n" in text
        assert all(parameter.name in text for parameter in takes)


def test_every_name_is_given_and_typed():
    assert sorted(fm.__all__) == dir(fm)
    tree = ast.parse((ROOT / "fieldmon" / "__init__.py").read_text())
    typed = {alias.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)
             for alias in node.names}  # fmt: skip
    assert set(fm.__all__) - {"__version__"} <= typed
    assert all(getattr(fm, name) is not None for name in fm.__all__)
    assert (ROOT / "fieldmon" / "py.typed").exists()
    with pytest.raises(AttributeError, match="no attribute 'plan_week'"):
        fm.plan_week  # noqa: B018


def test_importing_it_loads_nothing_heavy():
    code = "import sys, fieldmon; print({'numpy', 'numba', 'shapely'} & sys.modules.keys())"
    env = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


@pytest.mark.usefixtures("_here")
def test_what_imports_doubt_is_a_warning_where_it_was_asked_for():
    plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        fm.read_records("sample_data/mite_records.csv", near=plot)
    assert any("lie outside Gate" in str(warning.message) for warning in said)
    assert {warning.category for warning in said} == {ImportDoubt}
    assert {warning.filename for warning in said} == {__file__}


@pytest.mark.usefixtures("_here")
def test_a_season_from_the_first_file_to_what_was_found():
    plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    season = fm.Season.create("s.gpkg", plot, robot=fm.Robot(hours=0.5))
    today = season.settings.begins
    route = season.plan(today).route
    (table,) = route.to_file("day.csv")
    head, *lines = table.read_text(encoding="utf-8-sig").splitlines()
    columns = head.split(",")
    filled = [line.split(",") for line in lines]
    for k, cells in enumerate(filled):
        cells[columns.index("found")] = "yes" if k == 0 else "no"
    table.write_text("\n".join([head, *(",".join(cells) for cells in filled)]))
    done = season.record(fm.read_inspections("day.csv", plot), who="Ann")
    assert done.new == len(route)
    status = season.status(today)
    assert (status.inspected, status.found) == (len(route), 1)


def test_contenders_of_one_start_meet_the_same_insects():
    plot = fm.read_plot(SAMPLE_DATA / "paran_estate.zip", feature="Gate")
    chance = fm.plan_day(plot, on="2026-11-18").chance
    start = fm.draw_start(plot, chance, share=0.03, seed=4)
    settings, robot = fm.SeasonSettings(n_days=2), fm.Robot(hours=3)
    naive, adaptive = (
        fm.simulate(plot, start, name, robot, settings, seed=4) for name in ("naive", "adaptive")
    )
    assert naive.new[0] == adaptive.new[0] == start.infested.sum()
    assert adaptive.found.sum() > naive.found.sum()


@pytest.mark.usefixtures("_here")
@pytest.mark.filterwarnings("ignore::fieldmon.errors.ImportDoubt")
def test_what_the_library_gives_says_itself_in_one_short_line():
    plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    day = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1))
    start = fm.draw_start(plot, day.chance)
    simulated = fm.simulate(plot, start, "naive", settings=fm.SeasonSettings(n_days=2))
    season = fm.Season.create("season.gpkg", plot, begins=date(2026, 11, 18))
    season.record(fm.Inspections.of([0, 1], [0, 1], date(2026, 11, 18)))
    said = {
        plot: "<Plot Gate: 3825 plants in 45 rows>",
        fm.read_records("sample_data/mite_records.csv", plot): "<Observations: 329 records>",
        day: f"<DayPlan: {len(day.route)} of 3825 plants, {day.route.drive_m / 1000:.2f} km, ",
        day.route: f"<Route: {len(day.route)} stops, ",
        start: f"<Start: {start.infested.sum()} of 3825 plants infested>",
        simulated: "<SeasonMetrics: 2 days, ",
        season: "<Season season.gpkg: <Plot Gate: 3825 plants in 45 rows>>",
        season.history.inspections: "<Inspections: 2 inspections, 1 find>",
        season.status(date(2026, 11, 18)).hot_spots: "<HotSpots: 0 hot spots with 0 finds>",
    }
    for given, words in said.items():
        assert repr(given).startswith(words)
        assert len(repr(given)) < 100
