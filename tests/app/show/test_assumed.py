"""What is assumed, in words."""

from app.show.assumed import mark, sentence
from app.words.units import UnitsInLanguage
from fieldmon.plot.assumed import Assumed

ROWS, KNOWN = Assumed("row_spacing_m", 4.0), Assumed("background_chance", 0.01)


def test_lengths_are_in_the_persons_unit_and_chances_in_percent():
    assert sentence([ROWS, KNOWN], UnitsInLanguage()).endswith(
        "assumed: rows 4 m apart, 1 % of plants infested where nothing is known."
    )
    assert "rows 13.1234 ft apart" in sentence([ROWS], UnitsInLanguage(length="ft"))
    assert sentence([], UnitsInLanguage()) == ""


def test_only_figures_that_rest_on_it_are_marked():
    assert mark("Plants", [ROWS], ("row_spacing_m",)) == "Plants *"
    assert mark("Plants", [KNOWN], ("row_spacing_m",)) == "Plants"
