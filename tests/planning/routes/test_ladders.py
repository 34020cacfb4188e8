"""A ladder below a plot: no way on it is longer than the true one."""

import gc
from types import SimpleNamespace
from weakref import ref

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from shapely import MultiPolygon, Polygon

from fieldmon.planning.routes import ladders
from fieldmon.planning.routes.ladders import (
    Ladders,
    _from_left_to_right,
    _hanging,
    _take_crossing,
)
from fieldmon.plot.field import Field
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.projection import Frame
from fieldmon.plot.travel import GATE, Aisles
from tests.cut_lanes import cut_plot
from tests.planning.routes.test_best_route import crooked_aisles
from tests.planning.routes.tiny import ladder_below

# weights of 0 would count as no way at all
_LEAST = 1e-12


def on_the_ladder(ladder):
    """Return metres ``(n + 1, n + 1)`` on the ladder between all plants and, last, the gate."""
    e, n = len(ladder.across_m), len(ladder.plant)
    links = [(2 * k + s, 2 * k + 2 + s, ladder.up_m[k, s]) for k in range(e - 1) for s in range(2)]
    gate = 2 * e + n
    for k in range(e):
        if k == ladder.gate:
            links += [(gate, 2 * k + s, ladder.stub_m[s]) for s in range(2)]
            continue
        # both ends of an aisle that hangs are one place
        first, last = ((2 * k, 2 * k + 1), (2 * k, 2 * k), (2 * k + 1, 2 * k + 1))[ladder.hangs[k]]
        at, before = 0.0, first
        for i in range(ladder.start[k], ladder.start[k + 1]):
            links.append((before, 2 * e + ladder.plant[i], ladder.in_m[i] - at))
            at, before = ladder.in_m[i], 2 * e + ladder.plant[i]
        links.append((before, last, ladder.across_m[k] - at))
    a, b, metres = (np.array(column) for column in zip(*links, strict=True))
    assert (metres >= 0.0).all()
    net = coo_array((np.maximum(metres, _LEAST), (a, b)), shape=(gate + 1, gate + 1)).tocsr()
    places = np.arange(2 * e, gate + 1)
    return dijkstra(net, directed=False, indices=places)[:, places]


def truly(aisles):
    places = np.append(np.arange(len(aisles.grid)), GATE)
    return aisles.distance_m(places[:, None], places)


@given(crooked_aisles(max_radius_m=60.0, max_plants=400), st.booleans())
def test_no_way_on_the_ladder_is_longer_than_the_true_one(aisles, hanging):
    ladder = Ladders(aisles).whole(hanging=hanging)
    assert (on_the_ladder(ladder) <= truly(aisles) + 1e-5).all()


@pytest.mark.parametrize("corners", [
    [(13.4, 6.9), (-4.4, -7.1), (-12.9, 3.5), (-9.7, 4.0), (-9.3, 2.2), (-7.4, 3.5), (-8.8, 3.8)],
    [(13.6, 7.2), (-5.5, -6.6), (-12.8, 3.8), (-9.2, 4.4), (-9.3, 2.3), (-7.3, 2.8), (-8.9, 4.0)],
    [(13.2, 7.1), (-4.0, -6.7), (-13.3, 3.1), (-9.2, 3.7), (-9.2, 1.3), (-6.8, 3.2), (-8.2, 3.8)],
])  # fmt: skip
def test_nobody_crosses_by_an_aisle_that_hangs_on_the_left(corners):
    """Else ways would be two metres too long; one of 170 crooked plots shows it."""
    ground = MultiPolygon([Polygon(corners)])
    field = Field("bitten", Frame(0.0, 0.0, 90.0).geometry_lonlat(ground))
    aisles = Aisles.of(lay(field, Planting(row_spacing_m=1.5, plant_spacing_m=1.0, headland_m=1.0)))
    ladder = Ladders(aisles).whole(hanging=True)
    assert (ladder.hangs == 1).any()
    assert (on_the_ladder(ladder) <= truly(aisles) + 1e-5).all()


