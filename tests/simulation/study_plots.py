"""Plots of studies for tests."""

import numpy as np
import shapely
from shapely import MultiPolygon

from fieldmon.infestation.records import Records
from fieldmon.plot.field import Field
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.simulation.design import Design
from fieldmon.simulation.study_plot import StudyPlot

FRAME = Frame(5.0, 45.0)
DAY = np.datetime64("2026-11-02")
SMALL = Design(hours=(1.0, 3.0), n_days=4, n_seeds=24, infested=(0.05,))


def area(size_m):
    return FRAME.geometry_lonlat(MultiPolygon([shapely.box(0, 0, 2 * size_m, size_m)]))


def plot(size_m=40.0, name="plot"):
    return StudyPlot(Field(name, area(size_m)), Planting(), Records.none(), DAY)
