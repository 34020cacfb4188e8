"""Who is in a team, and how they work together."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import ObservationError, SettingError
from fieldmon.planning.members import TeamMember, Teamwork, must_differ, team_of


def test_a_team_of_none_or_a_start_on_another_day_is_refused():
    with pytest.raises(SettingError, match="1 member or more"):
        team_of(0)
    with pytest.raises(SettingError, match="must start within a day"):
        TeamMember("late", starts_s=1e6)


@pytest.mark.parametrize("name", ["", " "])
def test_a_member_without_a_name_is_refused(name):
    with pytest.raises(SettingError, match="must have a name, but this one has none"):
        TeamMember(name)


def test_a_gate_that_is_no_place_is_refused():
    with pytest.raises(ObservationError, match=r"The gate of Ann must be .* one is 500, 500"):
        TeamMember("Ann", gate=(500, 500))


def test_two_of_a_name_are_refused_whatever_its_capitals():
    must_differ(["a", "b"])
    with pytest.raises(SettingError, match="must have members of different names"):
        must_differ(["Ann", "ann"])


@pytest.mark.parametrize("name", ["contact_s", "least_gain"])
def test_teamwork_must_be_possible(name):
    rule = f"{name} must be (a number|0 or more|[0-9]+ at most)"
    for value in (-1.0, np.nan, np.inf):
        with pytest.raises(SettingError, match=rule):
            replace(Teamwork(), **{name: value})
