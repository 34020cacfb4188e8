"""The public library: every name is there, documented, and its examples run as they stand."""

import ast
import dataclasses
import doctest
import importlib
import inspect
import os
import re
import subprocess
import sys
import warnings
from datetime import UTC, date, datetime
from pathlib import Path

import geopandas as gpd
import numpy as np
import pandas as pd
import pytest

import fieldmon as fm
from fieldmon.errors import ImportDoubt
from fieldmon.samplers.sweeps import Bouncy
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
CLASSES = [name for name in fm.__all__ if inspect.isclass(getattr(fm, name))]


@pytest.fixture
def _here(tmp_path, monkeypatch):
    """Work in an empty folder beside the sample estate, as a reader would."""
    (tmp_path / "sample_data").symlink_to(SAMPLE_DATA)
    monkeypatch.chdir(tmp_path)


def examples_of(name):
    """Return the examples of a public name, without the names of its module."""
    return doctest.DocTestFinder().find(FUNCTIONS.get(name) or getattr(fm, name), name, globs={})


@pytest.fixture(scope="module")
def of_public_names():
    """Return the docstrings whose examples the test of public names runs."""
    return {test.docstring for name in (*CLASSES, *FUNCTIONS) for test in examples_of(name)}


@pytest.mark.usefixtures("_here")
@pytest.mark.parametrize("module", MODULES)
def test_examples_run_as_they_stand(module, of_public_names):
    """Those of public names need less, and are run by the test below."""
    tests = doctest.DocTestFinder().find(importlib.import_module(module))
    others = [test for test in tests if test.docstring not in of_public_names]
    with warnings.catch_warnings():
        # the sample's records lie about several plots, which is said
        warnings.simplefilter("ignore", ImportDoubt)
        assert [one.name for one in others if doctest.DocTestRunner().run(one).failed] == []


@pytest.mark.usefixtures("_here")
@pytest.mark.parametrize("name", [*CLASSES, *FUNCTIONS])
def test_examples_of_public_names_need_nothing_but_the_sample_estate(name):
    """No name of the module in which they stand, and no file that they do not make."""
    for test in examples_of(name):
        assert not [one.source for one in test.examples if doctest.SKIP in one.options]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ImportDoubt)
            assert doctest.DocTestRunner().run(test).failed == 0, test.name


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
    in_place = [one.name for one in takes if one.kind is one.POSITIONAL_OR_KEYWORD]
    assert len(in_place) <= 3 or name.startswith("routes.")


@pytest.mark.parametrize("name", CLASSES)
def test_a_public_class_names_its_fields_and_shows_an_example(name):
    public = getattr(fm, name)
    text = inspect.getdoc(public)
    assert ">>>" in text
    fields = dataclasses.fields(public) if dataclasses.is_dataclass(public) else ()
    assert [field.name for field in fields if field.name not in text] == []


def methods():
    """Return the public methods of the library's classes, those of their bases included."""
    bases = {
        base
        for name in CLASSES
        for base in getattr(fm, name).__mro__
        if base.__module__.startswith("fieldmon.")
    }
    found = {}
    for base in bases:
        for name, value in vars(base).items():
            method = getattr(value, "__func__", value)
            if inspect.isfunction(method) and not name.startswith("_"):
                found[f"{base.__name__}.{name}"] = method
    return found


@pytest.mark.parametrize(("name", "method"), sorted(methods().items()))
def test_a_public_method_says_what_it_takes_and_that_it_refuses(name, method):  # noqa: ARG001
    text = inspect.getdoc(method)
    takes = set(inspect.signature(method).parameters) - {"self", "cls"}
    assert {one for one in takes if not re.search(rf"\b{one}\b", text)} == set()
    if "raise " in inspect.getsource(method):
        assert re.search(r"\b[Rr]aise", text)


def test_samplers_say_in_a_line_who_they_are():
    assert repr(fm.SAMPLERS["naive"]) == "<Naive: every plant, row by row>"
    assert all(len(repr(kind)) < 100 for kind in fm.SAMPLERS.values())


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
    settings, robot = fm.SimulationSettings(n_days=2), fm.Robot(hours=3)
    naive, adaptive = (
        fm.simulate(plot, start, name, robot=robot, settings=settings, seed=4)
        for name in ("naive", "adaptive")
    )
    assert naive.new[0] == adaptive.new[0] == start.infested.sum()
    assert adaptive.found.sum() > naive.found.sum()


