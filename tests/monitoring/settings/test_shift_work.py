"""The work of a shift: whose it is, when it began, and how much of it is gone."""

import numpy as np
import pytest

from fieldmon.infestation.inspections import CLEAN, Inspections
from fieldmon.monitoring.estimates.history import History
from fieldmon.monitoring.settings.shift_work import Besides, Shift, made_by
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import GATE
from tests.monitoring.estimates.test_history import BEGINS, HISTORY, MORNING, PLOT, SHIFT

DAY_S = 86_400.0


def test_without_noted_times_the_work_took_what_driving_and_looking_cost():
    scene = HISTORY.scene(SHIFT, 2, MORNING)
    assert scene.at == 9
    gone_s = SHIFT.robot.day_s - scene.seconds_left
    assert gone_s > 2 * SHIFT.robot.visit_s
    later = HISTORY.scene(SHIFT, 2, MORNING, now_s=SHIFT.starts_s + 3600.0)
    assert later.seconds_left == SHIFT.robot.day_s - 3600.0
    assert HISTORY.scene(SHIFT, 2, MORNING, now_s=86_000.0).seconds_left == 0.0


def test_a_day_on_which_nothing_was_done_begins_at_the_gate_or_where_one_stayed():
    assert HISTORY.scene(SHIFT, 3, MORNING).at == GATE
    stays = Shift(PLOT.aisles, Robot(hours=2.0, returns=False))
    assert HISTORY.scene(stays, 3, MORNING).at == 9
    assert History(PLOT.grid, BEGINS, MORNING).scene(stays, 0, MORNING).at == GATE


def night_of(*looks):
    """Return the history of inspections at seconds since the first midnight, by whom each."""
    second = np.array([one for one, _ in looks])
    done = Inspections.of(
        np.arange(len(looks)), np.full(len(looks), CLEAN),
        np.datetime64(BEGINS) + (second // DAY_S).astype(int), second=second % DAY_S,
        who=np.array([name for _, name in looks], object),
    )  # fmt: skip
    return History(PLOT.grid, BEGINS, MORNING, done)


def test_work_past_midnight_is_of_the_day_on_which_it_began_and_each_has_their_own():
    from_22 = Shift(PLOT.aisles, Robot(hours=4.0), starts_s=79_200.0)
    history = night_of((80_000.0, "Ann"), (81_000.0, "bob"), (DAY_S + 1800.0, "ANN"))
    anns, besides = (history.work(from_22, who) for who in ("ann", Besides(("Bob",))))
    for work in (anns, besides):
        assert work.own(0).second.tolist() == [80_000.0, DAY_S + 1800.0]
        assert work.past_midnight(0).tolist() == [2]
        assert len(work.own(1)) == 0
        assert work.trail(1).tolist() == [0, 2]
        assert work.gone_s(0) == DAY_S + 1800.0 - work.begun_s(0)
        assert work.gone_s(0, 1800.0) == work.gone_s(0)
    by_day = history.work(SHIFT, "ann")
    assert (by_day.own(0).plant.tolist(), by_day.own(1).plant.tolist()) == ([0], [2])
    assert history.work(from_22, "ann") is anns
    assert made_by(history.inspections, None) is history.inspections


@pytest.mark.parametrize(("later_s", "begins_s"), [(299.0, 0.0), (1200.0, 1200.0)])
def test_work_begins_with_the_way_to_its_first_plant_if_that_was_minutes_off(later_s, begins_s):
    way_s = SHIFT.charged_s(np.array([0], np.int32), GATE)
    history = night_of((SHIFT.starts_s + way_s + later_s, "Ann"))
    assert history.work(SHIFT).begun_s(0) == pytest.approx(SHIFT.starts_s + begins_s)
