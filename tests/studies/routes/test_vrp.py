"""PyVRP on a reward matrix: what it is told of ways, and the walk made of its visits."""

import sys
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.routes import vrp
from fieldmon.studies.routes.drive import Walker, driven

REWARD = np.array([[0.0, 2.0, 0.0, 3.0], [1.0, 0.0, 0.0, 4.0], [0.0, 5.0, 0.0, 0.0]])


def places_of(reward):
    row, column = np.nonzero(reward)
    return np.concatenate([[[0, 0]], np.stack([row, column + 1], axis=1)])


def shortest(one, other, n):
    """Return the steps between two places, by walking either way round."""
    counts = []
    for side in (0, n + 1):
        walker = Walker(n)
        walker.row, walker.column = one
        walker.places = [tuple(one)]
        if one[0] != other[0]:
            if walker.column != side:
                walker.along(side)
            walker.to_row(int(other[0]))
        if walker.column != other[1]:
            walker.along(int(other[1]))
        counts.append(len(walker.places) - 1)
    return min(counts)


def test_the_steps_it_is_told_are_those_that_are_walked():
    places = places_of(REWARD)
    steps = vrp._steps(places, REWARD.shape[1])
    wanted = [[shortest(one, other, REWARD.shape[1]) for other in places] for one in places]
    assert steps.tolist() == wanted


class Drive(list):
    """A route: a list of clients by the number of their place, or of stops that know themselves."""

    def visits(self):
        return [*super().__iter__()]

    def __iter__(self):
        for place in self.visits():
            yield SimpleNamespace(is_client=lambda: True, idx=place - 1)


class Solver:
    """Stands in for PyVRP's model: visits clients in an order that the test gives."""

    visits = ()

    def __init__(self):
        self.told, self.prizes = {}, []

    def add_location(self, *_):
        return object()

    def add_depot(self, place):
        return place

    def add_client(self, _, prize, *, required):
        assert not required
        self.prizes.append(prize)

    def add_vehicle_type(self, **limits):
        self.limits = limits

    def add_edge(self, one, other, distance):
        self.told[one, other] = distance

    def solve(self, *_, **__):
        assert sorted(range(len(self.prizes)), key=self.prizes.__getitem__) == sorted(
            range(len(self.prizes)), key=REWARD[REWARD > 0].__getitem__
        )
        best = SimpleNamespace(routes=lambda: [Drive(self.visits)] if self.visits else [])
        return SimpleNamespace(is_feasible=lambda: True, best=best)


@pytest.mark.parametrize("order", [(), (1, 2), (5, 4, 3, 2, 1), (2, 4)])
def test_its_visits_are_walked_in_order_and_back_home(monkeypatch, order):
    monkeypatch.setattr(Solver, "visits", order)
    stop = SimpleNamespace(MaxRuntime=float)
    monkeypatch.setitem(sys.modules, "pyvrp", SimpleNamespace(Model=Solver, stop=stop))
    monkeypatch.setitem(sys.modules, "pyvrp.stop", stop)
    walk = vrp.collect(REWARD, 100)
    places = places_of(REWARD)
    stops = [0, *order, 0]
    ways = vrp._steps(places, REWARD.shape[1])
    walked = driven(walk, REWARD)
    assert walked.steps == sum(ways[a, b] for a, b in pairwise(stops))
    assert walked.reward >= REWARD[tuple((places[list(order)] - [0, 1]).T)].sum()


def test_where_it_is_not_installed_that_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvrp", None)
    with pytest.raises(SettingError, match=r"pip install fieldmon\[bench\]"):
        vrp.collect(REWARD, 10)


def test_more_plants_than_it_can_be_told_of_are_refused(monkeypatch):
    stop = SimpleNamespace(MaxRuntime=float)
    monkeypatch.setitem(sys.modules, "pyvrp", SimpleNamespace(Model=Solver, stop=stop))
    monkeypatch.setitem(sys.modules, "pyvrp.stop", stop)
    with pytest.raises(SettingError, match=f"must have {vrp.MOST_PLANTS} plants"):
        vrp.collect(np.ones((1, vrp.MOST_PLANTS + 1)), 10)
