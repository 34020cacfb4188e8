"""The slips of the listings, each of which can be put right."""

from dataclasses import asdict

import pytest

from fieldmon.studies.thesis.chapter4.listing_errors import (
    ALL_PUT_RIGHT,
    AS_PUBLISHED,
    NAMES,
    NIGHT_CORRECTED,
)


def test_as_published_all_are_in_force():
    assert all(asdict(AS_PUBLISHED).values())
    assert tuple(asdict(AS_PUBLISHED)) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_each_is_put_right_alone(name):
    right = asdict(AS_PUBLISHED.without(name))
    assert [each for each in NAMES if not right[each]] == [name]


def test_putting_right_twice_changes_nothing_and_order_does_not_matter():
    one, other = NAMES[:2]
    both = AS_PUBLISHED.without(one, other)
    assert both == AS_PUBLISHED.without(other).without(one) == both.without(one)
    assert AS_PUBLISHED.without() == AS_PUBLISHED


def test_the_named_sets_put_right_what_they_say():
    assert {n for n in NAMES if not getattr(NIGHT_CORRECTED, n)} == {
        "night_other_face", "night_row_index",
    }  # fmt: skip
    # drawing at every stop is what the prose says: no slip
    assert {n for n in NAMES if getattr(ALL_PUT_RIGHT, n)} == {"draw_every_stop"}


def test_an_unknown_slip_is_refused():
    with pytest.raises(TypeError, match="unexpected keyword"):
        AS_PUBLISHED.without("typo")
