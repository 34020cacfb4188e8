"""Reward matrices: read from files, and drawn by the published recipes."""

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.studies.routes.drive import Walker, driven
from fieldmon.studies.routes.instances import (
    full_budget,
    patchy_map,
    read_matrix,
    smooth_map,
    zipf,
)


@pytest.mark.parametrize(
    "text", ["1,0,3\n0,2,2.5\n", "1;0;3\r\n\r\n0;2;2.5\r\n", " 1 , 0 , 3\n0,2,2.5"]
)
def test_a_matrix_is_read_line_by_line_however_it_is_written(text):
    instance = read_matrix(text, "tiny.csv")
    assert instance.name == "tiny.csv"
    assert instance.reward.tolist() == [[1.0, 0.0, 3.0], [0.0, 2.0, 2.5]]


@pytest.mark.parametrize(
    ("text", "words"),
    [("1,2\n1,x\n", "line 2 does not: '1,x'"), ("1,2\n3\n", r"2 lines of \[1, 2\] numbers"),
     ("1,nan\n", "rewards of 0 or more"), ("1,-1\n", "rewards of 0 or more")],
)  # fmt: skip
def test_what_is_no_matrix_is_refused_with_the_line(text, words):
    with pytest.raises(FileProblem, match=words):
        read_matrix(text, "bad.csv")


@pytest.mark.parametrize("shape", [(1, 1), (2, 5), (7, 4), (100, 50)])
def test_the_full_budget_is_enough_to_pass_every_plant(shape):
    m, n = shape
    walker = Walker(n)
    for row in range(m):
        walker.through(row)
    walked = driven(walker.home(), np.ones(shape))
    assert walked.reward == m * n
    # an odd number of rows drives one of them twice
    assert walked.steps <= full_budget(m, n) + (n + 1) * (m % 2)


@pytest.mark.parametrize("exponent", [0.0, 0.8, 1.9])
def test_rewards_fall_by_zipfs_law(exponent):
    reward = zipf((200, 200), exponent, 3).reward
    assert (reward == np.round(reward)).all()
    assert (reward.min(), reward.max() <= 100) == (0.0, True)
    for low, high in ((0, 1), (1, 3)):
        share = (reward == high).sum() / (reward == low).sum()
        assert share == pytest.approx(((high + 1) / (low + 1)) ** -exponent, rel=0.2)


def test_a_smooth_map_has_neighbours_alike_and_a_patchy_one_is_empty_but_for_patches():
    smooth, patchy = (draw((60, 80), 1).reward for draw in (smooth_map, patchy_map))
    for reward in (smooth, patchy):
        assert (reward.min(), reward.max()) == (0.0, 100.0)
        assert np.corrcoef(reward[:, 1:].ravel(), reward[:, :-1].ravel())[0, 1] > 0.7
        assert np.corrcoef(reward[1:].ravel(), reward[:-1].ravel())[0, 1] > 0.7
    assert np.abs(np.diff(smooth, axis=1)).max() < 10.0
    assert (patchy == 0).mean() == pytest.approx(0.9, abs=0.01)