@pytest.mark.usefixtures("_here")
@pytest.mark.filterwarnings("ignore::fieldmon.errors.ImportDoubt")
def test_what_the_library_gives_says_itself_in_one_short_line():
    plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    day = fm.plan_day(plot, on="2026-11-18", robot=fm.Robot(hours=1))
    start = fm.draw_start(plot, day.chance)
    simulated = fm.simulate(plot, start, "naive", settings=fm.SimulationSettings(n_days=2))
    season = fm.Season.create("season.gpkg", plot, begins=date(2026, 11, 18))
    season.record(fm.Inspections.of([0, 1], [0, 1], date(2026, 11, 18)))
    said = {
        plot: "<Plot Gate: 3,825 plants in 45 rows>",
        fm.read_records("sample_data/mite_records.csv", plot): "<Records: 329 records>",
        day: f"<DayPlan: {len(day.route)} of 3,825 plants, {day.route.drive_m / 1000:.2f} km, ",
        day.route: f"<Route: {len(day.route)} stops, ",
        start: f"<Start: {start.infested.sum()} of 3,825 plants infested>",
        simulated: "<SeasonMetrics: 2 days, ",
        season: "<Season season.gpkg: <Plot Gate: 3,825 plants in 45 rows>>",
        season.history.inspections: "<Inspections: 2 inspections, 1 find>",
        season.status(date(2026, 11, 18)).hot_spots: "<HotSpots: 0 hot spots with 0 finds>",
    }
    for given, words in said.items():
        assert repr(given).startswith(words)
        assert len(repr(given)) < 100


@pytest.fixture(scope="module")
def plot():
    return fm.read_plot(SAMPLE_DATA / "paran_estate.zip", feature="Gate")


