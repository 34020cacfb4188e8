"""Teams of several sizes on the same insects."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.planning.members import Teamwork
from fieldmon.plot.robot import Robot
from fieldmon.simulation.executor import here
from fieldmon.simulation.experiment import run
from fieldmon.simulation.team_season import Team
from fieldmon.studies.outcome_table import OutcomeTable
from fieldmon.studies.teams.seasons import (
    TeamOutcome,
    TeamScenario,
    TeamSetting,
    outcome,
    square_plot,
    study_of,
    unknown_chance,
)

PLOT = square_plot(0.2)
SCENARIO = TeamScenario(PLOT, unknown_chance(PLOT), Spread(0.3, "one"), Robot(hours=0.5), n_days=4)
SETTINGS = [TeamSetting(SCENARIO, "naive", Team(k)) for k in (1, 2)]


def test_a_square_plot_has_its_hectares():
    assert SCENARIO.hectares == pytest.approx(0.2, rel=0.15)
    assert square_plot(5.0).n_plants == pytest.approx(5 * 10_000 / 12, rel=0.02)
    assert unknown_chance(PLOT).max() > unknown_chance(PLOT).min() > 0
    for hectares in (0.0, -1.0, 1e6, float("nan")):
        with pytest.raises(SettingError, match="above 0 and up to 1000 ha"):
            square_plot(hectares)


def test_a_scenario_is_told_from_others_by_all_that_its_seasons_depend_on():
    chance = unknown_chance(PLOT)
    others = [
        TeamScenario(PLOT, chance, Spread(0.3, "one"), Robot(hours=0.6), n_days=4),
        TeamScenario(PLOT, chance, Spread(0.3, "one"), Robot(hours=0.5), n_days=5),
        TeamScenario(PLOT, chance, Spread(0.3, "each"), Robot(hours=0.5), n_days=4),
        TeamScenario(PLOT, chance * 0.5, Spread(0.3, "one"), Robot(hours=0.5), n_days=4),
    ]
    names = {SCENARIO.name, *(one.name for one in others)}
    assert len(names) == 5
    assert SCENARIO.name.startswith("0.2 ha spread 30% to one ")


def test_ways_to_work_have_names_of_their_own():
    ways = [
        Team(1), Team(2), Team(2, Teamwork(contact_s=600.0)), Team(2, Teamwork(together=False))
    ]  # fmt: skip
    names = [TeamSetting(SCENARIO, "adaptive", team).who for team in ways]
    assert names == [
        "adaptive", "adaptive, together, at once",
        "adaptive, together, contact every 10 min", "adaptive, sections",
    ]  # fmt: skip


def test_a_season_comes_to_what_is_noted_of_it():
    made = outcome(SETTINGS[1], 3)
    assert (made.robots, made.seed, made.spread) == (2, 3, 0.3)
    assert 0 < made.worked_h <= 2 * 0.5 * 4
    assert 1 <= made.d80 <= 5
    assert made.key == next(
        c.key for c in study_of(SETTINGS, range(3, 4)).chunks() if c.setting is SETTINGS[1]
    )


def test_a_study_that_was_killed_goes_on_and_comes_to_the_same(tmp_path):
    study = study_of(SETTINGS, range(1, 4))
    keys = [chunk.key for chunk in study.chunks()]
    # seed by seed, so that teams can be compared at any time
    assert [key[-1] for key in keys] == [1, 1, 2, 2, 3, 3]
    with OutcomeTable(tmp_path / "whole.csv", keys, TeamOutcome) as whole:
        run(study, here(), whole)

    def stop_early(done, _total):
        if done == 3:
            raise KeyboardInterrupt

    file = tmp_path / "stopped.csv"
    with pytest.raises(KeyboardInterrupt), OutcomeTable(file, keys, TeamOutcome) as half:
        run(study, here(), half, stop_early)
    assert 0 < len(file.read_text().splitlines()) - 1 < 6
    told = []
    with OutcomeTable(file, keys, TeamOutcome) as rest:
        run(study, here(), rest, lambda done, _total: told.append(done))
    assert told[0] >= 2
    assert file.read_text() == (tmp_path / "whole.csv").read_text()
    assert np.isfinite([one.infested_plant_days for one in rest.asked()]).all()
