"""Records of one visit are told apart from those of several."""

import numpy as np
import pytest

from fieldmon.io.readers.visits import VISIT_S, first_of_visits, same_places, telling
from tests.io.tables_of_cells import table

NAN = float("nan")


@pytest.mark.parametrize(
    ("at_s", "first"),
    [
        ([NAN, NAN, NAN], [0]),
        ([0, VISIT_S, VISIT_S + 1], [0, 2]),
        ([VISIT_S + 1, VISIT_S, 0], [0, 2]),
        ([50_000, 0, 50_001], [0, 1]),
        ([0, NAN, 1], [0]),
        ([NAN, 50_000, 0], [1, 2]),
    ],
)
def test_a_visit_lasts_some_minutes_from_its_first_record(at_s, first):
    assert first_of_visits(["a"] * 3, np.array(at_s, float)).tolist() == first
    assert first_of_visits("abc", np.array(at_s, float)).tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    ("apart_m", "accuracy_m", "same"),
    [
        (0.0, NAN, True),
        (0.005, NAN, True),
        (0.1, NAN, False),
        (0.0, 5.0, True),
        (0.3, 5.0, False),  # so far off it names no plant
        (0.03, 0.05, True),
        (0.1, 0.05, False),
        (0.45, 1.0, True),
        (0.6, 1.0, False),  # perhaps the next plant
    ],
)
def test_a_place_is_the_same_within_an_accuracy_that_tells_plants_apart(apart_m, accuracy_m, same):
    places = same_places(np.array([[0.4, -0.1], [0.4 + apart_m, -0.1]]), np.full(2, accuracy_m))
    assert (places[0] == places[1]) is np.bool_(same)


@pytest.mark.parametrize(
    ("name", "cells", "tells"),
    [
        ("scout", ["Ann", "Ben"], True),
        ("trap_id", [1, 2], True),
        ("no", [1, 2], False),
        ("no", [1, 1], True),  # of a thing, which repeats
        ("id", ["a", "b"], False),
        ("detection_id", [7, 7], False),
        ("confidence", [0.1, 0.2], False),
        ("notes", ["a", "b"], False),
        ("time", ["08:00", "2026-11-20T17:00:00Z"], False),
        ("hour", ["8", "17"], False),
        ("time", ["early", "late"], True),
        ("lon", [1, 2], False),
    ],
)
def test_a_column_tells_things_apart_unless_it_is_of_the_record_its_time_or_its_place(
    name, cells, tells
):
    told = telling(table(**{name: cells}), np.arange(2), ["lon"]).get(name, ["", ""])
    assert (told[0] != told[1] or told[0] != "") is tells
