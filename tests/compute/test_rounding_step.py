"""The step to which coordinates are rounded is that of the finest of them."""

import numpy as np
import pytest

from fieldmon.compute.rounding_step import step_of


@pytest.mark.parametrize(
    ("xy", "step"),
    [
        ([[35.1, 31.25], [35.0, 31.5]], 0.01),
        ([[600_000.0, 3_500_001.0]], 1.0),
        ([[35.123456789012, 31.0]], 0.0),
    ],
)
def test_the_step_is_that_of_the_finest(xy, step):
    assert step_of(np.array(xy)) == pytest.approx(step)
