"""A sprayer and what treating costs: only what can be is taken."""

import pytest

from fieldmon.decisions.sprayer import Sprayer, TreatmentCosts
from fieldmon.errors import SettingError


def test_a_booms_section_covers_whole_rows():
    assert Sprayer.of_boom(12.0, 4, 1.5).rows == 2
    assert Sprayer.of_boom(3.0, 4, 4.0).rows == 1
    for width_m in (0.0, -1.0, float("inf")):
        with pytest.raises(SettingError, match="A boom must have"):
            Sprayer.of_boom(width_m, 4, 4.0)


@pytest.mark.parametrize("row_spacing_m", [0.0, -1.0, float("inf")])
def test_rows_under_a_boom_stand_apart(row_spacing_m):
    with pytest.raises(SettingError, match="under a boom must be 0"):
        Sprayer.of_boom(12.0, 4, row_spacing_m)


@pytest.mark.parametrize(
    "made",
    [
        lambda: Sprayer(-1),
        lambda: Sprayer(10**30),
        lambda: Sprayer(least_on_m=1e30),
        lambda: Sprayer.of_boom(1e30, 4, 1.5),
        lambda: TreatmentCosts(per_ha=-2.0),
        lambda: TreatmentCosts(works=0.0),
        lambda: TreatmentCosts(reserve=1.0),
    ],
)
def test_what_cannot_be_is_refused(made):
    with pytest.raises(SettingError, match="must be"):
        made()


@pytest.mark.parametrize("name", ["per_ha", "per_zone", "infested_plant_day", "days"])
@pytest.mark.parametrize("value", [10**30, 1e30, float("nan"), float("inf"), -1.0, "much"])
def test_costs_that_nobody_has_are_refused_by_their_name(name, value):
    with pytest.raises(SettingError, match=f"treatment's {name} must be"):
        TreatmentCosts(**{name: value})
