"""A season's file: opened, planned, recorded; after 25 days, and of 100 000 plants."""

from datetime import date, timedelta

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.prior.prior import start_infested
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.planning.workday import draw_detections
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot

BEGINS = date(2026, 4, 6)


def plot_of(n_rows, n_plants):
    grid = rectangle(n_rows, n_plants)
    boundary = grid.frame.geometry_lonlat(grid.drivable_m)
    return Plot.of(Field("Benchmark", boundary, row_bearing_deg=grid.frame.bearing_deg), Planting())


def season_of(path, plot, n_days):
    project = Season.create(path, plot, Records.none(), MonitoringSettings(BEGINS))
    infested = start_infested(project.morning(BEGINS), 0.02, RandomStreams(1).of("start"))
    for day in range(n_days):
        work(project, day, infested)
    return project


def work(project, day, infested):
    on = BEGINS + timedelta(days=day)
    plants = project.plan(on).route.plant
    key = RandomStreams(1).key("inspect", day)
    found = draw_detections(infested, np.array([0.84]), key)[plants] > 0
    project.record(Inspections.of(plants, found, np.datetime64(on, "D")), f"day {day}")


@pytest.fixture(scope="module", params=[(91, 91, 25), (317, 317, 5)], ids=["8k25d", "100k5d"])
def season(request, tmp_path_factory):
    n_rows, n_plants, n_days = request.param
    path = tmp_path_factory.mktemp("bench") / "season.gpkg"
    project = season_of(path, plot_of(n_rows, n_plants), n_days)
    return project, n_days


def test_opening_a_season_and_its_status(benchmark, season):
    project, n_days = season
    on = BEGINS + timedelta(days=n_days - 1)
    benchmark.extra_info["megabytes"] = round(project.path.stat().st_size / 1e6, 1)
    benchmark.extra_info["plants"] = len(project.plot.grid)
    status = benchmark(lambda: Season(project.path).status(on))
    assert status.inspected > 1000


def test_planning_the_next_day(benchmark, season):
    project, n_days = season
    today = benchmark(lambda: project.plan(BEGINS + timedelta(days=n_days), keep=False))
    assert len(today.route) > 300


def test_recording_a_day(benchmark, season):
    project, n_days = season
    on = BEGINS + timedelta(days=n_days)
    plants = project.plan(on).route.plant

    def record():
        project.record(Inspections.of(plants, plants % 50 == 0, np.datetime64(on, "D")), "today")

    benchmark.pedantic(record, setup=lambda: undone(project), rounds=5)


def undone(project):
    if project.batches()[0].source == "today" and not project.batches()[0].undone:
        project.undo()
