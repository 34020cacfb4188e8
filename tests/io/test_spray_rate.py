"""A rate that nobody sprays is refused alike wherever it is said."""

from functools import partial

import numpy as np
import pytest
from shapely import MultiPolygon

from fieldmon.errors import SettingError
from fieldmon.io.writers.treatment_map import TreatmentMap
from fieldmon.monitoring.settings.advice_settings import AdviceSettings


@pytest.mark.parametrize("rate", [0.0, -1.0, 100_000.0, np.nan, np.inf, "300", None])
def test_a_rate_that_nobody_sprays_is_refused_alike_in_a_map_and_in_advice(rate):
    said = []
    for make in (AdviceSettings, partial(TreatmentMap, "plot", MultiPolygon(), [])):
        with pytest.raises(SettingError, match="The rate in the zones must") as refused:
            make(rate_l_ha=rate)
        said.append(str(refused.value))
    assert said[0] == said[1]
