"""What a change of a season's settings makes of days past, told beside the change."""

from dataclasses import replace

from fieldmon.infestation.insects.spread import Spread
from fieldmon.monitoring.estimates.told_anew import telling_anew
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from tests.monitoring.seasons import on, some_results


def test_only_what_days_past_follow_from_is_told_of_them(season):
    season.record(some_results(season, found=[0], day=2), "x")
    first, said = season.settings, []
    later = replace(first, robot=first.robot.with_hours(3.0))
    with telling_anew(season, first, later, said.append):
        season.change(later, first)
    assert said == []
    faster = replace(later, belief=BeliefSettings(Spread(rate_per_day=0.2)))
    with telling_anew(season, later, faster, said.append):
        season.change(faster, later)
    (one,) = said
    assert one.startswith(f"Days past are worked out anew, too: after {on(2)} ")