@pytest.mark.parametrize("hanging", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_no_way_is_longer_where_lanes_are_cut(seed, hanging):
    aisles, _, _ = cut_plot(seed, n_rows=4, n_plants=10, faces=1 + seed % 2)
    assert aisles.grid.cut_ends.any()
    there = np.append(~aisles.too_narrow, [True])
    longer = on_the_ladder(Ladders(aisles).whole(hanging=hanging)) > truly(aisles) + 1e-5
    assert not longer[np.ix_(there, there)].any()


@pytest.mark.parametrize("hangs", [[0, 0, 0, 0, 0], [1, 0, 2, 0, 1], [2, 2, 0, 1, 0]])
def test_both_ends_of_an_aisle_that_hangs_are_one_place_and_the_other_headland_has_none(hangs):
    n, ends = len(hangs), {0: ((0,), (1,)), 1: ((0, 1), ()), 2: ((), (0, 1))}
    apart_m = np.random.default_rng(1).uniform(1.0, 50.0, (2, 2, n, n))
    found = ladders._lines(apart_m, np.array(hangs))
    for a, b, side, other in np.ndindex(n, n, 2, 2):
        ways = [apart_m[s, t, a, b] for s in ends[hangs[a]][side] for t in ends[hangs[b]][other]]
        assert found[side, other, a, b] == min(ways, default=np.inf)


@pytest.mark.parametrize("at_m", [0.0, -500.0, 700.0])
@pytest.mark.parametrize(
    ("rungs", "expected"),
    [
        # alone at their heights
        ([(0, 50, 0), (10, 40, 3), (0, 5, 6)], [0, 0, 0]),
        # of two beside each other one much shorter hangs, on the side where it lies
        ([(0, 50, 0), (60, 74, 0)], [0, 2]),
        ([(0, 14, 0), (30, 80, 0)], [1, 0]),
        ([(0, 16, 0), (30, 80, 0)], [0, 2]),
        # the main one goes on from below, though another is longer by less than three times
        ([(0, 50, 0), (0, 30, 3), (40, 90, 3)], [0, 0, 2]),
        ([(0, 50, 0), (0, 10, 3), (40, 90, 3)], [0, 1, 0]),
        # a third hangs on the main one, not on the longest
        ([(0, 50, 0), (0, 40, 3), (50, 60, 3), (70, 75, 3)], [0, 0, 2, 2]),
        ([(40, 90, 0), (0, 10, 3), (20, 30, 3), (40, 90, 3)], [0, 1, 1, 0]),
        # where the main one ends below, the longest is the next
        ([(70, 80, 3), (0, 60, 3), (90, 100, 3), (200, 250, 0)], [2, 0, 2, 0]),
        # nearly at one height is beside, farther up is not
        ([(0, 50, 0), (60, 80, 0.5), (60, 80, 1.2)], [0, 2, 0]),
    ],
)  # fmt: skip
def test_beside_the_main_aisle_of_a_height_the_others_hang_on_the_headland_where_they_lie(
    rungs, expected, at_m
):
    low, high, up = np.array(rungs, np.float64).T
    place = ladders.Rungs(low + at_m, high + at_m, up, np.empty(0), np.zeros(len(up), np.int64))
    for order in (np.arange(len(up)), np.arange(len(up))[::-1]):
        members = order if (np.diff(np.sort(up)) > 0).all() else np.arange(len(up))
        found = _hanging(place, members, 1.0)
        assert found.tolist() == [expected[k] for k in members]


@given(crooked_aisles(max_radius_m=60.0, max_plants=400))
def test_where_no_cross_links_are_found_each_element_may_be_crossed_and_none_is_too_long(aisles):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ladders, "_ROUNDS", 0)
        ladder = ladder_below(aisles)
    assert (on_the_ladder(ladder) <= truly(aisles) + 1e-5).all()


@pytest.mark.parametrize("faces", [1, 2])
def test_a_plain_plot_is_a_ladder_itself(faces):
    aisles = Aisles.of(rectangle(7, 9, Planting(faces=faces)))
    ladder = ladder_below(aisles)
    assert ladder.cross_links == 0
    assert on_the_ladder(ladder) == pytest.approx(truly(aisles), abs=1e-4)


@given(crooked_aisles(max_radius_m=40.0), st.data())
def test_every_plant_is_in_one_aisle_in_order(aisles, data):
    ladder = ladder_below(aisles)
    assert sorted(ladder.plant.tolist()) == list(range(len(aisles.grid)))
    k = data.draw(st.integers(0, len(ladder.across_m) - 1))
    part = slice(ladder.start[k], ladder.start[k + 1])
    assert (np.diff(ladder.in_m[part]) >= 0).all()
    assert len(set(aisles.grid.corridor[aisles.grid.row[ladder.plant[part]]])) <= 1


