"""What files come to, read once for all who bring the same."""

import pytest

from app.state import cached_files
from fieldmon.errors import PlotError
from tests.app.chosen import a_plot


def test_what_an_answer_leads_to_is_tried_once_for_a_key():
    made = []
    for key in ("a", "a", "b"):
        cached_files.tried(f"test {key}", lambda key=key: made.append(key))
    assert made == ["a", "b"]


def test_directions_of_plants_are_kept_by_the_key_of_their_plot():
    plants = a_plot().grid.lonlat()
    found = cached_files.directions("a square", plants)
    assert cached_files.directions("a square", plants[:1]) == found
    with pytest.raises(PlotError, match="2 plants or more"):
        cached_files.directions("a single plant", plants[:1])
