"""How a plot is planted, as it is said."""

import pytest

from fieldmon.errors import SettingError
from fieldmon.plot.planting import Planting


@pytest.mark.parametrize(
    "wrong",
    [
        {"row_spacing_m": 0.0},
        {"plant_spacing_m": float("nan")},
        {"headland_m": -1.0},
        {"headland_m": float("inf")},
        {"row_bearing_deg": float("nan")},
        {"faces": 3},
    ],
)
def test_impossible_plantings_are_refused(wrong):
    with pytest.raises(SettingError):
        Planting(**wrong)


def test_what_can_be_planted_can_be_said():
    for edge in (0.05, 1000.0):
        assert Planting(row_spacing_m=edge, plant_spacing_m=edge, headland_m=edge).faces == 1
    assert Planting(faces=2, half_canopy_m=0.0, row_bearing_deg=-360.0).outer_faces
