"""Doses in the units people write them in."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.decisions.doses import _AMOUNTS, _OF, Dose
from fieldmon.errors import SettingError

UNITS = st.builds("{}/{}".format, st.sampled_from(list(_AMOUNTS)), st.sampled_from(list(_OF)))
DOSES = st.builds(Dose, st.floats(0.01, 1000), UNITS)


@pytest.mark.parametrize(
    ("one", "other", "water", "share"),
    [
        (Dose(50, "ml/dunam"), Dose(0.5, "l/ha"), None, 1.0),
        (Dose(500, "cc/ha"), Dose(0.5, "L / ha"), None, 1.0),
        (Dose(1, "kg/ha"), Dose(400, "g/acre"), None, 1.011714),
        (Dose(0.05, "%"), Dose(50, "ml/100 l"), None, 1.0),
        (Dose(50, "ml/hl"), Dose(0.4, "l/ha"), 800.0, 1.0),
        (Dose(0.4, "l/ha"), Dose(50, "ml/100l"), 800.0, 1.0),
        (Dose(50, "ml/hl"), Dose(0.4, "l/ha"), None, None),
        (Dose(1, "kg/ha"), Dose(1, "l/ha"), 800.0, None),
    ],
)
def test_doses_are_compared_where_they_can_be(one, other, water, share):
    assert one.share_of(other, water) == (share if share is None else pytest.approx(share, 1e-6))


@given(DOSES, DOSES, st.floats(10, 5000))
def test_a_dose_is_so_much_of_another_as_that_is_the_inverse_of_it(one, other, water):
    there, back = one.share_of(other, water), other.share_of(one, water)
    assert (there is None) == (back is None)
    if there and back:
        assert there * back == pytest.approx(1.0, rel=1e-3)
    assert one.share_of(one) == 1.0


@pytest.mark.parametrize(
    ("value", "unit", "said"),
    [
        (0, "l/ha", "must be above 0"),
        (-1, "l/ha", "must be above 0"),
        (float("nan"), "l/ha", "must be a number"),
        (1, "l", "must be an amount by what it is for"),
        (1, "spoons/ha", "'spoons/ha'"),
        (1, "", "must be an amount"),
    ],
)
def test_what_is_no_dose_is_refused(value, unit, said):
    with pytest.raises(SettingError, match=said):
        Dose(value, unit)


def test_a_dose_is_written_as_people_write_it():
    assert str(Dose(0.5, "l/ha")) == "0.5 l/ha"
