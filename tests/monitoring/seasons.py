"""Seasons for tests: a small plot with records, and what a day's work finds on it."""

from datetime import UTC, date, datetime, time, timedelta
from functools import cache

import numpy as np
from shapely import MultiPolygon, box

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import night
from fieldmon.infestation.inspections import CLEAN, FOUND, Inspections
from fieldmon.infestation.prior.prior import start_infested
from fieldmon.infestation.records import Records
from fieldmon.monitoring import MonitoringSettings, Season
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.planning.workday import draw_detections
from fieldmon.plot import local_clock
from fieldmon.plot.field import Field
from fieldmon.plot.plant_names import PlantNames
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot, plot_around
from fieldmon.plot.projection import Frame
from fieldmon.plot.robot import Robot

BEGINS = date(2026, 4, 6)
ROBOT = Robot(hours=1.5)


def on(day):
    """Return the date of a day of the season."""
    return BEGINS + timedelta(days=day)


def clock_on(monkeypatch, day):
    """Let it be noon of a day of the season."""
    noon = datetime.combine(on(day), time(12), UTC)
    monkeypatch.setattr(local_clock, "utc_now", lambda: noon)


def all_on(monkeypatch, day):
    """Let it be noon of a day of the season for the log, too: it is said when it was planned."""
    clock_on(monkeypatch, day)
    logged_at(monkeypatch, local_clock.utc_now())


def logged_at(monkeypatch, moment):
    """Let the log say that this is the moment."""
    monkeypatch.setattr(season_log, "utc_text", lambda: local_clock.utc_text(moment))


@cache
def a_plot(width=0.0008, height=0.0007, **planting):
    hole = box(35.1503, 30.3603, 35.1504, 30.3604)
    boundary = MultiPolygon([box(35.15, 30.36, 35.15 + width, 30.36 + height).difference(hole)])
    field = Field("מטע Paran", boundary, gate=(35.15, 30.36))
    return Plot.of(field, Planting(**planting))


def a_small_plot():
    """Return a plot of some hundred plants, on which a night takes half as long."""
    return a_plot(0.00042, 0.00042)


def a_plot_with_named_rows():
    """Return a plot of 4 rows of 20 plants, which its file calls 1, 5A, 2 and Top."""
    row, plant = np.divmod(np.arange(80), 20)
    lonlat = Frame(35.0, 30.0, 90.0).lonlat(np.stack([2.0 * plant, 3.0 * row], axis=1))
    names = PlantNames(np.array(["1", "5A", "2", "Top"])[row], None, (plant + 1).astype(np.str_))
    return plot_around("own", lonlat, names=names)


def some_records(plot):
    here = plot.grid.lonlat()[[10, 11, 60]]
    day = np.array(["2026-03-30", "2026-04-02", "NaT"], "datetime64[D]")
    return Records.of(here, np.array([1, 1, 0], np.int8), day)


def a_season(path, plot=None, **choices):
    plot = plot or a_plot()
    settings = MonitoringSettings(BEGINS, **({"robot": ROBOT} | choices))
    return Season.create(path, plot, some_records(plot), settings)


def of_a_corner(path):
    """Begin a season in which a corner of the plot was found infested and left, nothing else."""
    made = a_season(path, belief=BeliefSettings(treated=False))
    plants = np.arange(0, len(made.plot.grid), 3)
    corner = made.plot.grid.xy_m[plants] - made.plot.grid.xy_m.min(axis=0)
    found = (corner < 16).all(axis=1)
    made.record(Inspections.of(plants, found.astype(int), np.datetime64(BEGINS)), "day")
    return made


class Insects:
    """The truth of a season: what an inspection would find, and what a night does."""

    def __init__(self, season, seed=1):
        self.season, self.chance = season, RandomStreams(seed)
        begin = start_infested(season.morning(BEGINS), 0.1, self.chance.of("start"))
        self.infested = begin[season.plot.grid.vine]

    def look(self, day, plants):
        """Return the results of inspecting plants on a day, and let the night come."""
        grid, settings = self.season.plot.grid, self.season.settings
        detects = np.array([settings.robot.detects])
        finds = draw_detections(self.infested, detects, self.chance.key("inspect", day))
        found = finds[plants] > 0
        self.infested = self.infested.copy()
        self.infested[plants[found]] = False
        self.infested = night(
            grid, self.infested, settings.belief.spread, self.chance.key("spread", day)
        )
        on = np.datetime64(BEGINS + timedelta(days=day), "D")
        return Inspections.of(plants, np.where(found, FOUND, CLEAN), on)


def some_results(season, n=5, day=0, found=()):
    """Return results of the first n plants of the day's route."""
    on = BEGINS + timedelta(days=day)
    plants = season.plan(on, keep=False).route.plant[:n]
    result = np.where(np.isin(np.arange(n), found), FOUND, CLEAN)
    return Inspections.of(plants, result, np.datetime64(on, "D"))


def three_results(on=0, first=100):
    plants = np.arange(first, first + 3)
    return Inspections.of(plants, np.zeros(3, np.int8), np.datetime64(BEGINS, "D") + on)


def state(path):
    """Return what counts of a season: it must hold together."""
    season = Season(path)
    season.store.check()
    assert season.verify() == ()
    with season.store.reading() as db:
        inspections = db.execute("SELECT digest FROM inspections ORDER BY fid").fetchall()
        batches = db.execute("SELECT rows FROM batches WHERE kind = 'findings'").fetchall()
        days = db.execute("SELECT sum(inspected) FROM days").fetchone()[0]
        routes = db.execute("SELECT fid, stops FROM routes").fetchall()
        stops = dict(db.execute("SELECT route, count(*) FROM stops GROUP BY route").fetchall())
    assert sum(n for (n,) in batches) == len(inspections)
    assert days == len(inspections)
    assert stops == {route: n for route, n in routes if n}
    return len(inspections)
