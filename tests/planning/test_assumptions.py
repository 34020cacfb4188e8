"""What a day's figures rest on though nobody said it."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.plot_request import PlantingChoices
from fieldmon.io.prepare import lay
from fieldmon.planning.assumptions import assumed_by, assumed_by_team
from fieldmon.planning.members import TeamMember, team_of
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot, scout
from tests.monitoring.seasons import a_plot


def names(assumed):
    return [one.setting for one in assumed]


def test_what_was_said_is_not_assumed():
    mine = Robot(speed_m_s=0.5, detection=0.7, row_change_s=12.0)
    assert assumed_by((), PriorSettings(background_chance=0.03), mine) == ()
    assert names(assumed_by((), PriorSettings(), mine)) == ["background_chance"]
    assert names(assumed_by((), PriorSettings(), scout())) == [
        "background_chance", "speed_m_s", "detects"
    ]  # fmt: skip


def test_times_of_simulated_drives_are_said_and_the_thesis_s_are_chosen():
    said = [str(one) for one in assumed_by((), PriorSettings(), Robot(detection=0.7))]
    assert "guessed: time added for a row change, as in simulated drives: 9 s" in said
    assert "guessed: time added for a stop, as in simulated drives: 1.13 s" in said
    thesis = Robot().with_times("thesis")
    assert names(assumed_by((), PriorSettings(), thesis)) == [
        "background_chance", "speed_m_s", "detects"
    ]  # fmt: skip


def test_where_no_rows_are_only_stops_add_time():
    trees = Plot.among("park", np.array([[34.9, 32.5], [34.9001, 32.5], [34.9, 32.5001]])).grid
    said = names(assumed_by((), PriorSettings(), Robot(), trees))
    assert "stop_s" in said
    assert "row_change_s" not in said


def test_a_plot_carries_what_was_assumed_of_its_rows():
    field = a_plot().field
    spacings, bearing = lay(field).plot.assumed[:2], lay(field).plot.assumed[2]
    assert spacings == (Assumed("row_spacing_m", 4.0), Assumed("plant_spacing_m", 3.0))
    assert (bearing.setting, bearing.value) == (
        "row_bearing_deg", pytest.approx(lay(field).plot.grid.frame.bearing_deg)
    )  # fmt: skip
    said = PlantingChoices(row_spacing_m=5.0, row_bearing_deg=0.0)
    assert names(lay(field, said).plot.assumed) == ["plant_spacing_m"]
    stated = replace(field, row_spacing_m=4.0, plant_spacing_m=3.0, row_bearing_deg=0.0)
    assert lay(stated).plot.assumed == ()
    plot = lay(field).plot
    missing = np.arange(len(plot.grid)) < 3
    assert plot.without(missing).assumed == plot.assumed


def test_of_a_team_it_is_said_of_whom_something_is_assumed():
    team = (TeamMember("Ann", scout()), TeamMember("R1", Robot(detection=0.9)))
    made = assumed_by_team((), PriorSettings(), team)
    assert [(one.setting, one.of) for one in made] == [
        ("background_chance", ""), ("speed_m_s", "Ann"), ("speed_m_s", "R1"),
        ("detects", "Ann"), ("row_change_s", "R1"), ("stop_s", "R1"),
    ]  # fmt: skip
    assert str(made[3]) == "guessed: chance to find what is there 69 % (Ann)"
    alike = assumed_by((), PriorSettings(), Robot())
    assert assumed_by_team((), PriorSettings(), team_of(2)) == alike