#: what a program may hand over by mistake, and what is said of it
MISTAKES = {
    "hours as text": (lambda _: fm.Robot(hours="4"), "The robot's hours must be a number"),
    "no hours": (lambda _: fm.Robot(hours=None), "hours must be a number, but it is None"),
    "a spacing as text": (lambda _: fm.Planting(row_spacing_m="4"), "row_spacing_m must be a n"),
    "a rate as text": (lambda _: fm.Spread("0.5"), "rate_per_day must be a number"),
    "a robot's hours alone": (lambda plot: fm.plan_day(plot, robot=4), "must be a Robot, but it"),
    "no sampler": (lambda plot: fm.plan_day(plot, sampler=None), "own with a method walk, but it"),
    "a sampler's class": (lambda plot: fm.Monitor(plot, sampler=Bouncy), "Give Bouncy()"),
    "a day as a number": (lambda plot: fm.plan_day(plot, on=20260101), "as 2026-11-18"),
    "a season for no GIS": (lambda plot: fm.Season.create("w1.txt", plot), "Name it 'w1.gpkg'"),
    "no time": (lambda plot: fm.plan_day(plot, on=pd.NaT), "as 2026-11-18, but it is 'NaT'"),
    "records as a table": (lambda plot: fm.plan_day(plot, pd.DataFrame()), "must be fm.Records"),
    "records as a path": (lambda plot: fm.plan_day(plot, "mites.csv"), "near=plot"),
    "a risk of words": (lambda plot: fm.plan_day(plot, risk=["a"]), "risk map must hold numbers"),
    "a chance of words": (lambda plot: fm.Monitor(plot, chance="x"), "must hold numbers, but 'x'"),
    "a chance of nobody": (
        lambda plot: fm.Monitor(plot, chance=np.full(plot.n_plants, np.nan)), "plant 0 of",
    ),
    "a seed of words": (lambda plot: fm.Monitor(plot, seed="x"), "seed must be a whole number"),
    "a robot of Monitor": (lambda plot: fm.Monitor(plot, robot=3), "must be a Robot, but it is 3"),
    "an outline as None": (lambda _: fm.Plot.from_geopandas(None), "must be a GeoDataFrame"),
    "an outline as a table": (
        lambda _: fm.Plot.from_geopandas(pd.DataFrame({"a": [1]})), "it is a DataFrame",
    ),
    "no geometry": (
        lambda _: fm.Plot.from_geopandas(gpd.GeoDataFrame({"a": [1]})), "which column holds",
    ),
    "a file as a frame": (lambda _: fm.read_plot(pd.DataFrame()), 'frame.to_csv("table.csv"'),
    "a file as a number": (lambda _: fm.read_plot(3), "A file must be given by its path"),
    "a plot as text": (lambda _: fm.read_records("a.csv", near="x"), "A plot must be what"),
    "a season's robot": (lambda plot: fm.Season.create("s.gpkg", plot, robot=4), "a Robot, but"),
    "a season's hours": (lambda plot: fm.Season.create("s.gpkg", plot, hours=4), "called 'hours'"),
    "a season's day": (
        lambda plot: fm.Season.create("s.gpkg", plot, begins="soon"), "but it is 'soon'",
    ),
    "a season's records": (lambda plot: fm.Season.create("s.gpkg", plot, "m.csv"), "be Records"),
    "a season's records by their old name": (
        lambda plot: fm.Season.create("s.gpkg", plot, observations=None), "Write records=",
    ),
    "a record half infested": (
        lambda _: fm.Records.of([[35.1, 30.3]], [0.7]), "1 (infested), 0 (clean) or -1",
    ),
    "records latitude first": (lambda _: fm.Records.of([[30, 120]], [1]), "longitude first"),
    "records by numbers": (lambda _: fm.Records.of([3, 4], [1, 1]), "pairs of longitude"),
    "records of no day": (
        lambda _: fm.Records.of([[35, 30]], [1], day=["soon"]), "must be as 2026-11-18",
    ),
    "a chance of too few": (lambda plot: fm.draw_start(plot, [0.1, 0.2]), "shape (3825,)"),
    "a chance above 1": (lambda plot: fm.draw_start(plot, np.full(3825, 2.0)), "0..1, but plant 0"),
    "states of nobody": (lambda plot: fm.hot_spots(plot.grid, None), "one entry a plant"),
    "states of words": (lambda plot: fm.hot_spots(plot.grid, ["a"] * 3825), "must hold numbers"),
    "states in a table": (lambda plot: fm.hot_spots(plot.grid, np.zeros((3825, 2))), "one entry a"),
    "states half found": (lambda plot: fm.hot_spots(plot.grid, np.full(3825, 0.5)), "1 (found inf"),
    "states of no plot": (lambda _: fm.hot_spots("Gate", np.zeros(3825)), "Give the plot"),
    "a hot spot's radius": (
        lambda plot: fm.hot_spots(plot.grid, np.zeros(3825), 9.0), "must be HotSpotSettings",
    ),
    "spread to a list": (lambda _: fm.Spread(to=["each"]), "of the neighbours, but it is ['each']"),
    "a pest's names": (lambda _: fm.Pest(name=np.array(["a", "b"])), "name must be text"),
    "a pest's cutoffs": (lambda _: fm.Pest("a", cutoff=np.array(["a", "b"])), "A cutoff must be"),
    "a pest's days": (lambda _: fm.Pest("a", latency_days="3"), "latency_days must be a number"),
    "a pest's movement": (lambda _: fm.Pest("a", movement=3), "movement must be a Movement"),
    "a pest's stages": (lambda _: fm.Pest("a", stages=("egg",)), "must be a tuple of Stages"),
    "viewpoints as a number": (lambda _: fm.Robot(viewpoints=3), "must be Viewpoints"),
    "hours beyond arithmetic": (lambda _: fm.Robot(hours=10**400), "less than 300 digits"),
    "a speed beyond roads": (lambda _: fm.Robot(speed_m_s=10**30), "must be 30 at most"),
    "a look of years": (lambda _: fm.Robot(look_s=10**30), "look_s must be 86400 at most"),
    "a latency of ages": (lambda _: fm.Pest("a", latency_days=10**30), "must be 3650 at most"),
    "a bearing without end": (lambda _: fm.Planting(row_bearing_deg=400), "-360 to 360 degrees"),
    "days as text": (lambda _: fm.SimulationSettings(n_days="9"), "n_days must be a whole number"),
    "a boundary of none": (lambda _: fm.Field("a", None), "boundary must be a MultiPolygon"),
    "a season by number": (lambda _: fm.Season(3), "A season must be given by its path"),
    "a dose as text": (lambda _: fm.Dose("0.5", "l/ha"), "A dose's value must be a number"),
    "a dose without unit": (lambda _: fm.Dose(0.5, None), "unit must be text"),
    "a label of none": (lambda _: fm.ProductLabel(None), "product must be text"),
    "a wait as text": (lambda _: fm.Application(waiting_days="7"), "waiting_days must be a whole"),
    "a chance as text": (lambda _: fm.Viewpoints(longer="x"), "longer must be a number"),
    "a start that is none": (lambda plot: fm.simulate(plot, None), "'start' of simulate must be"),
}  # fmt: skip


@pytest.mark.usefixtures("_here")
@pytest.mark.parametrize("mistake", MISTAKES)
def test_what_is_handed_over_by_mistake_is_said_in_a_sentence(mistake, plot):
    call, said = MISTAKES[mistake]
    with pytest.raises(fm.FieldmonError, match=re.escape(said)):
        call(plot)
    assert not Path("s.gpkg").exists()


@pytest.mark.parametrize("found", ["yes", "no", 1, float("nan"), np.nan])
def test_a_find_is_true_false_or_none_and_nothing_else_is_taken_for_one(found, plot):
    with fm.Monitor(plot, "naive").day() as day:
        day.ask()
        with pytest.raises(fm.ObservationError, match="True, False, or None"):
            day.tell(found)
        day.tell(np.False_)
        assert day.found.tolist() == [False]


