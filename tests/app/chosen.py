"""Choices without a page: what the sidebar would hand to one."""

from datetime import date
from itertools import count

import numpy as np
from shapely import MultiPolygon, box

from app.state.choices import Choices
from app.words.units import UnitsInLanguage
from fieldmon.infestation.records import Records
from fieldmon.plot.field import Field
from fieldmon.plot.planting import Planting
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot

CORNER = (35.15, 30.36)
DAY = date(2026, 11, 16)
# a key stands for a plot and its records
_KEYS = count()


def a_plot(size=0.0006, **planting):
    """Return a square plot with a gate in its corner."""
    lon, lat = CORNER
    square = MultiPolygon([box(lon, lat, lon + size, lat + size)])
    return Plot.of(Field("square", square, gate=CORNER), Planting(**planting))


def records_at(plot, plants, present, day="2026-11-10"):
    """Return records at plants of a plot, all of a day."""
    days = np.full(len(plants), day, "datetime64[D]")
    return Records.of(plot.grid.lonlat()[plants], np.asarray(present, np.int8), days)


def chosen(plot, records=None, season=None, **more):
    """Return choices of a plot, or of a season."""
    given = {"robot": Robot(hours=1.0), "sampler": "adaptive", "day": DAY.isoformat()} | more
    key = f"test {next(_KEYS)}" if season is None else str(season.path)
    records = Records.none() if records is None else records
    return Choices(
        key, plot, records, (), units=UnitsInLanguage(), season=season, plot_key=key, **given
    )


def in_season(season, day=DAY):
    """Return choices of a season on a day."""
    settings = season.settings
    return chosen(season.plot, season.records, season, robot=settings.robot,
                  sampler=settings.sampler, day=day.isoformat())  # fmt: skip
