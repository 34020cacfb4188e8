"""However a plot is come by, the same file of records says the same about it.

A record gives a position, or names a row and a plant, or its plot too, or its plot alone. What a
surface makes of positions it must make of the names that mean the same. A surface is a function
that returns what it made, and a line in `SURFACES`.
"""

import csv
import json
from concurrent.futures import Future
from contextlib import nullcontext
from datetime import date
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
import shapely
from shapely import MultiPolygon

from fieldmon.cli import plan_all
from fieldmon.cli.main import app
from fieldmon.io.options import PlotOptions
from fieldmon.io.parse.geometry import area_m2
from fieldmon.io.prepare import lay
from fieldmon.io.read import read_plots
from fieldmon.monitoring import Season
from fieldmon.plot.grid import plant_at
from fieldmon.plot.projection import Frame
from fieldmon.simulation import executor
from tests.app import driving
from tests.parcels import write_geojson

FRAME = Frame(5.0, 45.0)
DAY = "2026-03-01"
PLOT = "Plot 2"
BOXES = [(0, 0, 60, 30), (500, 0, 560, 40), (0, 500, 70, 530)]
#: row, plant, and mites on the plot that is looked at
FOUND = ((2, 3, 4), (2, 4, 1), (5, 9, 0))


def command(*words):
    app([str(word) for word in words], standalone_mode=False)


def of_one(records):
    return ["--feature", PLOT, "--records", records, "--hours", 0.5]


def planned(records):
    """Return the route of `fieldmon plan`."""
    command("plan", "plots.geojson", *of_one(records), "--date", DAY, "-o", "one.geojson")
    return Path("one.geojson").read_bytes()


def planned_with_all(records):
    """Return the plot's route of `fieldmon plan --all`."""
    words = ["--records", records, "--date", DAY, "--hours", 0.5, "-o", "routes"]
    # of whose rows they are is not asked where one cannot mistake it
    whose = ["--record-option", f"plot={PLOT}"] if records == "rows.csv" else []
    command("plan", "plots.geojson", "--all", *words, *whose)
    with Path("routes", "summary.csv").open(encoding="utf-8-sig") as summary:
        (file,) = (row["file"] for row in csv.DictReader(summary) if row["plot"] == PLOT)
    return Path("routes", file).read_bytes()


def begun(records):
    """Return what a season of `fieldmon init` believes on its first morning, and its route."""
    Path("s.gpkg").unlink(missing_ok=True)
    command("init", "s.gpkg", "plots.geojson", *of_one(records), "--begins", DAY)
    season = Season(Path("s.gpkg"))
    first = season.settings.begins
    return season.morning(first).tolist(), season.plan(first, keep=False).route.plant.tolist()


def simulated(records):
    """Return the table of `fieldmon simulate`."""
    size = ["--sampler", "naive", "--days", 2, "-o", "days.csv"]
    command("simulate", "plots.geojson", *of_one(records), "--date", DAY, *size)
    return Path("days.csv").read_bytes()


def played(records):
    """Return the seasons of `fieldmon study prior`."""
    words = ["--plot", "plots.geojson", "--feature", PLOT, "--records", records]
    command("study", "prior", *words, "--seeds", 2)
    return Path("prior_plot.csv").read_bytes()


def studied(records):
    """Return the plot's seasons of `fieldmon study run`."""
    to = Path("study", Path(records).stem)
    one = ["--feature", PLOT] if records == "rows.csv" else []
    size = ["--sampler", "naive", "--hours", 0.5, "--days", 2, "--seeds", 2, "--workers", 1]
    words = ["--records", records, "--date", DAY, *size, "-o", to]
    command("study", "run", "plots.geojson", *words, *one)
    rows = [row for part in to.rglob("*.parquet") for row in pq.read_table(part).to_pylist()]
    return sorted((row for row in rows if row["plot"] == PLOT), key=lambda row: row["seed"])


def opened_in_app(records):
    """Return a session of the app with the plot and the records brought to it, on Today."""
    session = driving.opened()
    driving.upload(
        session, plot=("plots.geojson", Path("plots.geojson").read_bytes()),
        record=(records, Path(records).read_bytes()),
    )  # fmt: skip
    which = next(box for box in session.selectbox if box.label == "Which plot")
    which.set_value(which.options.index(PLOT)).run()
    session.slider(key="hours Robot").set_value(0.5)
    session.date_input[0].set_value(date.fromisoformat(DAY)).run()
    driving.go(session, "today")
    assert not [*session.exception, *session.error]
    # a day of long ago is marked as such, and nothing else is
    assert [one.value for one in session.warning if "not today" not in one.value] == []
    return session


