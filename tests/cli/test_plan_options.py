"""What a plan is told: when the work starts."""

from datetime import date, time

from fieldmon.cli.plan_options import PlanOptions


def test_work_starts_on_the_day_and_at_the_time_that_are_said():
    starts = PlanOptions(on="2026-11-18", start="07:30").starts()
    assert (starts.on, starts.at) == (date(2026, 11, 18), time(7, 30))
    assert PlanOptions().starts().at == time(6, 0)
