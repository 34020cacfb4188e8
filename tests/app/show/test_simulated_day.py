"""What is known by a day of a simulated season."""

import numpy as np
import pytest

from app.show import simulated_day
from app.state import cached
from tests.app.chosen import a_plot, chosen


@pytest.fixture(scope="module")
def played():
    plot = a_plot()
    choices = chosen(plot)
    chance = np.full(len(plot.grid), 0.1)
    days, _ = cached.simulated_season(
        "shown", "dynamic", (4, 0.2, 0.1, 1), choices.robot, plot, chance
    )
    return choices, days


def test_states_are_what_the_days_so_far_found(played):
    _, days = played
    for number in range(len(days)):
        state = simulated_day.states(days, number)
        inspected = np.unique(np.concatenate([d.work.plant for d in days[: number + 1]]))
        found = np.unique(np.concatenate([d.work.plant[d.work.found] for d in days[: number + 1]]))
        assert np.flatnonzero(state >= 0).tolist() == inspected.tolist()
        assert np.flatnonzero(state == 1).tolist() == found.tolist()


def test_the_truth_is_shown_only_when_asked_for_and_without_what_was_found_that_day(played):
    choices, days = played
    ids = [layer.id for layer in simulated_day.layers(choices, days, 2, truth=False)]
    assert "truth" not in ids
    assert {"plants", "found", "route"} <= set(ids)
    layers = simulated_day.layers(choices, days, 2, truth=True)
    (truth,) = (layer for layer in layers if layer.id == "truth")
    assert len(truth.data) == days[2].left
