"""The figures of the chance map: none out of range, and how long a record counts."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.infestation.prior.prior_settings import PriorSettings


@pytest.mark.parametrize(
    "wrong",
    [
        {"background_chance": 1.5},
        {"edge_chance": -0.1},
        {"edge_depth_m": 0.0},
        {"reach_m": np.nan},
        {"half_life_days": np.inf},
        {"accuracy_m": -1.0},
        {"undated_days": np.nan},
        {"detection": 84.0},
        {"beside_one": 0.5, "beside_many": 0.4},
    ],
)
def test_a_setting_out_of_range_is_refused_by_name(wrong):
    with pytest.raises(SettingError, match=list(wrong)[-1]):
        PriorSettings(**wrong)


def test_after_the_days_in_which_it_hardly_counts_a_thirtieth_of_a_record_is_left():
    settings = PriorSettings(half_life_days=9.0)
    assert 0.5 ** (settings.hardly_days / settings.half_life_days) == 1 / 32
