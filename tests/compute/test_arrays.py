"""Lists one after the other, and arrays nobody may change."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.compute.arrays import as_compiled, offsets, read_only, run_ends, runs

COUNTS = st.lists(st.integers(0, 9), max_size=30)


@given(counts=COUNTS)
def test_lists_stand_one_after_the_other_without_a_gap(counts):
    start = offsets(np.array(counts, np.int32))
    joined = np.concatenate([np.full(n, i) for i, n in enumerate(counts)] or [np.empty(0)])
    assert start[0] == 0
    assert start[-1] == len(joined)
    for i, count in enumerate(counts):
        own = joined[start[i] : start[i + 1]]
        assert own.tolist() == [i] * count


@given(runs_of=st.lists(st.tuples(st.integers(-50, 50), st.integers(0, 9)), max_size=30))
def test_runs_are_the_whole_numbers_from_each_first_one(runs_of):
    first, count = np.array(runs_of, np.int64).reshape(-1, 2).T
    numbers, run = runs(first, count)
    wanted = [(i, start + k) for i, (start, n) in enumerate(runs_of) for k in range(n)]
    assert list(zip(run.tolist(), numbers.tolist(), strict=True)) == wanted


@given(numbers=st.sets(st.integers(0, 40)).map(sorted))
def test_the_ends_of_runs_are_numbers_without_the_one_before_or_after_them(numbers):
    first, last = run_ends(np.array(numbers, np.int64)).T.tolist()
    assert first == [k for k in numbers if k - 1 not in numbers]
    assert last == [k for k in numbers if k + 1 not in numbers]


def test_what_is_read_only_is_the_same_array_and_cannot_be_written_to():
    array = np.arange(3)
    assert read_only(array) is array
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 1


@pytest.mark.parametrize(
    "array", [np.arange(5), np.arange(10)[::2], read_only(np.arange(5)), np.arange(0)]
)
def test_loops_are_compiled_once_for_slices_and_for_what_nobody_may_change(array):
    same = as_compiled(array)
    np.testing.assert_array_equal(same, array)
    assert same.dtype == array.dtype
    assert same.flags.c_contiguous
    assert same.flags.writeable
    assert (same is array) == (array.flags.c_contiguous and array.flags.writeable)
