"""All ways of going on up a ladder: what they put together is one piece with even ends."""

from itertools import product

import numpy as np
import pytest

from fieldmon.planning.routes import frontier
from fieldmon.planning.routes.frontier import GATE_CLOSED, GATE_OPEN, WAYS, tables


def drawn(returns, gate, n):
    """Yield all that the tables can put together over n elements: ways and passes of each."""
    made = tables(returns=returns)

    def onward(k, state):
        if k == n:
            if state == 1:
                yield ()
            return
        for before, way, after in made.gate if k == gate else made.aisle:
            if before == state and not (after == 1 and k < gate):
                for rest in onward(k + 1, after):
                    yield ((int(way), tuple(int(p) for p in made.passes[after])), *rest)

    return onward(0, 0)


def nodes_and_edges(drive, returns, gate):
    """Return degrees of the row ends, and whether all that is driven is in one piece."""
    n = len(drive)
    degree = np.zeros((n, 2), int)
    link = {end: end for end in product(range(n), range(2))} | {"gate": "gate"}

    def find(a):
        while link[a] != a:
            a = link[a]
        return a

    ended = 0
    for k, (way, passes) in enumerate(drive):
        if k == gate:
            stubs = (GATE_CLOSED if returns else GATE_OPEN)[way]
            degree[k] += stubs
            for side in range(2):
                if stubs[side]:
                    link[find((k, side))] = find("gate")
        else:
            left, right, meets, ends = WAYS[way]
            degree[k] += left, right
            ended += ends
            if meets:
                link[find((k, 0))] = find((k, 1))
        for side in range(2):
            degree[k, side] += passes[side]
            if passes[side]:
                degree[k + 1, side] += passes[side]
                link[find((k, side))] = find((k + 1, side))
    driven = {find(tuple(end)) for end in np.argwhere(degree > 0).tolist()}
    return degree, driven == {find("gate")}, ended


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize("gate", [0, 1, 2])
def test_whatever_is_put_together_can_be_driven_from_the_gate(returns, gate):
    count = 0
    for drive in drawn(returns, gate, 3):
        degree, one_piece, ended = nodes_and_edges(drive, returns, gate)
        odd = int((degree % 2).sum())
        assert one_piece
        assert odd + ended == (0 if returns else 1)
        count += 1
    assert count > 50


@pytest.mark.parametrize(("ways", "odd"), [(GATE_CLOSED, 0), (GATE_OPEN, 1)])
def test_the_gate_is_passed_in_all_ways_of_at_most_two_passes_a_side(ways, odd):
    """Who comes back passes it an even number of times, who does not an odd one."""
    every = {pair for pair in product(range(3), repeat=2) if sum(pair) and sum(pair) % 2 == odd}
    assert sorted(ways) == sorted(every)


def test_states_between_aisles_are_the_five_of_ratliff_and_rosenthal():
    passes = tables(returns=True).passes
    used = {int(k) for k in tables(returns=True).aisle[:, 2]} - {0, 1}
    start = {int(after) for before, _, after in tables(returns=True).gate if before == 0}
    reached = set(start)
    while True:
        more = {int(a) for b, _, a in tables(returns=True).aisle if int(b) in reached} | reached
        if more == reached:
            break
        reached = more
    reached &= used
    assert sorted(passes[list(reached)].tolist()) == [[0, 2], [1, 1], [2, 0], [2, 2], [2, 2]]


def test_at_the_gate_stubs_are_driven_an_even_number_of_times_or_an_odd_one_on_one_way_days():
    every = {(left, right) for left, right in product(range(3), repeat=2) if left + right}
    assert {*GATE_CLOSED} == {each for each in every if sum(each) % 2 == 0}
    assert {*GATE_OPEN} == {each for each in every if sum(each) % 2 == 1}
    assert len(GATE_CLOSED) == len(GATE_OPEN) == 4


def test_in_an_aisle_an_odd_number_of_passes_meets_its_ends_where_the_day_ends_there():
    for way in WAYS:
        assert (way.left + way.right) % 2 == way.ends
        assert max(way.left, way.right) <= 2
        # what is driven through is driven by both ends, and from neither on is nothing
        assert not way.meets or min(way.left, way.right) > 0
    assert len({*WAYS}) == len(WAYS)


def can_be_driven(drive, returns, gate):
    """Tell whether passes between three elements are one piece that one can drive and end.

    And whether nobody goes on to a place at which nothing is, only to come back.
    """
    for k, (way, passes) in enumerate(drive):
        here = (GATE_CLOSED if returns else GATE_OPEN)[way] if k == gate else WAYS[way][:2]
        below = drive[k - 1][1] if k else (0, 0)
        if any(on and not (come + own) for on, come, own in zip(passes, below, here, strict=True)):
            return False
    degree, one_piece, ended = nodes_and_edges(drive, returns, gate)
    return one_piece and int((degree % 2).sum()) + ended == (0 if returns else 1)


@pytest.mark.parametrize("returns", [True, False])
@pytest.mark.parametrize(("n", "gate"), [(1, 0), (2, 0), (2, 1), (3, 1)])
def test_all_that_can_be_driven_is_put_together_in_one_way(returns, n, gate):
    # of three elements the last is driven in some ways only
    some = range(12) if n < 3 else (0, 1, 4, 6, 10)
    elements = [range(4) if k == gate else some if k else range(12) for k in range(n)]
    every = set()
    for ways in product(*elements):
        if returns and any(WAYS[w].ends for k, w in enumerate(ways) if k != gate):
            continue
        for passes in product(product(range(3), repeat=2), repeat=n - 1):
            drive = tuple(zip(ways, (*passes, (0, 0)), strict=True))
            if can_be_driven(drive, returns, gate):
                every.add(drive)
    made = [one for one in drawn(returns, gate, n)
            if all(way in of for (way, _), of in zip(one, elements, strict=True))]  # fmt: skip
    assert len(made) == len(set(made))
    assert set(made) == every


#: an aisle from its left end L by places a and b to its right end R; what is driven in it
DRIVEN = {
    "NOTHING": (), "FROM_LEFT": ("LaL",), "FROM_RIGHT": ("RbR",), "FROM_BOTH": ("LaL", "RbR"),
    "ONCE": ("LabR",), "TWICE": ("LabR", "RbaL"), "END_LEFT": ("La",), "END_RIGHT": ("Rb",),
    "END_LEFT_AND": ("La", "RbR"), "END_RIGHT_AND": ("Rb", "LaL"),
    "LEFT_BACK": ("LabR", "Rb"), "RIGHT_BACK": ("RbaL", "La"),
}  # fmt: skip


def test_each_way_passes_an_aisle_s_ends_as_often_as_it_is_driven_in_and_out():
    assert len(DRIVEN) == len(WAYS) == frontier.N_WAYS
    assert sorted(int(getattr(frontier, name)) for name in DRIVEN) == list(range(len(WAYS)))
    for name, driven in DRIVEN.items():
        at_ends = [sum(one.count(end) for one in driven) for end in "LR"]
        meets = any({"L", "R"} <= {*one} for one in driven)
        ends = any(one[-1] in "ab" for one in driven)
        assert WAYS[int(getattr(frontier, name))] == (*at_ends, meets, ends), name
