"""A driven day in time, from whoever noted it."""

from datetime import UTC, datetime
from itertools import pairwise

import numpy as np
import pytest

from fieldmon.drive.bag import write_bag
from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import drive_day
from fieldmon.drive.day_tables import stop_table
from fieldmon.drive.recording import Recording
from fieldmon.drive.trace import (
    believed_on_the_way,
    thinned,
    trace_of,
    trace_of_bag,
    trace_of_stops,
)
from fieldmon.errors import FileProblem
from fieldmon.monitoring.estimates.monitor import Monitor
from fieldmon.monitoring.settings.belief_settings import BeliefSettings


@pytest.fixture(scope="module")
def day(plot, robot):
    """Drive a day; return what was noted, and the day."""
    chance = np.random.default_rng(3).uniform(0.005, 0.3, len(plot.grid))
    noted = Recording(plot.aisles.for_robot(robot), robot, chance)
    with Monitor(plot, robot=robot, chance=chance).day() as today:
        who = robot, ChargedRobot(lambda stop: stop.plant % 7 == 0)
        driven = drive_day(today, noted.aisles, who, noted.note)
    return noted, driven


def at(trace, second):
    """Return where a trace is at a second, lon/lat."""
    t, lon, lat = trace.poses[:, :3].T
    return np.array([np.interp(second, t, lon), np.interp(second, t, lat)])


def apart_m(plot, one, other):
    """Return how far two positions, lon/lat, are apart."""
    return float(np.hypot(*(plot.grid.frame.xy_m(np.array([one, other]))[0]
                            - plot.grid.frame.xy_m(np.array([one, other]))[1])))  # fmt: skip


def test_the_robot_stands_before_each_plant_while_it_looks_and_drives_between_them(day, plot):
    noted, driven = day
    trace = trace_of(noted)
    assert [one.plant for one in trace.stops] == [one.stop.plant for one in driven.stops]
    assert [one.found for one in trace.stops] == [one.visit.found for one in driven.stops]
    for one in driven.stops:
        place = plot.grid.frame.lonlat(noted.aisles.stop_m[[one.stop.plant]])[0]
        for second in np.linspace(0.1, one.stop.inspect_s - 0.1, 3):
            assert apart_m(plot, at(trace, one.stop.arrive_s + second), place) < 0.05
    assert np.ptp(trace.poses[:, 1:3], axis=0).min() > 0


def test_a_robot_heads_where_it_drives(day, plot):
    trace = trace_of(day[0])
    checked = 0
    for (t0, lon0, lat0, heading), (t1, lon1, lat1, _) in pairwise(trace.poses.tolist()):
        east = (lon1 - lon0) * np.cos(np.deg2rad(lat0))
        if apart_m(plot, (lon0, lat0), (lon1, lat1)) < 0.5 or t1 <= t0:
            continue
        bearing = np.degrees(np.arctan2(east, lat1 - lat0))
        assert abs((bearing - heading + 180) % 360 - 180) < 2.0
        checked += 1
    assert checked > 10


def test_what_is_left_out_lies_between_what_is_kept():
    t = np.arange(0, 60, 0.1)
    poses = np.column_stack([t, np.minimum(t, 30.0), np.sin(t / 9), np.cos(t / 9) / 9])
    kept = thinned(poses)
    assert len(kept) < len(poses) / 5
    assert kept[[0, -1]].tolist() == poses[[0, -1]].tolist()
    for column in (1, 2):
        assert np.abs(np.interp(t, kept[:, 0], kept[:, column]) - poses[:, column]).max() < 0.02


def test_the_table_of_stops_gives_the_same_day_back(day, plot, robot):
    noted, driven = day
    own, read = trace_of(noted), trace_of_stops(stop_table(driven), noted.aisles, robot)
    assert [one[1:] for one in read.stops] == [one[1:] for one in own.stops]
    done = [one.done_s for one in own.stops]
    assert [one.done_s for one in read.stops] == pytest.approx(done, abs=0.06)
    for one in own.stops:
        assert apart_m(plot, at(read, one.done_s - 0.2), at(own, one.done_s - 0.2)) < 0.1


def test_a_bag_gives_the_same_day_back(day, plot, robot, tmp_path):
    noted, _ = day
    bag, *_ = write_bag(noted, datetime(2026, 4, 6, 3, tzinfo=UTC), tmp_path / "day.mcap")
    own, read = trace_of(noted), trace_of_bag(bag.read_bytes(), noted.aisles, robot)
    assert [one[1:] for one in read.stops] == [one[1:] for one in own.stops]
    begins = own.poses[0, 0]
    for second in np.linspace(begins, own.end_s, 40):
        assert apart_m(plot, at(read, second - begins), at(own, second)) < 0.1


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: text.replace("stop,plant", "a,b"), "must begin with the columns"),
        (lambda _: "", "must begin with the columns"),
        (lambda text: text.splitlines()[0] + "\n1,5,9,9,0,1,1,1,0,,0\n", "not row 9, plant 9"),
        (lambda text: text.splitlines()[0] + "\n1,5,1,x,0,1,1,1,0,,0\n", "Line 2 of the table"),
        (lambda text: text.splitlines()[0] + "\n1,5000,1,1,0,1,1,1,0,,0\n", "Plant 5000"),
    ],
)
def test_a_table_of_something_else_is_refused(day, robot, change, said):
    noted, driven = day
    with pytest.raises(FileProblem, match=said):
        trace_of_stops(change(stop_table(driven).decode()).encode(), noted.aisles, robot)


@pytest.mark.parametrize("data", [b"\x89MCAP0\r\n" + b"x" * 50, b""])
def test_a_damaged_bag_is_refused(day, robot, data):
    with pytest.raises(FileProblem, match="cannot be read"):
        trace_of_bag(data, day[0].aisles, robot)


def test_what_is_believed_on_the_way_ends_as_the_day_is_learnt(day, plot, robot):
    noted, driven = day
    trace, settings = trace_of(noted), BeliefSettings()
    morning = settings.first_morning(plot.grid, noted.chance)
    moments = believed_on_the_way(trace, morning, robot.detects, most=8)
    assert 1 < len(moments) <= 8
    plants = np.array([one.stop.plant for one in driven.stops], np.int32)
    found = np.array([one.visit.found for one in driven.stops])
    evening = settings.evening(morning, plants, found, robot.detects).chance
    assert moments[-1][0] == trace.stops[-1].done_s
    assert moments[-1][1] == pytest.approx(evening)
    assert not np.allclose(moments[0][1], evening)
