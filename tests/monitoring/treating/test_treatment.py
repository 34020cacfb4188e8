"""A treatment of some plants on some day."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.monitoring.treating.treatment import Treatment

PLANTS = np.ones(9, np.bool_)


@pytest.mark.parametrize("efficacy", [1.5, -0.1, np.nan, "0.8"])
def test_an_impossible_efficacy_is_refused(efficacy):
    with pytest.raises(SettingError, match="efficacy"):
        Treatment(0, PLANTS, efficacy)


def test_one_of_which_nobody_said_when_is_over_after_all_of_the_day_s_inspections():
    assert Treatment(0, PLANTS, 0.8).second == np.inf
