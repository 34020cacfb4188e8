"""What is known by a day of a simulated season."""

import numpy as np
import pytest

from app.show import field_map, simulated_day
from app.show.maps import deck
from app.state import cached_simulations
from fieldmon.simulation.worker import LaidPlot
from tests.app.chosen import a_plot, chosen
from tests.app.shown_plants import plants_in


@pytest.fixture(scope="module")
def played():
    plot = a_plot()
    choices = chosen(plot)
    chance = np.full(len(plot.grid), 0.1)
    days, _ = cached_simulations.simulated_season(
        "shown", "dynamic", (4, 0.2, 0.1, 1, 1), choices.robot, LaidPlot(plot, chance)
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
    bare = simulated_day.content(choices, days, 2, truth=False)
    ids = [layer.id for layer in bare.layers]
    assert "truth" not in ids
    assert {"boundary", "plants-state", "found", "route"} <= set(ids)
    told = simulated_day.content(choices, days, 2, truth=True)
    (truth,) = (layer for layer in told.layers if layer.id == "truth")
    assert len(truth.data) == days[2].left
    assert len(told.legend) == len(bare.legend) + 1


def test_the_map_shows_what_is_known_after_the_day_and_the_route_of_it(played):
    choices, days = played
    content = simulated_day.content(choices, days, 1, truth=False)
    layers = {layer.id: layer for layer in content.layers}
    shown = plants_in(layers["plants-state"])
    assert shown.rank.tolist() == (simulated_day.states(days, 1) + 1).tolist()
    stops = [one for one in content.labels if one["k"] == "stop"]
    assert len(stops) == len(days[1].work)
    assert content.bounds == deck.of_grid(choices.plot.grid)
    assert content.place == field_map.of_plot(choices)["place"], "the view stays"
