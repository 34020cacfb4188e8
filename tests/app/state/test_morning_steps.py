"""The steps of a morning: which are done, and that one at most comes next."""

from datetime import timedelta

import numpy as np
import pytest

from app.state import chosen_day, morning_steps
from fieldmon.infestation.inspections import SKIPPED, Inspections
from fieldmon.monitoring.phones import scouts
from tests.app.chosen import DAY, a_plot, chosen, in_season
from tests.monitoring.seasons import BEGINS, Insects, a_season, all_on


@pytest.fixture
def kept(tmp_path):
    """Return a season that has just begun."""
    return a_season(tmp_path / "s.gpkg")


def steps_of(choices):
    steps = morning_steps.steps(choices, choices.plan())
    assert sum(step.next for step in steps) <= 1
    return {step.name: step for step in steps}


def next_of(choices):
    return next((name for name, step in steps_of(choices).items() if step.next), None)


@pytest.mark.usefixtures("session")
def test_without_a_season_it_comes_first_to_begin_one():
    choices = chosen(a_plot())
    assert next_of(choices) == morning_steps.BEGIN
    assert set(steps_of(choices)) == {morning_steps.BEGIN, morning_steps.SEND, morning_steps.REPORT}
    assert choices.on == DAY


@pytest.mark.usefixtures("session")
def test_a_day_goes_from_the_plan_to_the_phone_to_the_records_to_the_report(kept):
    choices = in_season(kept, BEGINS)
    assert morning_steps.LOOK_BACK not in steps_of(choices), "nothing was before the first day"
    assert next_of(choices) == morning_steps.PLAN
    kept.plan(BEGINS)
    assert next_of(in_season(kept, BEGINS)) == morning_steps.SEND
    morning_steps.note(choices, morning_steps.SEND)
    assert next_of(in_season(kept, BEGINS)) == morning_steps.RECORD


@pytest.mark.usefixtures("session")
def test_a_day_that_was_recorded_without_being_sent_was_not_taken_along(kept):
    kept.record(Insects(kept).look(0, kept.plan(BEGINS).route.plant[:3]), "typed in")
    choices = in_season(kept, BEGINS)
    assert steps_of(choices)[morning_steps.SEND].done
    assert steps_of(choices)[morning_steps.SEND].nothing
    scouts.let_in(kept, "Dana")
    assert not steps_of(choices)[morning_steps.SEND].nothing


@pytest.mark.usefixtures("session")
def test_a_day_that_is_over_asks_for_its_report_then_for_the_next_day(kept):
    plants = kept.plan(BEGINS).route.plant
    kept.record(Insects(kept).look(0, plants), "all of it")
    choices = in_season(kept, BEGINS)
    if len(choices.plan().route):
        pytest.fail("the day must be over when its whole route is recorded")
    assert next_of(choices) == morning_steps.REPORT
    morning_steps.note(choices, morning_steps.REPORT)
    assert next_of(choices) == morning_steps.NEXT_DAY


@pytest.mark.usefixtures("session")
def test_a_plan_that_was_kept_but_not_recorded_comes_first_on_the_day_after(kept, monkeypatch):
    all_on(monkeypatch, 0)
    kept.plan(BEGINS)
    all_on(monkeypatch, 9)
    after = in_season(kept, BEGINS + timedelta(days=1))
    assert morning_steps.left_unsaid(after) == BEGINS
    assert next_of(after) == morning_steps.LOOK_BACK
    later = in_season(kept, BEGINS + timedelta(days=9))
    assert morning_steps.left_unsaid(later) == BEGINS, "it is asked for until it is recorded"
    assert morning_steps.left_unsaid(in_season(kept, BEGINS)) is None, "that day is not over"
    kept.record(Insects(kept).look(0, kept.kept_route(BEGINS)[:3]), "three of it")
    after = in_season(kept, BEGINS + timedelta(days=1))
    assert steps_of(after)[morning_steps.LOOK_BACK].done
    assert morning_steps.last_visit(after) == BEGINS


@pytest.mark.usefixtures("session")
def test_a_planned_day_is_asked_for_until_a_later_one_or_that_nobody_went_is_recorded(
    kept, monkeypatch
):
    for day in (0, 3):
        all_on(monkeypatch, day)
        kept.plan(BEGINS + timedelta(days=day))
    all_on(monkeypatch, 9)
    on = BEGINS + timedelta(days=9)
    assert morning_steps.left_unsaid(in_season(kept, on)) == BEGINS + timedelta(days=3)
    closed = Inspections.of(np.array([5]), np.array([SKIPPED]), np.datetime64(BEGINS) + 3)
    kept.record(closed, "nobody went")
    assert morning_steps.left_unsaid(in_season(kept, on)) is None
    assert morning_steps.last_visit(in_season(kept, on)) is None
    assert chosen_day.planned_only(in_season(kept, on), on) == (BEGINS,), "it is told all the same"
