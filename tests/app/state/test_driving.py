"""A planned day, driven by a simulated robot while somebody watches."""

import pytest

from app.state import background_work
from app.state.driving import DayInTime, DriveRun
from fieldmon.drive.simulated_robots import MadeUp
from fieldmon.errors import FieldmonError
from fieldmon.planning.workday import plan_work
from fieldmon.samplers import sampler
from tests.app.chosen import a_plot, chosen


@pytest.fixture(scope="module")
def planned():
    choices = chosen(a_plot())
    return choices.plot, choices.plan()


def run_of(planned, kind="charged", share=1e-9, by="adaptive"):
    plot, plan = planned
    return DriveRun(kind, plot, plan.scene, sampler(by), MadeUp(share))


def test_where_nothing_is_found_the_day_is_the_planned_one(planned):
    # of a sampler that learns of finds only: Adaptive learns of what is clean too
    run = run_of(planned, by="dynamic")
    run.start()
    run.wait(180)
    assert run.problem is None
    work = plan_work(planned[1].scene, sampler("dynamic"))
    assert [one.plant for one in run.day.trace.stops] == work.plant.tolist()
    assert 0.9 < run.share <= 1.0
    assert run.day.believed[-1][0] == run.day.trace.stops[-1].done_s


def test_a_day_that_is_stopped_is_not_kept_and_can_begin_again(planned):
    run = run_of(planned, share=0.2)
    run.stop()
    run._work()
    assert run.day is None
    assert (run.problem, run.share, run.thrown_away) == (None, 0.0, True)
    run.start()
    run.wait(180)
    assert not run.thrown_away
    assert any(one.found for one in run.day.trace.stops)


def test_a_day_ends_for_good_once_no_tab_is_open_any_more(planned, monkeypatch):
    monkeypatch.setattr(background_work, "UNSEEN_S", 0.0)
    run = run_of(planned)
    run.watch("a tab", lambda: False)
    run.start()
    run.wait(180)
    assert run.day is None
    assert (run.problem, run.share) == (None, 0.0)


def test_a_problem_is_kept_to_be_said(planned):
    run = run_of(planned, kind="gazebo")
    run._work()
    assert "gazebo" in str(run.problem)


def test_a_file_of_something_else_is_refused(planned):
    plot, plan = planned
    for data in (b"\x89MCAPxxx", b"a,b\n1,2\n", b"\xff\xfe"):
        with pytest.raises(FieldmonError):
            DayInTime.of_file(data, plot, plan.scene)
