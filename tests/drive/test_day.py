"""The loop: asked, driven, told, and what the day comes to."""

import signal

import numpy as np
import pytest

from fieldmon.drive.charged_robot import ChargedRobot
from fieldmon.drive.day import DrivenDay, drive_day
from fieldmon.drive.day_tables import in_words
from fieldmon.drive.errand import Visit


class Slow:
    """Takes ten seconds more for each plant than is charged, and finds none."""

    def __init__(self):
        self.now_s, self.asked = 0.0, []

    def begin(self, aisles, at_m, gone_s):  # noqa: ARG002
        self.now_s = gone_s

    def visit(self, errand):
        self.asked.append(errand)
        self.now_s = max(self.now_s, errand.stop.arrive_s) + errand.stop.inspect_s + 10.0
        return Visit(False, self.now_s, 0.01, frozenset({3}))

    def home(self, line_m):  # noqa: ARG002
        return Visit(None, self.now_s + 100.0)


def test_a_slow_robot_is_planned_for_by_its_own_clock(monitor, plot, robot):
    slow, aisles = Slow(), plot.aisles.for_robot(robot)
    with monitor.day() as day:
        driven = drive_day(day, aisles, (robot, slow))
    assert len(driven.stops) > 5
    extra = [one.driven_s - one.charged_s for one in driven.stops]
    assert extra == pytest.approx([10.0] * len(extra), abs=1e-6)
    assert driven.stops[-1].visit.done_s <= robot.day_s + 10.0
    assert driven.touched == {3}
    assert driven.strayed_m == 0.01
    assert driven.home_driven_s == pytest.approx(100.0)


def test_every_way_begins_where_the_last_one_ended_and_says_what_comes_after(monitor, plot, robot):
    asked, aisles = [], plot.aisles.for_robot(robot)
    charged = ChargedRobot(lambda stop: False)  # noqa: ARG005
    with monitor.day() as day:
        drive_day(day, aisles, (robot, charged), lambda stop, errand: asked.append(errand))  # noqa: ARG005
    at_m = aisles.gate_m
    for errand in asked:
        assert errand.line_m[0] == pytest.approx(at_m)
        at_m = errand.line_m[-1]
        assert at_m == pytest.approx(aisles.stop_m[errand.stop.plant])
        if errand.ahead:
            assert errand.ahead[0][1][0] == pytest.approx(at_m)
    looks = [errand.look_s for errand in asked]
    assert looks == pytest.approx([robot.look_s] * len(asked))
    ahead = [errand.ahead[0][0] for errand in asked if errand.ahead]
    assert ahead == [one.stop.plant for one in asked[1:]]


def test_whoever_watches_is_told_of_each_stop_once_it_is_recorded(monitor, plot, robot):
    seen = []
    with monitor.day() as day:
        drive_day(
            day,
            plot.aisles.for_robot(robot),
            (robot, ChargedRobot(lambda stop: stop.plant % 7 == 0)),
            lambda stop, errand: seen.append((stop, len(day.plants), errand.number)),
        )
    assert [number for _, _, number in seen] == [told for _, told, _ in seen]
    assert any(stop.visit.found for stop, _, _ in seen)


@pytest.fixture
def heard():
    """Let Ctrl-C be heard: a program begun in the background passes it by."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heard")
def test_who_stops_the_drive_waits_until_a_told_plant_is_noted_too(monitor, plot, robot):
    so_far, seen = DrivenDay(), []
    with monitor.day() as day:
        tell = day.tell

        def tell_and_stop(*result):
            tell(*result)
            signal.raise_signal(signal.SIGINT)

        day.tell = tell_and_stop
        who = robot, ChargedRobot(lambda stop: False)  # noqa: ARG005
        with pytest.raises(KeyboardInterrupt):
            drive_day(day, plot.aisles.for_robot(robot), who, lambda *one: seen.append(one), so_far)
        assert len(day.plants) == len(so_far.stops) == len(seen) == 1


class Crawls(Slow):
    """Drives four times slower than charged, home even slower, and says when it got there."""

    def __init__(self, charged, home):
        super().__init__()
        self.charged_s, self.times_home = charged, home

    def visit(self, errand):
        there_s = self.now_s + 4.0 * self.charged_s(errand.line_m)
        self.now_s = there_s + errand.stop.inspect_s
        return Visit(found=False, done_s=self.now_s, there_s=there_s)

    def home(self, line_m):
        return Visit(None, self.now_s + self.times_home * self.charged_s(line_m))


@pytest.mark.parametrize("home", [4.0, 20.0])
def test_a_slow_robot_goes_home_in_time_and_says_where_it_did_not(monitor, plot, robot, home):
    def charged_s(line_m):
        return float(np.hypot(*np.diff(line_m, axis=0).T).sum()) / robot.speed_m_s

    with monitor.day() as day:
        who = robot, Crawls(charged_s, home)
        driven = drive_day(day, plot.aisles.for_robot(robot), who)
    assert 3.0 < driven.slowness <= 4.0  # row changes take no time of their own
    ends_s = driven.stops[-1].visit.done_s + driven.home_driven_s
    if home == 4.0:
        assert ends_s < robot.day_s + 30.0
        assert driven.late_s == 0.0
        assert "after its hours" not in in_words(driven)
    else:
        assert driven.late_s == pytest.approx(ends_s - robot.day_s)
        assert f"It came home {driven.late_s / 60:.0f} min after its hours." in in_words(driven)