def test_one_more_crossing_is_to_the_last_bit_what_all_of_them_give():
    rng, n = np.random.default_rng(8), 14
    left, right = np.sort(rng.uniform(0.0, 300.0, (2, n)))
    cross, asked = np.where(rng.random(n) < 0.5, np.inf, 90.0), rng.uniform(0.0, 200.0, (n, n))
    cross[0] = 77.0
    over = _from_left_to_right(left, right, cross) - asked
    for k in rng.permutation(n):
        cross[k] = rng.uniform(0.0, 60.0)
        to = np.abs(left - left[k]) + cross[k]
        worst = _take_crossing(over, to, right, int(k), asked)
        assert (over == _from_left_to_right(left, right, cross) - asked).all()
        assert worst == np.argmax(over)


def test_ladders_are_made_once_for_a_plot_and_gone_with_it():
    aisles = Aisles.of(rectangle(5, 8, Planting(faces=2)))
    made = Ladders(aisles).whole(hanging=True)
    assert Ladders(aisles).whole(hanging=True) is made
    other = Aisles.of(rectangle(6, 8, Planting(faces=2)))
    assert len(Ladders(other).whole(hanging=True).across_m) > len(made.across_m)
    gone = ref(aisles)
    del aisles
    gc.collect(1)  # what came to be a moment ago
    assert gone() is None


def test_the_ends_of_some_aisles_and_a_gate_of_their_own_are_as_far_apart_as_told():
    rungs = Ladders(Aisles.of(rectangle(5, 4))).rungs
    members, to_gate_m = np.array([3, 0, 4]), np.arange(6.0).reshape(2, 3) + 1.0
    apart_m = ladders._apart(rungs, members, to_gate_m)
    assert apart_m.shape == (2, 2, 4, 4)
    for side, other, a, b in np.ndindex(2, 2, 3, 3):
        told_m = rungs.apart_m[side, other, members[a], members[b]]
        assert apart_m[side, other, a, b] == told_m
    for side, other, a in np.ndindex(2, 2, 3):
        # the gate is one place, whichever of its ends is asked for
        assert apart_m[side, other, a, 3] == to_gate_m[side, a]
        assert apart_m[other, side, 3, a] == to_gate_m[side, a]
    assert np.isinf(apart_m[:, :, 3, 3]).all()


@pytest.mark.parametrize("seed", range(5))
def test_places_are_as_far_up_as_no_two_are_further_apart_than_they_truly_are(seed):
    rng, n = np.random.default_rng(seed), 7
    apart_m = rng.uniform(1.0, 60.0, (n, n)) + 20.0 * np.abs(np.subtract.outer(range(n), range(n)))
    if seed == 4:  # of one place, and of the first, nothing is known
        apart_m[3], apart_m[:, 3] = np.inf, np.inf
        apart_m[0], apart_m[:, 0] = np.inf, np.inf
    hull = ladders._hull(apart_m)
    for a, b in np.ndindex(n, n):
        if a < b:
            told = [apart_m[i, j] for i in range(a + 1) for j in range(b, n)]
            assert hull[a, b] == min(told)
    place = ladders._places(apart_m)
    assert place[0] == 0.0
    assert (np.diff(place) >= 0.0).all()
    for k in range(1, n):
        ahead = [place[j] + hull[j, k] for j in range(k)]
        expected = min(ahead) if np.isfinite(min(ahead)) else place[k - 1]
        assert place[k] == pytest.approx(expected, rel=2e-9)
        for j in range(k):
            assert place[k] - place[j] <= apart_m[j, k]


def crossed(left, right, cross):
    """Return the metres from left to right nodes by the best crossing, each one tried."""
    return np.array([[min(abs(a - left[k]) + cross[k] + abs(right[k] - b)
                          for k in range(len(left))) for b in right] for a in left])  # fmt: skip


