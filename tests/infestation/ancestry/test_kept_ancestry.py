"""What is kept of an ancestry."""

import numpy as np
import pytest

from fieldmon.infestation.ancestry.kept_ancestry import ancestry_of, arrays_of
from fieldmon.plot.layout import rectangle
from tests.infestation.ancestry.ancestries import GRID, a_week, after


@pytest.mark.parametrize("treated", [True, False])
def test_what_is_kept_of_a_morning_goes_on_as_it_did(treated):
    known = a_week(treated=treated)
    kept = ancestry_of(GRID, arrays_of(known))
    plants = np.arange(50, 90)
    on, chance = after(plants, plants % 9 == 0, known)
    again, same = after(plants, plants % 9 == 0, kept)
    assert (chance == same).all()
    for name, values in arrays_of(on).items():
        assert (values == arrays_of(again)[name]).all(), name
    with pytest.raises(ValueError, match="An ancestry of 100 plants must have arrays of so many"):
        ancestry_of(rectangle(10, 10), arrays_of(known))
