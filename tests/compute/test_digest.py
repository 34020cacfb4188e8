"""Digests that stand in files come out as when they were stored, and tell values apart."""

import hashlib
from datetime import date

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import MultiPolygon, Point, box

from fieldmon.compute.digest import digest, places_by_name
from fieldmon.monitoring.file.geopackage import blob

AREA = MultiPolygon([box(35.15, 30.36, 35.1508, 30.3607)])


def test_of_bytes_alone_it_is_their_sha_256():
    assert digest(b"abc", end=b"") == hashlib.sha256(b"abc").hexdigest()
    assert digest(b"abc", length=7, end=b"") == hashlib.sha256(b"abc").hexdigest()[:7]


# as the first versions stored them: in season files, and as names of a study's chunks
@pytest.mark.parametrize(
    ("parts", "how", "stored"),
    [
        (
            (
                *("1", "abc", repr({"sampler": "naive", "hours": 4.0}).encode()),
                *((1, 5), 25, AREA, np.arange(3.0)),
            ),
            {"length": 20},
            "cc0bf4b8441951702f38",
        ),
        (
            (np.round(np.linspace(0, 1, 7), 9),),
            {"length": 24, "end": b""},
            "e4567b30a0e5fe5fdf6b7e36",
        ),
        (
            (np.array([3, 1, 2], "<i4"), np.array([0.123, 10.5, 20.25]), (-1, 3600.0)),
            {"length": 24, "end": b""},
            "beb9bcefc0ccca079bbacd1b",
        ),
        (
            (b"7|2026-04-06|08:30:00|found|3.0",),
            {"length": 24, "end": b""},
            "c416ebd087c0ac9b9d9f26ea",
        ),
        (
            (((2, str(date(2026, 4, 8)), 0.8, "soap", 17), blob(AREA)),),
            {"length": 24, "end": b""},
            "410c0159e3772ce58f85be04",
        ),
    ],
    ids=["chunk of a study", "chance map", "route", "inspection", "treatment"],
)
def test_what_was_stored_comes_out_again(parts, how, stored):
    assert digest(*parts, **how) == stored


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ((1, 2), (12,)),
        (("a", "b"), ("ab",)),
        ((np.arange(3),), (np.arange(4),)),
        ((Point(1, 2),), (Point(1, 2.0000001),)),
        (({"a": 1},), ({"a": 2},)),
        ((None,), ("None",)),
        ((), (None,)),
    ],
)
def test_other_values_have_another_digest(one, other):
    assert digest(*one) != digest(*other)


def test_the_order_of_a_mapping_does_not_matter_but_that_of_the_parts_does():
    assert digest({"a": 1, "b": 2}) == digest({"b": 2, "a": 1})
    assert digest("a", "b") != digest("b", "a")


@given(st.integers(1, 64))
def test_a_shorter_digest_is_the_beginning_of_a_longer_one(length):
    assert digest("x", 1.5, length=length) == digest("x", 1.5)[:length]


def test_each_name_has_a_place_of_its_own_until_so_many_others_were_asked_for():
    place = places_by_name(2)
    place("a").append(1)
    assert (place("b"), place("a")) == ([], [1])
    place("c")
    place("d")
    assert place("a") == []