@pytest.mark.parametrize("seed", range(8))
def test_cross_links_are_no_more_and_no_shorter_than_true_ways_ask_for(seed):
    rng, n, gate = np.random.default_rng(seed), 9, 4
    left, right = np.sort(rng.uniform(0.0, 60.0, (2, n)))
    across_m = rng.uniform(60.0, 120.0, n)
    across_m[gate], across_m[7] = 1.0, np.inf
    by_aisles = np.where(np.arange(n) == gate, np.inf, across_m)
    assert _from_left_to_right(left, right, by_aisles) == pytest.approx(
        crossed(left, right, by_aisles)
    )
    # true ways: as by the aisles, some longer, and some shorter by holes in the rows
    apart_m = crossed(left, right, by_aisles) + rng.uniform(0.0, 9.0, (n, n))
    assert ladders._cross_links((left, right), apart_m, across_m, gate) == []
    shorter = [(0, 8), (2, 6), (gate, 1), (8, gate), (5, 5)]
    for a, b in shorter:
        apart_m[a, b] = np.abs(np.subtract.outer(left, right)).max() + 20.0 + a
    links = ladders._cross_links((left, right), apart_m, across_m, gate)
    cross = by_aisles.copy()
    for k, metres in links:
        assert metres < by_aisles[k]
        cross[k] = metres
    numbers = [k for k, _ in links]
    assert gate not in numbers
    assert numbers == sorted(set(numbers))
    asked = [(a, b) for a, b in np.ndindex(n, n) if a != b and gate not in (a, b)]
    ways = crossed(left, right, cross)
    assert all(ways[a, b] <= apart_m[a, b] + 1e-6 for a, b in asked)
    # each is as long as it may be for some true way by it
    for k, metres in links:
        by_it = np.abs(left[:, None] - left[k]) + metres + np.abs(right[k] - right)
        assert any(by_it[a, b] == pytest.approx(apart_m[a, b]) for a, b in asked)
    # where ends lie nearer to each other than their places differ, there is none
    apart_m[0, 8] = 0.5 * min(abs(left[0] - left[k]) + abs(right[k] - right[8])
                              for k in range(n) if k != gate)  # fmt: skip
    assert (ladders._cross_links((left, right), apart_m, across_m, gate) is None) == (
        apart_m[0, 8] > 0.0
    )


def test_the_gate_is_as_far_from_its_node_as_its_nearest_way_allows():
    place = np.array([0.0, 10.0, 25.0, 40.0])
    for gate, to_m, expected in (
        (1, [30.0, 5.0, 35.0, 70.0], 20.0), (1, [12.0, 5.0, 35.0, 70.0], 2.0),
        (0, [1.0, 40.0, 26.0, 90.0], 1.0), (3, [60.0, 38.0, 22.0, 0.0], 7.0),
        (2, [24.0, 38.0, 0.0, 90.0], 0.0), (2, [np.inf] * 4, 0.0),
    ):  # fmt: skip
        apart_m = np.full((4, 4), np.nan)
        apart_m[gate] = to_m
        stub_m = ladders._stub(place, apart_m, gate)
        assert stub_m == pytest.approx(expected)
        assert stub_m <= expected


@pytest.mark.parametrize("cross", [None, [(1, 33.0), (3, 44.0)]])
def test_aisles_links_and_the_gate_are_put_together_in_order_with_their_plants(cross):
    aisles = Aisles.of(rectangle(4, 6, Planting(faces=2)))
    rungs, links = ladders.rungs_of(aisles), cross or []
    n = len(rungs.low)
    # the gate is the third; one aisle is left out
    placed = np.insert(np.arange(n - 1)[::-1], 2, -1)
    hangs = np.arange(n) % 3
    left, right = np.arange(n) * 4.0, np.arange(n) * 5.0
    across_m = np.where(placed >= 0, 100.0 + placed, np.inf)
    ladder = ladders._assembled(
        aisles.travel,
        rungs,
        (placed, hangs),
        (left, right),
        (links, across_m, np.array([2.0, 3.0])),
    )
    # a link stands right behind its aisle, in the same place
    expected = []
    for k in range(n):
        expected.append((left[k], right[k], across_m[k], hangs[k], placed[k]))
        expected += [(left[k], right[k], metres, 0, -1) for j, metres in links if j == k]
    lefts, rights, across, hanging, rung = (np.array(c) for c in zip(*expected, strict=True))
    assert ladder.up_m.tolist() == np.stack([np.diff(lefts), np.diff(rights)], axis=1).tolist()
    assert ladder.across_m.tolist() == across.tolist()
    assert ladder.hangs.tolist() == hanging.tolist()
    assert ladder.rung.tolist() == rung.tolist()
    assert ladder.cross_links == len(links)
    assert ladder.gate == 2 + sum(k < 2 for k, _ in links)
    assert ladder.stub_m.tolist() == [2.0, 3.0]
    grid = aisles.grid
    for k, aisle in enumerate(rung):
        own = ladder.plant[ladder.start[k] : ladder.start[k + 1]]
        here = np.flatnonzero(grid.corridor[grid.row] == aisle) if aisle >= 0 else []
        assert sorted(own.tolist()) == list(here)
    low = rungs.low[grid.corridor[grid.row]]
    assert ladder.in_m == pytest.approx((aisles.travel.x_m - low)[ladder.plant])
    assert (ladder.upper == (aisles.travel.side[grid.row] > 0)[ladder.plant]).all()
    assert len(ladder.plant) == ladder.start[-1]


