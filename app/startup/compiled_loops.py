"""Loading compiled loops by using them: a day and a short season on a few plants."""

from __future__ import annotations

import numpy as np
from shapely import MultiPolygon

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.hotspots import hot_spots, record_states
from fieldmon.infestation.records import PRESENT, Records
from fieldmon.planning.day_bound import with_bound
from fieldmon.planning.plan import PlanSettings, first_day
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start

_CORNERS = [(35.15, 30.36), (35.1504, 30.3601), (35.1503, 30.3604), (35.15, 30.3603)]


def load_planning() -> None:
    """Plan a day from a record, and look for hot spots, as Today does."""
    plot = Plot.of(Field("", MultiPolygon([(_CORNERS, [])])))
    record = Records.of(np.array([(35.1502, 30.3602)]), np.array([PRESENT]))
    with_bound(first_day(plot, record, np.datetime64("2026-11-16"), PlanSettings()))
    hot_spots(plot.grid, record_states(plot.grid, record))


def load_simulation() -> None:
    """Simulate with what Compare and Simulate begin with."""
    for name in ("adaptive", "dynamic", "naive"):
        start = Start(np.ones(9, np.bool_), np.full(9, 0.1))
        settings, aisles = SimulationSettings(n_days=2), Aisles.of(rectangle(3, 3))
        list(simulated_days(aisles, Robot(), sampler(name), start, settings, RandomStreams(0)))