@pytest.mark.parametrize(
    "on",
    [
        datetime(2026, 11, 18, 5, 30),
        datetime(2026, 11, 18, 3, 30, tzinfo=UTC),
        pd.Timestamp("2026-11-18 03:30", tz="UTC"),
        np.datetime64("2026-11-18T05:30"),
        np.datetime64("2026-11-18T05:30:00.000000000"),
        "2026-11-18 05:30",
        "2026-11-18T03:30Z",
    ],
)
def test_a_day_starts_at_the_plots_own_time_whatever_zone_it_was_given_in(on, plot):
    assert fm.plan_day(plot, on=on).route.notes.start == datetime(2026, 11, 18, 5, 30)


@pytest.mark.usefixtures("_here")
def test_a_season_may_begin_on_a_day_given_as_text(plot):
    season = fm.Season.create("s.gpkg", plot, begins="2026-11-18")
    assert season.settings.begins == date(2026, 11, 18)


@pytest.mark.usefixtures("_here")
def test_a_season_takes_a_moment_for_its_day_on_the_plot(plot):
    late = datetime(2026, 11, 17, 23, 30, tzinfo=UTC)
    season = fm.Season.create("s.gpkg", plot, begins=late, robot=fm.Robot(hours=0.5))
    assert season.settings.begins == date(2026, 11, 18)
    assert season.plan(on=pd.Timestamp(late)).route.notes.start == datetime(2026, 11, 18, 6)


@pytest.mark.parametrize(
    "asked",
    [
        lambda plot, chance: fm.plan_day(plot, on="2026-11-18", risk=chance),
        lambda plot, chance: fm.plan_team(plot, chance, fm.team_of(2)),
        lambda plot, chance: fm.routes.best(plot, chance, fm.Robot(hours=1)),
        lambda plot, chance: fm.Monitor(plot, chance=chance),
        fm.draw_start,
        lambda plot, chance: fm.hot_spots(plot, (chance > 0.5).astype(int)),
    ],
)
def test_chances_that_pandas_sorted_are_not_taken_by_their_place(asked, plot):
    chance = pd.Series(np.linspace(0, 1, plot.n_plants)).sort_values(ascending=False)
    with pytest.raises(fm.SettingError, match="must be in the plants' order"):
        asked(plot, chance)


def test_columns_of_records_and_inspections_that_pandas_sorted_apart_are_refused():
    frame = pd.DataFrame({"plant": [1, 2], "seen": [0, 1], "lon": 35.1, "lat": 30.3}, index=[4, 2])
    fm.Inspections.of(frame["plant"], frame["seen"], "2026-11-18")
    fm.Records.of(frame[["lon", "lat"]], frame["seen"])
    later = frame["seen"].sort_index()
    with pytest.raises(fm.SettingError, match="inspections must have one index, but that of resu"):
        fm.Inspections.of(frame["plant"], later, "2026-11-18")
    with pytest.raises(fm.SettingError, match="records must have one index, but that of present"):
        fm.Records.of(frame[["lon", "lat"]], later)


@pytest.mark.usefixtures("_here")
@pytest.mark.parametrize(
    "begin",
    [
        lambda plot, seen: fm.plan_day(
            plot, seen, "2026-11-18", robot=fm.Robot(hours=0.5), sampler="naive"
        ),
        lambda plot, seen: fm.Season.create("s.gpkg", plot, seen, begins="2026-11-18"),
    ],
)
def test_records_that_lie_elsewhere_or_nowhere_are_told_of(begin, plot):
    lonlat = plot.grid.lonlat(np.arange(6))
    lonlat[1], lonlat[2], lonlat[3, 0] = lonlat[1, ::-1], np.nan, lonlat[3, 0] + 1
    accuracy_m = [np.nan] * 4 + [1e9, 5.0]
    seen = fm.Records.of(lonlat, np.ones(6), "2026-11-17", accuracy_m=accuracy_m)
    with pytest.warns(ImportDoubt) as said:
        begin(plot, seen)
    sentences = [str(one.message) for one in said]
    for part in (
        f"2 of 5 records lie outside {plot.field.name} and were kept apart",
        "1 record would lie on the plot with longitude and latitude exchanged",
        "1 of the 6 records have no position",
        "1 of the 6 records are placed no better than to 1000 m",
    ):
        assert any(sentence.startswith(part) for sentence in sentences), sentences
    if Path("s.gpkg").exists():
        np.testing.assert_array_equal(fm.Season("s.gpkg").records.lonlat, lonlat)