def shown_and_begun_in_app(records):
    """Return the chances and the route of the app's first page, and what a season begins with.

    That is what the season believes on its first morning, and its route.
    """
    session = opened_in_app(records)
    # addresses name their content
    plants = driving.layer(session, "plants-chance")
    route, numbers = driving.layer(session, "route")["data"], driving.map_of(session)["labels"]
    shown = [plants["places"], plants["values"], route, numbers]
    name = Path(records).stem
    assert not driving.begun(session, name).error
    season = Season(Path("seasons", f"{name}.gpkg"))
    first = season.settings.begins
    route = season.plan(first, keep=False).route.plant.tolist()
    return shown, season.morning(first).tolist(), route


SURFACES = {
    "plan": planned,
    "plan --all": planned_with_all,
    "init": begun,
    "simulate": simulated,
    "study prior": played,
    "study run": studied,
    "app": shown_and_begun_in_app,
}


@pytest.fixture
def _records(tmp_path, monkeypatch):
    """Work in a folder with three plots, and the same records in every way of writing them."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FIELDMON_SEASONS", str(tmp_path / "seasons"))
    shapes = [FRAME.geometry_lonlat(MultiPolygon([shapely.box(*box)])) for box in BOXES]
    write_geojson(tmp_path / "plots.geojson", shapes)
    (field,) = read_plots(tmp_path / "plots.geojson", PlotOptions(feature=PLOT)).value
    grid = lay(field).plot.grid
    spots = grid.lonlat(np.array([plant_at(grid, row, plant) for row, plant, _ in FOUND]))
    middle = shapely.point_on_surface(field.boundary)
    reach_m = float(np.sqrt(area_m2(field.boundary) / np.pi))
    files = {
        "positions": ("lon,lat", [f"{lon!r},{lat!r}" for lon, lat in spots.tolist()]),
        "rows": ("row,plant", [f"{row},{plant}" for row, plant, _ in FOUND]),
        "plots_and_rows": ("plot,row,plant", [f"{PLOT},{row},{plant}" for row, plant, _ in FOUND]),
        "plots": ("plot", [PLOT] * len(FOUND)),
        "middles": ("lon,lat,accuracy", [f"{middle.x!r},{middle.y!r},{reach_m!r}"] * len(FOUND)),
    }
    for name, (columns, places) in files.items():
        lines = [f"{at},{DAY},{n}" for at, (_, _, n) in zip(places, FOUND, strict=True)]
        Path(f"{name}.csv").write_text("\n".join([f"{columns},date,count", *lines, ""]))


class AtOnce:
    """Does what a pool of processes is handed here and now."""

    def __init__(self, _workers, _context, _prepare, told):
        plan_all._BEGUN_WITH[:] = told

    def submit(self, work, *about):
        done = Future()
        done.set_result(work(*about))
        return done

    def shutdown(self, **_):
        pass


@pytest.fixture
def _one_process(monkeypatch):
    """Let all be done in this process; with others, these commands are tested by themselves."""
    monkeypatch.setattr(plan_all, "ProcessPoolExecutor", AtOnce)
    monkeypatch.setattr(executor, "cluster", lambda *_: nullcontext(executor.here()))


@pytest.mark.usefixtures("_records", "_one_process")
@pytest.mark.parametrize("surface", SURFACES)
def test_records_that_name_places_say_what_positions_say(surface):
    made = SURFACES[surface]
    there = made("positions.csv")
    assert made("rows.csv") == there
    if surface != "app":  # where the plot is chosen and the plots are told, as for the two others
        assert made("plots_and_rows.csv") == there
    somewhere = made("middles.csv")
    assert made("plots.csv") == somewhere
    assert somewhere != there


@pytest.mark.usefixtures("_records")
def test_a_plot_is_planned_the_same_alone_with_all_others_and_in_a_season():
    alone = planned("rows.csv")
    assert planned_with_all("rows.csv") == alone
    command("init", "s.gpkg", "plots.geojson", *of_one("rows.csv"), "--begins", DAY)
    command("plan", "s.gpkg", "--date", DAY, "-o", "of_season.geojson")
    of_season = json.loads(Path("of_season.geojson").read_bytes())
    ahead = [one["properties"].pop("forecast", None) for one in of_season["features"]]
    assert len([one for one in ahead if one]) == 1  # only a season knows what nights will bring
    assert of_season == json.loads(alone)
