"""A ladder below a plot: no way on it is longer than the true one."""

import gc
from weakref import ref

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from shapely import MultiPolygon, Polygon

from fieldmon.planning.routes import relaxation
from fieldmon.planning.routes.relaxation import (
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


@pytest.mark.parametrize("hangs", [[0, 0, 0, 0, 0], [1, 0, 2, 0, 1], [2, 2, 0, 1, 0]])
def test_both_ends_of_an_aisle_that_hangs_are_one_place_and_the_other_headland_has_none(hangs):
    n, ends = len(hangs), {0: ((0,), (1,)), 1: ((0, 1), ()), 2: ((), (0, 1))}
    apart_m = np.random.default_rng(1).uniform(1.0, 50.0, (2, 2, n, n))
    found = relaxation._lines(apart_m, np.array(hangs))
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
    place = relaxation.Rungs(low + at_m, high + at_m, up, np.empty(0), np.zeros(len(up), np.int64))
    for order in (np.arange(len(up)), np.arange(len(up))[::-1]):
        members = order if (np.diff(np.sort(up)) > 0).all() else np.arange(len(up))
        found = _hanging(place, members, 1.0)
        assert found.tolist() == [expected[k] for k in members]


@given(crooked_aisles(max_radius_m=60.0, max_plants=400))
def test_where_no_cross_links_are_found_each_element_may_be_crossed_and_none_is_too_long(aisles):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(relaxation, "_ROUNDS", 0)
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
    gc.collect()
    assert gone() is None


def test_the_ends_of_some_aisles_and_a_gate_of_their_own_are_as_far_apart_as_told():
    rungs = Ladders(Aisles.of(rectangle(5, 4))).rungs
    members, to_gate_m = np.array([3, 0, 4]), np.arange(6.0).reshape(2, 3) + 1.0
    apart_m = relaxation._apart(rungs, members, to_gate_m)
    assert apart_m.shape == (2, 2, 4, 4)
    for side, other, a, b in np.ndindex(2, 2, 3, 3):
        told_m = rungs.apart_m[side, other, members[a], members[b]]
        assert apart_m[side, other, a, b] == told_m
    for side, other, a in np.ndindex(2, 2, 3):
        # the gate is one place, whichever of its ends is asked for
        assert apart_m[side, other, a, 3] == to_gate_m[side, a]
        assert apart_m[other, side, 3, a] == to_gate_m[side, a]
    assert np.isinf(apart_m[:, :, 3, 3]).all()
