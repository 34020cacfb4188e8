"""What is doubtful about rows is said, each doubt in a sentence; what is certain is not."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.plot.plot import plot_around
from fieldmon.plot.projection import Frame
from fieldmon.plot.row_detection import RowDirection
from fieldmon.plot.row_report import RowReport

SURE = RowReport("20 plants in 4 rows", 0.02, 0.0, in_rows=True)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, None),
        ({"off_share": 0.009, "misnamed_share": 0.009}, None),
        ({"off_share": 0.04}, "4 % of the plants stand more than a quarter"),
        ({"misnamed_share": 0.2, "named": True}, "20 % of the plants seem to stand in another row"),
        ({"misnamed_share": 0.2, "named": True}, "the names decided"),
        ({"misnamed_share": 0.6}, "rows were found instead"),
        (
            {"directions": (RowDirection(20, 9, 3.0), RowDirection(80, 12, 3.0))},
            "in 2 directions: 9 rows along 20 degrees, but also 12 rows along 80 degrees. The",
        ),
        ({"in_rows": False}, "No rows were found"),
        ({"rows_said_m": (7.0, 2.5)}, "Rows of the measured plants are 2.50 m apart, not 7 m"),
        ({"plants_said_m": (5.0, 1.4)}, "Measured plants are 1.40 m apart in their rows, not 5 m"),
    ],
)
def test_each_doubt_is_a_sentence_and_what_is_certain_is_none(changes, said):
    doubts = replace(SURE, **changes).doubts
    if said is None:
        assert doubts == ()
    else:
        (doubt,) = doubts
        assert said in doubt


def test_plants_that_stand_anyhow_are_not_said_to_be_beside_rows_too():
    (doubt,) = replace(SURE, in_rows=False, off_share=0.5).doubts
    assert "No rows" in doubt


def test_the_share_beside_a_row_is_that_of_the_plants_moved_out_of_it():
    rng = np.random.default_rng(4)
    row, number = np.divmod(np.arange(12 * 50), 50)
    xy_m = np.stack([1.5 * number, 3.0 * row], axis=1) + rng.normal(0, 0.02, (600, 2))
    moved = rng.choice(np.flatnonzero((number > 4) & (number < 45)), 30, replace=False)
    xy_m[moved, 1] += 1.0
    found = plot_around("plot", Frame(8.0, 47.0).lonlat(xy_m)).rows
    assert found.in_rows
    assert found.off_share == pytest.approx(30 / 600, abs=0.01)
    assert any("beside their row" in doubt for doubt in found.doubts)


def test_blocks_of_which_one_is_taken_along_the_others_rows_are_doubted():
    x, y = np.meshgrid(1.5 * np.arange(20), 2.5 * np.arange(20))
    one = np.stack([x.ravel(), y.ravel()], axis=1)
    both = np.concatenate([one, one[:, ::-1] + (x.max() + 3.0, 0.0)])
    two, alone = (plot_around("a", Frame(8.0, 47.0).lonlat(xy)) for xy in (both, one))
    assert any("50 % of the plants stand nearer to one of another" in one for one in two.doubts)
    assert alone.rows.nearer_share == 0.0


def test_exact_rows_taken_across_are_doubted_where_a_few_plants_tell():
    across = replace(SURE, nearer_share=0.9)
    assert across.doubts == ()
    (doubt,) = replace(across, exact=True).doubts
    assert doubt.startswith("90 % of the plants stand nearer to one of another row")
    assert replace(across, exact=True, nearer_share=1.0).doubts == ()
