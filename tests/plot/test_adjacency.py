"""Who stands next to whom, by the rule read out plant by plant."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.plot.adjacency import across, across_aisles, along, link, lists
from fieldmon.plot.layout import rectangle

ROW_M, PLANT_M = 4.0, 3.0


def neighbours(csr):
    start, plant = csr
    return [set(plant[start[i] : start[i + 1]].tolist()) for i in range(len(start) - 1)]


@st.composite
def plants_on_lines(draw):
    """Draw plants on a few lines, x ascending within each and no two at one place."""
    x, line, y = [], [], []
    for number in range(draw(st.integers(1, 4))):
        # quarters of a metre add up exactly, and some lie just beyond half a spacing
        places = sorted(draw(st.sets(st.integers(0, 60), min_size=1, max_size=8)))
        x += [0.25 * place for place in places]
        line += [number] * len(places)
        y += [draw(st.sampled_from((4.0, 5.0, 6.5))) + (y[-1] if y else 0.0)] * len(places)
    return np.stack([x, y], axis=1), np.array(line)


@given(pairs=st.sets(st.tuples(st.integers(0, 7), st.integers(0, 7)), max_size=20))
def test_a_pair_stands_in_the_lists_of_both(pairs):
    pairs = {(i, j) for i, j in pairs if i < j}
    one, other = np.array(sorted(pairs), np.intp).reshape(-1, 2).T
    start, plant = lists(8, one, other)
    wanted = [sorted({j for i, j in pairs if i == k} | {i for i, j in pairs if j == k})
              for k in range(8)]  # fmt: skip
    assert [plant[start[k] : start[k + 1]].tolist() for k in range(8)] == wanted
    assert (start.dtype, plant.dtype) == (np.int32, np.int32)


@given(plants=plants_on_lines())
def test_along_a_row_stands_the_next_one_unless_one_is_missing_between(plants):
    xy_m, line = plants
    found = neighbours(along(xy_m[:, 0], line, PLANT_M))
    for i, near in enumerate(found):
        wanted = {
            j for j in (i - 1, i + 1)
            if 0 <= j < len(line) and line[j] == line[i]
            and abs(xy_m[j, 0] - xy_m[i, 0]) <= 1.5 * PLANT_M
        }  # fmt: skip
        assert near == wanted


def nearest_on(xy_m, line, i, step):
    """Return the plants of the next line that are nearest to plant i, as near as half a spacing."""
    there = np.flatnonzero(line == line[i] + step)
    if not there.size or abs(xy_m[there[0], 1] - xy_m[i, 1]) > 1.5 * ROW_M:
        return set()
    off = np.abs(xy_m[there, 0] - xy_m[i, 0])
    return set(there[(off == off.min()) & (off <= 0.5 * PLANT_M)].tolist())


@given(plants=plants_on_lines())
def test_across_stand_the_nearest_and_those_whose_nearest_one_is(plants):
    """Where two are as near, either may be taken, but one is."""
    xy_m, line = plants
    found = neighbours(across(xy_m, line, ROW_M, PLANT_M))
    nearest = {(i, step): nearest_on(xy_m, line, i, step)
               for i in range(len(line)) for step in (-1, 1)}  # fmt: skip
    for i, near in enumerate(found):
        assert all(i in found[j] for j in near)
        for j in near:
            step = int(line[j] - line[i])
            assert j in nearest[i, step] or i in nearest[j, -step]
        for step in (-1, 1):
            assert bool(nearest[i, step]) <= bool(near & nearest[i, step])


@given(plants=plants_on_lines())
def test_over_straight_aisles_stand_the_same_plants_as_across_the_rows(plants):
    xy_m, line = plants
    y = np.array([xy_m[line == number][0, 1] for number in range(line[-1] + 1)])
    gap = np.concatenate([[ROW_M], np.diff(y), [ROW_M]])
    aisle = np.stack([line, line + 1], axis=1)
    spacings = np.full(len(line), ROW_M), np.full(len(line), PLANT_M)
    place_m = np.stack([xy_m[:, 0]] * 2, axis=1)
    found = across_aisles(aisle, place_m, gap[aisle] / 2, *spacings)
    for told, wanted in zip(found, across(xy_m, line, ROW_M, PLANT_M), strict=True):
        np.testing.assert_array_equal(told, wanted)


def test_on_an_even_plot_everyone_has_one_before_one_behind_and_one_on_either_side():
    grid = rectangle(3, 4)
    start, other = grid.adjacent
    inner = 1 * 4 + 1
    assert set(other[start[inner] : start[inner + 1]].tolist()) == {4, 6, 1, 9}
    assert set(other[start[0] : start[1]].tolist()) == {1, 4}


@pytest.mark.parametrize("grid", [rectangle(1, 1), rectangle(1, 5), rectangle(4, 6)])
def test_each_neighbour_is_linked_with_its_own_entry_for_the_plant(grid):
    start, plant, back = grid.linked
    source = np.repeat(np.arange(len(grid)), np.diff(start))
    np.testing.assert_array_equal(plant[back], source)
    np.testing.assert_array_equal(back[back], np.arange(len(back)))


def test_an_entry_that_the_other_does_not_return_is_linked_with_itself():
    start, plant = np.array([0, 1, 1], np.int32), np.array([1], np.int32)
    back = np.full(1, -7, np.int32)
    link(start, plant, back)
    assert back.tolist() == [0]
