"""Simulated and driven days, kept between clicks as `cached` keeps what a season comes to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.pest_in_weather import seen_in_weather
from fieldmon.infestation.insects.spread import Spread
from fieldmon.samplers import sampler
from fieldmon.simulation.metrics import SeasonMetrics, season_metrics
from fieldmon.simulation.season import SimulatedDay, SimulationSettings, simulated_days
from fieldmon.simulation.start import season_start

from .cached import FEW, WORKING
from .comparison import WatchedComparison
from .driving import DayInTime, DriveRun
from .live_drive import LiveDrive

if TYPE_CHECKING:
    from fieldmon.drive.simulated_robots import MadeUp
    from fieldmon.drive.vda5050.mqtt import Broker, Watched
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.samplers.base import Sampler, Scene
    from fieldmon.simulation.worker import LaidPlot

    from .comparison import ComparisonSettings


@st.cache_resource(max_entries=8, show_spinner=False)
def comparison(
    key: str,
    settings: ComparisonSettings,
    robot: Robot,
    _laid: LaidPlot,
) -> WatchedComparison:
    """Return the comparison of these settings on this plot; it is at work or will be.

    `key` stands for the plot, its chances and its pest.
    """
    return WatchedComparison(settings, _laid, robot)


@st.cache_resource(max_entries=8, show_spinner=False)
def drive_run(
    key: str,
    kind: str,
    made_up: MadeUp,
    _plot: Plot,
    _scene: Scene,
    _sampler: Sampler,
) -> DriveRun:
    """Return a day driven by a simulated robot, done or to be; `key` stands for the scene."""
    return DriveRun(kind, _plot, _scene, _sampler, made_up)


@st.cache_resource(max_entries=8, show_spinner=False)
def live_drive(
    key: str, broker: Broker, watched: Watched, _scene: Scene, _robots: dict[str, Robot]
) -> LiveDrive:
    """Return robots' day as it is driven; `key` stands for the plot, the day and the team."""
    return LiveDrive(broker, watched, _scene, _robots)


@st.cache_resource(max_entries=8, show_spinner=WORKING)
def recorded_drive(key: str, _data: bytes, _plot: Plot, _scene: Scene) -> DayInTime:
    """Return a day that was driven; `key` stands for the scene and the file."""
    return DayInTime.of_file(_data, _plot, _scene)


@st.cache_resource(max_entries=FEW, show_spinner=WORKING)
def simulated_season(
    key: str,
    sampler_name: str,
    numbers: tuple[int, float, float, int, int],
    robot: Robot,
    _laid: LaidPlot,
) -> tuple[list[SimulatedDay], SeasonMetrics]:
    """Return a simulated season and its figures; `key` stands for plot, records, day and pest.

    `numbers` are days, share infested at the start, spread a night, days from one visit to the
    next, and seed.
    """
    n_days, share, rate, visit_every, seed = numbers
    streams = RandomStreams(seed)
    plot, chance, pest_in_weather = _laid
    robot = seen_in_weather(robot, pest_in_weather)
    start = season_start(plot.grid, chance, share, streams)
    spread = Spread(rate)
    settings = SimulationSettings(n_days, spread, pest=pest_in_weather, visit_every=visit_every)
    decides = sampler(sampler_name)
    walk = list(simulated_days(plot.aisles, robot, decides, start, settings, streams))
    return walk, season_metrics(walk)