def bitten():
    """Return a plot with both faces of its rows, bitten on either side: lanes end short."""
    ground = MultiPolygon([Polygon([
        (-20, -15), (21, -15), (14, -9), (22, -2), (15, 6), (20, 15), (-21, 15), (-13, 5),
        (-19, 1), (-12, -6),
    ])])  # fmt: skip
    field = Field("bitten", Frame(0.0, 0.0, 90.0).geometry_lonlat(ground))
    return Aisles.of(lay(field, Planting(row_spacing_m=2.5, plant_spacing_m=2.0, headland_m=1.0,
                                         faces=2)))  # fmt: skip


def test_ends_of_aisles_are_as_far_apart_as_the_nearest_of_their_lanes_and_what_these_end_short():
    travel = bitten().travel
    n_aisles, n_rows = int(travel.corridor.max()) + 1, len(travel.end_x_m)
    short = -np.random.default_rng(2).uniform(0.0, 3.0, (2, n_rows))
    found = ladders._between_aisles(travel, short)
    rows = [np.flatnonzero(travel.corridor == k) for k in range(n_aisles)]
    assert any(len(own) > 1 for own in rows)
    for a, b, i, j in np.ndindex(2, 2, n_aisles + 1, n_aisles + 1):
        ends = [[(2 * r + end, short[end, r]) for r in rows[k]] if k < n_aisles
                else [(2 * n_rows, 0.0)] for end, k in ((a, i), (b, j))]  # fmt: skip
        ways = [travel.between_m[p, q] + s + t for p, s in ends[0] for q, t in ends[1]]
        expected = np.inf if i == j < n_aisles else min(ways)
        assert found[a, b, i, j] == pytest.approx(expected)


def test_a_rung_is_as_long_as_its_longest_lane_and_no_ends_are_nearer_than_nothing():
    aisles = bitten()
    travel, rungs = aisles.travel, ladders.rungs_of(aisles)
    assert (rungs.low <= rungs.high).all()
    assert (rungs.apart_m >= 0.0).all()
    assert (rungs.part == 0).all()
    longest = 0
    for k in range(len(rungs.low)):
        rows = np.flatnonzero(travel.corridor == k)
        assert rungs.up[k] == aisles.grid.lane_y_m[rows[0]]
        first, last = travel.end_x_m[rows, 0], travel.end_x_m[rows, 1]
        # as long as the longest, or where ends would be too near as the innermost
        assert rungs.low[k] in (*first[[first.argmin(), first.argmax()]], rungs.high[k])
        assert rungs.high[k] in (*last[[last.argmin(), last.argmax()]], rungs.low[k])
        longest += rungs.low[k] == first.min() and rungs.high[k] == last.max()
    assert longest > 0


@pytest.mark.parametrize("lanes", [[(0.0, 10.0), (30.0, 50.0)], [(30.0, 50.0), (0.0, 10.0)]])
def test_an_aisle_of_lanes_without_a_metre_in_common_is_one_place_midway_between_them(
    monkeypatch, lanes
):
    """Where its ends would be nearer to another's than nothing, they are the innermost ones."""
    ends_m = np.array([*lanes, (0.0, 50.0)])
    travel = SimpleNamespace(corridor=np.array([0, 0, 1]), end_x_m=ends_m)
    aisles = SimpleNamespace(travel=travel, grid=SimpleNamespace(lane_y_m=np.array([0, 0, 4.0])))
    near = np.full((2, 2, 3, 3), 5.0)
    near[:, :, 0, 1] = near[:, :, 1, 0] = -1.0
    apart_m = iter([near, np.full((2, 2, 3, 3), 5.0)])
    monkeypatch.setattr(ladders, "_between_aisles", lambda *_: next(apart_m))
    rungs = ladders.rungs_of(aisles)
    assert rungs.low.tolist() == [20.0, 0.0]
    assert rungs.high.tolist() == [20.0, 50.0]
