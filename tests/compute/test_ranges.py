"""What a number may be, and how a sentence says that it is not."""

from types import SimpleNamespace

from hypothesis import given
from hypothesis import strategies as st

from fieldmon.compute.ranges import AllowedRange, broken_setting

numbers = st.floats(-1e6, 1e6)


@given(numbers, numbers, st.booleans(), st.booleans(), st.floats())
def test_a_number_breaks_a_rule_just_where_it_is_outside(one, other, above, below, value):
    least, most = sorted((one, other))
    inside = (least < value if above else least <= value) and (
        value < most if below else value <= most
    )
    assert bool(AllowedRange(least, most, above=above, below=below).broken(value)) != inside


def test_the_rule_names_the_end_that_was_passed_with_its_unit():
    hours = AllowedRange(0, 24, above=True, unit=" h")
    assert (hours.broken(0), hours.broken(24.5)) == ("above 0 h", "24 h at most")
    assert AllowedRange(0, 1, below=True).broken(1) == "below 1"
    assert AllowedRange(1, 1e9).broken(2e9) == "1000000000 at most"
    assert AllowedRange(0, 1, said="a chance").broken(2) == "a chance"


def test_the_first_setting_outside_its_range_is_named_and_none_is_no_number():
    ranges = {"a": AllowedRange(0, 1), "b": AllowedRange(0, 1)}
    assert broken_setting(SimpleNamespace(a=None, b=1), ranges) is None
    found = broken_setting(SimpleNamespace(a=None, b=3), ranges)
    assert found == {"name": "b", "value": 3, "rule": "1 at most"}
