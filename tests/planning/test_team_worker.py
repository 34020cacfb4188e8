"""One of a team on its day: what is spent, what is left, what a new plan drops."""

import numpy as np
import pytest

from fieldmon.planning.team_worker import Posted, StopMade, TeamWorker
from fieldmon.planning.workday import Workday
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE, Aisles
from fieldmon.samplers.base import NEVER, Scene

AISLES = Aisles.of(rectangle(4, 16))
N = len(AISLES.grid)
#: plants, when each is come to, and when it is left
STOPS = [(5, 60.0, 100.0), (6, 110.0, 150.0), (7, 160.0, 200.0)]


def worker(starts_s=0.0, stops=STOPS, **robot):
    """Return one with an hour's day that has made some stops in its aisle."""
    robot = Robot(hours=1.0, **robot)
    last = np.full(N, NEVER, np.int32)
    scene = Scene(AISLES, robot, np.full(N, 0.1), last, seconds_left=robot.day_s)
    made = TeamWorker.of(0, Posted(scene, starts_s, np.zeros(N, bool)))
    made.done = [StopMade(*stop, False, 1.0, 0.0) for stop in stops]
    made.at = stops[-1][0] if stops else GATE
    return made


def test_of_a_visit_to_an_aisle_only_the_stop_under_way_is_spent_already():
    """Those yet to be made there may be left out: seconds are shared out without them."""
    for now_s, free_s in ((0.0, 100.0), (99.0, 100.0), (105.0, 150.0), (199.0, 200.0)):
        assert worker().left_s(now_s) == 3600.0 - free_s
    assert worker().left_s(500.0) == 3100.0


def test_who_has_not_begun_has_its_whole_day_left_and_who_is_at_home_none():
    late = worker(400.0, stops=[])
    assert late.left_s(0.0) == 3600.0
    assert late.left_s(500.0) == 3500.0
    late.over = True
    assert late.left_s(500.0) == 0.0


@pytest.mark.parametrize(
    ("now_s", "kept"), [(0.0, 1), (99.0, 1), (100.0, 2), (149.0, 2), (150.0, 3)]
)
def test_a_new_plan_drops_the_stops_that_it_has_not_begun_to_drive_to(now_s, kept):
    one = worker()
    assert one.interrupt(now_s) is (kept < 3)
    assert one.anew
    assert (len(one.done), one.at) == (kept, STOPS[kept - 1][0])
    # what was planned of dropped stops is void
    assert one.version == int(kept < 3)


def test_its_day_counts_from_its_own_start():
    day = worker(20.0).worked()
    assert day.plant.tolist() == [5, 6, 7]
    assert day.arrive_s.tolist() == [40.0, 90.0, 140.0]
    assert day.stop_s.tolist() == [40.0] * 3
    assert len(worker(stops=[]).worked()) == 0


def test_there_is_just_time_to_spare_for_the_way_home():
    one = worker(stops=[])
    one.plan = Workday(np.array([9], np.int32), *(np.ones(1),) * 4, 1.0)
    assert one.target() == 9
    arrives_s = one.seconds(GATE, 9)
    spare_s = one.spare_s(arrives_s)
    assert arrives_s + spare_s + 1.0 + one.seconds(9, GATE) == pytest.approx(one.until_s)
    one.turn_home()
    assert one.target() == GATE


def test_who_stays_out_keeps_no_time_for_the_way_home():
    assert worker(returns=False).home_s(9) == 0.0
    assert worker().home_s(9) == worker().seconds(9, GATE) > 0.0
