"""The field of chapter 4."""

import numpy as np
import pytest

from fieldmon.errors import SettingError
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS, Hours, Vineyard, infest


@pytest.mark.parametrize(("scenario", "faces"), [("A", 500), ("B", 670), ("C", 1000)])
def test_the_scenarios_have_the_faces_of_the_thesis(scenario, faces):
    assert SCENARIOS[scenario].faces == faces
    assert SCENARIOS[scenario].vine_rows == 6


def test_a_field_is_made_of_row_length_area_and_distances_rounded_away_from_zero():
    assert Vineyard.from_size(100, 2, 3.5, 2) == SCENARIOS["A"]
    assert Vineyard.from_size(200, 4, 3.5, 3) == SCENARIOS["B"]
    assert Vineyard.from_size(75, 1.875, 2, 10).plants == 8
    assert Vineyard.from_size(75, 1.875, 2, 10).vine_rows == 13


def test_a_vine_is_infested_on_all_its_faces_and_an_outer_vine_has_one():
    plants, sides = 10, 6
    for row, expected in enumerate([{0}, {1, 2}, {3, 4}, {5}]):
        coins = np.zeros(40)
        coins[row * plants + 3] = 0.8
        faces = np.flatnonzero(infest(plants, sides, coins, 0.3))
        assert {tuple(divmod(int(face), plants)) for face in faces} == {(s, 3) for s in expected}


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Vineyard(5, 6, 2.0), "more than 5 vines.* but it holds 5"),
        (lambda: Vineyard(50, 1, 2.0), "at least 2 rows.* but it has 1"),
        (lambda: Vineyard(50, 6, 0.0), "more than 0 m apart, but they stand 0.0 m"),
        (lambda: Vineyard.from_size(100, 2, 0, 2), "distance between rows must be above 0"),
        (lambda: Hours(speed_m_s=0), "above 0 m/s, but it is 0"),
        (lambda: Hours(turn_180_s=-1), "turn_180_s must be 0 s or more, but it is -1"),
        (lambda: Hours(day_s=90_000), "0 to 86400 s, but day_s is 90000"),
        (lambda: Hours(days=0), "at least 1 day, but days is 0"),
    ],
)
def test_impossible_fields_and_hours_are_refused_with_a_sentence(make, sentence):
    with pytest.raises(SettingError, match=sentence):
        make()
