"""What labels allow: groups, waits, and the strictest of several."""

import pytest

from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import (
    ProductLabel,
    checked_waits,
    irac_groups,
    label_for,
    of_others,
    with_wait,
)
from fieldmon.errors import SettingError

FULL = ProductLabel(
    "Acarol", "tomato", "spider mites", Dose(0.5, "l/ha"), 3, 12.0, ("4A", "28"), 2, "label 2025"
)


@pytest.mark.parametrize(
    ("said", "groups"),
    [
        ("6", ("6",)), ("IRAC Group 4a", ("4A",)), ("4A + 28", ("4A", "28")), ("un", ("UN",)),
        ("", ()), ("6, 6", ("6",)),
    ],
)  # fmt: skip
def test_groups_are_known_however_they_are_written(said, groups):
    assert irac_groups(said) == groups


def test_where_nobody_said_crop_or_pest_the_strictest_counts():
    rose = ProductLabel("acarol", "rose", "", Dose(20, "ml/dunam"), 1, 24.0, ("6",), 5, "rose")
    assert label_for([FULL, rose], "ACAROL", "Tomato") == FULL
    assert label_for([FULL, rose], "soap") is None
    both = label_for([FULL, rose], "Acarol", dose=Dose(0.1, "l/ha"))
    assert (both.max_dose, both.waiting_days, both.reentry_hours) == (rose.max_dose, 3, 24.0)
    assert (both.max_uses, both.irac_groups) == (2, ("4A", "28", "6"))


@pytest.mark.parametrize(
    ("used", "water", "strictest"),
    [
        ("1.5 l/ha", 500, "0.1 %"), ("5 l/ha", 500, "0.1 %"), ("5 l/ha", 5000, "2 l/ha"),
        ("1.5 l/ha", None, "0.1 %"), ("2.5 l/ha", None, "2 l/ha"), ("3 kg/ha", 500, None),
    ],
)  # fmt: skip
def test_of_doses_on_an_area_and_in_water_the_strictest_counts_in_any_order(used, water, strictest):
    value, _, unit = used.partition(" ")
    lines = [ProductLabel("oil", "vine", max_dose=Dose(2, "l/ha")),
             ProductLabel("oil", "rose", max_dose=Dose(0.1, "%"))]  # fmt: skip
    for order in (lines, lines[::-1]):
        label = label_for(order, "oil", dose=Dose(float(value), unit), water_l_ha=water)
        assert strictest in {None, str(label.max_dose)}


@pytest.mark.parametrize(("days", "hours"), [(3651, None), (1.5, None), (None, -1), (None, 1e9)])
def test_waits_that_cannot_be_are_refused(days, hours):
    with pytest.raises(SettingError):
        checked_waits(days, hours)


def test_a_wait_said_by_hand_replaces_what_was_said_so_and_never_shortens_the_table_s():
    longer = with_wait(with_wait([FULL], "ACAROL", 1), "acarol", 2)
    assert longer[0] == FULL
    assert [one.waiting_days for one in longer] == [3, 2]
    assert label_for(longer, "Acarol", "tomato").waiting_days == 3
    assert label_for(longer, "Acarol", "tomato").irac_groups == FULL.irac_groups
    # of another crop, or of this one by another name: the strictest line
    assert label_for(longer, "Acarol", "rose").waiting_days == 3


def test_a_crop_or_pest_by_another_name_is_held_to_the_strictest_line_of_the_product():
    rose = ProductLabel("acarol", "rose", "", None, 1, 24.0, (), 1)
    label = label_for([FULL, rose, ProductLabel("Oil", max_uses=1)], "Acarol", "pimiento", "mites")
    assert (label.waiting_days, label.reentry_hours, label.max_uses) == (3, 24.0, 1)
    assert label.irac_groups == ("4A", "28")
    assert of_others([FULL, rose], "ACAROL", "pimiento", "mites") == (FULL, rose)
    assert of_others([FULL, rose], "Acarol", "rose", "mites") == ()
    assert of_others(with_wait([FULL], "Acarol", 9), "Acarol", "", "mites") == (FULL,)
    assert of_others(with_wait([], "Acarol", 9), "Acarol", "", "mites") == ()
