"""Where a scout goes next: the compass and the metres of the way that is really walked."""

import numpy as np
import pytest

from app.show.next_stop import next_stop
from app.words import texts
from app.words.units import UnitsInLanguage
from fieldmon.planning.plan import DayPlan
from fieldmon.planning.route import route_of
from fieldmon.planning.workday import plan_work
from fieldmon.plot.robot import Robot
from fieldmon.samplers import sampler
from fieldmon.samplers.base import NEVER, Scene
from tests.app.chosen import a_plot
from tests.app.driving import apart


@pytest.fixture(scope="module")
def plot():
    return a_plot()


def planned(plot, at=-1):
    grid = plot.grid
    robot = Robot(hours=2.0)
    chance = np.full(len(grid), 0.01)
    scene = Scene(aisles=plot.aisles, robot=robot, chance=chance, at=at, seconds_left=robot.day_s,
                  last_inspected=np.full(len(grid), NEVER, np.int32))  # fmt: skip
    work = plan_work(scene, sampler("naive"))
    return DayPlan(scene, work, route_of(scene, work))


def test_the_way_is_as_long_as_the_route_to_the_first_stop(plot):
    plan = planned(plot)
    stop = next_stop(plan, 0, UnitsInLanguage())
    line = plan.route.line_m[: plan.route.line_stop[0] + 1]
    metres = np.hypot(*np.diff(line, axis=0).T).sum()
    assert apart(stop.direction).startswith(f"{metres:.0f} m ")
    assert stop.plant == plan.route.plant[0]
    assert stop.lonlat == pytest.approx(plot.grid.lonlat()[stop.plant].tolist())


@pytest.mark.parametrize("at", [-1, 0, 57, 120, 200])
def test_compass_and_arrow_point_from_here_to_there(plot, at):
    plan = planned(plot, at)
    stop = next_stop(plan, 0, UnitsInLanguage())
    frame, grid = plot.grid.frame, plot.grid
    from_m = plot.aisles.gate_m if at < 0 else grid.xy_m[at]
    (here,) = frame.lonlat(np.reshape(from_m, (1, 2)))
    there = np.array(stop.lonlat)
    east, north = (there - here) * [np.cos(np.deg2rad(here[1])), 1.0]
    bearing = np.rad2deg(np.arctan2(east, north)) % 360
    sector = round(bearing / 45) % 8
    assert f" {texts.COMPASS[sector]}" in stop.direction
    assert stop.arrow == texts.ARROWS[sector]
    same = at >= 0 and grid.row[at] == grid.row[stop.plant]
    assert stop.direction.endswith("in this row" if same else "change rows")


def test_stops_done_and_left_and_hours_are_counted(plot):
    plan = planned(plot)
    said = apart(next_stop(plan, 17, UnitsInLanguage()).chance)
    assert said == f"Chance 1.0 % · 17 done, {len(plan.route)} to go · 2:00 left"
